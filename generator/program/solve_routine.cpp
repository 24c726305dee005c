#include "generator/program/solve_routine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/program/routine_builder.hpp"

namespace hamgen {

namespace {

class SolveRoutine {
 public:
  SolveRoutine(const Environment& environment, const LoweredStep& lowered)
      : environment_(environment), lowered_(lowered) {}

  Routine build(const SolveParts& parts, const CoefficientPlaces& coefficients) {
    routine_ = {.name = "solve",
                .remark = {lowered_.rests.empty()
                               ? "dz = Z - z for one step from z + carry."
                               : "dz + rest = Z - z for one step from z + carry; rest is small."},
                .result = {.type = "StepReport", .object = "report"},
                .places = coefficients};
    ahead_ = parts.ahead;
    add_arguments(parts);
    environment_.bind_parameters(routine_);
    if (ahead_ != nullptr) routine_.places.insert(ahead_->places.begin(), ahead_->places.end());
    for (int i = 0; i < size(); ++i) {
      routine_.places.insert_or_assign("carry(" + variable(i) + ")",
                                       environment_.place("carry", i));
    }
    std::set<std::string> used;
    for (const Stage& stage : lowered_.stages) collect(stage, used);
    for (const Expression& e : lowered_.increments) collect_symbols(e, used);
    if (parts.inverse) {
      Body fail{{Return{.success = false}}};
      routine_.body.push_back({If{{"k", "regular"}, false, std::move(fail)}});
    }
    environment_.load_state(routine_, routine_.body, used);
    for (std::size_t s = 0; s < lowered_.stages.size(); ++s) add_stage(s);
    add_increments();
    routine_.inlined = is_short();
    return std::move(routine_);
  }

 private:
  [[nodiscard]] int size() const { return 2 * environment_.degrees_of_freedom; }
  [[nodiscard]] std::string variable(int i) const {
    return environment_.variables.name(static_cast<std::size_t>(i));
  }

  // Note [a short solve is inlined]
  // It is called twice, from a prediction and from the state itself, and compilers would leave it a
  // function that is told everything by way of memory: with Newton's iteration, single trajectories
  // take up to 25 % longer then, and those in lanes 3 to 15 %.  Fixed points gain nothing.
  [[nodiscard]] bool is_short() const {
    constexpr long few = 400;
    long operations = 0;
    for (const Stage& stage : lowered_.stages) {
      if (!stage.solve) continue;
      if (stage.solve->kind != BlockKind::newton) return false;
      const Cost cost = hamgen::cost(stage.solve->body);
      operations += cost.additions + cost.multiplications + 10 * (cost.divisions + cost.functions);
    }
    return operations > 0 && operations <= few;
  }

  void add_arguments(const SolveParts& parts) {
    std::vector<Argument>& list = routine_.arguments;
    list.push_back(parameters_argument());
    if (parts.coefficients) list.push_back({.name = "k", .record = "Coefficients"});
    list.push_back({.name = "h"});
    list.push_back(state_argument("z"));
    list.push_back(state_argument("carry"));
    if (parts.start) list.push_back({.name = "start", .record = "Start", .changes = true});
    if (parts.ahead) list.push_back({.name = "at", .record = "Derivatives", .changes = true});
    list.push_back(state_argument("dz", true));
    if (!lowered_.rests.empty()) list.push_back(state_argument("rest", true));
  }

  // The symbols a stage reads.
  static void collect(const Stage& stage, std::set<std::string>& used) {
    for (const Statement& s : stage.before) collect_symbols(s.value, used);
    for (const Statement& s : stage.after) collect_symbols(s.value, used);
    if (!stage.solve) return;
    const Solve& solve = *stage.solve;
    for (const Statement& s : solve.body) collect_symbols(s.value, used);
    for (const LoopVariable& v : solve.variables) {
      for (const Expression& e : {v.cold, v.beside, v.next, v.correction}) collect_symbols(e, used);
    }
    for (const Expression& e : solve.residual) collect_symbols(e, used);
    for (const Expression& e : solve.gradient) collect_symbols(e, used);
    for (const auto& row : solve.matrix) {
      for (const Expression& e : row) collect_symbols(e, used);
    }
  }

  // What is computed in stage s and read after its iteration.
  [[nodiscard]] std::vector<std::string> kept(std::size_t s) const {
    std::set<std::string> later;
    const Solve& solve = *lowered_.stages[s].solve;
    for (const LoopVariable& v : solve.variables) collect_symbols(v.correction, later);
    for (const Statement& st : lowered_.stages[s].after) collect_symbols(st.value, later);
    for (std::size_t t = s + 1; t < lowered_.stages.size(); ++t) collect(lowered_.stages[t], later);
    for (const Expression& e : lowered_.increments) collect_symbols(e, later);
    for (const Expression& e : lowered_.rests) collect_symbols(e, later);
    std::vector<std::string> result;
    for (const Statement& st : solve.body) {
      if (later.contains(st.name) && !stands_at_point(st.name)) result.push_back(st.name);
    }
    return result;
  }
  [[nodiscard]] bool stands_at_point(const std::string& symbol) const {
    return ahead_ != nullptr && ahead_->places.contains(symbol);
  }

  void add_stage(std::size_t s) {
    const Stage& stage = lowered_.stages[s];
    append(routine_.body, stage.before);
    if (stage.solve) add_solve(s, *stage.solve);
    const std::size_t first = routine_.body.size();
    append(routine_.body, stage.after);
    if (stage.solve && stage.solve->kind == BlockKind::newton && routine_.body.size() > first) {
      routine_.body[first].remark = {
          lowered_.plan.equations.function
              ? "The last increments correct the gradient, by H'' for K'': no evaluation at the "
                "solution."
              : "The last increments correct the gradient to first order: no evaluation at the "
                "solution."};
    }
  }

  void add_solve(std::size_t s, const Solve& solve) {
    if (solve.sweeps) return add_sweeps(solve);
    const bool newton = solve.kind == BlockKind::newton;
    Iterate iterate{.rule = newton ? Rule::newton : Rule::fixed_point,
                    .name = fmt::format("rule_{}", s),
                    .type = std::string(newton ? "" : lowered_.plan.rule),
                    .unknowns = {},
                    .body = {},
                    .kept = kept(s)};
    if (ahead_ != nullptr) {
      take_derivatives(iterate.body, solve);
      append(iterate.body, split_body(environment_, lowered_).rest);
    } else {
      append(iterate.body, solve.body);
    }
    for (std::size_t j = 0; j < solve.variables.size(); ++j) {
      const LoopVariable& v = solve.variables[j];
      iterate.unknowns.push_back({.symbol = v.name,
                                  .start = v.cold,
                                  .correction = newton ? v.correction : v.next,
                                  .memory = memory_++,
                                  .beside = v.beside,
                                  .by_torn = v.by_torn});
      if (!solve.corrections.empty()) {
        iterate.kept.push_back(solve.corrections[j]);
        iterate.unknowns.back().correction =
            Expression::symbol(solve.corrections[j], kRankOfTemporary);
      }
    }
    if (newton && !solve.corrections.empty()) add_system(iterate.body, s, solve);
    if (!newton) add_refinement(s, solve, iterate);
    routine_.body.push_back({std::move(iterate)});
    if (newton) {
      routine_.body.back().remark = {
          "Newton's iteration for the stage values: residual R, its derivatives, increments "
          "delta."};
    } else {
      routine_.body.push_back({std::move(refinement_), {kRefinementRemark}});
    }
  }

  // The first iteration takes those that are known, and their point; else they are evaluated.
  void take_derivatives(Body& body, const Solve& solve) {
    const Place ready{"at", "ready"};
    Body take;
    Body evaluate;
    for (std::size_t j = 0; j < solve.variables.size(); ++j) {
      const std::string symbol = to_text(ahead_->point[j]);
      const std::string& unknown = solve.variables[j].name;
      routine_.places[symbol] = ahead_->point[j];
      take.push_back({Assign{unknown, Expression::symbol(symbol, kRankOfVariable)}});
      evaluate.push_back({Assign{symbol, Expression::symbol(unknown, kRankOfVariable)}});
    }
    evaluate.push_back({call_of(ahead_->routine)});
    body.push_back({If{ready, true, std::move(take)}});
    body.push_back({If{ready, false, std::move(evaluate)}});
    body.push_back({SetFlag{ready, false}});
  }

  void add_sweeps(const Solve& solve) {
    Sweep sweep{.count = *solve.sweeps, .unknowns = {}, .body = {}, .results = {}};
    append(sweep.body, solve.body);
    for (const LoopVariable& v : solve.variables) {
      sweep.unknowns.push_back({.symbol = v.name, .start = v.cold, .correction = v.next});
      sweep.results.push_back(v.name + "*");
    }
    routine_.body.push_back({std::move(sweep), {"Predictor: grad H at z."}});
  }

  // The increments -matrix^-1 residual: by elimination, or with the inverse of a constant matrix.
  void add_system(Body& body, std::size_t s, const Solve& solve) {
    const auto size = static_cast<int>(solve.matrix.size());
    if (!solve.constant_matrix) put_matrix(body, "matrix", solve.matrix, form_of(solve));
    body.push_back({Array{"vector", {size}, right_side(solve)}});
    if (solve.constant_matrix) {
      multiply(body, s, size);
    } else {
      body.push_back({Factorise{{"matrix"}, is_compared(solve) ? size : 0}});
      body.push_back({SolveFactorised{{"matrix"}, {"vector"}}});
    }
    for (std::size_t j = 0; j < solve.corrections.size(); ++j) {
      const char* solution = solve.constant_matrix ? "product" : "vector";
      body.push_back(
          {Assign{solve.corrections[j], bind_element(routine_, solution, {static_cast<int>(j)})}});
    }
  }

  // product = k.inverse vector
  void multiply(Body& body, std::size_t s, int size) {
    const auto element = [&](const Place& place, const std::string& symbol) {
      routine_.places.insert_or_assign(symbol, place);
      return Expression::symbol(symbol, kRankOfTemporary);
    };
    const AffineIndex i{0, {{"i", 1}}};
    const AffineIndex j{0, {{"j", 1}}};
    const Expression term =
        element({"k", inverse_name(s), {i, j}}, fmt::format("k.{}(i,j)", inverse_name(s))) *
        element({"vector", "", {j}}, "vector(j)");
    const Expression target = element({"product", "", {i}}, "product(i)");
    body.push_back({Array{"product", {size}}});
    Body sum{{Accumulate{target.name(), term}}};
    Body row{for_each(counting("j", size), std::move(sum))};
    body.push_back(for_each(counting("i", size), std::move(row)));
  }

  static std::vector<Expression> right_side(const Solve& solve) {
    std::vector<Expression> values;
    for (const Expression& r : solve.residual) values.push_back(-r);
    return values;
  }

  // Behind the iteration; what it changes are places in its object.
  void add_refinement(std::size_t s, const Solve& solve, const Iterate& iterate) {
    Refine refine{.name = fmt::format("refinement_{}", s),
                  .unknowns = iterate.unknowns,
                  .body = iterate.body,
                  .kept = iterate.kept,
                  .gradient = solve.gradient,
                  .beside = solve.refined_beside};
    for (std::size_t j = 0; j < solve.changes.size(); ++j) {
      routine_.places[solve.changes[j]] = {
          refine.name, "change", {{.constant = static_cast<long>(j), .factors = {}}}};
    }
    refinement_ = std::move(refine);
  }

  void add_increments() {
    Return end;
    for (int i = 0; i < size(); ++i) {
      const Expression& increment = lowered_.increments[static_cast<std::size_t>(i)];
      if (increment.is_zero()) continue;
      const Expression target = environment_.bind_state(routine_, "dz", i);
      routine_.body.push_back({Assign{target.name(), increment}});
      end.finite.push_back(target.name());
      if (lowered_.rests.empty()) continue;
      const Expression rest = environment_.bind_state(routine_, "rest", i);
      routine_.body.push_back({Assign{rest.name(), lowered_.rests[static_cast<std::size_t>(i)]}});
      end.finite.push_back(rest.name());
    }
    routine_.body.push_back({std::move(end)});
  }

  const Environment& environment_;
  const LoweredStep& lowered_;
  Routine routine_;
  Refine refinement_;
  const DerivativesAhead* ahead_ = nullptr;
  int memory_ = 0;  // elements of start.value in use
};

}  // namespace

Routine solve_routine(const Environment& environment, const LoweredStep& lowered,
                      const SolveParts& parts, const CoefficientPlaces& coefficients) {
  return SolveRoutine(environment, lowered).build(parts, coefficients);
}

}  // namespace hamgen
