// An outline whose numbers are affine in the size of the system.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "generator/verify/growth.hpp"

namespace hamgen {

// near + slope * size
struct AffineNumber {
  long near = 0;
  long slope = 0;
};
struct GrowingEvent {
  const CodeEvent& of;
  std::vector<AffineNumber> numbers;
};

// Not the same, longer, and why.
struct NotLonger {
  std::string why;
};

// Of three sizes; throws NotLonger.  The events refer to those of the first.
[[nodiscard]] std::vector<GrowingEvent> affine_events(const std::array<SizedOutline, 3>& sizes);

}  // namespace hamgen
