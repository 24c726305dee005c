// The iterations of a routine, with the rules of generator/numerics.
#pragma once

#include <algorithm>
#include <utility>

#include "generator/interpreter/machine_addresses.hpp"

namespace hamgen {

template <class Real>
class MachineIterations : public MachineAddresses<Real> {
 protected:
  using Base = MachineAddresses<Real>;
  using Base::Base;
  using Base::m_;
  using Base::magnitude;
  using typename Base::Array2;
  using typename Base::Compiled;
  using typename Base::Distance;
  using Step = std::function<bool()>;  // false: the routine has ended
  using Steps = std::vector<Step>;

  static bool run_all(const Steps& steps) {
    return std::ranges::all_of(steps, [](const Step& step) { return step(); });
  }

  // The rule hears of the corrections before they are made; the last ones are not made here.
  template <class Judge, class Correct>
  bool run_newton(AnyNewtonRule<Real>& rule, bool predicted, const Steps& body, const Judge& judge,
                  const Correct& correct) const {
    m_.newton = &rule;
    rule.begin(predicted);
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      const auto [answer, size] = judge(static_cast<int>(m_.iteration));
      if (answer != Answer::go_on) return ends(answer, size);
      correct();
    }
  }

  // The rule hears of the unknowns as they are measured, which may move them; what is left to move
  // depends on its answer.
  template <class Measure, class Judge, class Move>
  bool run_contraction(const Steps& body, const Measure& measure, const Judge& judge,
                       const Move& move) const {
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      const Distance distance = measure();
      const auto [answer, size] = judge(distance, static_cast<int>(m_.iteration));
      move(answer);
      if (answer != Answer::go_on) return ends(answer, size);
    }
  }
  template <class Measure, class Judge>
  bool run_contraction(const Steps& body, const Measure& measure, const Judge& judge) const {
    return run_contraction(body, measure, judge, [](Answer) {});
  }

  static std::pair<Answer, Real> judged(AnyFixedPointRule<Real>& rule, const Distance& distance,
                                        int iteration) {
    const Answer answer = rule(distance, iteration);
    return {answer, rule.size()};
  }

  // Of arrays in loops: whole ones are summed as Distance does it, in parts, others one by one.
  template <class Each>
  Distance measure_each(const Each& each, bool are_whole, std::size_t arrays,
                        bool is_in_loops) const {
    struct Seen {
      std::vector<Real> moved, value, beside;
    };
    std::vector<Seen> seen(arrays);
    std::size_t next = 0;
    Distance distance;
    if (is_in_loops) distance.narrow();
    each([&](const Array2& u) {
      const Real value = m_.frame.at(u.value);
      const Real increment = m_.frame.at(u.increment);
      const Real beside = u.beside(m_.frame);
      if (are_whole) {
        Seen& array = seen[next++ % arrays];
        array.moved.push_back(increment);
        array.value.push_back(value);
        array.beside.push_back(beside);
      } else {
        distance.add(magnitude(increment), magnitude(value) + magnitude(beside));
      }
    });
    for (const Seen& array : seen) {
      distance.add(array.moved.data(), array.value.data(), array.beside.data(),
                   static_cast<int>(array.moved.size()));
    }
    return distance;
  }
  template <class Each>
  void move_each(const Each& each) const {
    each([&](const Array2& u) { m_.frame.at(u.value) += m_.frame.at(u.increment); });
  }
  template <class Each>
  std::pair<Answer, Real> judged_in_loops(AnyNewtonRule<Real>& rule,
                                          const typename MachineAddresses<Real>::Whole& lengths,
                                          const Each& each, std::size_t arrays,
                                          int iteration) const {
    std::size_t count = 0;
    each([&](const Array2&) { ++count; });
    // They stand in their order, one array after the other; what is summed is one of each.
    std::size_t next = 0;
    const auto unknown = [&] { return next % arrays * (count / arrays) + next / arrays; };
    std::vector<Real> all_lengths(count), all_moved(count);
    if (lengths.size > 0) std::copy_n(&m_.frame.at(lengths.first), count, all_lengths.begin());
    each([&](const Array2& u) {
      all_moved[unknown()] = m_.frame.at(u.increment);
      ++next;
    });
    rule.know(all_lengths, all_moved);
    // In the order in which it is written.
    typename AnyNewtonRule<Real>::Sums sums;
    next = 0;
    each([&](const Array2& u) {
      const Real value = m_.frame.at(u.value);
      const Real beside = u.beside(m_.frame);
      const Real moved = magnitude(m_.frame.at(u.increment));
      const Real length = magnitude(value) + magnitude(beside);
      const std::size_t j = unknown();
      ++next;
      sums.size += moved * rule.unit(j);
      sums.moved += moved;
      sums.scale += length;
      const Real way = u.by_torn ? magnitude(value - beside) : length;
      sums.uneven += rule.relative(static_cast<int>(j), moved, length, way);
    });
    return {rule.of_sums(all_lengths, all_moved, sums, iteration), sums.size};
  }
  // All together, where they are written out: the corrections, then the sums from the left, term by
  // term.
  std::vector<Real> corrections_of(const std::vector<Compiled>& unknowns) const {
    std::vector<Real> corrections;
    for (const Compiled& u : unknowns) corrections.push_back(u.correction(m_.frame));
    return corrections;
  }
  std::pair<Answer, Real> judged(AnyNewtonRule<Real>& rule, const std::vector<Compiled>& unknowns,
                                 const std::vector<Real>& corrections, int iteration) const {
    std::vector<Real> moved;
    std::vector<Real> lengths;
    std::vector<Real> ways;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      const Real value = m_.frame.at(unknowns[j].target);
      const Real beside = unknowns[j].beside(m_.frame);
      moved.push_back(magnitude(corrections[j]));
      lengths.push_back(magnitude(value) + magnitude(beside));
      ways.push_back(unknowns[j].by_torn ? magnitude(unknowns[j].way(m_.frame)) : lengths.back());
    }
    const Answer answer = rule.of_each(moved, lengths, ways, iteration);
    return {answer, rule.last()};
  }
  Distance move_all(const std::vector<Compiled>& unknowns,
                    const std::vector<Real>& increments) const {
    Distance distance;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      Real& value = m_.frame.at(unknowns[j].target);
      distance.add(magnitude(increments[j]),
                   magnitude(value) + magnitude(unknowns[j].beside(m_.frame)));
      value += increments[j];
    }
    return distance;
  }

  // Has Refinement found the solution?
  bool is_found(const AnyRefinement<Real>& refinement) {
    if (!refinement.found()) m_.report.increment = refinement.last();
    return refinement.found();
  }

 private:
  bool ends(Answer answer, Real size) const {
    m_.report.iterations += m_.iteration;
    if (answer == Answer::failed) m_.report.increment = size;
    return answer == Answer::done;
  }
};

}  // namespace hamgen
