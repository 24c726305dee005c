// The linearised step as it is written, against A+ dZ = A- u with
//
//   A+ = I - h J S (I/2 + C),  A- = I + h J S (I/2 - C),  S the Hessian at zbar = z + (I/2 + C) dz.
//
// Where a block is left to elimination its solution x is a free symbol, and the rows that x should
// satisfy lack rho = matrix x - right side: then A+ dZ - A- u = h J S rho for every x, which no
// wrong entry of the matrix passes.
#include <fmt/format.h>

#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

using Column = std::vector<Expression>;

class ExpectedTangent {
 public:
  ExpectedTangent(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
                  const Linearisation& linearisation)
      : mechanics_(mechanics),
        derivatives_(derivatives),
        member_(member),
        linearisation_(linearisation),
        n_(mechanics.degrees_of_freedom) {}

  Identities run() {
    Identities identities{.emitted = linearisation_.once};
    Column rho(size(), Expression(0));
    for (const Linearisation::Stage& stage : linearisation_.stages) {
      identities.emitted.insert(identities.emitted.end(), stage.before.begin(), stage.before.end());
      if (stage.solve) add_rest(*stage.solve, rho);
    }
    Column displacement;
    Column dz;
    for (const Quantity& variable : mechanics_.variables) {
      displacement.push_back(Expression::symbol("u(" + variable.name + ")"));
      dz.push_back(Expression::symbol("dz(" + variable.name + ")"));
    }
    // S, each entry by a name of its own.
    const Column moved = weighted(dz, 1);
    Substitution stage;
    for (std::size_t i = 0; i < size(); ++i) {
      const std::string& name = mechanics_.variables[i].name;
      const Expression bar = Expression::symbol("=bar(" + name + ")");
      identities.expected.push_back({bar.name(), variable(i) + moved[i]});
      stage.emplace(name, bar);
    }
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = i; j < size(); ++j) {
        const Expression entry = derivatives_.second(static_cast<int>(i), static_cast<int>(j));
        if (entry.is_zero()) continue;
        const std::string name =
            fmt::format("=H({},{})", mechanics_.variables[i].name, mechanics_.variables[j].name);
        identities.expected.push_back({name, substitute(entry, stage)});
        hessian_[{i, j}] = Expression::symbol(name);
      }
    }
    const Column of_step = times_hjs(weighted(linearisation_.results, 1));
    const Column of_displacement = times_hjs(weighted(displacement, -1));
    const Column of_rest = times_hjs(rho);
    for (std::size_t i = 0; i < size(); ++i) {
      identities.claims.push_back({"row " + mechanics_.variables[i].name + " of the tangent map",
                                   linearisation_.results.at(i) - of_step[i] - of_rest[i],
                                   displacement[i] + of_displacement[i]});
    }
    return identities;
  }

 private:
  [[nodiscard]] std::size_t size() const { return mechanics_.variables.size(); }
  [[nodiscard]] Expression variable(std::size_t i) const {
    return mechanics_.variable(static_cast<int>(i));
  }

  void add_rest(const LinearisedSolve& solve, Column& rho) const {
    for (std::size_t i = 0; i < solve.solution.size(); ++i) {
      Expression rest = -solve.right_side.at(i);
      for (std::size_t j = 0; j < solve.solution.size(); ++j) {
        rest += solve.matrix.at(i).at(j) * Expression::symbol(solve.solution[j]);
      }
      for (std::size_t k = 0; k < size(); ++k) {
        if (solve.solution[i] == "moved(" + mechanics_.variables[k].name + ")") rho[k] = rest;
      }
    }
  }

  // (I/2 +- C) v
  [[nodiscard]] Column weighted(const Column& v, int sign) const {
    Column result;
    for (const Expression& e : v) result.push_back(Expression(Rational(1, 2)) * e);
    for (const auto& [place, entry] : member_.c) {
      result[static_cast<std::size_t>(place.first)] +=
          Expression(sign) * entry * v[static_cast<std::size_t>(place.second)];
    }
    return result;
  }

  // h J S v
  [[nodiscard]] Column times_hjs(const Column& v) const {
    const Expression h = Expression::symbol("h", kRankOfStep);
    const auto n = static_cast<std::size_t>(n_);
    Column slope(size(), Expression(0));
    for (const auto& [place, entry] : hessian_) {
      slope[place.first] += entry * v[place.second];
      if (place.first != place.second) slope[place.second] += entry * v[place.first];
    }
    Column result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(h * slope[n + i]);
    for (std::size_t i = 0; i < n; ++i) result.push_back(-(h * slope[i]));
    return result;
  }

  const Mechanics& mechanics_;
  const Derivatives& derivatives_;
  const Member& member_;
  const Linearisation& linearisation_;
  int n_;
  std::map<std::pair<std::size_t, std::size_t>, Expression> hessian_;
};

}  // namespace

Identities tangent_identities(const Mechanics& mechanics, const Derivatives& derivatives,
                              const Member& member, const Linearisation& linearisation) {
  return ExpectedTangent(mechanics, derivatives, member, linearisation).run();
}

}  // namespace hamgen
