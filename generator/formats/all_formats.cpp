#include "generator/formats/all_formats.hpp"

#include <array>

namespace hamgen {

namespace {

constexpr std::array kFormats = {
    NamedFormat{"cpp-header", "one self-contained C++ header (the default)"},
    NamedFormat{"cpp-plugin", "one translation unit with the C interface of the runtime"},
    NamedFormat{"cmake-package", "the header as a CMake project with an INTERFACE target"},
};

}  // namespace

std::span<const NamedFormat> all_formats() { return kFormats; }

}  // namespace hamgen
