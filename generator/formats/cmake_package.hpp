// The emitted header as a CMake package.
#pragma once

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// The files of cpp-header and a CMakeLists.txt with an INTERFACE library, linked to what it needs.
[[nodiscard]] OutputFiles cmake_package(const Program& program, const EmitOptions& options);

}  // namespace hamgen
