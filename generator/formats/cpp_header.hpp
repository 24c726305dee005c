// The formats in C++: `cpp-header`, a header for programs, and `cpp-plugin`, which the runtime
// compiles and loads.
#pragma once

#include <string>

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// The header alone.
[[nodiscard]] std::string cpp_header(const Program& program, const EmitOptions& options);
// The same mathematics with the C interface of runtime/plugin.h around it: one translation unit.
[[nodiscard]] std::string cpp_plugin(const Program& program, const EmitOptions& options);

// Their files; the header's with the shared blocks where the options want them.
[[nodiscard]] OutputFiles cpp_header_files(const Program& program, const EmitOptions& options);
[[nodiscard]] OutputFiles cpp_plugin_files(const Program& program, const EmitOptions& options);

}  // namespace hamgen
