// A program around emitted headers, compiled with the flags of `hamgen run` in a directory of its
// own and run there.
#pragma once

#include <string>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen {

struct ProgramFile {
  std::string name, text;
};

// The header of a model's method in this scalar, its names in this namespace.
[[nodiscard]] std::string emitted_header(const std::string& model, Request request,
                                         const std::string& scalar, const std::string& name_space);

// What the program made of the files whose names end in ".cpp" prints; they may include the others.
// More flags come at the end of those there are.  Throws as output_of_program.
[[nodiscard]] std::string output_of_sources(const std::vector<ProgramFile>& files,
                                            const std::vector<std::string>& flags);

// What program.cpp prints, the headers included before it in their order, with more flags at the
// end of those there are.  Throws std::runtime_error with the compiler's or the program's words.
[[nodiscard]] std::string output_of_program(const std::vector<ProgramFile>& headers,
                                            const std::string& program,
                                            const std::vector<std::string>& flags = {});

}  // namespace hamgen
