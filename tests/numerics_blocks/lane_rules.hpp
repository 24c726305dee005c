// Iterations of a batch, beside the same ones of one trajectory alone.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

namespace packs_of_rules {
#include "tests/numerics_blocks/packs.inc"
}  // namespace packs_of_rules

namespace lanes = packs_of_rules;
using of_double::Verdict;
inline constexpr int kCount = 8;

// Increments of an iteration from its first on, the last one again and again.
struct Increments {
  std::string name;
  std::vector<double> sizes;
  [[nodiscard]] double at(int iteration) const {
    const auto i = static_cast<std::size_t>(iteration - 1);
    return i < sizes.size() ? sizes[i] : sizes.back();
  }
};

inline const std::vector<Increments>& all_increments() {
  static const double infinity = std::numeric_limits<double>::infinity();
  static const double nan = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<Increments> list = {
      {"quadratic", {1e-2, 1e-4, 1e-8, 1e-16}},
      {"at once", {1e-17}},
      {"lost", {1e-3, nan}},
      {"never", {1, 0.99}},
      {"astray", {1e-3, 9e-4, 1e-9, 0}},
      {"stands still", {1e-3, 1e-13, 2e-13, 3e-13}},
      {"infinite", {1e300, infinity}},
      {"fast", {1e-5, 1e-12}},
      {"linear", {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-15}},
      {"two sequences", {1e-2, 1e-9, 1e-3, 1e-10, 1e-5, 1e-14, 1e-9, 1e-15, 1e-13, 1e-16}},
      {"nothing", {0}},
      {"noise", {1e-6, 1e-14, 2e-14, 1e-14, 3e-14, 2e-14, 1e-14}},
      {"grows", {1e-9, 1e-8, 1e-7, 1e-6, 1e-5}},
      {"stalls", {6e-14, 6e-14, 7e-14, 5e-14, 7e-14, 4e-14, 7e-14, 3e-14, 1e-16}},
      {"slow and close", {1e-4, 0.6e-4, 0.4e-4, 1e-15}},
      {"slow", {1e-2, 6e-3, 3.5e-3, 2e-3, 1.2e-3, 7e-4, 4e-4, 2.5e-4, 1.5e-4, 1e-15}}};
  return list;
}
inline const Increments& increments_of(int batch, int lane) {
  return all_increments()[static_cast<std::size_t>(kCount * batch + lane)];
}

// How many iterations, and whether the end was a success.
struct End {
  int iterations = 0;
  bool done = false;
  bool operator==(const End&) const = default;
};
inline void PrintTo(const End& end, std::ostream* out) {
  *out << end.iterations << (end.done ? " done" : " failed");
}

// Of a rule that is asked by `ask`, from iteration 1 on.
template <class Ask>
End end_alone(const Increments& increments, const Ask& ask) {
  for (int iteration = 1;; ++iteration) {
    const Verdict verdict = ask(increments.at(iteration), iteration);
    if (verdict != Verdict::go_on) return {iteration, verdict == Verdict::done};
  }
}
// What stands in the lanes of the iteration of this number.
inline lanes::Real sizes_of(int batch, int iteration) {
  lanes::Real size = 0;
  for (int lane = 0; lane < kCount; ++lane)
    size.set(lane, increments_of(batch, lane).at(iteration));
  return size;
}
template <class Ask>
void ask_together(int batch, const Ask& ask) {
  int iteration = 1;
  while (any(ask(sizes_of(batch, iteration), iteration))) ++iteration;
}
inline End end_in(const lanes::Iteration& rule, int lane) {
  return {static_cast<int>(rule.taken[lane]), !rule.failed[lane]};
}
template <class Distance, class Number>
Distance distance_of(const Number& size) {
  Distance distance;
  distance.add(size, Number(1));
  return distance;
}
inline of_double::Distance moved_by(double size) { return distance_of<of_double::Distance>(size); }
inline lanes::Distance moved_by(const lanes::Real& size) {
  return distance_of<lanes::Distance>(size);
}

// Not one of those in which all check their contraction.
inline lanes::Turn turn_of_all() {
  lanes::Turn turn;
  turn.begin(true);
  return turn;
}

}  // namespace hamgen::numerics_blocks_test
