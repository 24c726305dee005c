#include "generator/formats/cmake_package.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_header.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

OutputFiles cmake_package(const Program& program, const EmitOptions& options) {
  const std::string target = identifier(options.file_name);
  std::string links;
  if (program.facts.needs_eigen)
    links += fmt::format(
        "find_package(Eigen3 REQUIRED)\ntarget_link_libraries({} INTERFACE Eigen3::Eigen)\n",
        target);
  if (options.scalar == "quad")
    links += fmt::format("target_link_libraries({} INTERFACE quadmath)\n", target);
  OutputFiles files = cpp_header_files(program, options);
  files.push_back({"CMakeLists.txt", fmt::format("cmake_minimum_required(VERSION 3.20)\n"
                                                 "project({0} CXX)\n\n"
                                                 "add_library({0} INTERFACE)\n"
                                                 "target_include_directories({0} INTERFACE "
                                                 "${{CMAKE_CURRENT_SOURCE_DIR}})\n"
                                                 "target_compile_features({0} INTERFACE "
                                                 "cxx_std_17)\n"
                                                 "{1}",
                                                 target, links)});
  return files;
}

}  // namespace hamgen
