// Many steps of a member of a system in loops: the class around what cpp_array_solve.cpp writes.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_step.hpp"

namespace hamgen {

namespace {

class ArrayPropagator {
 public:
  ArrayPropagator(CodeWriter& out, CppContext& context, StepRole role)
      : out_(out),
        context_(context),
        plan_(*context.program.plan.arrays),
        role_(role),
        name_(class_name(role)),
        member_(uniform_parameters(context.equations.scheme.member()).value()),
        weights_(plan_.method == ArrayMethod::sweeps || iterates(plan_) ? array_weights(member_)
                                                                        : ArrayWeights{}) {}

  void write() {
    const SolvePlan& plan = context_.program.plan;
    out_.line(iterates(plan_) ? "// Many steps: start values are extrapolated, rounding errors of "
                                "the updates carried along."
                              : "// Many steps: rounding errors of the updates are carried along.");
    out_.line("class " + name_ + " {");
    out_.line(" public:");
    out_.indent();
    write_constructor();
    out_.line();
    out_.line("// One step; on failure the state stays as it was.");
    out_.dedent();
    out_.lines(array_step(context_.mechanics, plan, weights_));
    out_.line();
    out_.indent();
    write_advance(out_);
    if (role_ == StepRole::substep) write_substep_access(out_, forgotten());
    out_.dedent();
    const bool tangent = context_.options.tangent;
    if (tangent) out_.lines(array_tangent(context_.mechanics, plan, weights_, context_.scalar));
    out_.line();
    out_.line(" private:");
    out_.lines(array_iteration(context_.mechanics, plan_, weights_));
    if (iterates(plan_)) out_.line();
    if (tangent) out_.lines(array_curvature(plan_));
    write_update();
    out_.indent();
    write_members();
    out_.dedent();
    out_.line("};");
    out_.line();
    if (tangent) write_array_tangent_of(out_, role_);
  }

 private:
  // An expression in h and the parameters, as it is written in the constructor.
  [[nodiscard]] std::string text(const Expression& e) const {
    const CppExpression cpp(
        context_.scalar,
        [&](const std::string& symbol) -> std::string {
          if (symbol == "h") return "h";
          if (symbol == "pi") context_.used.pi = true;
          const auto it = context_.parameter_text.find(symbol);
          return it != context_.parameter_text.end() ? it->second : symbol;
        },
        context_.options.builtins);
    std::string result = cpp(e);
    context_.note(cpp);
    return result;
  }

  [[nodiscard]] bool needs_drift() const { return plan_.reduced && !member_.beta.is_zero(); }
  [[nodiscard]] bool needs_scale() const { return plan_.reduced && plan_.matrix.has_value(); }
  [[nodiscard]] bool needs_masses() const {
    return plan_.reduced && !plan_.mass && (needs_scale() || needs_drift());
  }
  [[nodiscard]] bool needs_mass() const {
    return plan_.mass && (needs_drift() || (plan_.reduced && context_.options.tangent));
  }

  // D = h (h alpha (1 - alpha) m / (1 + h beta m) - gamma).
  [[nodiscard]] Expression scale(const Expression& mass) const {
    const Expression h = Expression::symbol("h", kRankOfStep);
    return h * (h * member_.alpha * (Expression(1) - member_.alpha) * mass /
                    (Expression(1) + h * member_.beta * mass) -
                member_.gamma);
  }

  void write_constructor() {
    std::string list = "par_(par), h_(h), z_(z)";
    for (const auto& [name, value] : weights_.members) {
      list += fmt::format(", {}({})", name, text(value));
    }
    if (needs_mass()) list += fmt::format(", mass_({})", text(*plan_.mass));
    if (plan_.mass && needs_scale()) list += fmt::format(", scale_({})", text(scale(*plan_.mass)));
    const std::string head = name_ + "(const Parameters& par, Real h, const State& z)";
    CodeWriter body;
    if (weights_.complementary) {
      body.line("// The step is symplectic because the two sum to h: like this they do exactly.");
      body.line("h_rest_ = h - h_alpha_;");
      body.line("h_alpha_ = h - h_rest_;");
    }
    if (needs_drift()) {
      // dH/dp at p = 0.
      body.line("kinetic_gradient(par_, bar_.p, drift_);");
    }
    if (needs_masses()) body.line("masses(par_, mass_);");
    if (needs_masses() && needs_scale()) {
      // The mass as a symbol of no parameter's name.
      const Expression mass = Expression::symbol("mass_[i]", kRankOfVariable);
      body.line(fmt::format("for (int i = 0; i < n; ++i) scale_[i] = {};", text(scale(mass))));
    }
    out_.line(head);
    out_.line("    : " + list + (body.text().empty() ? " {}" : " {"));
    if (body.text().empty()) return;
    out_.indent();
    out_.lines(body.text());
    out_.dedent();
    out_.line("}");
  }

  [[nodiscard]] std::string forgotten() const {
    if (!iterates(plan_)) return "";
    const bool newton = plan_.method == ArrayMethod::newton;
    return std::string(newton ? "rule_ = {};\n" : "") + "history_ = {};\n";
  }

  void write_update() {
    const bool refined = plan_.method == ArrayMethod::fixed_point;
    out_.lines(
        fmt::format(R"(  // Z = z + h J grad H(zbar).
  StepReport update() {{
    StepReport report;
    Real length = 0;
    for (int i = 0; i < n; ++i) {{
      length += h_ * slope_.q[i] * (h_ * slope_.q[i]) + h_ * slope_.p[i] * (h_ * slope_.p[i]);
    }}
    // False for infinities and NaN alike.
    report.converged = length <= {};
    if (!report.converged) {{
      report.increment = length;
      return report;
    }}
    for (int i = 0; i < n; ++i) {{
      {};
      {};
    }}
    return report;
  }}

)",
                    context_.scalar.largest,
                    refined ? "add(z_.q[i], carry_.q[i], h_ * slope_.p[i], carry_.q[i] + h_ * "
                              "refinement_.change[n + i])"
                            : "two_sum(z_.q[i], carry_.q[i], carry_.q[i] + h_ * slope_.p[i])",
                    refined ? "add(z_.p[i], carry_.p[i], -h_ * slope_.q[i], carry_.p[i] - h_ * "
                              "refinement_.change[i])"
                            : "two_sum(z_.p[i], carry_.p[i], carry_.p[i] - h_ * slope_.q[i])"));
  }

  void write_members() {
    const bool is_explicit = !iterates(plan_) && plan_.method != ArrayMethod::sweeps;
    std::vector<std::pair<std::string, std::string>> members{
        {"Parameters par_;", ""},
        {"Real h_;", ""},
        {"State z_;", ""},
        {"State carry_;", "what rounding took from z_"},
        {is_explicit ? "Real bar_[n] = {};" : "State bar_;", "zbar"},
        {"State slope_;", "grad H(zbar): slope_.q = dH/dq"}};
    for (const auto& [name, value] : weights_.members) {
      const std::string meaning = name == "half_h_"    ? "h/2"
                                  : name == "h_rest_"  ? "h (1 - alpha)"
                                  : name == "h_alpha_" ? "h alpha"
                                  : name == "h_beta_"  ? "h beta"
                                                       : "h gamma";
      members.emplace_back("Real " + name + ";", meaning);
    }
    const char* array = plan_.mass ? ";" : "[n] = {};";
    if (needs_masses() || needs_mass()) {
      members.emplace_back(fmt::format("Real mass_{}", array), "d2H/dp_i^2");
    }
    if (needs_drift()) members.emplace_back("Real drift_[n] = {};", "dH/dp_i at p = 0");
    if (needs_scale()) {
      members.emplace_back(fmt::format("Real scale_{}", array), "the matrix is I + scale V''");
    }
    if (plan_.matrix) members.emplace_back("Matrix matrix_;", "");
    if (plan_.constant_matrix) members.emplace_back("bool factorised_ = false;", "");
    if (iterates(plan_)) {
      const char* unknowns = plan_.reduced ? "n" : "2 * n";
      members.emplace_back(fmt::format("Real residual_[{}] = {{}};", unknowns), "");
      if (plan_.method == ArrayMethod::newton) members.emplace_back("NewtonRule<2> rule_;", "");
      if (plan_.method == ArrayMethod::fixed_point)
        members.emplace_back(fmt::format("Real length_[{}] = {{}};", unknowns), "");
      if (plan_.method == ArrayMethod::fixed_point)
        members.emplace_back(fmt::format("Refinement<{}, 2 * n> refinement_;", unknowns), "");
      members.emplace_back(fmt::format("History<{}> history_;", unknowns), "");
    }
    out_.aligned(members);
  }

  CodeWriter& out_;
  CppContext& context_;
  const ArrayPlan& plan_;
  StepRole role_;
  std::string name_;
  FamilyParameters member_;
  ArrayWeights weights_;
};

}  // namespace

std::string class_name(StepRole role) {
  return role == StepRole::propagator ? "Propagator" : "Substep";
}

void write_substep_access(CodeWriter& out, const std::string& reset) {
  out.line("// Goes on from a state of another substep.");
  out.open("void begin_at(const State& z, const State& carry)");
  out.line("z_ = z;");
  out.line("carry_ = carry;");
  out.close();
  if (reset.empty()) return;
  out.line("// Drops the start values.");
  out.open("void forget()");
  out.lines(reset);
  out.close();
}

void write_array_propagator(CodeWriter& out, CppContext& context, StepRole role) {
  ArrayPropagator(out, context, role).write();
}

}  // namespace hamgen
