#include "generator/verify/expected_step.hpp"

#include <ginac/ginac.h>

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/verify/expected_builder.hpp"

namespace hamgen {

Derivatives::Derivatives(const Mechanics& mechanics) {
  SymbolTable table;
  std::vector<GiNaC::ex> variables;
  for (std::size_t i = 0; i < mechanics.variables.size(); ++i) {
    variables.push_back(
        table.symbol(mechanics.variables[i].name, kRankOfVariable + static_cast<int>(i)));
  }
  const GiNaC::ex energy = to_ginac(mechanics.energy, table);
  const int size = static_cast<int>(variables.size());
  for (int i = 0; i < size; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const GiNaC::ex slope = energy.diff(GiNaC::ex_to<GiNaC::symbol>(variables[row]));
    gradient_.push_back(is_zero_by_algebra(from_ginac(slope, table)) ? Expression(0)
                                                                     : from_ginac(slope, table));
    const std::set<std::string> present = symbols(gradient_.back());
    for (int j = i; j < size; ++j) {
      const auto column = static_cast<std::size_t>(j);
      if (!present.contains(mechanics.variables[column].name)) continue;
      const Expression entry =
          from_ginac(slope.diff(GiNaC::ex_to<GiNaC::symbol>(variables[column])), table);
      if (!is_zero_by_algebra(entry)) hessian_.emplace(std::pair(i, j), entry);
    }
  }
}

Derivatives::Derivatives(const GeneratingFunction& function)
    : gradient_(function.gradient), hessian_(function.hessian) {}

Expression Derivatives::second(int i, int j) const {
  const auto it = hessian_.find(std::minmax(i, j));
  return it == hessian_.end() ? Expression(0) : it->second;
}

ExpectedStep::ExpectedStep(const Mechanics& mechanics, const Derivatives& derivatives,
                           const Member& member, const Program& program)
    : mechanics_(mechanics),
      n_(mechanics.degrees_of_freedom),
      derivatives_(derivatives),
      program_(program) {
  add(program.coefficients);
  for (const Stage& stage : program.stages) {
    add(stage.before);
    if (stage.solve) {
      add(stage.solve->body);
      solves_.push_back(&*stage.solve);
    }
    add(stage.after);
  }
  for (int i = 0; i < 2 * n_; ++i) bar_.push_back(free("bar", i));
  gradient_.resize(at(2 * n_));
  set_weights(member);
}

Identities ExpectedStep::run() {
  if (program_.plan.sweeps) {
    sweep();
  } else {
    for (const Block& block : program_.plan.blocks) solve(block);
    if (next_solve_ != solves_.size()) internal_error("a solve that no block asks for");
  }
  for (int i = 0; i < 2 * n_; ++i) {
    const Expression slope = gradient(i < n_ ? i + n_ : i - n_);
    const Expression h = i < n_ ? h_ : -h_;
    const auto change = change_.find(i < n_ ? i + n_ : i - n_);
    Expression expected = carry(i) + h * slope;
    if (change != change_.end()) {
      expected = h * change->second.first +
                 define("rest(d" + name(i) + ")", carry(i) + h * change->second.second);
    }
    const Expression rest = program_.rests.empty() ? Expression(0) : program_.rests[at(i)];
    claim("the increment of " + name(i), program_.increments[at(i)] + rest, expected);
  }
  return std::move(identities_);
}

Expression ExpectedStep::free(const std::string& what, int i) const {
  return Expression::symbol(what + "(" + name(i) + ")", kRankOfVariable + i);
}

namespace {

// What is free of it is the mathematics.
bool has_product_error(const Expression& e) {
  return (e.kind() == Kind::function && e.name() == kProductError) ||
         std::ranges::any_of(e.operands(), has_product_error);
}

}  // namespace

void ExpectedStep::add(const std::vector<Statement>& statements) {
  // What a product loses is a number of its own, and its rounded value, which stands before it, the
  // product less that.
  std::map<std::string, Expression> lost;
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const Expression& error = statements[i].value;
    if (error.kind() != Kind::function || error.name() != kProductError) continue;
    const Expression product = error.operands()[0] * error.operands()[1];
    for (std::size_t j = i; j-- > 0;) {
      if (statements[j].value != product) continue;
      lost.emplace(statements[j].name, Expression::symbol(statements[i].name));
      break;
    }
  }
  for (const Statement& s : statements) {
    if (has_product_error(s.value)) continue;
    const auto it = lost.find(s.name);
    identities_.emitted.push_back({s.name, it == lost.end() ? s.value : s.value - it->second});
  }
}
void ExpectedStep::claim(std::string what, const Expression& emitted, const Expression& expected) {
  identities_.claims.push_back({std::move(what), emitted, expected});
}
Expression ExpectedStep::define(const std::string& what, const Expression& value) {
  if (value.is_number()) return value;
  std::string unique = "=" + what;
  while (!names_.insert(unique).second) unique += "*";
  identities_.expected.push_back({unique, value});
  return Expression::symbol(unique);
}

// h (I/2 + C) J: row i of zbar = z + h (I/2 + C) J grad H(zbar).
void ExpectedStep::set_weights(const Member& member) {
  for (int i = 0; i < 2 * n_; ++i) {
    for (int j = 0; j < 2 * n_; ++j) {
      const auto it = member.c.find({i, j});
      Expression entry = it == member.c.end() ? Expression(0) : it->second;
      if (i == j) entry += Expression(Rational(1, 2));
      if (entry.is_zero()) continue;
      // (J g)_j = g_{j+n} for a coordinate, -g_{j-n} for a momentum.
      const int k = j < n_ ? j + n_ : j - n_;
      if (derivatives_.first(k).is_zero()) continue;
      weights_[i].emplace_back(k, h_ * (j < n_ ? entry : -entry));
    }
  }
}

Expression ExpectedStep::at_stage(const Expression& e) const {
  Substitution stage;
  for (int i = 0; i < 2 * n_; ++i) stage.emplace(name(i), bar_[at(i)]);
  return substitute(e, stage);
}

Expression ExpectedStep::gradient(int k) {
  if (!gradient_[at(k)]) {
    gradient_[at(k)] = define("H(" + name(k) + ")", at_stage(derivatives_.first(k)));
  }
  return *gradient_[at(k)];
}

Expression ExpectedStep::carry(int i) const {
  const bool changes = !derivatives_.first(i < n_ ? i + n_ : i - n_).is_zero();
  return changes ? free("carry", i) : Expression(0);
}

Expression ExpectedStep::row(int i) {
  Expression sum = mechanics_.variable(i) + carry(i);
  for (const auto& [k, weight] : weights_[i]) sum += weight * gradient(k);
  return sum;
}

void ExpectedStep::solve(const Block& block) {
  switch (block.kind) {
    case BlockKind::assign: {
      const int i = block.unknowns[0];
      bar_[at(i)] = define("bar(" + name(i) + ")", row(i));
      return;
    }
    case BlockKind::quadratic:
      quadratic(block.unknowns[0]);
      return;
    case BlockKind::linear:
    case BlockKind::newton:
      if (block.kind == BlockKind::linear && block.unknowns.size() <= 3) {
        affine(block);
      } else {
        block.simplified ? simplified_newton(block) : newton(block);
      }
      return;
    case BlockKind::fixed_point:
      fixed_point(block);
      return;
  }
}

// F(x) = x - z_i - sum w_k H_k(x) is of degree two: F(z_i + d) = c0 + c1 d + c2 d^2.
void ExpectedStep::quadratic(int i) {
  const Expression x = Expression::symbol("x");
  auto with = [&](const Expression& e, const Expression& value) {
    bar_[at(i)] = value;
    return at_stage(e);
  };
  const Expression z = mechanics_.variable(i);
  Expression c0 = -carry(i);
  Expression c1(1);
  Expression c2(0);
  for (const auto& [k, weight] : weights_[i]) {
    const Expression slope = derivatives_.second(k, i);
    c0 += -(weight * with(derivatives_.first(k), z));
    c1 += -(weight * with(slope, z));
    c2 += -(weight * (with(slope, z + Expression(1)) - with(slope, z)) / Expression(2));
  }
  const Expression named0 = define("c0(" + name(i) + ")", c0);
  const Expression named1 = define("c1(" + name(i) + ")", c1);
  const Expression named2 = define("c2(" + name(i) + ")", c2);
  const Expression d = Expression(-2) * named0 /
                       (named1 + square_root(named1 * named1 - Expression(4) * named0 * named2));
  bar_[at(i)] = define("bar(" + name(i) + ")", z + d);
  claim("the root of the equation for " + name(i), named1 * d + named2 * d * d, -named0);
}

const Solve& ExpectedStep::next_solve(BlockKind kind) {
  if (next_solve_ == solves_.size() || solves_[next_solve_]->kind != kind) {
    internal_error("a block without its solve");
  }
  return *solves_[next_solve_++];
}

void ExpectedStep::fixed_point(const Block& block) {
  const Solve& solve = next_solve(BlockKind::fixed_point);
  for (const int x : block.unknowns) bar_[at(x)] = free("bar", x);
  for (const int t : block.torn) bar_[at(t)] = define("bar(" + name(t) + ")", row(t));
  for (std::size_t j = 0; j < block.unknowns.size(); ++j) {
    const int x = block.unknowns[j];
    claim("the start of " + name(x), solve.variables.at(j).cold, mechanics_.variable(x));
    claim("the next value of " + name(x), solve.variables.at(j).next, row(x));
  }
  // What the rounded solution lacks of the exact one is free, as loop variables are.
  for (int k = 0; k < 2 * n_; ++k) {
    const Expression change = Expression::symbol("change(H(" + name(k) + "))", kRankOfTemporary);
    const auto place = std::ranges::find(solve.changes, change.name());
    if (place == solve.changes.end()) continue;
    claim("dH/d" + name(k) + " at the fixed point",
          solve.gradient.at(static_cast<std::size_t>(place - solve.changes.begin())), gradient(k));
    change_[k] = {gradient(k), change};
  }
}

// In terms of the gradient g: first grad H(z), then K times grad H(zbar(g)).
void ExpectedStep::sweep() {
  const Solve& solve = *solves_.at(0);
  std::vector<int> components;
  for (int k = 0; k < 2 * n_; ++k) {
    gradient_[at(k)] = Expression(0);
    if (derivatives_.first(k).is_zero()) continue;
    components.push_back(k);
    gradient_[at(k)] = free("H", k);
  }
  for (int i = 0; i < 2 * n_; ++i) bar_[at(i)] = define("bar(" + name(i) + ")", row(i));
  for (std::size_t j = 0; j < components.size(); ++j) {
    const int k = components[j];
    const LoopVariable& variable = solve.variables.at(j);
    claim("the predictor of dH/d" + name(k), variable.cold, derivatives_.first(k));
    claim("the next dH/d" + name(k), variable.next, at_stage(derivatives_.first(k)));
    gradient_[at(k)] = Expression::symbol("H(" + name(k) + ")*");
  }
  claim("the number of sweeps", Expression(solve.sweeps.value_or(-1)),
        Expression(*program_.plan.sweeps));
}

Identities step_identities(const Mechanics& mechanics, const Derivatives& derivatives,
                           const Member& member, const Program& program) {
  return ExpectedStep(mechanics, derivatives, member, program).run();
}

}  // namespace hamgen
