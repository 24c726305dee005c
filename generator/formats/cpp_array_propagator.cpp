// Many steps of a member of a system in loops.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"

namespace hamgen {

namespace {

std::string explicit_step(bool a) {
  // alpha = 0 has bar = (q, P), alpha = 1 has bar = (Q, p).
  if (a) {
    return R"(  StepReport step() {
    for (int i = 0; i < n; ++i) bar_[i] = z_.q[i];
    clear(gradient_);
    potential_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) bar_[n + i] = z_.p[i] - h_ * gradient_[i];
    kinetic_gradient(par_, bar_, gradient_);
    return update();
  }
)";
  }
  return R"(  StepReport step() {
    for (int i = 0; i < n; ++i) bar_[n + i] = z_.p[i];
    clear(gradient_);
    kinetic_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) bar_[i] = z_.q[i] + h_ * gradient_[n + i];
    potential_gradient(par_, bar_, gradient_);
    return update();
  }
)";
}

// Newton on qbar alone.  The kinetic energy is sum m_i p_i^2/2 + d_i p_i, so
//   pbar_i = (p_i - h (1 - alpha) V_i - h beta d_i) / (1 + h beta m_i)
// and the matrix is I + D V'' with D_i = h (h alpha (1 - alpha) m_i / (1 + h beta m_i) - gamma).
std::string reduced_solve(bool constant) {
  const std::string assemble = R"(        matrix_.clear();
        for (int i = 0; i < n; ++i) matrix_.put(i, i, 1);
        hessian(par_, bar_, [&](int row, int column, Real value) {
          matrix_.put(row, column, scale_[row] * value);
        });
        if (!matrix_.factorise()) break;
)";
  return std::string(
             R"(  // Newton's iteration from bar_; the torn momenta follow from the coordinates.
  bool iterate(StepReport& report) {
    rule_.begin();
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
      for (int i = 0; i < n; ++i) {
        residual_[i] = bar_[i] - z_.q[i] - h_ * (alpha_ * gradient_[n + i] + gamma_ * gradient_[i]);
      }
)") +
         (constant
              ? "      if (!factorised_) {\n" + assemble + "        factorised_ = true;\n      }\n"
              : "      {\n" + assemble + "      }\n") +
         R"(      matrix_.solve(residual_);
      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_[i]) + magnitude(z_.q[i]);
        bar_[i] -= residual_[i];
      }
      report.increment = size;
      const Verdict verdict = rule_(size, scale, iteration);
      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) break;
      evaluate();
      return true;
    }
    return false;
  }

  // The gradient at bar_, whose momenta are made from its coordinates.
  void evaluate() {
    clear(gradient_);
    potential_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) {
      const Real momentum = z_.p[i] - h_ * ((1 - alpha_) * gradient_[i] + beta_ * drift_[i]);
      bar_[n + i] = momentum / (1 + h_ * beta_ * mass_[i]);
    }
    kinetic_gradient(par_, bar_, gradient_);
  }
)";
}

std::string full_solve(bool constant) {
  const std::string assemble = R"(        matrix_.clear();
        for (int i = 0; i < 2 * n; ++i) matrix_.put(i, i, 1);
        hessian(par_, bar_, [&](int row, int column, Real value) {
          const int i = row < n ? row : row - n;
          const Real to_q = row < n ? gamma_ : alpha_;
          const Real to_p = row < n ? 1 - alpha_ : beta_;
          matrix_.put(i, column, -h_ * to_q * value);
          matrix_.put(n + i, column, h_ * to_p * value);
        });
        if (!matrix_.factorise()) break;
)";
  return std::string(R"(  // Newton's iteration from bar_ on all stage values.
  bool iterate(StepReport& report) {
    rule_.begin();
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      gradient(par_, bar_, gradient_);
      for (int i = 0; i < n; ++i) {
        const Real by_q = h_ * gradient_[i];
        const Real by_p = h_ * gradient_[n + i];
        residual_[i] = bar_[i] - z_.q[i] - (alpha_ * by_p + gamma_ * by_q);
        residual_[n + i] = bar_[n + i] - z_.p[i] + ((1 - alpha_) * by_q + beta_ * by_p);
      }
)") +
         (constant
              ? "      if (!factorised_) {\n" + assemble + "        factorised_ = true;\n      }\n"
              : "      {\n" + assemble + "      }\n") +
         R"(      matrix_.solve(residual_);
      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < 2 * n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_[i]) + magnitude(i < n ? z_.q[i] : z_.p[i - n]);
        bar_[i] -= residual_[i];
      }
      report.increment = size;
      const Verdict verdict = rule_(size, scale, iteration);
      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) break;
      gradient(par_, bar_, gradient_);
      return true;
    }
    return false;
  }
)";
}

}  // namespace

void write_array_propagator(CodeWriter& out, const CppContext& context, StepRole role) {
  const std::string name = class_name(role);
  const Program& program = context.program;
  const ArrayPlan& plan = *program.plan.arrays;
  const bool newton = uses_newton(plan);
  const bool reduced = plan.method == ArrayMethod::reduced_newton;
  const FamilyParameters member =
      uniform_parameters(program.plan.equations.scheme.member()).value();
  const CppExpression cpp(
      context.scalar,
      [&](const std::string& symbol) -> std::string {
        if (symbol == "h") return "h";
        const auto it = context.parameter_text.find(symbol);
        return it != context.parameter_text.end() ? it->second : symbol;
      },
      context.options.builtins);
  out.line(
      "// Many steps: start values are extrapolated, rounding errors of the updates carried "
      "along.");
  out.line("class " + name + " {");
  out.line(" public:");
  out.indent();
  if (newton) {
    out.line(name + "([[maybe_unused]] const Parameters& par, Real h, const State& z)");
    const std::string size = reduced ? "n" : "2 * n";
    out.line(fmt::format("    : par_(par), h_(h), z_(z), alpha_({}), beta_({}), gamma_({}){} {{",
                         cpp(member.alpha), cpp(member.beta), cpp(member.gamma),
                         plan.bandwidth ? "" : ", matrix_(" + size + "), residual_(" + size + ")"));
    out.indent();
    if (reduced) {
      out.line("clear(bar_);");
      out.line("clear(gradient_);");
      out.line("kinetic_gradient(par_, bar_, gradient_);");
      out.line("for (int i = 0; i < n; ++i) drift_[i] = gradient_[n + i];");
      out.line("masses(par_, bar_, [&](int row, int, Real value) { mass_[row - n] += value; });");
      out.open("for (int i = 0; i < n; ++i)");
      out.line(
          "const Real inverse = alpha_ * (1 - alpha_) * mass_[i] / (1 + h_ * beta_ * mass_[i]);");
      out.line("scale_[i] = h_ * (h_ * inverse - gamma_);");
      out.close();
    }
    out.close();
  } else {
    out.line(name + "(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}");
  }
  out.line();
  out.line("// One step; on failure the state stays as it was.");
  out.dedent();
  if (!newton) {
    out.lines(explicit_step(plan.method == ArrayMethod::explicit_a));
  } else {
    out.lines(R"(  StepReport step() {
    StepReport report;
    const bool known = history_.known > 0;
    if (known) {
      history_.extrapolate(start_);
      for (int i = 0; i < unknowns; ++i) bar_[i] = start_[i];
    } else {
      start_at_state();
    }
    bool solved = iterate(report);
    if (!solved && known) {
      // Extrapolation may lead astray, the state itself seldom does.
      rule_ = NewtonRule();
      history_ = History();
      start_at_state();
      solved = iterate(report);
    }
    if (!solved) return report;
    for (int i = 0; i < unknowns; ++i) start_[i] = bar_[i];
    const int iterations = report.iterations;
    report = update();
    report.iterations = iterations;
    if (report.converged) history_.record(start_);
    return report;
  }
)");
  }
  out.line();
  out.lines(
      R"(  // Up to `steps` steps; stops at the first failure.  The report sums the iterations.
  StepReport advance(long long steps) {
    StepReport total;
    total.converged = true;
    for (long long i = 0; i < steps && total.converged; ++i) {
      const StepReport report = step();
      total.iterations += report.iterations;
      total.increment = report.increment;
      total.converged = report.converged;
    }
    return total;
  }

  [[nodiscard]] const State& state() const { return z_; }
)");
  out.indent();
  if (role == StepRole::substep) {
    write_substep_access(out, newton ? "rule_ = NewtonRule();\nhistory_ = History();\n" : "");
  }
  out.dedent();
  out.lines(R"(
 private:
  static void clear(Real (&values)[2 * n]) {
    for (Real& value : values) value = 0;
  }
)");
  if (newton) {
    out.lines(R"(  void start_at_state() {
    for (int i = 0; i < n; ++i) {
      bar_[i] = z_.q[i];
      bar_[n + i] = z_.p[i];
    }
  }
)");
    out.lines(reduced ? reduced_solve(plan.constant_matrix) : full_solve(plan.constant_matrix));
  }
  out.lines(fmt::format(R"(
  // Z = z + h J grad H(zbar).
  StepReport update() {{
    StepReport report;
    Real length = 0;
    for (const Real g : gradient_) length += h_ * g * (h_ * g);
    report.converged = length <= {};
    if (!report.converged) {{
      report.increment = length;
      return report;
    }}
    for (int i = 0; i < n; ++i) {{
      add(z_.q[i], carry_.q[i], h_ * gradient_[n + i]);
      add(z_.p[i], carry_.p[i], -h_ * gradient_[i]);
    }}
    return report;
  }}

  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  Real bar_[2 * n] = {{}};
  Real gradient_[2 * n] = {{}};
)",
                        context.scalar.largest));
  out.indent();
  if (newton) {
    out.line("static constexpr int unknowns = History::unknowns;");
    out.line("Real alpha_, beta_, gamma_;");
    if (reduced) out.line("Real mass_[n] = {}, drift_[n] = {}, scale_[n] = {};");
    out.line(plan.bandwidth ? "BandMatrix matrix_;" : "SparseMatrix matrix_;");
    out.line(plan.bandwidth ? "Real residual_[n] = {};"
                            : "Eigen::Matrix<Real, Eigen::Dynamic, 1> residual_;");
    out.line("NewtonRule rule_;");
    out.line("History history_;");
    out.line("Real start_[unknowns] = {};");
    if (plan.constant_matrix) out.line("bool factorised_ = false;");
  }
  out.dedent();
  out.line("};");
  out.line();
}

}  // namespace hamgen
