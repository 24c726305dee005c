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

enum class Direction { rising, falling, both };

struct Crossing {
  double fraction = 0.0;    // theta: of the step in which it is, in (0, 1]
  std::vector<Wide> state;  // 2n values
};

// Crossings of zero of a quantity.  Each is the root in theta of the quantity after one step of
// length theta h of the same scheme from the state before, so that it has the order of the steps;
// the orbit is not changed.
//
// Note [several crossings in a step]
// The signs at both ends tell of an odd number of them only.  Between them the state is taken from
// the cubic through both states and their derivatives J grad H, with an error of order h^4, which
// costs no step; where its signs change, or it comes near zero and turns, the sign is that after a
// part of the step.  What the cubic misses, a touch of zero by less than its error, is not found.
class EventLocator {
 public:
  using Quantity = std::function<double(std::span<const Wide> state)>;

  // `start`: parameters and h of the run, whose state is not used.
  EventLocator(std::shared_ptr<const Library> library, InitialValues start, Quantity quantity,
               Direction direction);

  [[nodiscard]] double value(std::span<const Wide> state) const { return quantity_(state); }
  // Within the step from one state to the next, whose values are given, in the order of time.  A
  // value of zero belongs to the step that ends there.  Without those for which a step of part of
  // the length fails.
  [[nodiscard]] std::vector<Crossing> within(const std::vector<Wide>& before, double value_before,
                                             const std::vector<Wide>& after,
                                             double value_after) const;

 private:
  struct Sample {
    double theta = 0.0;
    double value = 0.0;
  };
  [[nodiscard]] std::optional<double> value_after_part(const std::vector<Wide>& from,
                                                       double theta) const;
  [[nodiscard]] std::vector<double> suspected(const std::vector<Wide>& before, double value_before,
                                              const std::vector<Wide>& after,
                                              double value_after) const;
  [[nodiscard]] bool counts(double before, double after) const;
  [[nodiscard]] std::optional<Crossing> root(const std::vector<Wide>& from, const Sample& low,
                                             const Sample& high,
                                             const std::vector<Wide>& after) const;

  std::shared_ptr<const Library> library_;
  InitialValues start_;
  Quantity quantity_;
  Direction direction_;
};

}  // namespace hamgen::runtime
