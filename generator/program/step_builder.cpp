#include "generator/program/step_builder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/mechanics/cancelling_forces.hpp"
#include "generator/program/arithmetic.hpp"

namespace hamgen {

namespace {

// The summands of a sum, or of a multiple of one.
std::vector<Expression> terms_of(const Expression& e) {
  const auto [coefficient, rest] = e.split_coefficient();
  if (rest.kind() != Kind::sum) return {e};
  std::vector<Expression> terms;
  for (const Expression& term : rest.operands()) terms.push_back(Expression(coefficient) * term);
  return terms;
}

std::set<std::string> stage_names(const StepEquations& equations) {
  std::set<std::string> names;
  for (int v = 0; v < 2 * equations.mechanics.degrees_of_freedom; ++v)
    names.insert(equations.stage(v).name());
  return names;
}

std::vector<Section> sections(const SolvePlan& plan) {
  std::vector<Section> result(4 + 3 * plan.blocks.size() + 3);
  for (std::size_t s = 0; 2 + 3 * s < result.size(); ++s) result[2 + 3 * s].is_loop = true;
  return result;
}

}  // namespace

StepBuilder::StepBuilder(const SolvePlan& plan)
    : plan_(plan),
      equations_(plan.equations),
      n_(plan.equations.mechanics.degrees_of_freedom),
      linear_terms_(stage_names(plan.equations)),
      lowering_(sections(plan)) {
  for (const Quantity& parameter : equations_.mechanics.parameters) {
    lowering_.declare(parameter.name, kCoefficients);
  }
  lowering_.declare("h", kCoefficients);
  lowering_.declare("E0", kCoefficients);
  for (int i = 0; i < 2 * n_; ++i) {
    lowering_.declare(equations_.mechanics.variables.name(index(i)), before(0));
    lowering_.declare("carry(" + name_of(i) + ")", before(0));
    stage_value_.push_back(equations_.stage(i));
    gradient_.push_back(equations_.gradient_symbol(i));
  }
  solves_constants_ = std::ranges::any_of(plan_.blocks, [](const Block& block) {
    return block.kind == BlockKind::linear && block.constant_matrix;
  });
  const auto has_block = [&](auto... kinds) {
    return std::ranges::any_of(plan_.blocks,
                               [&](const Block& block) { return ((block.kind == kinds) || ...); });
  };
  const bool is_solved = has_block(BlockKind::linear, BlockKind::newton);
  const bool is_contracted = has_block(BlockKind::fixed_point);
  // Where the stage is the state itself, nothing is added to it on the way.
  const bool has_stage = std::ranges::any_of(plan_.blocks, [&](const Block& block) {
    return !equations_.row_gradients(block.unknowns[0]).empty();
  });
  is_explicit_ = has_stage && !is_solved && !is_contracted && !has_block(BlockKind::quadratic) &&
                 !plan_.sweeps;
  keeps_gradients_ =
      solves_constants_ || std::ranges::any_of(equations_.stage_matrix, [](const auto& entry) {
        return !multiplies_exactly(entry.second);
      });
  keeps_losses_ = keeps_gradients_ && is_solved && !is_contracted && !plan_.sweeps;
  sums_exactly_ = keeps_losses_ || is_explicit_;
  const auto is_newton = [](const Block& block) {
    return block.kind == BlockKind::newton && !block.simplified;
  };
  splits_products_ = std::ranges::any_of(plan_.blocks, is_newton) && !solves_constants_ &&
                     !is_contracted && !plan_.sweeps && has_linear_force();
  rounded_beside_.resize(index(2 * n_), Expression(0));
  if (is_contracted || has_block(BlockKind::newton)) find_rounded_beside();
  known_gradient_.resize(index(2 * n_), false);
  correction_.resize(index(2 * n_));
}

LoweredStep StepBuilder::build() {
  if (plan_.sweeps) {
    add_sweeps();
  } else {
    for (const Block& block : plan_.blocks) add_block(block);
  }
  std::vector<std::size_t> increments;
  std::vector<std::size_t> rests;
  for (int i = 0; i < 2 * n_; ++i) {
    const int k = i < n_ ? i + n_ : i - n_;
    need_gradient(k);
    const auto [large, small] = increment(i, k);
    if (sums_exactly_) rests.push_back(lowering_.want(small, straight()));
    increments.push_back(lowering_.want(sums_exactly_ ? large : large + small, straight()));
  }
  lowering_.run();

  LoweredStep lowered{.plan = plan_};
  lowered.coefficients = lowering_.statements(kCoefficients);
  for (int s = 0; s <= stage_; ++s) {
    Stage stage{.before = lowering_.statements(before(s)), .after = lowering_.statements(after(s))};
    for (PendingSolve& pending : solves_) {
      if (pending.stage == s) stage.solve = finished(pending);
    }
    lowered.stages.push_back(std::move(stage));
  }
  for (const std::size_t handle : increments) {
    lowered.increments.push_back(lowering_.wanted(handle));
  }
  for (const std::size_t handle : rests) lowered.rests.push_back(lowering_.wanted(handle));
  return lowered;
}

int StepBuilder::straight() const { return solving_done_ ? after(stage_) : before(stage_); }

void StepBuilder::open_solve() {
  if (solving_done_) ++stage_;
  solving_done_ = true;
}

Expression StepBuilder::carry_symbol(int i) const {
  // What never changes is never rounded.
  if (gradient_[index(i < n_ ? i + n_ : i - n_)].is_zero()) return Expression(0);
  return Expression::symbol("carry(" + name_of(i) + ")", kRankOfTemporary);
}

std::string StepBuilder::name_of(int i) const {
  return equations_.mechanics.variables.name(index(i));
}

RoundedTerm StepBuilder::increment(int i, int k) {
  if (gradient_[index(k)].is_zero()) return {Expression(0), Expression(0)};
  const Expression sign(i < n_ ? 1 : -1);
  const auto& [main, correction] = correction_[index(k)];
  const Expression& gradient = correction.is_zero() ? gradient_[index(k)] : main;
  std::vector<Expression> terms{carry_symbol(i)};
  const Parts h = step_size_for(k);
  Expression large = sign * h.high * gradient;
  if (!h.low.is_zero()) {
    terms[0] = named_rest("moving " + name_of(i), terms[0] + sign * h.low * gradient, straight());
  }
  if (keeps_losses_) {
    const auto [flow, lost] = flow_of(k, gradient, straight());
    large = sign * flow;
    terms.push_back(sign * lost);
  }
  for (const Expression& term : terms_of(correction)) terms.push_back(sign * step_size() * term);
  if (terms.size() == 1) return {large, terms[0]};
  const Expression small = Expression::sum(std::move(terms));
  return {large, sums_exactly_ ? small : named_rest("d" + name_of(i), small, straight())};
}

Expression StepBuilder::named_rest(const std::string& of, const Expression& value, int section) {
  const int before = rests_[of]++;
  const Expression symbol = Expression::symbol(
      fmt::format("rest({}){}", of, std::string(index(before), '*')), kRankOfTemporary);
  define(symbol, value, section);
  return symbol;
}

void StepBuilder::need_gradient(int k) {
  if (known_gradient_[index(k)] || gradient_[index(k)].is_zero()) return;
  define_gradient(k, straight());
}

Expression StepBuilder::at_stage(const Expression& e) const {
  Substitution replacements;
  for (int i = 0; i < 2 * n_; ++i) {
    if (stage_value_[index(i)] != equations_.stage(i)) {
      replacements.emplace(equations_.stage(i).name(), stage_value_[index(i)]);
    }
  }
  return replacements.empty() ? e : substitute(e, replacements);
}

Expression StepBuilder::name_once(const std::string& name, const Expression& value, int section,
                                  Lowering::Keep keep) {
  const Expression symbol = Expression::symbol(name, kRankOfTemporary);
  if (named_.insert(name).second) lowering_.define(name, value, section, keep);
  return symbol;
}

void StepBuilder::define_gradient(int k, int section) {
  known_gradient_[index(k)] = true;
  lowering_.define(gradient_[index(k)].name(), value_of_gradient(k, section), section,
                   keeps_gradients_ ? Lowering::Keep::yes : Lowering::Keep::no);
  find_lost_of_gradient(k, section);
}

void StepBuilder::define(const Expression& symbol, const Expression& value, int section) {
  lowering_.define(symbol.name(), value, section);
}

void StepBuilder::renew(Expression& value, const std::string& name, const Expression& renewed,
                        int section) {
  if (renewed == value) return;
  const Expression symbol = Expression::symbol(name + "*", kRankOfTemporary);
  define(symbol, renewed, section);
  // What a gradient has lost is missing from it still.
  if (const auto lost = lost_of_gradient_.find(value.name()); lost != lost_of_gradient_.end())
    lost_of_gradient_.emplace(symbol.name(), lost->second);
  value = symbol;
}

void StepBuilder::add_block(const Block& block) {
  for (const int v : block.unknowns) solved_.insert(equations_.stage(v).name());
  for (const int v : block.torn) solved_.insert(equations_.stage(v).name());
  switch (block.kind) {
    case BlockKind::assign:
      add_assignment(block.unknowns[0]);
      return;
    case BlockKind::quadratic:
      add_quadratic(block.unknowns[0]);
      return;
    case BlockKind::linear:
    case BlockKind::newton:
      if (block.kind == BlockKind::linear && linear_solver(block) == LinearSolver::written_out) {
        add_affine(block);
      } else if (block.simplified) {
        add_simplified_newton(block);
      } else {
        add_newton(block);
      }
      return;
    case BlockKind::fixed_point:
      add_fixed_point(block);
      return;
  }
}

void StepBuilder::add_assignment(int i) {
  const std::vector<int> gradients = equations_.row_gradients(i);
  for (const int k : gradients) need_gradient(k);
  if (!is_explicit_ || gradients.size() != 1) {
    define(stage_value_[index(i)], row(i, straight()), straight());
    return;
  }
  // See Note [rounded once].
  const Expression& z = equations_.mechanics.variable(i);
  const Expression flow =
      name_value("flow(" + name_of(i) + ")",
                 -(weight(i, gradients[0]) * gradient_[index(gradients[0])]), straight());
  const auto names = [&](TermRole role, const Expression& value) {
    const char* what = role == TermRole::difference ? "first(" : "lost(";
    return name_value(what + name_of(i) + ")", value, straight());
  };
  const RoundedTerm first = rounded_difference(names, z, {flow}, Errors::of_all);
  define(stage_value_[index(i)],
         first.large + named_rest(name_of(i), first.small + carry_symbol(i), straight()),
         straight());
}

// c0 + c1 d + c2 d^2 = 0 for d = zbar_i - z_i: the root that tends to 0 with h, in the form
// without cancellation, d = -2 c0 / (c1 + sqrt(c1^2 - 4 c0 c2)).
void StepBuilder::add_quadratic(int i) {
  const Expression z = equations_.mechanics.variable(i);
  const std::string bar = equations_.stage(i).name();
  Expression c0 = -carry_symbol(i);
  Expression c1(1);
  Expression c2(0);
  for (const int k : equations_.row_gradients(i)) {
    const Expression slope = at_stage(equations_.stage_hessian(k, i));
    auto slope_at = [&](const Expression& x) { return substitute(slope, {{bar, x}}); };
    const Expression w = weight(i, k);
    c0 += -(w * substitute(at_stage(equations_.stage_gradient(k)), {{bar, z}}));
    c1 += -(w * slope_at(z));
    c2 += -(w * Expression(Rational(1, 2)) * (slope_at(Expression(1)) - slope_at(Expression(0))));
  }
  const std::string& name = equations_.mechanics.variables.name(index(i));
  auto named = [&](const std::string& what, const Expression& value) {
    const Expression symbol = Expression::symbol(what + "(" + name + ")", kRankOfTemporary + i);
    define(symbol, value, straight());
    return symbol;
  };
  const Expression constant = named("c0", c0);
  const Expression linear = named("c1", c1);
  const Expression square = named("c2", c2);
  const Expression root = square_root(linear * linear - Expression(4) * constant * square);
  const Expression d = Expression(-2) * constant / (linear + root);
  define(stage_value_[index(i)], z + d, straight());
}

void StepBuilder::add_fixed_point(const Block& block) {
  open_solve();
  PendingSolve pending{.stage = stage_};
  pending.solve.kind = BlockKind::fixed_point;
  const int where = body(stage_);
  for (const int x : block.unknowns) lowering_.declare(stage_value_[index(x)].name(), where);
  auto evaluate = [&](int k) {
    if (!known_gradient_[index(k)]) define_gradient(k, where);
  };
  for (const int t : block.torn) {
    for (const int k : equations_.row_gradients(t)) evaluate(k);
    define(stage_value_[index(t)], row(t, where), where);
  }
  std::vector<Expression> lengths;  // that coordinates are rounded with besides
  for (const int x : block.unknowns) {
    for (const int k : equations_.row_gradients(x)) evaluate(k);
    pending.solve.variables.push_back({stage_value_[index(x)].name(), {}, {}, {}});
    begin_with_state(pending, x);
    pending.next.push_back(lowering_.want(row(x, where), where));
    if (x < n_) lengths.push_back(rounded_beside_[index(x)]);
  }
  if (const auto length = common_length(equations_.mechanics, lengths))
    pending.refined_beside = lowering_.want(*length, before(stage_));
  // What else depends on these unknowns is refined with them.
  std::set<std::string> own;
  for (const int v : block.unknowns) own.insert(equations_.stage(v).name());
  for (const int v : block.torn) own.insert(equations_.stage(v).name());
  for (int k = 0; k < 2 * n_; ++k) {
    const std::set<std::string> used = symbols(equations_.stage_gradient(k));
    bool depends = false;
    bool known = true;
    for (int v = 0; v < 2 * n_; ++v) {
      const std::string& name = equations_.stage(v).name();
      depends = depends || (used.contains(name) && own.contains(name));
      known = known && (!used.contains(name) || solved_.contains(name));
    }
    if (!depends || !known) continue;
    evaluate(k);
    const std::string& gradient = gradient_[index(k)].name();
    const Expression change = Expression::symbol("change(" + gradient + ")", kRankOfTemporary);
    lowering_.declare(change.name(), after(stage_));
    pending.solve.changes.push_back(change.name());
    pending.gradient.push_back(lowering_.want(gradient_[index(k)], where));
    correction_[index(k)] = {gradient_[index(k)], change};
    change_of_gradient_.emplace(k, change);
  }
  sums_exactly_ = true;
  solves_.push_back(std::move(pending));
}

// Algorithm 1 of the paper: predictor z + h J grad H(z), then K times zbar from the last Z and
// Z = z + h J grad H(zbar).  In terms of the gradient g: g = grad H(z), K times g = grad
// H(zbar(g)).
void StepBuilder::add_sweeps() {
  open_solve();
  PendingSolve pending{.stage = stage_};
  pending.solve.kind = BlockKind::fixed_point;
  pending.solve.sweeps = plan_.sweeps;
  const int where = body(stage_);
  for (int k = 0; k < 2 * n_; ++k) {
    if (!gradient_[index(k)].is_zero()) lowering_.declare(gradient_[index(k)].name(), where);
    known_gradient_[index(k)] = true;
  }
  for (int i = 0; i < 2 * n_; ++i) define(equations_.stage(i), row(i, where), where);
  for (int k = 0; k < 2 * n_; ++k) {
    if (gradient_[index(k)].is_zero()) continue;
    pending.solve.variables.push_back({gradient_[index(k)].name(), {}, {}, {}});
    pending.cold.push_back(lowering_.want(equations_.mechanics.gradient[index(k)], before(stage_)));
    pending.next.push_back(lowering_.want(equations_.stage_gradient(k), where));
  }
  // After the loop the gradient is a value of its own: what the loop made of the one before it
  // does not hold for it.
  for (Expression& component : gradient_) {
    if (component.is_zero()) continue;
    component = Expression::symbol(component.name() + "*", kRankOfTemporary);
    lowering_.declare(component.name(), after(stage_));
  }
  solves_.push_back(std::move(pending));
}

Solve StepBuilder::finished(PendingSolve& pending) const {
  Solve solve = std::move(pending.solve);
  solve.body = lowering_.statements(body(pending.stage));
  for (std::size_t j = 0; j < solve.variables.size(); ++j) {
    LoopVariable& variable = solve.variables[j];
    if (j < pending.cold.size()) variable.cold = lowering_.wanted(pending.cold[j]);
    if (j < pending.beside.size()) variable.beside = lowering_.wanted(pending.beside[j]);
    if (j < pending.next.size()) variable.next = lowering_.wanted(pending.next[j]);
    if (j < pending.correction.size()) {
      variable.correction = lowering_.wanted(pending.correction[j]);
    }
  }
  if (pending.refined_beside) solve.refined_beside = lowering_.wanted(*pending.refined_beside);
  for (const std::size_t handle : pending.gradient) {
    solve.gradient.push_back(lowering_.wanted(handle));
  }
  for (const std::size_t handle : pending.residual) {
    solve.residual.push_back(lowering_.wanted(handle));
  }
  for (const auto& line : pending.matrix) {
    auto& row = solve.matrix.emplace_back();
    for (const std::size_t handle : line) row.push_back(lowering_.wanted(handle));
  }
  return solve;
}

}  // namespace hamgen
