#include "generator/algebra/ginac_parts.hpp"

#include <algorithm>

namespace hamgen {
namespace {

double bits(const GiNaC::ex& e) {
  if (!GiNaC::is_a<GiNaC::numeric>(e)) return 0;
  const auto& value = GiNaC::ex_to<GiNaC::numeric>(e);
  return value.is_rational() ? value.numer().int_length() + value.denom().int_length() : 0;
}

}  // namespace

GiNaC::exvector operands_of(const GiNaC::ex& e) {
  GiNaC::exvector result;
  const bool is_sum = GiNaC::is_a<GiNaC::add>(e);
  if (is_sum || GiNaC::is_a<GiNaC::mul>(e)) {
    const GiNaC::epvector& pairs = is_sum ? GinacSum::pairs(GiNaC::ex_to<GiNaC::add>(e))
                                          : GinacProduct::pairs(GiNaC::ex_to<GiNaC::mul>(e));
    for (const GiNaC::expair& pair : pairs) result.push_back(pair.rest);
  } else {
    for (std::size_t i = 0; i < e.nops(); ++i) result.push_back(e.op(i));
  }
  return result;
}

std::size_t node_count(const GiNaC::ex& e, std::size_t limit) {
  std::size_t count = 1;
  for (std::size_t i = 0; i < e.nops() && count < limit; ++i)
    count += node_count(e.op(i), limit - count);
  return count;
}

double longest_coefficient(const GiNaC::ex& e) {
  if (GiNaC::is_a<GiNaC::mul>(e)) return bits(GinacProduct::number(GiNaC::ex_to<GiNaC::mul>(e)));
  if (!GiNaC::is_a<GiNaC::add>(e)) return bits(e);
  const auto& sum = GiNaC::ex_to<GiNaC::add>(e);
  double longest = bits(GinacSum::number(sum));
  for (const GiNaC::expair& pair : GinacSum::pairs(sum))
    longest = std::max(longest, bits(pair.coeff));
  return longest;
}

}  // namespace hamgen
