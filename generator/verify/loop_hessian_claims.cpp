// H'' in a member whose sums are loops: the entries of Newton's matrix, and the product of H'' with
// a vector.  The loops run over all their instances, and the claims are made of every entry.
#include <fmt/format.h>

#include <map>
#include <set>
#include <span>

#include "generator/equations/step_equations.hpp"
#include "generator/solvers/solve_plan.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

// What is linear in a vector: the sum of these times its elements, and what it has besides.
struct Linear {
  std::map<int, Expression> of = {};
  Expression rest = {};
};

struct VectorEntries {
  std::map<std::string, Linear> known = {};  // symbols in which the vector is

  [[nodiscard]] Linear taken_apart(const Expression& e) const {
    if (e.kind() == Kind::symbol) {
      const auto it = known.find(e.name());
      return it != known.end() ? it->second : Linear{.rest = e};
    }
    if (e.kind() == Kind::sum) return sum(e.operands());
    if (e.kind() != Kind::product) return {.rest = e};
    return product(e.operands());
  }
  [[nodiscard]] Linear sum(std::span<const Expression> terms) const {
    std::map<int, std::vector<Expression>> of;
    std::vector<Expression> rest;
    for (const Expression& term : terms) {
      Linear part = taken_apart(term);
      for (auto& [j, entry] : part.of) of[j].push_back(std::move(entry));
      rest.push_back(std::move(part.rest));
    }
    Linear result{.rest = Expression::sum(std::move(rest))};
    for (auto& [j, entries] : of) result.of[j] = Expression::sum(std::move(entries));
    return result;
  }
  // Of one factor the others are entries.  What is not linear stays what it is, and no claim holds.
  [[nodiscard]] Linear product(std::span<const Expression> factors) const {
    for (std::size_t i = 0; i < factors.size(); ++i) {
      Linear part = taken_apart(factors[i]);
      if (part.of.empty()) continue;
      std::vector<Expression> others(factors.begin(), factors.end());
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const Expression factor = Expression::product(std::move(others));
      for (auto& [j, entry] : part.of) entry = entry * factor;
      part.rest = part.rest * factor;
      return part;
    }
    return {.rest = Expression::product({factors.begin(), factors.end()})};
  }
};

class LoopHessianClaims {
 public:
  LoopHessianClaims(const StepUnderProof& step, const Derivatives& derivatives,
                    const FamilyParameters& member)
      : step_(step),
        derivatives_(derivatives),
        member_(member),
        n_(step.mechanics.degrees_of_freedom),
        reduced_(has("evaluate")),
        size_(reduced_ ? n_ : 2 * n_) {}

  std::vector<Identities> run() {
    std::vector<Identities> found;
    if (has("differentiate")) found.push_back(matrix_identities());
    // A step may have that of V'' and its tangent that of H''.
    if (has("potential_curvature"))
      found.push_back(curvature_identities("potential_curvature", n_));
    if (has("curvature")) found.push_back(curvature_identities("curvature", 2 * n_));
    return found;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] bool has(const char* routine) const {
    return step_.code.routine(routine) != nullptr;
  }
  void claim(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }

  // Where tbar is known, without what moves with it and without the row of p_t.
  // With the momenta torn out, pbar = (p - h (1 - alpha) V_q - h beta d)/(1 + h beta m), that of
  //   qbar - q - h alpha T_p(pbar) - h gamma V_q(qbar);
  // else I - h (I/2 + C) J H''.
  Expression expected_entry(int i, int j) {
    const auto& [alpha, beta, gamma] = member_;
    const Expression h = step_size();
    const Expression unit(i == j ? 1 : 0);
    const int time = n_ - 1;
    if (knows_time(step_.mechanics, member_) && (j == time || i % n_ == time)) return unit;
    if (reduced_) {
      const Expression own = derivatives_.second(n_ + i, n_ + i);
      const Expression slope = -(h * (Expression(1) - alpha)) / (Expression(1) + h * beta * own);
      return unit - (h * alpha * own * slope + h * gamma) * derivatives_.second(i, j);
    }
    if (i < n_) {
      return unit - h * alpha * derivatives_.second(n_ + i, j) -
             h * gamma * derivatives_.second(i, j);
    }
    return unit + h * (Expression(1) - alpha) * derivatives_.second(i - n_, j) +
           h * beta * derivatives_.second(i, j);
  }

  Identities matrix_identities() {
    SymbolicMachine machine = step_.machine();
    for (int i = 0; i < 2 * n_; ++i)
      machine.set({"at", "", {{i, {}}}}, step_.mechanics.variable(i));
    if (has("prepare")) machine.run("prepare");
    machine.matrix("matrix")[{0, 0}] = Expression::symbol("left from before");
    machine.run("differentiate");
    const MatrixEntries entries = machine.matrix("matrix");
    identities_ = {};
    std::set<std::pair<long, long>> places;
    for (const auto& [place, value] : entries) places.insert(place);
    for (int i = 0; i < size_; ++i) places.insert({i, i});
    for (const auto& [place, value] : derivatives_.hessian()) {
      const auto add = [&](int i, int j) {
        if (i < size_ && j < size_) places.insert({i, j});
      };
      for (const auto& [i, j] : {place, std::pair(place.second, place.first)}) {
        if (reduced_ && (i >= n_ || j >= n_)) continue;
        add(i, j);
        add(i < n_ ? i + n_ : i - n_, j);
      }
    }
    for (const auto& [i, j] : places) {
      const auto it = entries.find({i, j});
      claim(fmt::format("entry {}, {} of Newton's matrix", i + 1, j + 1),
            it == entries.end() ? Expression(0) : it->second,
            expected_entry(static_cast<int>(i), static_cast<int>(j)));
    }
    identities_.emitted = machine.definitions();
    return std::move(identities_);
  }

  // H'' u, or V'' u, of so many elements: linear in u, so that every entry is a claim.
  Identities curvature_identities(const char* routine, int size) {
    SymbolicMachine machine = step_.machine();
    VectorEntries entries;
    for (int i = 0; i < size; ++i) {
      const long place = i < n_ ? i : i - n_;
      machine.set({i < n_ ? "q" : "p", "", {{place, {}}}}, step_.mechanics.variable(i));
      const Expression u = Expression::symbol("u(" + step_.name(i) + ")");
      machine.set({"u", "", {{i, {}}}}, u);
      entries.known[u.name()].of[i] = Expression(1);
    }
    machine.run(routine);
    identities_ = {.emitted = machine.definitions()};
    for (const Statement& s : identities_.emitted) {
      Linear value = entries.taken_apart(s.value);
      if (!value.of.empty()) entries.known[s.name] = std::move(value);
    }
    const std::vector<std::vector<int>> partners = derivatives_.partners();
    for (int k = 0; k < size; ++k) {
      Linear product = entries.taken_apart(machine.value({"y", "", {{k, {}}}}));
      for (const int j : partners[at(k)]) {
        if (j < size) product.of[j];
      }
      for (const auto& [j, entry] : product.of) {
        claim(fmt::format("entry {}, {} of {}", k + 1, j + 1, routine), entry,
              derivatives_.second(k, j));
      }
      claim(fmt::format("element {} of {} of nothing", k + 1, routine), product.rest,
            Expression(0));
    }
    return std::move(identities_);
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const FamilyParameters member_;
  int n_;
  bool reduced_;  // the momenta are torn out
  int size_;      // of the matrix
  Identities identities_;
};

}  // namespace

std::vector<Identities> loop_hessian_identities(const StepUnderProof& step,
                                                const Derivatives& derivatives,
                                                const Member& member) {
  return LoopHessianClaims(step, derivatives, uniform_parameters(member).value()).run();
}

}  // namespace hamgen
