// Sums of fractions over one denominator.
#pragma once

#include <ginac/ginac.h>

namespace hamgen {

// A polynomial in symbols and in what is no rational function of them, expanded: e times the
// denominators that stand in it, each to its largest power.  It is zero only if e is, and if e is
// as a rational function of these.  Common divisors are not sought, as GiNaC's normal() does, whose
// time depends on the order of the symbols.  Throws std::overflow_error where a denominator is
// identically zero, std::length_error where the way there has more terms than that, of all products
// together, or exponents of millions.  GiNaC's products take a time that grows with the square of
// their terms: so many take up to a second.  What is proved of the shipped models has up to 7,500.
[[nodiscard]] GiNaC::ex numerator(const GiNaC::ex& e, std::size_t most_terms = 20'000);

}  // namespace hamgen
