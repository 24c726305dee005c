// A member of the family at the point where its routine evaluates: the stage values, the gradient
// and the Hessian there, and what the increments of its iterations do to them.
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/equations/step_equations.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

class MemberPoints {
 public:
  MemberPoints(const StepUnderProof& step, const Derivatives& derivatives, const Member& member,
               std::optional<int> sweeps)
      : step_(step),
        derivatives_(derivatives),
        member_(member),
        n_(step.mechanics.degrees_of_freedom),
        sweeps_(sweeps),
        machine_(step.machine()) {
    set_weights();
  }

 protected:
  // A stage value: given by what comes before it, or found in an iteration.
  struct Point {
    std::optional<Expression> emitted;  // the local of its name
    int iteration = -1;
    int unknown = -1;                      // of the iteration
    std::optional<Expression> value = {};  // as the claims know it
  };

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::string name(int i) const { return step_.name(i); }
  [[nodiscard]] const IterationTrace& iteration(int b) const {
    return machine_.iterations[static_cast<std::size_t>(b)];
  }
  void claim(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }
  // A symbol for the value, which is matched with the routine's local of that name.
  Expression define(const std::string& what, const Expression& value) {
    if (value.is_number()) return value;
    std::string unique = "=" + what;
    while (!names_.insert(unique).second) unique += "*";
    identities_.expected.push_back({unique, value});
    return Expression::symbol(unique);
  }

  // h B, B = (I/2 + C) J, where grad H does not vanish.
  void set_weights() {
    for (int i = 0; i < 2 * n_; ++i) {
      for (int j = 0; j < 2 * n_; ++j) {
        const auto it = member_.c.find({i, j});
        Expression entry = it == member_.c.end() ? Expression(0) : it->second;
        if (i == j) entry += Expression(Rational(1, 2));
        if (entry.is_zero()) continue;
        // (J g)_j = g_{j+n} for a coordinate, -g_{j-n} for a momentum.
        const int k = j < n_ ? j + n_ : j - n_;
        if (derivatives_.first(k).is_zero()) continue;
        weights_[i].emplace_back(k, step_size() * (j < n_ ? entry : -entry));
      }
    }
  }

  // --- the points -------------------------------------------------------------------------------

  void find_points() {
    for (int v = 0; v < 2 * n_; ++v) {
      const std::string bar = "bar(" + name(v) + ")";
      Point point{.emitted = machine_.local(bar)};
      for (std::size_t b = 0; b < machine_.iterations.size(); ++b) {
        const IterationTrace& trace = machine_.iterations[b];
        for (std::size_t j = 0; j < trace.unknowns.size(); ++j) {
          if (trace.unknowns[j].name() != bar) continue;
          point.unknown = static_cast<int>(j);
          point.value = trace.unknowns[j];
        }
        const std::set<std::string> read =
            point.emitted ? symbols(*point.emitted) : std::set<std::string>{};
        const auto inside = [&](const std::string& s) { return trace.inside.contains(s); };
        if (std::ranges::any_of(read, inside)) point.iteration = static_cast<int>(b);
      }
      points_.push_back(std::move(point));
    }
    gradient_.resize(at(2 * n_));
  }

  // The variables of a component of the gradient.
  [[nodiscard]] std::vector<int> variables_of(int k) const {
    std::vector<int> result;
    const std::set<std::string> read = symbols(derivatives_.first(k));
    for (int v = 0; v < 2 * n_; ++v) {
      if (read.contains(name(v))) result.push_back(v);
    }
    return result;
  }
  // The iteration in which dH/dz_k is evaluated before the last increment; -1 if there is none.
  int iteration_of(int k) {
    const auto [known, is_new] = iteration_of_.try_emplace(k, -1);
    if (is_new) known->second = find_iteration_of(k);
    return known->second;
  }
  int find_iteration_of(int k) {
    int last = -1;
    for (const int v : variables_of(k)) last = std::max(last, points_[at(v)].iteration);
    if (last < 0) return last;
    for (int v = 0; v < 2 * n_; ++v) {
      if (points_[at(v)].iteration != last) continue;
      const auto& row = weights_[v];
      if (std::ranges::any_of(row, [&](const auto& term) { return term.first == k; })) return last;
    }
    return -1;
  }

  // zbar_v for what iteration b evaluates; -1: with all increments made.
  Expression value(int v, int b) {
    Point& point = points_[at(v)];
    if (!point.value) point.value = value_by_its_row(v);
    if (point.iteration < 0 || point.iteration == b || !is_newton(point.iteration))
      return *point.value;
    if (!final_.contains(v)) {
      final_[v] = define("bar(" + name(v) + ")*", *point.value + moved(v));
    }
    return final_.at(v);
  }
  // Where it depends on itself, the routine's own value: its row is claimed afterwards.
  Expression value_by_its_row(int v) {
    Point& point = points_[at(v)];
    const std::string bar = "bar(" + name(v) + ")";
    if (is_implicit(v)) {
      if (point.iteration < 0 && is_affine(v)) return define(bar + "*", value_by_increments(v));
      if (!point.emitted) return Expression::symbol("unknown " + bar);
      define_others_of(v);
      by_claim_.push_back(v);
      return define(bar, *point.emitted);
    }
    const Expression defined = define(bar, row(v, point.iteration));
    by_claim_.push_back(v);
    return defined;
  }
  // What its row takes besides: before the value, in which that is then one symbol.
  void define_others_of(int v) {
    open_.insert(v);
    for (const auto& [k, weight] : weights_[v]) {
      for (const int u : variables_of(k)) {
        if (!open_.contains(u)) (void)value(u, points_[at(v)].iteration);
      }
    }
    open_.erase(v);
  }
  // z + carry + (I/2 + C)(dz - carry) with the routine's dz: the increments then say if it solves
  // the equations, and no matter how.
  Expression value_by_increments(int v) {
    const auto part = [&](int i) { return step_.increment(machine_, i) - carry(i); };
    Expression sum = step_.mechanics.variable(v) + carry(v) + Expression(Rational(1, 2)) * part(v);
    for (const auto& [place, entry] : member_.c) {
      if (place.first == v) sum += entry * part(place.second);
    }
    return sum;
  }
  // Is its row affine in everything that is found with it?
  bool is_affine(int v) const {
    for (const auto& [k, weight] : weights_.at(v)) {
      for (const int u : variables_of(k)) {
        if (points_[at(u)].unknown >= 0 || !depends(u, v)) continue;
        const std::set<std::string> read = symbols(derivatives_.second(k, u));
        for (const int w : variables_of(k)) {
          if (points_[at(w)].unknown < 0 && depends(w, v) && read.contains(name(w))) return false;
        }
      }
    }
    return true;
  }
  // Does what is not iterated depend on itself through the rows of others?
  bool is_implicit(int v) const { return depends(v, v); }
  bool depends(int v, int on) const {
    std::set<int> reached;
    std::vector<int> open = {v};
    while (!open.empty()) {
      const int next = open.back();
      open.pop_back();
      const auto row = weights_.find(next);
      if (row == weights_.end()) continue;
      for (const auto& [k, weight] : row->second) {
        for (const int u : variables_of(k)) {
          if (points_[at(u)].unknown >= 0) continue;
          if (u == on) return true;
          if (reached.insert(u).second) open.push_back(u);
        }
      }
    }
    return false;
  }

  [[nodiscard]] bool is_newton(int b) const {
    return b >= 0 && iteration(b).rule != Rule::fixed_point;
  }

  Expression at_point(const Expression& e, int b) {
    Substitution stage;
    const std::set<std::string> read = symbols(e);
    for (int v = 0; v < 2 * n_; ++v) {
      if (read.contains(name(v))) stage.emplace(name(v), value(v, b));
    }
    return substitute(e, stage);
  }

  // --- derivatives ------------------------------------------------------------------------------

  // The program's name of dH/dz_k, or of K's that stands in its place.
  [[nodiscard]] std::string gradient_name(int k) const {
    return (member_.generating_order > 0 ? "K(" : "H(") + name(k) + ")";
  }
  // dH/dz_k as it was evaluated.
  Expression gradient(int k) {
    if (!gradient_[at(k)]) {
      const Expression value = at_point(derivatives_.first(k), iteration_of(k));
      if (!gradient_[at(k)]) gradient_[at(k)] = define(gradient_name(k), value);
    }
    return *gradient_[at(k)];
  }
  Expression second(int k, int v) {
    const auto [a, b] = std::minmax(k, v);
    const Expression entry = derivatives_.second(a, b);
    if (entry.is_zero()) return entry;
    const int where = iteration_of(k);
    const std::tuple key(a, b, where);
    if (const auto it = second_.find(key); it != second_.end()) return it->second;
    const Expression symbol = define("H(" + name(a) + "," + name(b) + ")", at_point(entry, where));
    return second_.emplace(key, symbol).first->second;
  }
  // d(zbar_v)/d(unknown j) along the rows of what is torn out.
  std::vector<Expression> slopes(int v) {
    if (const auto it = slopes_.find(v); it != slopes_.end()) return it->second;
    const Point& point = points_[at(v)];
    const std::size_t m = iteration(point.iteration).unknowns.size();
    std::vector<Expression> result(m, Expression(0));
    if (point.unknown >= 0) {
      result[at(point.unknown)] = Expression(1);
    } else {
      Expression own(1);
      for (const auto& [k, weight] : weights_[v])
        own += -(weight * second_in(k, v, point.iteration));
      for (std::size_t j = 0; j < m; ++j) {
        Expression sum(0);
        for (const auto& [k, weight] : weights_[v]) {
          for (const int u : variables_of(k)) {
            if (u == v || points_[at(u)].iteration != point.iteration) continue;
            const Expression entry = second_in(k, u, point.iteration);
            if (!entry.is_zero()) sum += weight * entry * slopes(u)[j];
          }
        }
        result[j] = define(fmt::format("d({})/d({})", name(v), unknown_name(point.iteration, j)),
                           sum / own);
      }
    }
    return slopes_.emplace(v, std::move(result)).first->second;
  }
  // Where a row of iteration b is linearised.
  Expression second_in(int k, int v, int b) {
    return iteration_of(k) == b ? second(k, v) : Expression(0);
  }

  [[nodiscard]] std::string unknown_name(int b, std::size_t j) const {
    const std::string& bar = iteration(b).unknowns[j].name();
    return bar.substr(4, bar.size() - 5);
  }
  [[nodiscard]] int variable_of(int b, std::size_t j) const {
    for (int v = 0; v < 2 * n_; ++v) {
      if (points_[at(v)].iteration == b && points_[at(v)].unknown == static_cast<int>(j)) return v;
    }
    internal_error("an unknown that is no stage value");
  }

  // What the increments move zbar_v by.
  Expression moved(int v) {
    const int b = points_[at(v)].iteration;
    if (!is_newton(b)) return Expression(0);
    Expression sum(0);
    const std::vector<Expression> by = slopes(v);
    for (std::size_t j = 0; j < by.size(); ++j) sum += by[j] * iteration(b).increments[j];
    return sum;
  }
  // What they add to dH/dz_k.
  Expression change(int k) {
    const int b = iteration_of(k);
    if (!is_newton(b)) return Expression(0);
    if (const auto it = changes_.find(k); it != changes_.end()) return it->second;
    const Expression named = define("change(" + gradient_name(k) + ")", spelled_change(k, b));
    return changes_.emplace(k, named).first->second;
  }
  Expression spelled_change(int k, int b) {
    Expression sum(0);
    if (iteration_of(k) != b) return sum;
    for (const int v : variables_of(k)) {
      if (points_[at(v)].iteration != b) continue;
      const Expression entry = second(k, v);
      if (!entry.is_zero()) sum += entry * moved(v);
    }
    return sum;
  }

  // What dH/dz_k changes by from the rounded end of a fixed point to the solution, and the gradient
  // that its refinement looks at there.
  struct Refined {
    Expression change, gradient;
  };
  [[nodiscard]] std::optional<Refined> refined(int k) const {
    for (const IterationTrace& trace : machine_.iterations) {
      const auto it =
          std::ranges::find(trace.changes, "change(" + gradient_name(k) + ")", &Expression::name);
      if (it == trace.changes.end()) continue;
      return Refined{*it, trace.gradient[static_cast<std::size_t>(it - trace.changes.begin())]};
    }
    return {};
  }

  [[nodiscard]] Expression carry(int i) const {
    return derivatives_.first(i < n_ ? i + n_ : i - n_).is_zero() ? Expression(0) : step_.carry(i);
  }
  // z_i + carry_i + h (B grad H)_i as iteration b knows the gradient; -1: with the increments.
  Expression row(int i, int b) {
    Expression sum = step_.mechanics.variable(i) + carry(i);
    for (const auto& [k, weight] : weights_[i]) sum += weight * gradient_at(k, b);
    return sum;
  }
  Expression gradient_at(int k, int b) {
    const Expression plain = gradient(k);
    const int where = iteration_of(k);
    if (where < 0 || where == b) return plain;
    // The claim of the increment has where a refinement looks.
    const std::optional<Refined> end = refined(k);
    const Expression more = end ? change(k) + end->change : change(k);
    if (more.is_zero()) return plain;
    if (!corrected_.contains(k)) corrected_[k] = define(gradient_name(k) + "*", plain + more);
    return corrected_.at(k);
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const Member& member_;
  int n_;
  std::optional<int> sweeps_;
  SymbolicMachine machine_;
  std::map<int, std::vector<std::pair<int, Expression>>> weights_;  // k, h B_ik
  std::vector<Point> points_;
  std::vector<std::optional<Expression>> gradient_;
  std::map<std::tuple<int, int, int>, Expression> second_;
  std::map<int, std::vector<Expression>> slopes_;
  std::map<int, int> iteration_of_;
  std::map<int, Expression> changes_, corrected_, final_, by_row_;
  std::vector<int> by_claim_;
  std::set<int> open_;
  std::set<std::string> names_;
  Identities identities_;
};

}  // namespace hamgen
