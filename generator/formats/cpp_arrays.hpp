// The mathematics of a large system in C++: loops over kernels, scattered into arrays.
#pragma once

#include <string>

#include "generator/formats/code_writer.hpp"
#include "generator/formats/cpp_expression.hpp"
#include "generator/formats/cpp_header.hpp"

namespace hamgen {

// The body of the namespace from the energy to the class Propagator.  State has Real q[n], p[n].
void write_array_program(CodeWriter& out, const Program& program, const ScalarType& scalar,
                         bool builtins, const std::map<std::string, std::string>& parameter_text,
                         std::set<std::string>& functions);

}  // namespace hamgen
