#include "generator/verify/zero_by_algebra.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "generator/algebra/from_ginac.hpp"
#include "generator/verify/affine.hpp"
#include "generator/verify/numerator.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/sample_points.hpp"
#include "generator/verify/sums_of_step.hpp"

namespace hamgen {

namespace {

// Sizes as trees up to which differences are expanded, and brought over one denominator.
constexpr std::size_t kExpandable = 6000;
constexpr std::size_t kNormalisable = 2000;
// Or of so many different parts, where so few symbols have few terms.
constexpr std::size_t kFewSymbols = 4;
// What is larger is looked at once for each symbol in which it is affine, if there are no more of
// these, and no more different parts in it.
constexpr std::size_t kMostAffine = 24;
constexpr std::size_t kMostParts = 200;
// Of products on the way to one denominator: of one look, and of one of many.
constexpr std::size_t kTermsOfAll = 20'000;
constexpr std::size_t kTermsOfPoint = 1500;
// Points that only refute: most mistakes show at once.
constexpr int kRefutingPoints = 3;

std::size_t tree_size(const Expression& e, std::map<const void*, std::size_t>& known) {
  if (e.operands().empty()) return 1;
  if (const auto it = known.find(e.identity()); it != known.end()) return it->second;
  std::size_t size = 1;
  for (const Expression& operand : e.operands()) {
    size = std::min(size + tree_size(operand, known), 2 * kExpandable);
  }
  known[e.identity()] = size;
  return size;
}

bool has_ranks(const Expression& e) {
  std::set<const void*> seen;
  const auto visit = [&](auto&& self, const Expression& node) -> bool {
    if (!seen.insert(node.identity()).second) return false;
    if (node.kind() == Kind::symbol) return node.rank() != 0;
    return std::ranges::any_of(node.operands(),
                               [&](const Expression& operand) { return self(self, operand); });
  };
  return visit(visit, e);
}

// With symbols of one rank: the two sides may have the same ones in another order, and sin(x - y)
// and sin(y - x) are one function only where the order is one.
Expression without_ranks(const Expression& e) {
  if (!has_ranks(e)) return e;
  Substitution plain;
  for (const std::string& name : symbols(e)) plain.emplace(name, Expression::symbol(name));
  return substitute(e, plain);
}

// Square roots as symbols: s_b^k for b^(k/2), with s_b^2 = b to be used afterwards.
class SquareRoots {
 public:
  [[nodiscard]] const std::map<Expression, Expression>& symbols() const { return symbols_; }
  // A part that stands in many places is looked at once.
  Expression replace(const Expression& e) {
    if (e.operands().empty()) return e;
    if (const auto it = replaced_.find(e); it != replaced_.end()) return it->second;
    return replaced_.emplace(e, replace_in(e)).first->second;
  }

 private:
  Expression replace_in(const Expression& e) {
    if (e.kind() == Kind::power && e.operands()[1].is_number() &&
        e.operands()[1].number().get_den() == 2) {
      const Expression base = replace(e.operands()[0]);
      const auto name = "sqrt#" + std::to_string(symbols_.size());
      const Expression symbol = symbols_.try_emplace(base, Expression::symbol(name)).first->second;
      return Expression::power(symbol, Expression(Rational(e.operands()[1].number() * 2)));
    }
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) operands.push_back(replace(operand));
    return with_operands(e, std::move(operands));
  }

  std::map<Expression, Expression> symbols_;
  ExpressionMap<Expression> replaced_;
};

// The sum, a polynomial, with s^(2k) = b^k and s^(2k+1) = s b^k: zero if it vanishes so.
bool vanishes_with_roots(GiNaC::ex sum, const SquareRoots& roots, SymbolTable& table) {
  for (const auto& [base, symbol] : roots.symbols()) {
    const GiNaC::ex s = table.symbol(symbol.name(), 0);
    const GiNaC::ex b = to_ginac(base, table);
    if (sum.ldegree(s) < 0) return false;  // which numerator() excludes, and k / 2 has to
    GiNaC::ex reduced = 0;
    for (int k = sum.ldegree(s); k <= sum.degree(s); ++k) {
      reduced += sum.coeff(s, k) * GiNaC::pow(b, k / 2) * (k % 2 == 0 ? GiNaC::ex(1) : s);
    }
    sum = numerator(reduced);
  }
  return sum.is_zero();
}

// Is it not zero at some point?  Cheaper than any algebra.
bool differs_from_zero(const Expression& e) {
  for (int number = 0; number < kRefutingPoints; ++number) {
    SamplePoint point({}, 4, number);  // the first is a positive one
    std::map<std::string, Precise> free;
    for (const std::string& name : symbols(e)) {
      if (name != "pi") free.emplace(name, point(name));
    }
    const auto value = PreciseValues(free, {}).scaled(e);
    if (value) return !is_zero(*value);
  }
  return false;
}

// Is it short enough to be brought over one denominator, and zero then?
bool has_no_numerator(const Expression& e, std::size_t most_terms) {
  std::map<const void*, std::size_t> known;
  const std::size_t size = tree_size(e, known);
  const bool is_short =
      size <= kNormalisable || (known.size() <= kNormalisable && symbols(e).size() <= kFewSymbols);
  if (!is_short) return false;
  SymbolTable table;
  SquareRoots roots;
  const Expression rational = roots.replace(e);
  try {
    return vanishes_with_roots(numerator(to_ginac(rational, table), most_terms), roots, table);
  } catch (const std::exception&) {  // a denominator that vanishes identically, or too many terms
    return false;
  }
}

// What is affine in the state is much shorter at each of these points.
bool vanishes_at_unit_points(const Expression& e) {
  const std::vector<std::string> affine = affine_symbols(e);
  return !affine.empty() && affine.size() <= kMostAffine &&
         symbols(e).size() <= affine.size() + kFewSymbols &&
         std::ranges::all_of(at_unit_points(e, affine), [](const Expression& value) {
           return has_no_numerator(value, kTermsOfPoint);
         });
}

}  // namespace

bool is_zero_by_algebra(const Expression& e) {
  if (e.is_zero()) return true;
  if (e.is_number()) return false;
  std::map<const void*, std::size_t> known;
  const std::size_t size = tree_size(e, known);
  SumsOfStep sums;
  const Expression shorter = sums.named(e);
  if (!sums.empty() && is_zero_by_algebra(shorter)) return true;
  if (differs_from_zero(e)) return false;
  const Expression plain = without_ranks(e);
  if (size <= kExpandable && vanishes(plain)) return true;
  if (size <= kNormalisable) return has_no_numerator(plain, kTermsOfAll);
  return known.size() <= kMostParts && vanishes_at_unit_points(plain);
}

}  // namespace hamgen
