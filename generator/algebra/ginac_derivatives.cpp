#include "generator/algebra/ginac_derivatives.hpp"

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/algebra/ginac_parts.hpp"
#include "generator/base/budget.hpp"

namespace hamgen {
namespace {

// To put a factor in its place among others, its powers and coefficients collected; GiNaC also
// looks through the terms of a sum for what they have in common, and down nested functions.
constexpr double steps_of_factor = 15;
constexpr double steps_of_term = 1;
constexpr double steps_of_level = 3;
// GiNaC's hash values of functions nested in each other repeat: it compares them down to the
// innermost, and what they are multiplied by too.
constexpr double steps_of_nesting = 0.25;

}  // namespace

std::size_t Differentiator::number(const GiNaC::ex& symbol) {
  return numbers_.emplace(symbol, numbers_.size()).first->second;
}

Differentiator::Known& Differentiator::known(const GiNaC::ex& e) {
  if (Known* const found = known_.find(e)) return *found;
  Known result;
  if (GiNaC::is_a<GiNaC::symbol>(e)) result.symbols.push_back(number(e));
  for (const GiNaC::ex& each : operands_of(e)) {
    const Known& operand = known(each);
    result.symbols.insert(result.symbols.end(), operand.symbols.begin(), operand.symbols.end());
    result.depth = std::max(result.depth, operand.depth + 1);
    result.steps += steps_of_factor + steps_of_level * operand.depth;
    if (GiNaC::is_a<GiNaC::add>(each))
      result.steps += steps_of_term * static_cast<double>(each.nops());
  }
  std::ranges::sort(result.symbols);
  std::vector<std::size_t>& symbols = result.symbols;
  symbols.erase(std::unique(symbols.begin(), symbols.end()), symbols.end());
  spend(Resource::nodes, 1 + 0.1 * static_cast<double>(result.symbols.size()));
  spend(Resource::work, static_cast<double>(result.symbols.size()) +
                            steps_of_nesting * result.depth * result.depth);
  return known_.emplace(e, std::move(result));
}

bool Differentiator::depends(const GiNaC::ex& e, const GiNaC::symbol& s) {
  return std::ranges::binary_search(known(e).symbols, number(s));
}

// The operands of a sum or a product that depend on the symbol.
std::vector<std::size_t> Differentiator::places(const GiNaC::ex& e, const GiNaC::symbol& s) {
  Known& of_e = known(e);
  if (of_e.places.empty()) {
    const GiNaC::exvector operands = operands_of(e);
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const Known& operand = known(operands[i]);
      spend(Resource::work, static_cast<double>(operand.symbols.size()));
      for (const std::size_t symbol : operand.symbols) of_e.places[symbol].push_back(i);
    }
  }
  return of_e.places[number(s)];
}

GiNaC::ex Differentiator::operator()(const GiNaC::ex& e, const GiNaC::symbol& s) {
  if (GiNaC::is_a<GiNaC::symbol>(e)) return e.is_equal(s) ? 1 : 0;
  if (e.nops() == 0 || !depends(e, s)) return 0;
  spend(Resource::work, steps_of_factor);
  const std::size_t symbol = number(s);
  if (const auto& done = known(e).derivatives; done.contains(symbol)) return done.at(symbol);
  GiNaC::ex result;
  if (GiNaC::is_a<GiNaC::add>(e)) {
    result = of_sum(e, s);
  } else if (GiNaC::is_a<GiNaC::mul>(e)) {
    result = of_product(e, s);
  } else if (GiNaC::is_a<GiNaC::power>(e)) {
    result = of_power(e, s);
  } else {
    result = of_function(e, s);
  }
  spend(Resource::nodes, static_cast<double>(1 + result.nops()));
  spend(Resource::work, longest_coefficient(result) / 64);
  known(e).derivatives.emplace(symbol, result);
  return result;
}

// (sum c_i f_i)' = sum c_i f_i'
GiNaC::ex Differentiator::of_sum(const GiNaC::ex& e, const GiNaC::symbol& s) {
  const auto& sum = GiNaC::ex_to<GiNaC::add>(e);
  const GiNaC::epvector& pairs = GinacSum::pairs(sum);
  GiNaC::epvector terms;
  for (const std::size_t i : places(e, s)) {
    spend(Resource::work, 1);
    terms.push_back(GinacSum::pair(sum, (*this)(pairs[i].rest, s), pairs[i].coeff));
  }
  return GiNaC::add(std::move(terms));
}

// (c prod f_i^k_i)' = sum_i (c k_i) f_i^(k_i - 1) f_i' prod_{j != i} f_j^k_j
GiNaC::ex Differentiator::of_product(const GiNaC::ex& e, const GiNaC::symbol& s) {
  const auto& product = GiNaC::ex_to<GiNaC::mul>(e);
  GiNaC::epvector pairs = GinacProduct::pairs(product);
  GiNaC::exvector terms;
  const double steps = known(e).steps;
  for (const std::size_t i : places(e, s)) {
    spend(Resource::work, steps);
    spend(Resource::nodes, static_cast<double>(pairs.size()));
    const GiNaC::expair factor = pairs[i];
    const GiNaC::ex inner = (*this)(factor.rest, s);
    pairs[i] =
        GinacProduct::pair(product, GiNaC::mul(GiNaC::pow(factor.rest, factor.coeff - 1), inner));
    terms.push_back(GiNaC::mul(pairs, GinacProduct::number(product) * factor.coeff));
    pairs[i] = factor;
  }
  return GiNaC::add(terms);
}

// (f^k)' = k f^(k - 1) f' for a number k, else f^g (g' log f + g f'/f)
GiNaC::ex Differentiator::of_power(const GiNaC::ex& e, const GiNaC::symbol& s) {
  const GiNaC::ex base = e.op(0);
  const GiNaC::ex exponent = e.op(1);
  const GiNaC::ex inner = (*this)(base, s);
  spend(Resource::work, known(e).steps);
  if (GiNaC::is_a<GiNaC::numeric>(exponent)) {
    return GiNaC::mul(GiNaC::epvector{GiNaC::expair(base, exponent - 1), GiNaC::expair(inner, 1)},
                      exponent);
  }
  return e * ((*this)(exponent, s) * GiNaC::log(base) + exponent * inner * GiNaC::pow(base, -1));
}

// The partial derivative, made once: what is made apart is met apart.
GiNaC::ex Differentiator::partial(const GiNaC::ex& e, std::size_t i) {
  std::vector<GiNaC::ex>& partials = known(e).partials;
  while (partials.size() <= i)
    partials.push_back(GinacFunction::partial(GiNaC::ex_to<GiNaC::function>(e), partials.size()));
  return partials[i];
}

// f(g_1, g_2)' = sum_i f_i(g_1, g_2) g_i'.  Of abs, and of the conjugate that is in its derivative,
// GiNaC has formulas of their own.
GiNaC::ex Differentiator::of_function(const GiNaC::ex& e, const GiNaC::symbol& s) {
  const auto& function = GiNaC::ex_to<GiNaC::function>(e);
  spend(Resource::work, known(e).steps);
  const std::string name = function.get_name();
  if (name == "abs" || find_function(name) == nullptr) {
    spend(Resource::work, static_cast<double>(node_count(e, 1'000'000)));
    return e.diff(s);
  }
  GiNaC::ex result = 0;
  for (std::size_t i = 0; i < e.nops(); ++i) {
    const GiNaC::ex inner = (*this)(e.op(i), s);
    if (!inner.is_zero()) result += GiNaC::mul(partial(e, i), inner);
  }
  return result;
}

}  // namespace hamgen
