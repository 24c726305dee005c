// Sums of fractions over one denominator.
#pragma once

#include <ginac/ginac.h>

namespace hamgen {

// A polynomial in symbols and in what is no rational function of them, expanded, which is zero if
// and only if e is, read as a rational function of these: e times the denominators that stand in
// it, each to its largest power.  Common divisors are not sought, as GiNaC's normal() does, whose
// time depends on the order of the symbols; where denominators are products of a few, as in
// derivatives, there are none but these.  Throws std::overflow_error where a denominator is
// identically zero.
[[nodiscard]] GiNaC::ex numerator(const GiNaC::ex& e);

}  // namespace hamgen
