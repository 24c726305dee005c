// What GiNaC keeps in its sums, products and functions, without making anything anew.
#pragma once

#include <ginac/ginac.h>

#include <cstddef>
#include <unordered_map>
#include <utility>

namespace hamgen {

struct GinacSum : GiNaC::add {
  // The number in it is not among the pairs.
  static const GiNaC::epvector& pairs(const GiNaC::add& e) { return e.*(&GinacSum::seq); }
  static const GiNaC::ex& number(const GiNaC::add& e) { return e.*(&GinacSum::overall_coeff); }
  static GiNaC::expair pair(const GiNaC::add& e, const GiNaC::ex& rest, const GiNaC::ex& factor) {
    return (e.*(&GinacSum::combine_ex_with_coeff_to_pair))(rest, factor);
  }
};

struct GinacProduct : GiNaC::mul {
  static const GiNaC::epvector& pairs(const GiNaC::mul& e) { return e.*(&GinacProduct::seq); }
  static const GiNaC::ex& number(const GiNaC::mul& e) { return e.*(&GinacProduct::overall_coeff); }
  static GiNaC::expair pair(const GiNaC::mul& e, const GiNaC::ex& part) {
    return (e.*(&GinacProduct::split_ex_to_pair))(part);
  }
};

struct GinacFunction : GiNaC::function {
  static GiNaC::ex partial(const GiNaC::function& e, std::size_t k) {
    return (e.*(&GinacFunction::pderivative))(static_cast<unsigned>(k));
  }
};

// What is known of expressions, by the place they have in memory: GiNaC's hash values of functions
// nested in each other repeat, and a comparison then goes down to the innermost.  Equal expressions
// that were made apart are two here.
template <class T>
class ByIdentity {
 public:
  [[nodiscard]] T* find(const GiNaC::ex& e) {
    const auto it = known_.find(&GiNaC::ex_to<GiNaC::basic>(e));
    return it == known_.end() ? nullptr : &it->second.second;
  }
  T& emplace(const GiNaC::ex& e, T value) {
    return known_.emplace(&GiNaC::ex_to<GiNaC::basic>(e), std::pair(e, std::move(value)))
        .first->second.second;
  }

 private:
  std::unordered_map<const GiNaC::basic*, std::pair<GiNaC::ex, T>> known_;
};

// What stands below a node: of a sum its terms without their coefficients, of a product the bases.
[[nodiscard]] GiNaC::exvector operands_of(const GiNaC::ex& e);

// Of its tree, each subexpression where it stands, up to the limit.
[[nodiscard]] std::size_t node_count(const GiNaC::ex& e, std::size_t limit);

// Bits of the numerator and denominator that are together the longest, of the number that e is, or
// of the coefficients of a sum or a product.
[[nodiscard]] double longest_coefficient(const GiNaC::ex& e);

}  // namespace hamgen
