#include <fmt/format.h>

#include <optional>

#include "generator/algebra/from_ginac.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

// An invariant and H with their derivatives.
class Bracket {
 public:
  Bracket(const Mechanics& mechanics, const Expression& energy, const Expression& invariant,
          const Surroundings& around)
      : n_(static_cast<std::size_t>(mechanics.degrees_of_freedom)),
        corners_(corners({energy, invariant})),
        around_(around) {
    std::vector<GiNaC::symbol> variables;
    for (std::size_t i = 0; i < 2 * n_; ++i) {
      const std::string& name = mechanics.variables.name(i);
      (void)table_.symbol(name, kRankOfVariable + static_cast<int>(i));
      variables.push_back(table_.find(name));
    }
    const GiNaC::ex h = to_ginac(energy, table_);
    const GiNaC::ex f = to_ginac(invariant, table_);
    for (const GiNaC::symbol& x : variables) {
      energy_.push_back(h.diff(x));
      invariant_.push_back(f.diff(x));
    }
    const std::set<std::string> beyond = non_polynomial_symbols(invariant);
    for (const GiNaC::symbol& x : variables) polynomial_ &= !beyond.contains(x.get_name());
    if (!polynomial_) return;
    for (std::size_t i = 0; i < 2 * n_; ++i) {
      for (std::size_t j = 0; j < 2 * n_; ++j) {
        const GiNaC::ex entry = invariant_[i].diff(variables[j]).expand();
        linear_ &= entry.is_zero();
        // Not ex::has: a real symbol that was copied as a symbol is found in nothing.
        if (!entry.is_zero())
          for (const GiNaC::symbol& x : variables) quadratic_ &= entry.diff(x).is_zero();
        form_.push_back(entry);
      }
    }
  }

  // Is I of this degree at most?
  [[nodiscard]] bool is_linear() const { return polynomial_ && linear_; }
  [[nodiscard]] bool is_quadratic() const { return polynomial_ && quadratic_; }

  // sum I_q H_p and sum I_p H_q, whose difference is {I, H}.
  [[nodiscard]] GiNaC::ex drift() const { return sum(0, n_); }
  [[nodiscard]] GiNaC::ex kick() const { return sum(n_, 0); }
  [[nodiscard]] Decision difference() const {
    Decision decision = equal("`{I, H}` is not 0: sum `I_q H_p`", drift(), kick());
    const std::string words = " and should be ";
    if (const auto at = decision.witness.find(words); at != std::string::npos) {
      decision.witness.replace(at, words.size(), ", sum `I_p H_q` is ");
    }
    return decision;
  }
  [[nodiscard]] Decision zero(const std::string& what, const GiNaC::ex& e) const {
    return equal(what, e, 0);
  }

  // R = C^T M + M C of the quadratic form z^T M z / 2.
  [[nodiscard]] std::optional<GiNaC::matrix> residual(const Member& member) const {
    const auto size = static_cast<unsigned>(2 * n_);
    GiNaC::matrix c(size, size);
    for (const auto& [place, value] : member.c) {
      c(static_cast<unsigned>(place.first), static_cast<unsigned>(place.second)) =
          to_ginac(value, table_);
    }
    GiNaC::matrix form(size, size);
    for (unsigned i = 0; i < size; ++i) {
      for (unsigned j = 0; j < size; ++j) form(i, j) = form_[i * size + j];
    }
    const GiNaC::matrix r = c.transpose().mul(form).add(form.mul(c));
    for (unsigned i = 0; i < size; ++i) {
      for (unsigned j = 0; j < size; ++j) {
        if (!r(i, j).expand().is_zero()) return r;
      }
    }
    return std::nullopt;
  }

  // d^T R d with d = J grad H.
  [[nodiscard]] GiNaC::ex along_flow(const GiNaC::matrix& r) const {
    GiNaC::ex result = 0;
    for (std::size_t i = 0; i < 2 * n_; ++i) {
      for (std::size_t j = 0; j < 2 * n_; ++j) {
        result += velocity(i) * r(static_cast<unsigned>(i), static_cast<unsigned>(j)) * velocity(j);
      }
    }
    return result;
  }

 private:
  [[nodiscard]] GiNaC::ex velocity(std::size_t i) const {
    return i < n_ ? energy_[i + n_] : -energy_[i - n_];
  }
  [[nodiscard]] GiNaC::ex sum(std::size_t of_invariant, std::size_t of_energy) const {
    GiNaC::ex result = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      result += invariant_[of_invariant + i] * energy_[of_energy + i];
    }
    return result;
  }
  [[nodiscard]] Decision equal(const std::string& what, const GiNaC::ex& a,
                               const GiNaC::ex& b) const {
    // What is derived says nothing at a corner.
    const Verdict smooth = corners_.empty() ? Verdict::proved : Verdict::tested;
    Decision decision{.verdict = Verdict::proved, .claims = 1, .by_algebra = 1};
    if (!(a - b).expand().is_zero() || !corners_.empty())
      decision = decide_equal(what, from_ginac(a, table_), from_ginac(b, table_), around_);
    decision.verdict = resting_on(smooth, decision.verdict);
    decision.corners = corners_;
    return decision;
  }

  std::size_t n_;
  std::vector<Corner> corners_;
  const Surroundings& around_;
  mutable SymbolTable table_;
  std::vector<GiNaC::ex> energy_, invariant_, form_;
  bool polynomial_ = true;
  bool quadratic_ = true;
  bool linear_ = true;
};

constexpr const char* kUpToTheOrder = "neither linear nor quadratic: conserved up to the order";

// Z - z = d = h J grad H(zbar) changes I = z^T M z / 2 by
//   d^T M (z + Z)/2 = d^T M zbar - d^T M C d = h {I, H}(zbar) - d^T (C^T M + M C) d / 2.
Finding conserved_by_member(const Bracket& bracket, const Member& member) {
  if (bracket.is_linear()) {
    return {"", Verdict::proved, "linear: every member conserves it"};
  }
  if (!bracket.is_quadratic()) return {"", Verdict::not_decided, kUpToTheOrder};
  const auto r = bracket.residual(member);
  if (!r) return {"", Verdict::proved, "`C^T M + M C = 0` for its quadratic form `M`"};
  if (member.generating_order > 0) {
    return {"", Verdict::not_decided,
            "`C^T M + M C` is not 0 for its quadratic form `M`: `K` may not have this invariant"};
  }
  const std::string what = "`d^T (C^T M + M C) d`, `d = J grad H`,";
  const Decision decision = bracket.zero(what, bracket.along_flow(*r));
  if (decision.verdict == Verdict::proved) return {"", Verdict::proved, what + " is 0 for this H"};
  if (decision.verdict == Verdict::tested) {
    return {"", Verdict::tested, fmt::format("{} is 0 for this H {}", what, points_text(decision))};
  }
  return {"", decision.verdict, decision.witness};
}

Finding conserved_by_splitting(const Bracket& bracket) {
  const Decision of_drift = bracket.zero("`{I, T}`", bracket.drift());
  const Decision of_kick = bracket.zero("`{I, V}`", bracket.kick());
  const Verdict verdict = both(of_drift.verdict, of_kick.verdict);
  if (holds(verdict)) {
    const std::string where = verdict == Verdict::proved
                                  ? ""
                                  : " " + points_text(of_drift.points > 0 ? of_drift : of_kick);
    return {
        "", verdict,
        fmt::format("`{{I, T}} = {{I, V}} = 0`{}: every drift and every kick conserves it", where)};
  }
  return {"", Verdict::not_decided,
          "not conserved by its drifts and kicks one by one: conserved up to the order"};
}

// A symplectic Runge-Kutta method conserves quadratic invariants (Cooper 1987; HLW IV.2.2).
Finding conserved_by_tableau(const Bracket& bracket, Verdict symplectic) {
  if (bracket.is_linear()) {
    return {"", Verdict::proved, "linear: every Runge-Kutta method conserves it"};
  }
  if (holds(symplectic) && bracket.is_quadratic()) {
    return {"", symplectic, "quadratic, and the tableau is symplectic"};
  }
  return {"", Verdict::not_decided,
          bracket.is_quadratic() ? "quadratic, and the tableau is not symplectic: conserved up to "
                                   "the order"
                                 : kUpToTheOrder};
}

Finding conserved(const Bracket& bracket, const Scheme& scheme, bool solved, Verdict symplectic) {
  if (std::holds_alternative<Splitting>(scheme.method)) return conserved_by_splitting(bracket);
  if (std::holds_alternative<RungeKutta>(scheme.method)) {
    return conserved_by_tableau(bracket, symplectic);
  }
  if (!solved && !bracket.is_linear()) {
    return {"", Verdict::not_decided, "the sweeps leave the step unsolved"};
  }
  return conserved_by_member(bracket, scheme.member());
}

}  // namespace

bool says_nothing_of_invariants(const Mechanics& mechanics) {
  return mechanics.keeps_sums() && mechanics.degrees_of_freedom > kMostBracketed;
}

Proof prove_invariants(const Mechanics& mechanics, const Expression& hamiltonian,
                       const Scheme& scheme, bool solved, Verdict symplectic,
                       const Surroundings& around) {
  Proof proof;
  for (const NamedExpression& invariant : mechanics.invariants) {
    if (invariant.only_observed) continue;
    const std::string name = invariant.name + " invariant";
    if (says_nothing_of_invariants(mechanics)) {
      proof.push_back({name, Verdict::not_decided,
                       fmt::format("{} degrees of freedom, more than {}; verify a smaller size",
                                   mechanics.degrees_of_freedom, kMostBracketed)});
      continue;
    }
    const Bracket bracket(mechanics, hamiltonian, invariant.value, around);
    const Decision decision = bracket.difference();
    if (!holds(decision.verdict)) {
      proof.push_back({name, decision.verdict, decision.witness});
      continue;
    }
    const bool proved = decision.verdict == Verdict::proved;
    proof.push_back(
        {name, decision.verdict, "`{I, H} = 0`" + (proved ? "" : " " + points_text(decision))});
    Finding of_step = conserved(bracket, scheme, solved, symplectic);
    of_step.property = invariant.name + " conserved by the step";
    proof.push_back(
        resting_on(decision.verdict, "`{I, H} = 0` is tested only", std::move(of_step)));
  }
  return proof;
}

}  // namespace hamgen
