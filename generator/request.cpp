#include "generator/request.hpp"

#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

MathWish MathWish::read(const std::string& name) {
  if (name.empty() || name == "own") return {};
  if (name == "libm") return {.of_library = true};
  throw UsageError(fmt::format("--math {}: there are own and libm", name));
}

SupportWish SupportWish::read(const std::string& name) {
  if (name.empty() || name == "own") return {};
  if (name == "shared") return {.shared = true};
  throw UsageError(fmt::format("--support {}: there are own and shared", name));
}

}  // namespace hamgen
