#include "generator/verify/corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/verify/numerator.hpp"

namespace hamgen {

namespace {

// Terms of a sum that is looked at for a square, as it stands and when it is expanded.
constexpr std::size_t kLargestRadicand = 60;
constexpr std::size_t kLargestExpanded = 1000;

bool has_symbols(const Expression& e) {
  std::set<std::string> names = symbols(e);
  names.erase("pi");
  return !names.empty();
}

// Is the exponent an even integer times 1?
bool is_even(const Rational& exponent) {
  return exponent.get_den() == 1 && mpz_even_p(exponent.get_num_mpz_t()) != 0;
}

// Is it seen at once that no factor divides a polynomial twice?  One that does, and depends on x,
// still does where all other symbols are numbers, as long as these leave the degree in x.
bool is_plainly_square_free(const GiNaC::ex& polynomial) {
  GiNaC::exmap numbers;
  for (auto node = polynomial.preorder_begin(); node != polynomial.preorder_end(); ++node)
    if (GiNaC::is_a<GiNaC::symbol>(*node)) numbers.try_emplace(*node);
  int number = 10;
  for (auto& [symbol, value] : numbers) value = number += 7;
  for (const auto& [x, value] : numbers) {
    GiNaC::exmap others = numbers;
    others.erase(x);
    const GiNaC::ex along = polynomial.subs(others, GiNaC::subs_options::no_pattern).expand();
    if (along.degree(x) != polynomial.degree(x)) return false;
    const auto& symbol = GiNaC::ex_to<GiNaC::symbol>(x);
    if (GiNaC::gcd(along, along.diff(symbol)).degree(x) > 0) return false;
  }
  return true;
}

bool is_positive(const Expression& e);

bool is_never_negative(const Expression& e) {
  const auto& operands = e.operands();
  if (e.kind() == Kind::power && operands[1].is_number() && is_even(operands[1].number()))
    return true;
  if (e.kind() == Kind::sum || e.kind() == Kind::product)
    return std::ranges::all_of(operands, is_never_negative);
  return is_positive(e) || (e.is_number() && e.number() == 0);
}

// Is it seen at once?
bool is_positive(const Expression& e) {
  if (e.is_number()) return e.number() > 0;
  if (e.kind() == Kind::function) return e.name() == "exp" || e.name() == "cosh";
  return e.kind() == Kind::sum && is_never_negative(e) &&
         std::ranges::any_of(e.operands(), is_positive);
}

// Over one denominator, functions taken as symbols; 0 where that is too long.
GiNaC::ex over_one_denominator(const GiNaC::ex& sum, GiNaC::exmap& functions) {
  const GiNaC::ex rational = sum.to_polynomial(functions);
  if (expanded_terms(rational) > kLargestExpanded) return 0;
  try {
    return numerator(rational, kLargestExpanded);
  } catch (const std::exception&) {
    return 0;
  }
}

// Factors of a sum that divide it an even number of times, functions in it taken as symbols.
std::vector<std::pair<Expression, int>> even_factors(const Expression& sum) {
  std::vector<std::pair<Expression, int>> result;
  if (sum.operands().size() > kLargestRadicand) return result;
  SymbolTable table;
  GiNaC::exmap functions;
  const GiNaC::ex polynomial = over_one_denominator(to_ginac(sum, table), functions);
  if (polynomial.is_zero() || is_plainly_square_free(polynomial)) return result;
  const GiNaC::ex factored = GiNaC::sqrfree(polynomial);
  const auto look = [&](const GiNaC::ex& factor) {
    if (!GiNaC::is_a<GiNaC::power>(factor)) return;
    const GiNaC::ex& exponent = factor.op(1);
    if (!exponent.info(GiNaC::info_flags::even)) return;
    const GiNaC::ex base = factor.op(0).subs(functions, GiNaC::subs_options::no_pattern);
    result.emplace_back(from_ginac(base, table), GiNaC::ex_to<GiNaC::numeric>(exponent).to_int());
  };
  if (GiNaC::is_a<GiNaC::mul>(factored)) {
    for (std::size_t i = 0; i < factored.nops(); ++i) look(factored.op(i));
  } else {
    look(factored);
  }
  return result;
}

class Search {
 public:
  explicit Search(std::vector<Corner>& found) : found_(found) {}

  void look(const Expression& e) {
    if (e.operands().empty() || !seen_.insert(e.identity()).second) return;
    for (const Expression& operand : e.operands()) look(operand);
    if (e.kind() == Kind::function) of_function(e);
    if (e.kind() == Kind::power) of_root(e, e.operands()[0], e.operands()[1]);
  }

 private:
  void add(const Expression& function, std::string place) {
    if (std::ranges::none_of(found_, [&](const Corner& c) { return c.function == function; })) {
      found_.push_back({function, std::move(place)});
    }
  }

  void of_function(const Expression& e) {
    const Expression& x = e.operands()[0];
    if (!has_symbols(e)) return;
    const Function* row = find_function(e.name());
    if (row == nullptr || row->corner.empty()) return;
    // Of atan2 it is where the second is negative.
    if (e.operands().size() == 2 && is_positive(e.operands()[1])) return;
    add(e, fmt::format(fmt::runtime(row->corner), to_text(x), to_text(e.operands().back())));
  }

  // (f^m)^r is |f|^(m r) for an even m: smooth where m r is even again.
  void of_root(const Expression& e, const Expression& base, const Expression& exponent) {
    if (!exponent.is_number() || exponent.number().get_den() == 1 || !has_symbols(base)) return;
    const auto test = [&](const Expression& inner, const Rational& m) {
      const Rational power = m * exponent.number();
      if (is_even(m) && !is_even(power) && has_symbols(inner)) add(e, to_text(inner) + " = 0");
    };
    const auto of_factor = [&](const Expression& factor) {
      Expression inside = factor;
      Rational times = 1;
      if (factor.kind() == Kind::power && factor.operands()[1].is_number()) {
        inside = factor.operands()[0];
        times = factor.operands()[1].number();
        test(inside, times);
      }
      if (inside.kind() != Kind::sum) return;
      for (const auto& [inner, m] : factors_of(inside)) test(inner, times * m);
    };
    if (base.kind() == Kind::product) {
      for (const Expression& factor : base.operands()) of_factor(factor);
    } else {
      of_factor(base);
    }
  }

  // H and its derivatives have several powers of one sum.
  const std::vector<std::pair<Expression, int>>& factors_of(const Expression& sum) {
    const auto [known, is_new] = factors_.try_emplace(sum.identity());
    if (is_new) known->second = even_factors(sum);
    return known->second;
  }

  std::vector<Corner>& found_;
  std::unordered_set<const void*> seen_;
  std::unordered_map<const void*, std::vector<std::pair<Expression, int>>> factors_;
};

}  // namespace

std::vector<Corner> corners(const std::vector<Expression>& expressions) {
  std::vector<Corner> found;
  Search search(found);
  for (const Expression& e : expressions) search.look(e);
  return found;
}

std::vector<Corner> corners_of_hamiltonian(const Mechanics& mechanics) {
  if (!mechanics.keeps_sums()) return corners(mechanics.energy);
  std::vector<Expression> summands;
  for (const Kernel& kernel : mechanics.kernels) summands.push_back(kernel.value);
  summands.push_back(mechanics.of_sums);
  return corners(summands);
}

std::vector<Corner> corners(const Expression& e) { return corners(std::vector{e}); }

std::string off_the(const std::vector<Corner>& corners) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(corners.size(), most); ++i) {
    text += (i == 0 ? "off the corners of " : " and ") + to_text(corners[i].function);
  }
  if (corners.size() > most) text += fmt::format(" and {} more", corners.size() - most);
  return text;
}

}  // namespace hamgen
