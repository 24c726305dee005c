// Where along an orbit a quantity crosses zero, to rounding.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/integrator.hpp"

namespace hamgen::app {

enum class Direction { rising, falling, both };

struct Crossing {
  double fraction = 0.0;             // of the step in which it is, in (0, 1]
  std::vector<runtime::Wide> state;  // 2n values
};

// Crossings of zero of one of a plugin's invariants.  Between two states that its sign tells apart
// the crossing is the root in theta of the quantity after one step of length theta h of the same
// scheme from the first of them, so that it has the order of the steps; the orbit is not changed.
class EventLocator {
 public:
  // `start`: parameters and h of the run, whose state is not used.
  EventLocator(std::shared_ptr<const runtime::Library> library, runtime::InitialValues start,
               std::size_t invariant, Direction direction);

  [[nodiscard]] double value(std::span<const runtime::Wide> state) const;
  // Within the step from one state to the next, whose values are given.  A value of zero belongs to
  // the step that ends there.  Empty also where a step of part of the length fails.
  [[nodiscard]] std::optional<Crossing> within(const std::vector<runtime::Wide>& before,
                                               double value_before,
                                               const std::vector<runtime::Wide>& after,
                                               double value_after) const;

 private:
  [[nodiscard]] std::optional<std::vector<runtime::Wide>> step(
      const std::vector<runtime::Wide>& from, double fraction) const;

  std::shared_ptr<const runtime::Library> library_;
  runtime::InitialValues start_;
  std::size_t invariant_;
  Direction direction_;
};

}  // namespace hamgen::app
