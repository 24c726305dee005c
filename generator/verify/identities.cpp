#include "generator/verify/identities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "generator/algebra/from_ginac.hpp"
#include "generator/verify/affine.hpp"
#include "generator/verify/numerator.hpp"
#include "generator/verify/precise.hpp"
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
constexpr int kPoints = 200;
// The first points only refute: most mistakes show at once.
constexpr int kFirstPoints = 3;
constexpr int kAttempts = 100;

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
struct SquareRoots {
  std::map<Expression, Expression> symbols;
  Expression replace(const Expression& e) {
    if (e.operands().empty()) return e;
    if (e.kind() == Kind::power && e.operands()[1].is_number() &&
        e.operands()[1].number().get_den() == 2) {
      const Expression base = replace(e.operands()[0]);
      const auto name = "sqrt#" + std::to_string(symbols.size());
      const Expression symbol = symbols.try_emplace(base, Expression::symbol(name)).first->second;
      return Expression::power(symbol, Expression(Rational(e.operands()[1].number() * 2)));
    }
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) operands.push_back(replace(operand));
    return with_operands(e, std::move(operands));
  }
};

// The sum, a polynomial, with s^(2k) = b^k and s^(2k+1) = s b^k: zero if it vanishes so.
bool vanishes_with_roots(GiNaC::ex sum, const SquareRoots& roots, SymbolTable& table) {
  for (const auto& [base, symbol] : roots.symbols) {
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
  for (int number = 0; number < kFirstPoints; ++number) {
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

class Decider {
 public:
  // `of_program`: what is emitted has to be defined wherever the expected is.
  Decider(const Identities& identities, const Surroundings& around, bool of_program)
      : identities_(identities), around_(around), of_program_(of_program) {
    for (const Statement& s : identities.emitted) emitted_.emplace(s.name, s.value);
  }

  Decision run() {
    Decision decision{.claims = static_cast<int>(identities_.claims.size())};
    decision.corners = corners_of_all();
    if (!is_ordered(decision)) return decision;
    const bool holds_at_first = test(decision, 0, kFirstPoints);
    if (decision.verdict == Verdict::refuted) return decision;
    for (const Statement& s : identities_.expected) match(s.name, s.value);
    const std::vector<Expression> sides = reduced_sides();
    for (std::size_t i = 0; i < sides.size(); i += 2) {
      if (equal(sides[i], sides[i + 1])) ++decision.by_algebra;
    }
    if (decision.by_algebra == decision.claims && decision.corners.empty()) {
      decision.verdict = Verdict::proved;
      decision.points = 0;
      decision.witness.clear();
      return decision;
    }
    if (!holds_at_first || !test(decision, kFirstPoints, kPoints)) return decision;
    decision.verdict = Verdict::tested;
    return decision;
  }

 private:
  [[nodiscard]] std::vector<Corner> corners_of_all() const {
    std::vector<Expression> all;
    for (const Statement& s : identities_.emitted) all.push_back(s.value);
    for (const Statement& s : identities_.expected) all.push_back(s.value);
    for (const Claim& claim : identities_.claims) {
      all.push_back(claim.emitted);
      all.push_back(claim.expected);
    }
    return corners(all);
  }

  // Every value is computed once, and before it is used.
  bool is_ordered(Decision& decision) const {
    std::set<std::string> later;
    auto fail = [&](const std::string& why) {
      decision.verdict = Verdict::refuted;
      decision.witness = why;
      return false;
    };
    for (const Statement& s : identities_.emitted) {
      if (!later.insert(s.name).second) return fail(s.name + " is computed twice");
    }
    for (const Statement& s : identities_.emitted) {
      for (const std::string& name : symbols(s.value)) {
        if (later.contains(name)) return fail(name + " is used before it is computed");
      }
      later.erase(s.name);
    }
    return true;
  }

  // With definitions replaced by what is known of them, all at once: claims share most of what they
  // are made of.  Symbols lose their ranks by it.
  std::vector<Expression> reduced(std::span<const Expression> values) {
    Substitution replacements;
    for (const Expression& value : values) {
      for (const std::string& name : symbols(value)) {
        if (!replacements.contains(name)) replacements.emplace(name, definition(name));
      }
    }
    return substitute(values, replacements);
  }
  Expression reduced(const Expression& e) { return reduced(std::span(&e, 1))[0]; }

  // Of every claim what is emitted and what is expected.
  std::vector<Expression> reduced_sides() {
    std::vector<Expression> sides;
    for (const Claim& claim : identities_.claims) {
      sides.push_back(claim.emitted);
      sides.push_back(claim.expected);
    }
    return reduced(sides);
  }

  Expression definition(const std::string& name) {
    if (const auto it = known_.find(name); it != known_.end()) return it->second;
    const auto it = emitted_.find(name);
    if (it == emitted_.end()) return Expression::symbol(name);
    const Expression value = reduced(it->second);
    known_.emplace(name, value);
    return value;
  }

  void match(const std::string& name, const Expression& expected) {
    Expression value = reduced(expected);
    const std::string partner = name.substr(1);
    if (const auto it = opaque_.find(value); it != opaque_.end()) {
      const Expression symbol = it->second;
      if (emitted_as(partner, value)) known_[partner] = symbol;
      known_[name] = symbol;
      return;
    }
    if (value.kind() != Kind::symbol && !value.is_number() && emitted_as(partner, value)) {
      // From here on both are one symbol, free as far as the other claims care.
      const Expression symbol = Expression::symbol("~" + partner);
      opaque_.emplace(value, symbol);
      spelled_.emplace(symbol.name(), value);
      known_[partner] = symbol;
      value = symbol;
    }
    known_[name] = value;
  }

  bool emitted_as(const std::string& name, const Expression& value) {
    return emitted_.contains(name) && equal(definition(name), value);
  }

  // Matched symbols are spelled out again before the answer is no: first those that one side only
  // has, then the others.
  bool equal(Expression a, Expression b) const {
    for (int depth = 0; depth < 5; ++depth) {
      if (a == b || is_zero_by_algebra(a - b)) return true;
      const std::set<std::string> of_a = symbols(a);
      const std::set<std::string> of_b = symbols(b);
      Substitution of_one;
      Substitution of_any;
      for (const auto& [name, value] : spelled_) {
        if (of_a.contains(name) || of_b.contains(name)) of_any.emplace(name, value);
        if (of_a.contains(name) != of_b.contains(name)) of_one.emplace(name, value);
      }
      if (of_any.empty()) return false;
      a = substitute(a, of_one.empty() ? of_any : of_one);
      b = substitute(b, of_one.empty() ? of_any : of_one);
    }
    return false;
  }

  // False and a witness if some claim fails at one of the points first..last-1.
  bool test(Decision& decision, int first, int last) {
    std::set<std::string> free;
    for (const Claim& claim : identities_.claims) {
      collect_symbols(claim.emitted, free);
      collect_symbols(claim.expected, free);
    }
    for (const auto& [name, value] : emitted_) collect_symbols(value, free);
    Substitution definitions = emitted_;
    for (const Statement& s : identities_.expected) {
      collect_symbols(s.value, free);
      definitions.emplace(s.name, s.value);
    }
    std::erase_if(
        free, [&](const std::string& name) { return name == "pi" || definitions.contains(name); });
    for (int point = first; point < last; ++point) {
      // A point may lie outside the domain of H: then another is taken.
      for (int attempt = 0;; ++attempt) {
        if (attempt == kAttempts) {
          decision.witness = "no point was found where all of it is defined";
          return false;
        }
        SamplePoint draw(around_, point, attempt);
        std::map<std::string, Precise> values;
        for (const std::string& name : free) values.emplace(name, draw(name));
        const auto outcome = compare(values, definitions, decision);
        if (!outcome) continue;
        if (!*outcome) return false;
        break;
      }
      decision.points = point + 1;
    }
    return true;
  }

  // Empty outside the domain.
  std::optional<bool> compare(const std::map<std::string, Precise>& free,
                              const Substitution& definitions, Decision& decision) const {
    PreciseValues values(free, definitions);
    for (const Statement& s : identities_.expected) {
      if (!values(Expression::symbol(s.name))) return std::nullopt;
    }
    for (const Claim& claim : identities_.claims) {
      if (!values(claim.expected)) return std::nullopt;
      if ((!of_program_ || claim.where_regular) && !values(claim.emitted)) return std::nullopt;
    }
    for (const Claim& claim : identities_.claims) {
      const auto emitted = values.scaled(claim.emitted);
      const auto expected = values.scaled(claim.expected);
      if (!emitted && values.has_lost_digits()) return std::nullopt;
      if (!emitted) {
        decision.verdict = Verdict::refuted;
        decision.witness = claim.what + " is not defined at a random point where it should be";
        return false;
      }
      if (is_zero(*emitted - *expected)) continue;
      decision.verdict = Verdict::refuted;
      decision.witness =
          fmt::format("{} is {:.10g} and should be {:.10g} at a random point", claim.what,
                      to_double(emitted->value), to_double(expected->value));
      return false;
    }
    return true;
  }

  const Identities& identities_;
  const Surroundings& around_;
  bool of_program_;
  Substitution emitted_;
  Substitution known_;
  ExpressionMap<Expression> opaque_;  // what a matched definition is -> its symbol
  Substitution spelled_;              // and back
};

}  // namespace

namespace {

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
  SymbolTable table;
  if (size <= kExpandable && to_ginac(plain, table).expand().is_zero()) return true;
  if (size <= kNormalisable) return has_no_numerator(plain, kTermsOfAll);
  return known.size() <= kMostParts && vanishes_at_unit_points(plain);
}

Decision decide(const Identities& identities, const Surroundings& around) {
  return Decider(identities, around, true).run();
}

Decision decide_equal(const std::string& what, const Expression& a, const Expression& b,
                      const Surroundings& around) {
  const Identities identities{.claims = {{what, a, b}}};
  return Decider(identities, around, false).run();
}

std::string points_text(const Decision& decision) {
  const std::string off = off_the(decision.corners);
  if (decision.points == 0) return "by algebra, " + off;
  return fmt::format(
      "at {} points around the scenes, of both signs and several scales, to 1e-40 of their terms{}",
      decision.points, off.empty() ? "" : ", " + off);
}

std::string to_text(const Decision& decision) {
  if (!holds(decision.verdict)) return decision.witness;
  if (decision.verdict == Verdict::proved) {
    return fmt::format("{} identities by algebra", decision.claims);
  }
  return fmt::format("{} identities, {} by algebra, all {}", decision.claims, decision.by_algebra,
                     points_text(decision));
}

}  // namespace hamgen
