// The emitted header as a CMake package.
#pragma once

#include <string>

#include "generator/formats/output_files.hpp"

namespace hamgen {

// NAME.hpp and a CMakeLists.txt with the INTERFACE library NAME, linked to what the header needs.
[[nodiscard]] OutputFiles cmake_package(const std::string& name, const std::string& header,
                                        bool eigen, bool quadmath);

}  // namespace hamgen
