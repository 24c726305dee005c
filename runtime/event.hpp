// Where along an orbit a quantity crosses zero, to rounding.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/integrator.hpp"

namespace hamgen::runtime {

// The state after one step of length theta h from `from` (2n values), with the parameters and h of
// `start`: what lies between two states of an orbit, to the order of the step.  Empty if that step
// fails.
[[nodiscard]] std::optional<std::vector<Wide>> part_of_step(
    const std::shared_ptr<const Library>& library, const InitialValues& start,
    const std::vector<Wide>& from, const Wide& theta);

// Of `from`, from which a step fails: the largest part of it, theta below 1, that ends in a good
// state, by halving and then narrowing to a thousandth of itself; 0 if there is none from 2^-20 on.
[[nodiscard]] double reach_of_step(const std::shared_ptr<const Library>& library,
                                   const InitialValues& start, const std::vector<Wide>& from,
                                   const std::function<bool(std::span<const Wide>)>& is_good);
// The start with its step size times theta.
[[nodiscard]] InitialValues with_part_of_step(InitialValues start, const Wide& theta);

// Which crossings of zero count, as time goes on.
enum class Direction {
  rising,   // from below
  falling,  // from above
  both
};

// A zero of a quantity within a step.
struct Crossing {
  double fraction = 0.0;    // theta: of the step in which it is, in (0, 1]
  std::vector<Wide> state;  // 2n values
};

// Crossings of zero of a quantity.  Each is the root in theta of the quantity after one step of
// length theta h of the same scheme from the state before, so that it has the order of the steps;
// the orbit is not changed.
// How they are told from each other: Note [several crossings in a step] of numerics/crossings.hpp.
class EventLocator {
 public:
  // Of 2n values, q then p.
  using Quantity = std::function<double(std::span<const Wide> state)>;

  // `start`: parameters and h of the run, whose state is not used.
  EventLocator(std::shared_ptr<const Library> library, InitialValues start, Quantity quantity,
               Direction direction);

  // The quantity at a state.
  [[nodiscard]] double value(std::span<const Wide> state) const { return quantity_(state); }
  // Within the step from one state to the next, whose values are given, in the order of time.  A
  // value of zero belongs to the step that ends there.  Without those for which a step of part of
  // the length fails.
  [[nodiscard]] std::vector<Crossing> within(const std::vector<Wide>& before, double value_before,
                                             const std::vector<Wide>& after,
                                             double value_after) const;

 private:
  [[nodiscard]] std::optional<double> value_after_part(const std::vector<Wide>& from,
                                                       double theta) const;

  std::shared_ptr<const Library> library_;
  InitialValues start_;
  Quantity quantity_;
  Direction direction_;
};

}  // namespace hamgen::runtime
