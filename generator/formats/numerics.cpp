#include "generator/formats/numerics.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/base/fixed_blocks.hpp"

namespace hamgen {

std::string cpp_vocabulary(const ScalarType& scalar, bool builtins) {
  std::string value =
      builtins ? "__builtin_fabs" + function_suffix(scalar) + "(x)" : "std::fabs(x)";
  if (scalar.digits == 113) value = "x < 0 ? -x : x";
  return fmt::format(R"(inline Real magnitude(Real x) {{ return {}; }}
inline constexpr Real largest = {};  // what is beyond counts as infinite
inline constexpr Real epsilon = {};  // the distance from 1 to the next number
)",
                     value, scalar.largest, scalar.epsilon);
}

std::string lanes_vocabulary(const ScalarType& scalar, int lanes) {
  return fmt::format(R"(using Real = Pack<{0}>;
using Mask = LaneMask<{0}>;
inline Real magnitude(const Real& x) {{ return lane_abs(x); }}
inline constexpr double largest = {1};  // what is beyond counts as infinite
inline constexpr double epsilon = {2};  // the distance from 1 to the next number
)",
                     lanes, scalar.largest, scalar.epsilon);
}

std::string ieee_begin(const ScalarType& scalar) {
  // Wider numbers than double have no wider registers.
  return cpp_numerics("shells/ieee_flags") +
         (scalar.digits <= 53 ? cpp_numerics("shells/ieee_registers") : "") +
         cpp_numerics("shells/ieee_begin");
}

std::string cpp_numerics(std::string_view name) {
  const auto found = std::ranges::find(all_numerics(), name, &NumericsText::name);
  if (found == all_numerics().end()) internal_error(fmt::format("no numerics '{}'", name));
  return std::string(found->text);
}

std::string c_numerics(std::string_view name, const ScalarType& scalar, const std::string& fabs) {
  if (name == kEpsilon)
    return fmt::format(
        "// The distance from 1 to the next number.\nstatic const Real epsilon = {};\n",
        scalar.epsilon);
  if (name == kVocabulary)
    return fmt::format(
        "static inline Real magnitude(Real x) {{ return {}(x); }}\n"
        "static const Real largest = {};  // what is beyond counts as infinite\n",
        fabs, scalar.largest);
  return cpp_numerics("c/" + std::string(name));
}

}  // namespace hamgen
