// The elementary functions of lanes, on one number: with the bits that they have in any lane.
#pragma once

#include <string>

namespace hamgen {

// An internal error for a name that is none.
[[nodiscard]] double (*lane_function(const std::string& name))(double, double);

}  // namespace hamgen
