// THE LIST of schemes that have a name.  To add one, add one line in all_schemes.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/schemes/scheme.hpp"

namespace hamgen {

struct NamedScheme {
  std::string_view name;
  int order = 1;
  bool symmetric = false;
  std::string_view needs;        // "any H", "separable H"
  std::string_view description;  // one line
  std::string_view source;
  std::string_view alpha;        // of the member, as on the command line
  std::string_view beta;
  std::string_view gamma;
};

[[nodiscard]] std::span<const NamedScheme> all_schemes();
[[nodiscard]] const NamedScheme* find_scheme(std::string_view name);

}  // namespace hamgen
