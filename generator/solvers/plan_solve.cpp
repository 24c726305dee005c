#include <fmt/format.h>

#include <algorithm>

#include "generator/solvers/ahead.hpp"
#include "generator/solvers/blocks.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

std::string name_of(const StepEquations& equations, int i) {
  return equations.mechanics.variables.name(static_cast<std::size_t>(i));
}

// "q, x[1..8], p[2]": runs of array elements in short.
std::string names_of(const StepEquations& equations, std::vector<int> variables) {
  std::ranges::sort(variables);
  std::string text;
  for (std::size_t k = 0; k < variables.size();) {
    const std::string& first = name_of(equations, variables[k]);
    const std::size_t bracket = first.find('[');
    std::size_t end = k + 1;
    if (bracket != std::string::npos) {
      const std::string base = first.substr(0, bracket + 1);
      while (end < variables.size() && variables[end] == variables[end - 1] + 1 &&
             name_of(equations, variables[end]).starts_with(base)) {
        ++end;
      }
    }
    text += text.empty() ? "" : ", ";
    if (end - k > 1) {
      const std::string& last = name_of(equations, variables[end - 1]);
      text += first.substr(0, first.size() - 1) + ".." + last.substr(bracket + 1);
    } else {
      text += first;
    }
    k = end;
  }
  return text;
}

// Stage values some component of the gradient needs; the others are never computed.
std::vector<int> needed_stages(const StepEquations& equations) {
  std::vector<bool> needed(equations.mechanics.variables.size(), false);
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < needed.size(); ++i) place[equations.mechanics.variables.name(i)] = i;
  std::set<std::string> names;
  for (const Expression& component : equations.mechanics.gradient) {
    collect_symbols(component, names);
  }
  for (const std::string& name : names) {
    if (const auto it = place.find(name); it != place.end()) needed[it->second] = true;
  }
  std::vector<int> result;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (needed[i]) result.push_back(static_cast<int>(i));
  }
  return result;
}

// Are dH/dz_k polynomials in these variables, and d2H/dz_k dz_j free of them, k in the rows of all
// i and j any of these?
bool are_free_of(const StepEquations& equations, const std::vector<int>& block,
                 const std::vector<int>& variables) {
  std::set<std::string> names;
  for (const int v : variables) names.insert(name_of(equations, v));
  const auto is_one = [&](const std::string& name) { return names.contains(name); };
  std::set<int> gradients;
  for (const int i : block) {
    for (const int k : equations.row_gradients(i)) gradients.insert(k);
  }
  return std::ranges::all_of(gradients, [&](int k) {
    if (std::ranges::any_of(equations.non_polynomial[static_cast<std::size_t>(k)], is_one))
      return false;
    return std::ranges::all_of(block, [&](int j) {
      const Expression entry = equations.mechanics.second_derivative(k, j);
      return entry.is_zero() || std::ranges::none_of(symbols(entry), is_one);
    });
  });
}

// Is row i affine in zbar_j, alone?
bool is_affine_in(const StepEquations& equations, int i, int j) {
  return std::ranges::all_of(equations.row_gradients(i), [&](int k) {
    return equations.is_polynomial(k, j) &&
           !symbols(equations.mechanics.second_derivative(k, j)).contains(name_of(equations, j));
  });
}

// Are the block's rows affine in all the block's stage values?
bool is_affine(const StepEquations& equations, const std::vector<int>& block) {
  return are_free_of(equations, block, block);
}

bool has_constant_matrix(const StepEquations& equations, const std::vector<int>& block) {
  std::vector<int> all;
  for (int i = 0; i < 2 * equations.mechanics.degrees_of_freedom; ++i) all.push_back(i);
  return are_free_of(equations, block, all);
}

// One unknown, its row a polynomial of degree two in it: the third derivative vanishes, that is the
// second derivative of the gradient is free of the unknown.
bool is_quadratic(const StepEquations& equations, int i) {
  for (const int k : equations.row_gradients(i)) {
    if (!equations.is_polynomial(k, i)) return false;
    const Expression slope = equations.mechanics.second_derivative(k, i);
    const std::string& name = name_of(equations, i);
    // slope = a + b x: evaluated at three points, the second difference vanishes identically.
    auto at = [&](long x) { return substitute(slope, {{name, Expression(x)}}); };
    const Expression line = at(0) + (at(1) - at(0)) * equations.mechanics.variable(i);
    if (!(slope - line).is_zero()) return false;
  }
  return true;
}

// The Hessian is that of a shorter K: rows that it takes for explicit are eliminated from the
// linear system while that is written out.
Block plan_simplified_newton(const StepEquations& equations, const std::vector<int>& component) {
  const Dependency couples = [&](int i, int j) { return equations.hessian_couples(i, j); };
  const int n = equations.mechanics.degrees_of_freedom;
  std::vector<int> momenta_first = component;
  std::ranges::stable_sort(momenta_first, {}, [&](int i) { return i < n; });
  std::vector<int> torn = tear(momenta_first, couples, [](int) { return false; });
  if (torn.size() == component.size()) torn.pop_back();
  Block block{.kind = BlockKind::newton, .torn = torn, .simplified = true};
  for (const int i : component) {
    if (std::ranges::find(torn, i) == torn.end()) block.unknowns.push_back(i);
  }
  if (linear_solver(block) != LinearSolver::written_out) {
    block.unknowns = component;
    block.torn.clear();
  }
  return block;
}

Block plan_block(const StepEquations& equations, const std::vector<int>& component,
                 bool fixed_point) {
  const Dependency depends =
      tabulated(component, [&](int i, int j) { return equations.depends(i, j); });
  if (component.size() == 1 && !depends(component[0], component[0])) {
    return {.kind = BlockKind::assign, .unknowns = component};
  }
  // The Hessian of a shorter K says nothing of where the equations are linear.
  const bool exact = equations.has_exact_hessian();
  if (!fixed_point && !exact) return plan_simplified_newton(equations, component);
  // Tearing saves a fixed-point iteration little, and takes long to plan for a large block.
  constexpr std::size_t kLargeBlock = 64;
  if (fixed_point && component.size() > kLargeBlock) {
    return {.kind = BlockKind::fixed_point, .unknowns = component};
  }
  const int n = equations.mechanics.degrees_of_freedom;
  auto may_self = [&](int i) { return !fixed_point && is_affine_in(equations, i, i); };
  // Momenta first: with quadratic kinetic energy they are the cheap ones to eliminate.
  std::vector<int> momenta_first = component;
  std::ranges::stable_sort(momenta_first, {}, [&](int i) { return i < n; });
  std::vector<int> torn = tear(momenta_first, depends, may_self);
  if (const std::vector<int> other = tear(component, depends, may_self);
      other.size() > torn.size()) {
    torn = other;
  }
  // An affine block keeps one unknown at least.
  if (torn.size() == component.size()) torn.erase(std::ranges::find(torn, component[0]));
  Block block{.kind = BlockKind::newton, .torn = torn};
  for (const int i : component) {
    if (std::ranges::find(torn, i) == torn.end()) block.unknowns.push_back(i);
  }
  block.constant_matrix = exact && has_constant_matrix(equations, component);
  if (exact && is_affine(equations, component)) {
    block.kind = BlockKind::linear;
    // Written out, an oscillator's 2 x 2 system costs what its torn one does, and keeps what the
    // torn momentum p - h/2 omega^2 qbar loses by cancellation: h omega units of rounding.
    constexpr std::size_t kWrittenOut = 3;
    if (component.size() <= kWrittenOut) {
      block.unknowns = component;
      block.torn.clear();
    }
  } else if (fixed_point) {
    block.kind = BlockKind::fixed_point;
  } else if (component.size() == 1 && is_quadratic(equations, component[0])) {
    block.kind = BlockKind::quadratic;
  }
  return block;
}

std::string describe(const StepEquations& equations, const Block& block) {
  const std::size_t size = block.unknowns.size();
  const std::string which = names_of(equations, block.unknowns);
  std::string text;
  switch (block.kind) {
    case BlockKind::assign:
      return "assign " + which;
    case BlockKind::linear:
      text = fmt::format("linear solve of size {} for {}{}", size, which,
                         block.constant_matrix ? ", constant matrix hoisted" : "");
      break;
    case BlockKind::quadratic:
      return "quadratic equation for " + which + ", root in closed form";
    case BlockKind::newton:
      text = fmt::format("{} of size {} on {}", block.simplified ? "simplified Newton" : "Newton",
                         size, which);
      break;
    case BlockKind::fixed_point:
      text = fmt::format("fixed point of size {} on {}", size, which);
      break;
  }
  if (!block.torn.empty()) text += "; " + names_of(equations, block.torn) + " torn out";
  return text;
}

std::vector<std::string> what_was_left_out(const SolvePlan& plan) {
  const StepEquations& equations = plan.equations;
  const Mechanics& mechanics = equations.mechanics;
  const int n = mechanics.degrees_of_freedom;
  std::vector<std::string> list;
  const Member& member = equations.scheme.member();
  if (!has_beta(member)) list.emplace_back("beta terms: beta = 0");
  if (!has_gamma(member)) list.emplace_back("gamma terms: gamma = 0");
  const std::vector<int> needed = needed_stages(equations);
  std::vector<int> cyclic;
  for (int i = 0; i < 2 * n; ++i) {
    if (!std::ranges::binary_search(needed, i)) cyclic.push_back(i);
  }
  if (!cyclic.empty()) {
    list.push_back("stage values of " + names_of(equations, cyclic) +
                   ": H does not depend on them");
  }
  std::vector<int> kept;
  for (int i = 0; i < 2 * n; ++i) {
    if (equations.increment(i).is_zero()) kept.push_back(i);
  }
  if (!kept.empty()) list.push_back("updates of " + names_of(equations, kept) + ": constant");
  std::set<std::string> used;
  for (const Expression& component : mechanics.gradient) collect_symbols(component, used);
  for (const auto& [place, value] : equations.stage_matrix) collect_symbols(value, used);
  std::string unused;
  for (const Quantity& parameter : mechanics.parameters) {
    if (!used.contains(parameter.name)) unused += (unused.empty() ? "" : ", ") + parameter.name;
  }
  if (!unused.empty()) list.push_back("parameters " + unused + ": the step does not use them");
  if (plan.is_explicit()) list.emplace_back("equation solver: the step is explicit");
  if (!plan.sweeps) {
    std::size_t torn = 0;
    for (const Block& block : plan.blocks) torn += block.torn.size();
    if (torn != 0) list.push_back(fmt::format("{} of the unknowns: torn out", torn));
  }
  return list;
}

std::string solver_line(const SolvePlan& plan) {
  if (plan.sweeps) {
    return fmt::format("{} fixed-point sweep{} (Algorithm 1 of the paper): not symplectic",
                       *plan.sweeps, *plan.sweeps == 1 ? "" : "s");
  }
  std::vector<std::string> parts;
  for (const Block& block : plan.blocks) {
    if (block.kind != BlockKind::assign) parts.push_back(describe(plan.equations, block));
  }
  if (parts.empty()) return "explicit";
  if (parts.size() > 3) {
    return fmt::format("{} independent or successive blocks, the first: {}", parts.size(),
                       parts[0]);
  }
  std::string text = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) text += ", then " + parts[i];
  return text;
}

}  // namespace

bool SolvePlan::is_explicit() const {
  return !sweeps &&
         std::ranges::all_of(blocks, [](const Block& b) { return b.kind == BlockKind::assign; });
}

LinearSolver linear_solver(const Block& block) {
  if (block.unknowns.size() <= 3) return LinearSolver::written_out;
  return block.unknowns.size() <= 24 ? LinearSolver::elimination : LinearSolver::eigen_dense;
}

namespace {

SolvePlan plan_member(const StepEquations& equations, const SolverWish& wish, NumbersOf numbers) {
  if (equations.mechanics.keeps_sums()) return plan_arrays(equations, wish, numbers);
  SolvePlan plan{.equations = equations};
  if (wish.kind == SolverWish::Kind::sweeps) plan.sweeps = wish.sweeps;
  const std::vector<int> needed = needed_stages(equations);
  const Dependency depends = [&](int i, int j) { return equations.depends(i, j); };
  // Sweeps take all stage values together: no blocks.
  const auto components = plan.sweeps ? std::vector<std::vector<int>>{}
                                      : strongly_connected_components(needed, depends);
  for (const auto& component : components) {
    plan.blocks.push_back(
        plan_block(equations, component, wish.kind == SolverWish::Kind::fixed_point));
  }
  plan.solver = solver_line(plan);
  plan.left_out = what_was_left_out(plan);
  return plan;
}

}  // namespace

SolvePlan plan_solve(const StepEquations& equations, const SolverChoice& solver,
                     NumbersOf numbers) {
  const bool is_member = equations.scheme.has_member();
  SolvePlan plan =
      is_member ? plan_member(equations, *solver, numbers) : plan_without_member(equations, solver);
  plan.rule = solver->rule;
  plan.ahead = waits_for_functions(plan);
  if (const auto* composition = std::get_if<Composition>(&equations.scheme.method)) {
    plan.solver = fmt::format("{} substeps, each: {}", composition->substeps.size(), plan.solver);
  }
  return plan;
}

std::string to_text(const SolvePlan& plan) {
  std::string text = "solver: " + plan.solver + "\n";
  if (plan.arrays) {
    text += "sums stay loops\n";
  } else if (!plan.equations.scheme.has_member()) {
    text += "no blocks: " + plan.equations.scheme.description + "\n";
  } else if (plan.sweeps) {
    text += "predict Z by explicit Euler; sweep all stage values together\n";
  } else {
    for (const Block& block : plan.blocks) {
      const std::string line = describe(plan.equations, block);
      const bool is_said = plan.blocks.size() == 1 && plan.solver.ends_with(line);
      if (!is_said) text += line + "\n";
    }
  }
  if (plan.ahead) text += std::string(kAhead) + "\n";
  if (plan.equations.function) text += to_text(*plan.equations.function);
  text += "left out:\n";
  for (const std::string& item : plan.left_out) text += "  " + item + "\n";
  return text;
}

}  // namespace hamgen
