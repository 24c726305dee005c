#include <fmt/format.h>

#include <algorithm>

#include "generator/equations/step_equations.hpp"

namespace hamgen {

namespace {

std::string name_of(const StepEquations& equations, int i) {
  return equations.mechanics.variables.name(static_cast<std::size_t>(i));
}

Substitution state_to_stage(const StepEquations& equations) {
  Substitution replacements;
  for (int i = 0; i < 2 * equations.mechanics.degrees_of_freedom; ++i) {
    replacements.emplace(name_of(equations, i), equations.stage(i));
  }
  return replacements;
}

// For people: the derivatives of H by name.
std::string shown(const StepEquations& equations, const Expression& e) {
  Substitution names;
  for (int i = 0; i < 2 * equations.mechanics.degrees_of_freedom; ++i) {
    const Expression slope = equations.gradient_symbol(i);
    if (!slope.is_zero())
      names.emplace(slope.name(), Expression::symbol((equations.function ? "dK/d" : "dH/d") +
                                                         name_of(equations, i),
                                                     kRankOfTemporary + i));
  }
  return to_text(substitute(e, names));
}

// Exact where that is short, else to 20 digits.
std::string coefficient_text(const Expression& e) {
  const std::string exact = to_text(e);
  if (exact.size() <= 24) return exact;
  const Rational value = numeric_value(e);
  Integer digits;
  Integer scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, 20);
  const Rational scaled = abs(value) * scale;
  mpz_fdiv_q(digits.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const Integer whole = digits / scale;
  const Integer fraction = digits % scale;
  return fmt::format("{}{}.{:0>20}...", value < 0 ? "-" : "", whole.get_str(), fraction.get_str());
}

std::string list_text(const std::vector<Expression>& values) {
  std::string text;
  for (const Expression& e : values) text += (text.empty() ? "" : ", ") + coefficient_text(e);
  return text;
}

std::string splitting_text(const Splitting& splitting) {
  const std::string kicks = "kicks p -= b h dV/dq with b = " + list_text(splitting.kicks) + "\n";
  const std::string drifts = "drifts q += a h dT/dp with a = " + list_text(splitting.drifts) + "\n";
  return "in turn:\n" + (splitting.kick_first ? kicks + drifts : drifts + kicks);
}

std::string tableau_text(const RungeKutta& tableau) {
  std::string text = "Z = z + h sum b_i f(Z_i), Z_i = z + h sum a_ij f(Z_j), f = J grad H\n";
  for (std::size_t i = 0; i < tableau.b.size(); ++i) {
    text += fmt::format("a_{}: {}\n", i + 1, list_text(tableau.a[i]));
  }
  return text + "b: " + list_text(tableau.b) + "\nc: " + list_text(tableau.c) + "\n";
}

// The degrees of freedom of a system in loops all have the same C: that of one of them.
SparseMatrix gauge_of_series(const Mechanics& mechanics, const Member& member) {
  if (!mechanics.keeps_sums()) return member.c;
  const auto [alpha, beta, gamma] = uniform_parameters(member).value();
  return family_member(1, {{alpha}}, {{beta}}, {{gamma}}).member().c;
}

}  // namespace

Expression step_size() { return Expression::symbol("h", kRankOfStep); }

Expression StepEquations::stage(int i) const {
  return Expression::symbol("bar(" + name_of(*this, i) + ")", kRankOfVariable + i);
}

Expression StepEquations::gradient_symbol(int i) const {
  if (mechanics.gradient[static_cast<std::size_t>(i)].is_zero()) return {};
  return Expression::symbol((function ? "K(" : "H(") + name_of(*this, i) + ")",
                            kRankOfTemporary + i);
}

Expression StepEquations::hessian_symbol(int i, int j) const {
  if (!mechanics.hessian.contains(std::minmax(i, j))) return {};
  const int n = 2 * mechanics.degrees_of_freedom;
  const auto [a, b] = std::minmax(i, j);
  return Expression::symbol("H(" + name_of(*this, a) + "," + name_of(*this, b) + ")",
                            kRankOfTemporary + n * (a + 1) + b);
}

Expression StepEquations::stage_gradient(int i) const {
  return substitute(mechanics.gradient[static_cast<std::size_t>(i)], state_to_stage(*this));
}

Expression StepEquations::stage_hessian(int i, int j) const {
  return substitute(mechanics.second_derivative(i, j), state_to_stage(*this));
}

Expression StepEquations::row(int i) const {
  std::vector<Expression> terms{mechanics.variable(i)};
  for (const int k : row_gradients(i)) {
    terms.push_back(step_size() * stage_matrix.at({i, k}) * gradient_symbol(k));
  }
  return Expression::sum(std::move(terms));
}

std::vector<int> StepEquations::row_gradients(int i) const {
  std::vector<int> result;
  for (auto it = stage_matrix.lower_bound({i, 0}); it != stage_matrix.end() && it->first.first == i;
       ++it) {
    if (!gradient_symbol(it->first.second).is_zero()) result.push_back(it->first.second);
  }
  return result;
}

bool StepEquations::hessian_couples(int i, int j) const {
  for (const int k : row_gradients(i)) {
    if (mechanics.hessian.contains(std::minmax(k, j))) return true;
  }
  return false;
}

bool StepEquations::is_polynomial(int k, int j) const {
  return !non_polynomial[static_cast<std::size_t>(k)].contains(name_of(*this, j));
}

bool StepEquations::depends(int i, int j) const {
  if (has_exact_hessian()) {
    return hessian_couples(i, j) ||
           std::ranges::any_of(row_gradients(i), [&](int k) { return !is_polynomial(k, j); });
  }
  return std::ranges::any_of(row_gradients(i), [&](int k) {
    return depends_on(mechanics.gradient[static_cast<std::size_t>(k)], name_of(*this, j));
  });
}

bool StepEquations::has_exact_hessian() const {
  return !function || function->hessian_order == function->order;
}

Mechanics StepEquations::of_energy() const {
  Mechanics result = mechanics;
  if (function) result.kernels = energy_kernels;
  return result;
}

Expression StepEquations::increment(int i) const {
  const int n = mechanics.degrees_of_freedom;
  return i < n ? step_size() * gradient_symbol(i + n) : -(step_size() * gradient_symbol(i - n));
}

bool uses_energy_parameter(const StepEquations& equations) {
  return std::ranges::any_of(equations.stage_matrix,
                             [](const auto& entry) { return depends_on(entry.second, "E0"); });
}

StepEquations discretise(const Mechanics& mechanics, const Scheme& scheme, HessianWish wish) {
  StepEquations equations{.mechanics = mechanics, .scheme = scheme, .stage_matrix = {}};
  if (scheme.has_member()) equations.stage_matrix = stage_matrix(scheme.member());
  if (scheme.is_member() && scheme.member().generating_order > 0) {
    equations.function = generating_function(mechanics, gauge_of_series(mechanics, scheme.member()),
                                             scheme.member().generating_order, wish);
    equations.energy_gradient = mechanics.gradient;
    equations.energy_kernels = mechanics.kernels;
    equations.mechanics.gradient = equations.function->gradient;
    equations.mechanics.hessian = equations.function->hessian;
    equations.mechanics.kernels = equations.function->kernels;
  }
  std::erase_if(equations.stage_matrix, [](const auto& entry) { return entry.second.is_zero(); });
  for (const Expression& component : equations.mechanics.gradient) {
    equations.non_polynomial.push_back(non_polynomial_symbols(component));
  }
  return equations;
}

std::string to_text(const StepEquations& equations) {
  std::string text = fmt::format("scheme {}: {}, order {}{}\n", equations.scheme.name,
                                 equations.scheme.description, equations.scheme.order,
                                 equations.scheme.symmetric ? ", symmetric" : "");
  const int n = equations.mechanics.degrees_of_freedom;
  if (const auto* splitting = std::get_if<Splitting>(&equations.scheme.method)) {
    return text + splitting_text(*splitting);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&equations.scheme.method)) {
    return text + tableau_text(*tableau);
  }
  if (const auto* composition = std::get_if<Composition>(&equations.scheme.method)) {
    text += "for h = " + list_text(composition->substeps) + " times the step size, in turn:\n";
  }
  if (equations.mechanics.keeps_sums()) {
    const std::string of_k = equations.function ? to_text(*equations.function) : "";
    return text +
           fmt::format(
               "for every degree of freedom i = 1..{0}:\n"
               "  bar(q_i) = q_i + h*alpha*d{1}/dp_i + h*gamma*d{1}/dq_i\n"
               "  bar(p_i) = p_i - h*(1 - alpha)*d{1}/dq_i - h*beta*d{1}/dp_i\n"
               "  new q_i = q_i + h*d{1}/dp_i, new p_i = p_i - h*d{1}/dq_i\n",
               n, equations.function ? "K" : "H") +
           of_k;
  }
  for (int i = 0; i < 2 * n; ++i) {
    text +=
        fmt::format("{} = {}\n", to_text(equations.stage(i)), shown(equations, equations.row(i)));
  }
  if (equations.function) text += to_text(*equations.function);
  // Written out, a graph with shared subexpressions may be far longer than its operations.
  constexpr long kReadable = 500;
  const bool readable = !equations.function || equations.function->operations < kReadable;
  for (int i = 0; readable && i < 2 * n; ++i) {
    const Expression symbol = equations.gradient_symbol(i);
    if (symbol.is_zero()) continue;
    text +=
        fmt::format("{} = {}\n", shown(equations, symbol), to_text(equations.stage_gradient(i)));
  }
  for (int i = 0; i < 2 * n; ++i) {
    const std::string& name = name_of(equations, i);
    const Expression now = Expression::symbol(name, kRankOfVariable + i);
    text += fmt::format("new {} = {}\n", name, shown(equations, now + equations.increment(i)));
  }
  return text;
}

}  // namespace hamgen
