// The elementary functions of lanes that are our own, on one number: with the bits that they have
// in any lane.
#pragma once

#include <string>

namespace hamgen {

// None for the name of another, of which lanes have the library's.
[[nodiscard]] double (*lane_function(const std::string& name))(double, double);

}  // namespace hamgen
