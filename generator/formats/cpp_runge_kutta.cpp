// Runge-Kutta methods: the state as one array, f = J grad H of it.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_member.hpp"
#include "generator/formats/cpp_schemes.hpp"
#include "generator/formats/cpp_stages.hpp"
#include "generator/formats/cpp_support.hpp"
#include "generator/formats/cpp_tangent.hpp"

namespace hamgen {

namespace {

// f = (H_p, -H_q) from grad H = (H_q, H_p).
void write_vector_field(CodeWriter& out, CppContext& context) {
  out.line("// J grad H at a state (q, p).");
  const std::string head = std::string("inline void vector_field(") +
                           (context.arrays() ? "" : "[[maybe_unused]] ") +
                           "const Parameters& par, ";
  if (context.arrays()) {
    out.lines(head + R"(const Real (&x)[dimension],
                         Real (&f)[dimension]) {
  gradient(par, x, x + n, f + n, f);
  for (int i = 0; i < n; ++i) f[n + i] = -f[n + i];
}

)");
    return;
  }
  const Evaluation& field = context.program.vector_field;
  write_evaluation(
      out, context,
      head + "[[maybe_unused]] const Real (&z)[dimension], Real (&values)[dimension])", field,
      [&](CodeWriter& w, const CppExpression& cpp) { write_results(w, cpp, field); },
      CppContext::StateForm::array);
}

// y = x + h sum a_j f_j, and dz = h sum b_j f_j: only what is not zero.
std::string combination(const std::vector<Rational>& row, const ScalarType& scalar) {
  std::string text;
  for (std::size_t j = 0; j < row.size(); ++j) {
    if (row[j] == 0) continue;
    text +=
        (text.empty() ? "" : " + ") + fmt::format("{} * f_{}[k]", literal(row[j], scalar), j + 1);
  }
  return text;
}

std::vector<Rational> numbers(const std::vector<Expression>& values) {
  std::vector<Rational> result;
  for (const Expression& e : values) result.push_back(numeric_value(e));
  return result;
}

void write_explicit(CodeWriter& out, const CppContext& context) {
  const StageTable& table = context.program.sequence.stages;
  out.line("// dz = Z - z for one step from z.");
  out.open(
      "[[nodiscard]] inline StepReport solve(const Parameters& par, Real h, "
      "const Real (&z)[dimension], Real (&dz)[dimension])");
  out.line("StepReport report;");
  out.line("Real y[dimension];");
  for (std::size_t i = 0; i < table.weight.size(); ++i) {
    const std::string sum = combination(numbers(table.coupling[i]), context.scalar);
    out.line(fmt::format("Real f_{}[dimension];", i + 1));
    if (!sum.empty()) {
      out.line(fmt::format("for (int k = 0; k < dimension; ++k) y[k] = z[k] + h * ({});", sum));
    }
    out.line(fmt::format("vector_field(par, {}, f_{});", sum.empty() ? "z" : "y", i + 1));
  }
  out.line("Real length = 0;");
  out.open("for (int k = 0; k < dimension; ++k)");
  out.line("dz[k] = h * (" + combination(numbers(table.weight), context.scalar) + ");");
  out.line("length += dz[k] * dz[k];");
  out.close();
  out.line("// False for infinities and NaN alike.");
  out.line(fmt::format("report.converged = length <= {};", context.scalar.largest));
  out.line("if (!report.converged) report.increment = length;");
  out.line("return report;");
  out.close();
  out.line();
  out.lines(R"(// Many steps: rounding errors of the updates are carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    Real z[dimension];
    Real dz[dimension];
    read(z_, z);
    const StepReport report = solve(par_, h_, z, dz);
    if (report.converged) add(z_, carry_, dz);
    return report;
  }

)");
  out.indent();
  write_advance(out);
  out.dedent();
  out.lines(R"(
 private:
  Parameters par_;
  Real h_;
  State z_;
  State carry_;
};

)");
}

}  // namespace

void write_flat_state(CodeWriter& out, const CppContext& context, bool with_rest) {
  out.line("// The state as one array.");
  out.open("inline void read(const State& z, Real (&x)[dimension])");
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    out.line("x[i] = z.q[i];");
    out.line("x[n + i] = z.p[i];");
    out.close();
  } else {
    for (int i = 0; i < 2 * context.n(); ++i) {
      out.line(fmt::format("x[{}] = z.{};", i, context.state_field(i)));
    }
  }
  out.close();
  out.line();
  out.line(with_rest ? "// z += dz + rest, where the rest has the carry in it."
                     : "// z += dz, with what rounding loses kept in carry.");
  out.open(std::string("inline void add(State& z, State& carry, const Real (&dz)[dimension]") +
           (with_rest ? ", const Real (&rest)[dimension])" : ")"));
  const auto added = [&](const std::string& field, const std::string& index) {
    return fmt::format("add(z.{0}, carry.{0}, dz[{1}]{2});", field, index,
                       with_rest ? ", rest[" + index + "]" : "");
  };
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    out.line(added("q[i]", "i"));
    out.line(added("p[i]", "n + i"));
    out.close();
  } else {
    for (int i = 0; i < 2 * context.n(); ++i) {
      out.line(added(context.state_field(i), std::to_string(i)));
    }
  }
  out.close();
  out.line();
}

void write_runge_kutta(CodeWriter& out, CppContext& context, const RungeKutta& tableau) {
  const bool implicit = context.program.plan.stage_solver.has_value();
  write_types(out, context, implicit);
  if (context.arrays()) {
    write_array_functions(out, context);
  } else {
    write_functions(out, context);
  }
  out.line(fmt::format("inline constexpr int dimension = {};", 2 * context.n()));
  out.line();
  write_vector_field(out, context);
  out.lines((implicit ? cpp_two_sum() + "\n" + cpp_sum_with_rest() : cpp_compensated_sum()) + "\n");
  write_flat_state(out, context, implicit);
  if (implicit) {
    write_stages(out, context, tableau);
  } else {
    write_explicit(out, context);
  }
  write_single_step(out);
  if (!context.options.tangent) return;
  if (implicit) {
    write_stages_tangent(out);
  } else {
    write_stage_hessian(out, context);
    write_explicit_tangent(out, context);
  }
}

}  // namespace hamgen
