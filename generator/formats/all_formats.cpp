#include "generator/formats/all_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "generator/base/diagnostic.hpp"
#include "generator/formats/c_header.hpp"
#include "generator/formats/cmake_package.hpp"
#include "generator/formats/cpp_header.hpp"

namespace hamgen {

namespace {

constexpr std::array kFormats = {
    NamedFormat{"cpp-header", "one self-contained C++ header (the default)", cpp_header_files},
    NamedFormat{"cpp-plugin", "one translation unit with the C interface of the runtime",
                cpp_plugin_files},
    NamedFormat{"c-header",
                "a header in C11, of steps that are explicit or of small Newton systems",
                [](const Program& program, const EmitOptions& options) {
                  return c_header_files("c-header", program, options);
                },
                false},
    NamedFormat{"opencl-header", "the functions of a c-header for kernels in OpenCL C",
                [](const Program& program, const EmitOptions& options) {
                  return c_header_files("opencl-header", program, options);
                },
                false},
    NamedFormat{"cmake-package", "the header as a CMake project with an INTERFACE target",
                cmake_package},
};

}  // namespace

std::span<const NamedFormat> all_formats() { return kFormats; }

const NamedFormat& find_format(std::string_view name) {
  if (name.empty()) return kFormats.front();
  for (const NamedFormat& format : kFormats) {
    if (format.name == name || format.name == fmt::format("{}-header", name)) return format;
  }
  throw UsageError(fmt::format("unknown format '{}'; see `hamgen list formats`", name));
}

}  // namespace hamgen
