// A member of the family that is written out.  With zbar the point where the routine evaluates,
// whatever it iterates on, tears out or solves at once:
//
//   what is not iterated satisfies its row,       zbar_t = z_t + carry_t + h (B grad H(zbar))_t
//   the increments delta are those of Newton,     F(zbar) + F'(zbar) delta = 0
//   and dz is that of zbar + delta, linearised,   dz = carry + h J (grad H(zbar) + H''(zbar) delta)
//
// with F(zbar) = zbar - z - carry - h B grad H(zbar), B = (I/2 + C) J.  What elimination returns is
// free: then its matrix and right side are those of F + F' delta, entry by entry.
#include <fmt/format.h>

#include <algorithm>

#include "generator/verify/member_points.hpp"

namespace hamgen {

namespace {

class MemberClaims : private MemberPoints {
 public:
  using MemberPoints::MemberPoints;

  Identities run() {
    if (step_.code.routine("prepare") != nullptr) machine_.run("prepare");
    machine_.run("solve");
    identities_.emitted = machine_.definitions();
    find_points();
    if (sweeps_) {
      claim_sweeps();
    } else {
      for (std::size_t b = 0; b < machine_.iterations.size(); ++b) claim_starts(b);
      claim_rows();
      for (std::size_t b = 0; b < machine_.iterations.size(); ++b) claim_iteration(b);
    }
    for (int i = 0; i < 2 * n_; ++i) claim_increment(i);
    return std::move(identities_);
  }

 private:
  void claim_starts(std::size_t b) {
    const IterationTrace& trace = machine_.iterations[b];
    for (std::size_t j = 0; j < trace.unknowns.size(); ++j) {
      const int v = variable_of(static_cast<int>(b), j);
      claim("the start of " + name(v), trace.starts[j], step_.mechanics.variable(v));
    }
  }

  // Every stage value that the gradient needs and no iteration finds.
  void claim_rows() {
    for (int k = 0; k < 2 * n_; ++k) {
      if (is_needed(k)) (void)gradient(k);
    }
    for (std::size_t j = 0; j < by_claim_.size(); ++j) {  // grows on the way
      const int v = by_claim_[j];
      const Point& point = points_[at(v)];
      if (!point.emitted) continue;
      if (is_implicit(v)) {
        claim_implicit(v);
      } else {
        claim("the stage value of " + name(v), *point.emitted, row(v, point.iteration));
      }
    }
  }
  // Its row, with what the routine makes of it spelled out in the gradient too.
  void claim_implicit(int v) {
    const Point& point = points_[at(v)];
    const auto definition = std::ranges::find(
        identities_.emitted, point.emitted->kind() == Kind::symbol ? point.emitted->name() : "",
        &Statement::name);
    const Expression spelled =
        definition == identities_.emitted.end() ? *point.emitted : definition->value;
    Expression sum = step_.mechanics.variable(v) + carry(v);
    for (const auto& [k, weight] : weights_[v]) {
      Substitution stage;
      for (const int u : variables_of(k)) {
        stage.emplace(name(u), u == v ? spelled : value(u, point.iteration));
      }
      sum += weight * substitute(derivatives_.first(k), stage);
    }
    claim("the stage value of " + name(v), spelled, sum);
  }
  [[nodiscard]] bool is_needed(int k) const { return !derivatives_.first(k).is_zero(); }

  // lack + matrix delta = 0, of which the unknowns in `left` are solved together.
  struct Given {
    std::size_t unknown = 0;
    Expression rest;
    std::vector<Expression> slope;  // delta = -rest + slope delta
  };
  struct System {
    std::vector<Expression> lack;
    std::vector<std::vector<Expression>> matrix;
    std::vector<std::size_t> left = {};
    std::vector<Given> given = {};
  };
  void claim_iteration(std::size_t number) {
    const int b = static_cast<int>(number);
    const IterationTrace& trace = machine_.iterations[number];
    if (trace.rule == Rule::fixed_point) return claim_fixed_point(b);
    // F(zbar) + F'(zbar) delta of the unknowns.
    System system;
    for (std::size_t j = 0; j < trace.unknowns.size(); ++j) {
      const int x = variable_of(b, j);
      system.lack.push_back(trace.unknowns[j] - row(x, b));
      auto& line = system.matrix.emplace_back();
      for (std::size_t l = 0; l < trace.unknowns.size(); ++l) {
        line.push_back(Expression(j == l ? 1 : 0) - chain(x, l, b));
      }
    }
    eliminate(b, system);
    for (const std::size_t j : system.left) {
      const std::string r = "R(" + unknown_name(b, j);
      system.lack[j] = define(r + ")", system.lack[j]);
      for (const std::size_t l : system.left) {
        system.matrix[j][l] = define(r + "," + unknown_name(b, l) + ")", system.matrix[j][l]);
      }
    }
    claim_given(b, system);
    if (const EliminatedSystem* solved = system_of(trace)) {
      return claim_elimination(b, *solved, system);
    }
    if (const InvertedMatrix* inverse = inverse_of(trace)) {
      return claim_inverse(b, *inverse, system);
    }
    for (const std::size_t j : system.left) {
      Expression sum(0);
      for (const std::size_t l : system.left) sum += system.matrix[j][l] * trace.corrections[l];
      claim("what Newton's increments do to the equation for " + unknown_name(b, j), sum,
            -system.lack[j]);
      identities_.claims.back().where_regular = true;
    }
  }

  // Increments that the routine computes from others: their equations hold for any value of these,
  // and take them out of the others' equations.
  void eliminate(int b, System& system) {
    const IterationTrace& trace = iteration(b);
    const std::size_t m = system.lack.size();
    std::vector<std::size_t> given;
    for (std::size_t j = 0; j < m; ++j) (follows(trace, j) ? given : system.left).push_back(j);
    for (const std::size_t l : given) {
      const Expression own = system.matrix[l][l];
      const Expression rest = define("R(" + unknown_name(b, l) + ")", system.lack[l] / own);
      std::vector<Expression> slope(m, Expression(0));
      for (const std::size_t j : system.left) {
        slope[j] = define(fmt::format("d({})/d({})", unknown_name(b, l), unknown_name(b, j)),
                          -system.matrix[l][j] / own);
      }
      for (std::size_t i = 0; i < m; ++i) {
        const Expression factor = system.matrix[i][l];
        if (i == l || factor.is_zero()) continue;
        system.lack[i] = system.lack[i] - factor * rest;
        for (const std::size_t j : system.left) system.matrix[i][j] += factor * slope[j];
        system.matrix[i][l] = Expression(0);
      }
      system.given.push_back({l, rest, std::move(slope)});
    }
  }
  void claim_given(int b, const System& system) {
    const IterationTrace& trace = iteration(b);
    std::map<std::size_t, Expression> increments;
    for (const std::size_t j : system.left) {
      if (system.given.empty()) return;
      increments[j] = define("delta(" + unknown_name(b, j) + ")", trace.corrections[j]);
    }
    for (const Given& given : system.given) {
      Expression sum = -given.rest;
      for (const std::size_t j : system.left) sum += given.slope[j] * increments.at(j);
      claim("the increment of " + unknown_name(b, given.unknown), trace.corrections[given.unknown],
            sum);
    }
  }
  // Is the increment of unknown j computed from those of others?
  [[nodiscard]] bool follows(const IterationTrace& trace, std::size_t j) const {
    const auto definition = std::ranges::find(
        identities_.emitted,
        trace.corrections[j].kind() == Kind::symbol ? trace.corrections[j].name() : "",
        &Statement::name);
    if (definition == identities_.emitted.end()) return false;
    const std::set<std::string> read = symbols(definition->value);
    return std::ranges::any_of(trace.corrections, [&](const Expression& other) {
      return other.kind() == Kind::symbol && read.contains(other.name());
    });
  }
  Expression chain(int x, std::size_t l, int b) {
    Expression sum(0);
    for (const auto& [k, weight] : weights_[x]) {
      for (const int u : variables_of(k)) {
        if (points_[at(u)].iteration != b) continue;
        const Expression entry = second_in(k, u, b);
        if (!entry.is_zero()) sum += weight * entry * slopes(u)[l];
      }
    }
    return sum;
  }

  // The system some of whose solutions are corrections.
  [[nodiscard]] const EliminatedSystem* system_of(const IterationTrace& trace) const {
    for (const EliminatedSystem& system : machine_.systems) {
      if (std::ranges::find(trace.corrections, system.solution.at(0)) != trace.corrections.end())
        return &system;
    }
    return nullptr;
  }
  // The inverse that the corrections are multiplied with.
  [[nodiscard]] const InvertedMatrix* inverse_of(const IterationTrace& trace) const {
    for (const InvertedMatrix& inverse : machine_.inverses) {
      const std::string& entry = inverse.inverse.at(0).at(0).name();
      if (inverse.inverse.size() != trace.unknowns.size()) continue;
      std::set<std::string> read;
      std::vector<std::string> open;
      const auto look = [&](const Expression& e) {
        for (const std::string& s : symbols(e)) {
          if (read.insert(s).second) open.push_back(s);
        }
      };
      look(trace.corrections[0]);
      while (!open.empty()) {
        const std::string next = open.back();
        open.pop_back();
        const auto definition = std::ranges::find(identities_.emitted, next, &Statement::name);
        if (definition != identities_.emitted.end() && trace.inside.contains(next))
          look(definition->value);
      }
      if (read.contains(entry)) return &inverse;
    }
    return nullptr;
  }

  void claim_elimination(int b, const EliminatedSystem& solved, const System& system) {
    const IterationTrace& trace = iteration(b);
    claim("the number of linear equations", Expression(std::ssize(solved.solution)),
          Expression(std::ssize(system.left)));
    if (solved.solution.size() != system.left.size()) return;
    for (std::size_t i = 0; i < system.left.size(); ++i) {
      const std::size_t j = system.left[i];
      const std::string& x = unknown_name(b, j);
      claim("the residual of " + x, solved.right_side[i], -system.lack[j]);
      claim("the increment of " + x, trace.corrections[j], solved.solution[i]);
      claim_row(b, solved.matrix, i, system);
    }
  }
  void claim_row(int b, const MatrixEntries& entries, std::size_t i, const System& system) {
    for (std::size_t l = 0; l < system.left.size(); ++l) {
      const auto it = entries.find({static_cast<long>(i), static_cast<long>(l)});
      claim("the derivative of the residual of " + unknown_name(b, system.left[i]) + " by " +
                unknown_name(b, system.left[l]),
            it == entries.end() ? Expression(0) : it->second,
            system.matrix[system.left[i]][system.left[l]]);
    }
  }

  void claim_inverse(int b, const InvertedMatrix& inverse, const System& system) {
    const IterationTrace& trace = iteration(b);
    for (std::size_t i = 0; i < system.left.size(); ++i) {
      Expression sum(0);
      for (std::size_t l = 0; l < system.left.size(); ++l) {
        sum += -(inverse.inverse[i][l] * system.lack[system.left[l]]);
      }
      claim("the increment of " + unknown_name(b, system.left[i]),
            trace.corrections[system.left[i]], sum);
      claim_row(b, inverse.matrix, i, system);
    }
  }

  void claim_fixed_point(int b) {
    const IterationTrace& trace = iteration(b);
    for (std::size_t j = 0; j < trace.unknowns.size(); ++j) {
      const int x = variable_of(b, j);
      claim("the next value of " + name(x), trace.corrections[j], row(x, b));
    }
  }

  // In terms of the gradient g: first grad H(z), then K times grad H(zbar(g)).
  void claim_sweeps() {
    claim("the number of sweeps",
          Expression(machine_.sweeps.empty() ? 0 : machine_.sweeps.front().count),
          Expression(*sweeps_));
    if (machine_.sweeps.empty()) return;
    const SweepTrace& trace = machine_.sweeps.front();
    for (int k = 0; k < 2 * n_; ++k) {
      const auto j = sweep_of(k);
      gradient_[at(k)] = j ? trace.unknowns[*j] : Expression(0);
    }
    for (int v = 0; v < 2 * n_; ++v) {
      points_[at(v)].value = define("bar(" + name(v) + ")", row(v, -1));
    }
    for (int k = 0; k < 2 * n_; ++k) {
      const auto j = sweep_of(k);
      if (!is_needed(k)) continue;
      claim("a sweep for dH/d" + name(k), Expression(j ? 1 : 0), Expression(1));
      if (!j) continue;
      claim("the predictor of dH/d" + name(k), trace.starts[*j], derivatives_.first(k));
      claim("the next dH/d" + name(k), trace.next[*j], at_point(derivatives_.first(k), -1));
    }
    for (int k = 0; k < 2 * n_; ++k) {
      const auto j = sweep_of(k);
      gradient_[at(k)] = j ? trace.results[*j] : Expression(0);
    }
  }
  [[nodiscard]] std::optional<std::size_t> sweep_of(int k) const {
    const std::vector<Expression>& list = machine_.sweeps.front().unknowns;
    const auto it = std::ranges::find(list, gradient_name(k), &Expression::name);
    if (it == list.end()) return {};
    return static_cast<std::size_t>(it - list.begin());
  }

  void claim_increment(int i) {
    const int k = i < n_ ? i + n_ : i - n_;
    const Expression h = i < n_ ? step_size() : -step_size();
    Expression expected = carry(i);
    if (is_needed(k)) {
      if (!sweeps_ && is_anew(k)) {
        expected += h * at_end(derivatives_.first(k));
      } else {
        expected += h * gradient(k);
        if (!sweeps_) expected += h * (change(k) + refined_change(k));
      }
    }
    claim("the increment of " + name(i), step_.increment(machine_, i), expected);
  }

  // A component that is linear, of variables whose rows the routine evaluates once more: these move
  // them by as much as the increments do, and it with them.
  bool is_anew(int k) {
    if (!is_newton(iteration_of(k))) return false;
    bool any = false;
    for (const int v : variables_of(k)) {
      const std::set<std::string> read = symbols(derivatives_.second(k, v));
      for (int u = 0; u < 2 * n_; ++u) {
        if (read.contains(name(u))) return false;
      }
      const Point& point = points_[at(v)];
      any = any || (point.unknown < 0 && point.iteration == iteration_of(k) &&
                    machine_.local("bar(" + name(v) + ")*"));
    }
    return any;
  }
  Expression at_end(const Expression& e) {
    Substitution stage;
    const std::set<std::string> read = symbols(e);
    for (int v = 0; v < 2 * n_; ++v) {
      if (read.contains(name(v))) stage.emplace(name(v), value_at_end(v));
    }
    return substitute(e, stage);
  }
  Expression value_at_end(int v) {
    const Point& point = points_[at(v)];
    if (!is_newton(point.iteration) || point.unknown >= 0) return value(v, -1);
    if (const auto it = by_row_.find(v); it != by_row_.end()) return it->second;
    const Expression by_row = define("bar(" + name(v) + ")*", row(v, -1));
    Expression sum(0);
    for (const auto& [k, weight] : weights_[v]) sum += weight * spelled_change(k, point.iteration);
    claim("how far the row of " + name(v) + " moves", moved(v), sum);
    return by_row_.emplace(v, by_row).first->second;
  }

  // What the rounded solution of a fixed point lacks of the exact one is free, of the component
  // that its refinement looks at.
  Expression refined_change(int k) {
    const std::optional<Refined> end = refined(k);
    if (!end) return Expression(0);
    claim("dH/d" + name(k) + " at the fixed point", end->gradient, gradient(k));
    return end->change;
  }
};

}  // namespace

Identities member_identities(const StepUnderProof& step, const Derivatives& derivatives,
                             const Member& member, std::optional<int> sweeps) {
  return MemberClaims(step, derivatives, member, sweeps).run();
}

}  // namespace hamgen
