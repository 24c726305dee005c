// Sums of fractions over one denominator.
#pragma once

#include <ginac/ginac.h>

namespace hamgen {

// A polynomial in symbols and in what is no rational function of them, expanded: e times the
// denominators that stand in it, each to its largest power.  It is zero only if e is, and if e is
// as a rational function of these.  Common divisors are not sought, as GiNaC's normal() does, whose
// time depends on the order of the symbols.  Throws std::overflow_error where a denominator is
// identically zero, std::length_error where the way there has ten thousands of terms or exponents
// of millions.
[[nodiscard]] GiNaC::ex numerator(const GiNaC::ex& e);

}  // namespace hamgen
