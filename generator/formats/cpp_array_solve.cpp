// How a member's step of a system in loops finds grad H(zbar).
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_arrays.hpp"

namespace hamgen {

namespace {

// What is small is summed first, the carry with it: Note [rounding without bias] in
// program/step_builder.hpp.
std::string from_state(const std::string& component, const std::string& change) {
  if (change.empty()) return "z_." + component;
  return fmt::format("z_.{0} + (carry_.{0}{1})", component, change);
}
// bar_ - row, as a statement's right side.
std::string lacking(const std::string& component, const std::string& change) {
  if (change.empty()) return fmt::format("bar_.{0} - z_.{0};", component);
  return fmt::format("(bar_.{0} - z_.{0}) - (carry_.{0}{1});", component, change);
}

// alpha = 0 has zbar = (q, P), alpha = 1 has zbar = (Q, p).
std::string explicit_step(bool a) {
  return a ? R"(  StepReport step() {
    potential_gradient(par_, z_.q, slope_.q);
    for (int i = 0; i < n; ++i) bar_[i] = z_.p[i] + (carry_.p[i] - h_ * slope_.q[i]);
    kinetic_gradient(par_, bar_, slope_.p);
    return update();
  }
)"
           : R"(  StepReport step() {
    kinetic_gradient(par_, z_.p, slope_.p);
    for (int i = 0; i < n; ++i) bar_[i] = z_.q[i] + (carry_.q[i] + h_ * slope_.p[i]);
    potential_gradient(par_, bar_, slope_.q);
    return update();
  }
)";
}

// The paper's Algorithm 1: Z by explicit Euler, then zbar and Z again and again.
std::string sweeps_step(const Mechanics& mechanics, const ArrayWeights& w, int sweeps) {
  return "  StepReport step() {\n" + gradient_at(mechanics, "z_", 4) +
         fmt::format(R"(    for (int sweep = 0; sweep < {}; ++sweep) {{
      for (int i = 0; i < n; ++i) {{
        bar_.q[i] = {};
        bar_.p[i] = {};
      }}
)",
                     sweeps, stage_q(w), stage_p(w)) +
         gradient_at(mechanics, "bar_", 6) +
         fmt::format(R"(    }}
    StepReport report = update();
    report.iterations = {};
    return report;
  }}
)",
                     sweeps);
}

std::string iterated_step(const ArrayPlan& plan) {
  const bool newton = plan.method == ArrayMethod::newton;
  const std::string forget = newton ? "      rule_ = {};\n" : "";
  const std::string ahead =
      plan.reduced ? "      history_.extrapolate(bar_.q);\n" : R"(      Real start[2 * n];
      history_.extrapolate(start);
      for (int i = 0; i < n; ++i) {
        bar_.q[i] = start[i];
        bar_.p[i] = start[n + i];
      }
)";
  const std::string unknowns = plan.reduced ? "bar_.q" : "solution";
  const std::string watch = newton ? fmt::format("      rule_.watch(history_, {}, 0, {});\n",
                                                 unknowns, plan.reduced ? "n" : "2 * n")
                                   : "";
  const std::string copy = plan.reduced ? "" : R"(      Real solution[2 * n];
      for (int i = 0; i < n; ++i) {
        solution[i] = bar_.q[i];
        solution[n + i] = bar_.p[i];
      }
)";
  const std::string record = "    if (updated.converged) {\n" + copy + watch +
                             fmt::format("      history_.record({});\n    }}\n", unknowns);
  return R"(  StepReport step() {
    StepReport report;
    const bool known = history_.known > 0;
    if (known) {
)" + ahead +
         R"(    } else {
      bar_ = z_;
    }
    bool solved = iterate(report);
    if (!solved && known) {
      // Extrapolation may lead astray, the state itself seldom does.
)" + forget +
         R"(      history_ = {};
      bar_ = z_;
      solved = iterate(report);
    }
    if (!solved) return report;
    StepReport updated = update();
    updated.iterations = report.iterations;
)" + record +
         R"(    return updated;
  }
)";
}

// The gradient at bar_.  Torn momenta follow from the coordinates:
//   pbar_i = (p_i - h (1 - alpha) V_i - h beta d_i) / (1 + h beta m_i).
std::string evaluate(const Mechanics& mechanics, const ArrayPlan& plan, const ArrayWeights& w) {
  if (!plan.reduced) {
    return "  // The gradient at bar_.\n  void evaluate() {\n" + gradient_at(mechanics, "bar_", 4) +
           "  }\n";
  }
  std::string momentum = from_state(
      "p[i]", weighted("-", w.p_by_q, "slope_.q[i]") + weighted("-", w.p_by_p, "drift_[i]"));
  if (!w.p_by_p.empty()) {
    momentum =
        fmt::format("({}) / (1 + {} * {})", momentum, w.p_by_p, plan.mass ? "mass_" : "mass_[i]");
  }
  return fmt::format(R"(  // The gradient at bar_, whose momenta are made from its coordinates.
  void evaluate() {{
    potential_gradient(par_, bar_.q, slope_.q);
    for (int i = 0; i < n; ++i) bar_.p[i] = {};
    kinetic_gradient(par_, bar_.p, slope_.p);
  }}
)",
                     momentum);
}

// matrix_ = the derivative of the residual, factorised.  With the momenta torn out that is I + D
// V'',
//   D_i = h (h alpha (1 - alpha) m_i / (1 + h beta m_i) - gamma).
std::string factorise(const ArrayPlan& plan, const ArrayWeights& w) {
  std::string text = "  // The derivative of the residual at bar_.  False if it is singular.\n";
  text += "  bool factorise() {\n";
  if (plan.constant_matrix) text += "    if (factorised_) return true;\n";
  text += R"(    matrix_.clear();
    for (int i = 0; i < Matrix::size; ++i) matrix_.put(i, i, 1);
)";
  if (plan.reduced) {
    text += "    hessian(par_, bar_.q, [&](int row, int column, Real value) {\n";
    text += fmt::format("      matrix_.put(row, column, {} * value);\n",
                        plan.mass ? "scale_" : "scale_[row]");
  } else {
    auto put = [](const std::string& sign, const char* row, const std::string& weight) {
      return weight.empty() ? ""
                            : fmt::format("        matrix_.put({}, column, {}{} * value);\n", row,
                                          sign, weight);
    };
    text += "    hessian(par_, bar_.q, bar_.p, [&](int row, int column, Real value) {\n";
    text += "      if (row < n) {\n" + put("-", "row", w.q_by_q) + put("", "n + row", w.p_by_q);
    text += "      } else {\n" + put("-", "row - n", w.q_by_p) + put("", "row", w.p_by_p);
    text += "      }\n";
  }
  text += "    });\n";
  text += plan.constant_matrix ? "    factorised_ = matrix_.factorise();\n    return factorised_;\n"
                               : "    return matrix_.factorise();\n";
  return text + "  }\n";
}

std::string residual(const ArrayPlan& plan, const ArrayWeights& w) {
  const std::string of_q = lacking(
      "q[i]", weighted("+", w.q_by_p, "slope_.p[i]") + weighted("+", w.q_by_q, "slope_.q[i]"));
  if (plan.reduced) {
    return "      for (int i = 0; i < n; ++i) {\n        residual_[i] = " + of_q + "\n      }\n";
  }
  return fmt::format(R"(      for (int i = 0; i < n; ++i) {{
        residual_[i] = {}
        residual_[n + i] = {}
      }}
)",
                     of_q,
                     lacking("p[i]", weighted("-", w.p_by_q, "slope_.q[i]") +
                                         weighted("-", w.p_by_p, "slope_.p[i]")));
}

// bar_ -= residual_, and the sizes that the stopping rule wants.
std::string subtract(const ArrayPlan& plan) {
  if (plan.method == ArrayMethod::fixed_point) {
    std::string text = R"(      Real scale = 0;
      for (int i = 0; i < n; ++i) {
        length_[i] = magnitude(bar_.q[i]) + magnitude(z_.q[i]);
        scale += length_[i];
        bar_.q[i] -= residual_[i];
)";
    if (!plan.reduced) {
      text += R"(        length_[n + i] = magnitude(bar_.p[i]) + magnitude(z_.p[i]);
        scale += length_[n + i];
        bar_.p[i] -= residual_[n + i];
)";
    }
    return text + "      }\n";
  }
  std::string text = R"(      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_.q[i]) + magnitude(z_.q[i]);
        bar_.q[i] -= residual_[i];
)";
  if (!plan.reduced) {
    text += R"(        size += magnitude(residual_[n + i]);
        scale += magnitude(bar_.p[i]) + magnitude(z_.p[i]);
        bar_.p[i] -= residual_[n + i];
)";
  }
  return text + "      }\n      report.increment = size;\n";
}

std::string refine(const ArrayPlan& plan, const ArrayWeights& w) {
  const std::string all = plan.reduced ? "n" : "2 * n";
  const std::string both = plan.reduced ? "" : R"(
        point[n + i] = bar_.p[i];)";
  const std::string back = plan.reduced ? "" : R"(
        bar_.p[i] = point[n + i];)";
  return fmt::format(
      R"(  // The unknowns are rounded to the side that the iteration came from, at every step alike.  What
  // the equations lack there is solved for too.
  void refine() {{
    Real point[{0}];
    Real slope[2 * n];
    for (bool more = true; more;) {{
      evaluate();
{1}      for (Real& lack : residual_) lack = -lack;
      for (int i = 0; i < n; ++i) {{
        point[i] = bar_.q[i];{2}
        slope[i] = slope_.q[i];
        slope[n + i] = slope_.p[i];
      }}
      more = refinement_(point, residual_, slope);
      for (int i = 0; i < n; ++i) {{
        bar_.q[i] = point[i];{3}
        slope_.q[i] = refinement_.slope[i];
        slope_.p[i] = refinement_.slope[n + i];
      }}
    }}
  }}

)",
      all, residual(plan, w), both, back);
}

std::string iteration(const Mechanics& mechanics, const ArrayPlan& plan, const ArrayWeights& w) {
  const bool newton = plan.method == ArrayMethod::newton;
  const std::string unknowns = plan.reduced ? "n" : "2 * n";
  const std::string what = newton ? "Newton's iteration" : "Fixed-point iteration";
  const std::string on =
      plan.reduced ? "the torn momenta follow from the coordinates" : "on all stage values";
  std::string text = fmt::format("  // {} from bar_{} {}.\n", what, plan.reduced ? ";" : ",", on) +
                     "  bool iterate(StepReport& report) {\n" +
                     (newton ? "    rule_.begin();\n"
                             : fmt::format("    FixedPointRule<{}, 2> rule;\n", unknowns)) +
                     R"(    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
)" + residual(plan, w);
  if (newton) text += "      if (!factorise()) return false;\n      matrix_.solve(residual_);\n";
  text += subtract(plan);
  text += newton ? "      const Verdict verdict = rule_(size, scale, iteration);\n"
                 : R"(      const Verdict verdict = rule(residual_, length_, scale, iteration);
      report.increment = rule.size;
)";
  text += R"(      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) return false;
)";
  text += newton ? "      evaluate();\n      return true;\n    }\n  }\n\n"
                 : "      refine();\n      return true;\n    }\n  }\n\n" + refine(plan, w);
  text += evaluate(mechanics, plan, w);
  if (plan.matrix) text += "\n" + factorise(plan, w);
  return text;
}

}  // namespace

std::string weighted(const char* sign, const std::string& weight, const std::string& value) {
  return weight.empty() ? "" : fmt::format(" {} {} * {}", sign, weight, value);
}

std::string gradient_at(const Mechanics& mechanics, const std::string& state, int indent) {
  const std::string lead(static_cast<std::size_t>(indent), ' ');
  if (!mechanics.is_separable()) {
    return fmt::format("{0}gradient(par_, {1}.q, {1}.p, slope_.q, slope_.p);\n", lead, state);
  }
  return fmt::format(
      "{0}potential_gradient(par_, {1}.q, slope_.q);\n"
      "{0}kinetic_gradient(par_, {1}.p, slope_.p);\n",
      lead, state);
}

std::string stage_q(const ArrayWeights& w) {
  return from_state(
      "q[i]", weighted("+", w.q_by_p, "slope_.p[i]") + weighted("+", w.q_by_q, "slope_.q[i]"));
}
std::string stage_p(const ArrayWeights& w) {
  return from_state(
      "p[i]", weighted("-", w.p_by_q, "slope_.q[i]") + weighted("-", w.p_by_p, "slope_.p[i]"));
}

ArrayWeights array_weights(const FamilyParameters& member) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  ArrayWeights weights;
  auto named = [&](const Expression& value, const std::string& name) -> std::string {
    if (value.is_zero()) return "";
    if (value.is_one()) return "h_";
    const std::string member_name = value == Expression(Rational(1, 2)) ? "half_h_" : name;
    const auto known =
        std::ranges::find(weights.members, member_name, &std::pair<std::string, Expression>::first);
    if (known == weights.members.end()) weights.members.emplace_back(member_name, h * value);
    return member_name;
  };
  weights.q_by_p = named(member.alpha, "h_alpha_");
  weights.p_by_q = named(Expression(1) - member.alpha, "h_rest_");
  weights.complementary = weights.q_by_p == "h_alpha_" && weights.p_by_q == "h_rest_";
  weights.p_by_p = named(member.beta, "h_beta_");
  weights.q_by_q = named(member.gamma, "h_gamma_");
  return weights;
}

std::string array_step(const Mechanics& mechanics, const SolvePlan& plan,
                       const ArrayWeights& weights) {
  const ArrayPlan& arrays = *plan.arrays;
  switch (arrays.method) {
    case ArrayMethod::explicit_a:
    case ArrayMethod::explicit_b:
      return explicit_step(arrays.method == ArrayMethod::explicit_a);
    case ArrayMethod::sweeps:
      return sweeps_step(mechanics, weights, *plan.sweeps);
    case ArrayMethod::newton:
    case ArrayMethod::fixed_point:
      return iterated_step(arrays);
    case ArrayMethod::gradient_only:
      break;
  }
  return "";
}

std::string array_iteration(const Mechanics& mechanics, const ArrayPlan& plan,
                            const ArrayWeights& weights) {
  return iterates(plan) ? iteration(mechanics, plan, weights) : "";
}

}  // namespace hamgen
