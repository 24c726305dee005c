#include "generator/verify/identities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "generator/verify/precise.hpp"
#include "generator/verify/zero_by_algebra.hpp"

namespace hamgen {

namespace {

constexpr int kPoints = 200;
// The first points only refute: most mistakes show at once.
constexpr int kFirstPoints = 3;
constexpr int kAttempts = 100;
// Of definitions, and of claims, that algebra does not decide: so many, and the others like them
// are left to the points.
constexpr int kMostUndecided = 8;

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
    decision.by_algebra = by_algebra(sides);
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

  // How many of the pairs are equal by it.
  int by_algebra(const std::vector<Expression>& sides) const {
    int result = 0;
    int undecided = 0;
    for (std::size_t i = 0; i < sides.size(); i += 2) {
      if (equal(sides[i], sides[i + 1], undecided)) ++result;
    }
    return result;
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
    return emitted_.contains(name) && equal(definition(name), value, unmatched_);
  }

  // Whether they are, of which so many were not.
  bool equal(const Expression& a, const Expression& b, int& undecided) const {
    if (a == b) return true;
    if (undecided < kMostUndecided && equal(a, b)) return true;
    ++undecided;
    return false;
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
  int unmatched_ = 0;
};

}  // namespace

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
