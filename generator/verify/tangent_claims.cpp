// The linearised step as it is written, against A+ dZ = A- u with
//
//   A+ = I - h J S (I/2 + C),  A- = I + h J S (I/2 - C),  S the Hessian at zbar = z + (I/2 + C) dz,
//
// for every unit vector u.  Where a block is left to elimination its solution x is a free symbol,
// and the rows that x should satisfy lack rho = matrix x - right side: then
// A+ dZ - A- u = h J S rho for every x, which no wrong entry of the matrix passes.
#include <fmt/format.h>

#include <algorithm>

#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

using Column = std::vector<Expression>;

class TangentClaims {
 public:
  TangentClaims(const StepUnderProof& step, const Derivatives& derivatives, const Member& member)
      : step_(step), derivatives_(derivatives), member_(member), machine_(step.machine()) {}

  Identities run() {
    Column dz;
    for (int i = 0; i < step_.size(); ++i) {
      dz.push_back(Expression::symbol("dz(" + step_.name(i) + ")", kRankOfVariable + i));
      machine_.set(step_.environment.place("dz", i), dz.back());
    }
    const bool composed = step_.code.routine("substep_tangent") != nullptr;
    machine_.run(composed ? "substep_tangent" : "tangent");
    identities_.emitted = machine_.definitions();
    add_hessian(dz);
    for (int column = 0; column < step_.size(); ++column) claim_column(column);
    return std::move(identities_);
  }

 private:
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(step_.size()); }

  // S, each entry by a name of its own.
  void add_hessian(const Column& dz) {
    const Column moved = weighted(dz, 1);
    Substitution stage;
    for (int i = 0; i < step_.size(); ++i) {
      const Expression bar = Expression::symbol("=bar(" + step_.name(i) + ")");
      identities_.expected.push_back(
          {bar.name(), step_.mechanics.variable(i) + moved[static_cast<std::size_t>(i)]});
      stage.emplace(step_.name(i), bar);
    }
    for (int i = 0; i < step_.size(); ++i) {
      for (int j = i; j < step_.size(); ++j) {
        const Expression entry = derivatives_.second(i, j);
        if (entry.is_zero()) continue;
        const std::string name = fmt::format("=H({},{})", step_.name(i), step_.name(j));
        identities_.expected.push_back({name, substitute(entry, stage)});
        hessian_[{static_cast<std::size_t>(i), static_cast<std::size_t>(j)}] =
            Expression::symbol(name);
      }
    }
  }

  void claim_column(int column) {
    Column dz;
    for (int i = 0; i < step_.size(); ++i) {
      dz.push_back(machine_.value({"m", "", {{i * step_.size() + column, {}}}}));
    }
    Column unit(size(), Expression(0));
    unit[static_cast<std::size_t>(column)] = Expression(1);
    const Column of_step = times_hjs(weighted(dz, 1));
    const Column of_displacement = times_hjs(weighted(unit, -1));
    const Column of_rest = times_hjs(rest(column));
    for (std::size_t i = 0; i < size(); ++i) {
      identities_.claims.push_back(
          {fmt::format("row {}, column {} of the tangent map", i + 1, column + 1),
           dz[i] - of_step[i] - of_rest[i], unit[i] + of_displacement[i]});
    }
  }

  // rho, by the variables that the solutions are displacements of: the same in every column.
  [[nodiscard]] Column rest(int column) const {
    Column rho(size(), Expression(0));
    const std::size_t stages = machine_.systems.size() / size();
    for (std::size_t s = 0; s < stages; ++s) {
      const EliminatedSystem& own = machine_.systems[static_cast<std::size_t>(column) * stages + s];
      const EliminatedSystem& last = machine_.systems[(size() - 1) * stages + s];
      for (std::size_t i = 0; i < own.solution.size(); ++i) {
        Expression lack = -own.right_side[i];
        for (std::size_t j = 0; j < own.solution.size(); ++j) {
          const auto entry = own.matrix.find({static_cast<long>(i), static_cast<long>(j)});
          if (entry != own.matrix.end()) lack += entry->second * own.solution[j];
        }
        for (int k = 0; k < step_.size(); ++k) {
          if (machine_.local("moved(" + step_.name(k) + ")") == last.solution[i])
            rho[static_cast<std::size_t>(k)] = lack;
        }
      }
    }
    return rho;
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
    const std::size_t n = size() / 2;
    Column slope(size(), Expression(0));
    for (const auto& [place, entry] : hessian_) {
      slope[place.first] += entry * v[place.second];
      if (place.first != place.second) slope[place.second] += entry * v[place.first];
    }
    Column result;
    for (std::size_t i = 0; i < n; ++i) result.push_back(step_size() * slope[n + i]);
    for (std::size_t i = 0; i < n; ++i) result.push_back(-(step_size() * slope[i]));
    return result;
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const Member& member_;
  SymbolicMachine machine_;
  std::map<std::pair<std::size_t, std::size_t>, Expression> hessian_;
  Identities identities_;
};

}  // namespace

Identities tangent_identities(const StepUnderProof& step, const Derivatives& derivatives,
                              const Member& member) {
  return TangentClaims(step, derivatives, member).run();
}

}  // namespace hamgen
