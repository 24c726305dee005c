#include "generator/formats/cpp_tangent.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

// I/2 + C.
void write_stage_matrix(CodeWriter& out, CppContext& context) {
  const SparseMatrix& c = context.equations.scheme.member().c;
  Names names;
  names.reserve("values");
  const CppExpression cpp = context.expression(names);
  out.line("// I/2 + C, which makes zbar = z + (I/2 + C) (Z - z).");
  out.open(
      fmt::format("inline void stage_matrix([[maybe_unused]] const Parameters& par, "
                  "[[maybe_unused]] Real h, Real (&values)[{0}][{0}])",
                  2 * context.n()));
  for (int i = 0; i < 2 * context.n(); ++i) {
    for (int j = 0; j < 2 * context.n(); ++j) {
      const auto it = c.find({i, j});
      Expression entry = it == c.end() ? Expression(0) : it->second;
      if (i == j) entry += Expression(Rational(1, 2));
      if (!entry.is_zero()) out.line(fmt::format("values[{}][{}] = {};", i, j, cpp(entry)));
    }
  }
  out.close();
  out.line();
  context.note(cpp);
}

std::string moved_fields(const CppContext& context, const std::string& state) {
  std::string text;
  for (int i = 0; i < 2 * context.n(); ++i) {
    text += fmt::format("  {}.{} += move[{}];\n", state, context.state_field(i), i);
  }
  return text;
}

constexpr const char* kSwept =
    R"(// M = dZ/dz of the sweeps themselves, each linearised: g and its derivative dg along z are carried
// through zbar = z + h (I/2 + C) J g and g = grad H(zbar).
inline bool {name}(const Parameters& par, Real h, const State& z, const State&,
                    Real (&m)[{size}][{size}]) {{
  constexpr int size = {size};
  constexpr int half = {half};
  Real w[size][size] = {{}};
  stage_matrix(par, h, w);
  Real g[size] = {{}};
  gradient(par, z, g);
  Real dg[size][size] = {{}};
  hessian(par, z, dg);
  for (int sweep = 0; sweep < {sweeps}; ++sweep) {{
    // J g and J dg: row i is row i + n of g, or minus row i - n.
    Real move[size] = {{}};
    Real dbar[size][size] = {{}};
    for (int i = 0; i < size; ++i) {{
      dbar[i][i] = 1;
      for (int k = 0; k < size; ++k) {{
        const int from = k < half ? k + half : k - half;
        const Real weight = k < half ? h * w[i][k] : -h * w[i][k];
        move[i] += weight * g[from];
        for (int j = 0; j < size; ++j) dbar[i][j] += weight * dg[from][j];
      }}
    }}
    State bar = z;
  {moved}    gradient(par, bar, g);
    Real s[size][size] = {{}};
    hessian(par, bar, s);
    for (int i = 0; i < size; ++i) {{
      for (int j = 0; j < size; ++j) {{
        dg[i][j] = 0;
        for (int k = 0; k < size; ++k) dg[i][j] += s[i][k] * dbar[k][j];
      }}
    }}
  }}
  for (int i = 0; i < size; ++i) {{
    for (int j = 0; j < size; ++j) {{
      m[i][j] = (i == j ? 1 : 0) + (i < half ? h * dg[i + half][j] : -h * dg[i - half][j]);
    }}
  }}
  return true;
}}

)";

}  // namespace

std::optional<std::string> without_tangent(const Program& program) {
  const StepEquations& equations = program.plan.equations;
  if (!equations.has_exact_hessian()) {
    return "the Hessian of the K that stands in for H is too long";
  }
  // The matrix, and that of the stages, are on the stack.
  constexpr int kMost = 512;
  const int size = 2 * equations.mechanics.degrees_of_freedom;
  const int stages =
      program.plan.stage_solver ? static_cast<int>(program.sequence.stages.weight.size()) : 1;
  if (size * stages <= kMost) return {};
  return fmt::format("its equations have {} unknowns, of at most {}", size * stages, kMost);
}

std::string tangent_name(StepRole role) {
  return role == StepRole::propagator ? "tangent" : "substep_tangent";
}

void write_member_tangent(CodeWriter& out, CppContext& context, StepRole role) {
  if (!context.program.plan.sweeps) return context.write_routine(out, tangent_name(role));
  context.write_routine(out, "hessian");
  write_stage_matrix(out, context);
  out.lines(fmt::format(kSwept, fmt::arg("name", tangent_name(role)),
                        fmt::arg("size", 2 * context.n()), fmt::arg("half", context.n()),
                        fmt::arg("moved", moved_fields(context, "bar")),
                        fmt::arg("sweeps", *context.program.plan.sweeps)));
}

}  // namespace hamgen
