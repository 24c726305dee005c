#include "runtime/arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace hamgen::runtime {
namespace {

// Sums and products in another order, quotients by reciprocals, results kept in registers of
// another width, no signed zeros, no NaN or infinity, subnormal numbers taken for zero.  Linked
// with some of them, an object sets "flush to zero" for the whole process.
//
// Not among them, because no result depends on them: -fno-trapping-math, -fno-math-errno,
// -frounding-math, -fcx-* (there are no complex numbers), -mrecip (which acts with -ffast-math
// only); and -ffp-contract, because the last one counts and that is ours.
constexpr std::array<std::string_view, 22> kRefused = {
    "-ffast-math", "-Ofast", "--optimize=fast", "-funsafe-math-optimizations", "-fassociative-math",
    "-freciprocal-math", "-ffinite-math-only", "-fno-honor-nans", "-fno-honor-infinities",
    "-fno-signed-zeros", "-fapprox-func", "-ffp-model=fast", "-fsingle-precision-constant",
    "-mdaz-ftz", "-mno-sse", "-mno-sse2", "-mpc32", "-mpc64",
    // of clang -cc1, after -Xclang
    "-menable-unsafe-fp-math", "-menable-no-nans", "-menable-no-infs", "-mreassociate"};

bool changes_arithmetic(std::string_view flag) {
  if (flag.starts_with("-mfpmath=")) return flag != "-mfpmath=sse";
  if (flag.starts_with("-fdenormal-fp-math"))
    return !flag.ends_with("=ieee") && !flag.ends_with("=ieee,ieee");
  return std::ranges::find(kRefused, flag) != kRefused.end();
}

}  // namespace

std::optional<std::string> refused_flag(std::span<const std::string> arguments) {
  for (const std::string& word : arguments) {
    if (word.starts_with('@'))
      return fmt::format(
          "'{}' may hold flags that change what the arithmetic means\n"
          "help: write out the flags it holds",
          word);
    if (changes_arithmetic(word))
      return fmt::format(
          "the compiler flag '{}' is refused: it changes what the arithmetic means, and what is "
          "proved of a method would not hold\nhelp: leave it out; -O3 and -march=native are fine",
          word);
  }
  return {};
}

bool environment_is_ieee() {
  // volatile: computed here and now, not by the compiler.
  const volatile double smallest = std::numeric_limits<double>::min();
  const volatile double subnormal = std::numeric_limits<double>::denorm_min();
  const volatile double half = 0.5;
  const volatile double two = 2.0;
  const bool is_flushed = smallest * half == 0.0;
  const bool operand_is_zero = subnormal * two == 0.0;
  return std::fegetround() == FE_TONEAREST && !is_flushed && !operand_is_zero;
}

KeptEnvironment::KeptEnvironment() { std::fegetenv(&environment_); }

KeptEnvironment::~KeptEnvironment() { std::fesetenv(&environment_); }

}  // namespace hamgen::runtime
