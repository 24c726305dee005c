#include "generator/formats/cpp_tangent.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_functions.hpp"

namespace hamgen {

namespace {

// values[i][j] of the Hessian, both halves.
void write_hessian_function(CodeWriter& out, CppContext& context) {
  const Program& program = context.program;
  out.line("// Second derivatives of H.");
  write_evaluation(
      out, context,
      fmt::format(
          "inline void hessian([[maybe_unused]] const Parameters& par, [[maybe_unused]] const "
          "State& z, [[maybe_unused]] Real (&values)[{0}][{0}])",
          2 * context.n()),
      program.hessian, [&](CodeWriter& w, const CppExpression& cpp) {
        for (std::size_t k = 0; k < program.hessian_places.size(); ++k) {
          const auto [i, j] = program.hessian_places[k];
          w.line(fmt::format("values[{}][{}] = {};", i, j, cpp(program.hessian.results[k])));
          if (i != j) w.line(fmt::format("values[{1}][{0}] = values[{0}][{1}];", i, j));
        }
      });
}

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

// "z.q, z.p": the fields of a state in order.
std::string fields_of(const CppContext& context, const std::string& state) {
  std::string text;
  for (int i = 0; i < 2 * context.n(); ++i) {
    text += (i == 0 ? "" : ", ") + state + "." + context.state_field(i);
  }
  return text;
}

std::string moved_fields(const CppContext& context, const std::string& state) {
  std::string text;
  for (int i = 0; i < 2 * context.n(); ++i) {
    text += fmt::format("  {}.{} += move[{}];\n", state, context.state_field(i), i);
  }
  return text;
}

constexpr const char* kSolved =
    R"(// M = dZ/dz of the step that moves z by dz: with S the Hessian at zbar = z + (I/2 + C) dz and
// A+ = I - h J S (I/2 + C), A- = I + h J S (I/2 - C), it is A+^-1 A-.  False if A+ is singular.
inline bool tangent(const Parameters& par, Real h, const State& z, const State& dz,
                    Real (&m)[{size}][{size}]) {{
  constexpr int size = {size};
  constexpr int half = {half};
  Real w[size][size] = {{}};
  stage_matrix(par, h, w);
  const Real d[size] = {{{fields}}};
  Real move[size] = {{}};
  for (int i = 0; i < size; ++i) {{
    for (int j = 0; j < size; ++j) move[i] += w[i][j] * d[j];
  }}
  State bar = z;
{moved}  Real s[size][size] = {{}};
  hessian(par, bar, s);
  Real a[size][size];
  for (int i = 0; i < size; ++i) {{
    const Real sign = i < half ? h : -h;
    const Real* row = s[i < half ? i + half : i - half];
    for (int j = 0; j < size; ++j) {{
      Real product = 0;
      for (int k = 0; k < size; ++k) product += row[k] * w[k][j];
      const Real one = i == j ? 1 : 0;
      a[i][j] = one - sign * product;
      m[i][j] = one + sign * (row[j] - product);
    }}
  }}
  // Elimination with partial pivoting.
  for (int c = 0; c < size; ++c) {{
    int pivot = c;
    for (int i = c + 1; i < size; ++i) {{
      if (a[i][c] * a[i][c] > a[pivot][c] * a[pivot][c]) pivot = i;
    }}
    if (!(a[pivot][c] * a[pivot][c] > 0)) return false;
    for (int j = 0; j < size; ++j) {{
      const Real kept_a = a[c][j];
      a[c][j] = a[pivot][j];
      a[pivot][j] = kept_a;
      const Real kept_m = m[c][j];
      m[c][j] = m[pivot][j];
      m[pivot][j] = kept_m;
    }}
    for (int i = 0; i < size; ++i) {{
      if (i == c) continue;
      const Real factor = a[i][c] / a[c][c];
      for (int j = c; j < size; ++j) a[i][j] -= factor * a[c][j];
      for (int j = 0; j < size; ++j) m[i][j] -= factor * m[c][j];
    }}
  }}
  for (int i = 0; i < size; ++i) {{
    for (int j = 0; j < size; ++j) m[i][j] /= a[i][i];
  }}
  return true;
}}

)";

constexpr const char* kSwept =
    R"(// M = dZ/dz of the sweeps themselves, each linearised: g and its derivative dg along z are carried
// through zbar = z + h (I/2 + C) J g and g = grad H(zbar).
inline bool tangent(const Parameters& par, Real h, const State& z, const State&,
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

bool has_tangent(const Program& program) {
  return program.plan.equations.scheme.is_member() && !program.plan.arrays &&
         !program.plan.equations.function;
}

void write_tangent(CodeWriter& out, CppContext& context) {
  write_hessian_function(out, context);
  write_stage_matrix(out, context);
  const auto& sweeps = context.program.plan.sweeps;
  out.lines(fmt::format(fmt::runtime(sweeps ? kSwept : kSolved), fmt::arg("size", 2 * context.n()),
                        fmt::arg("half", context.n()), fmt::arg("fields", fields_of(context, "dz")),
                        fmt::arg("moved", moved_fields(context, "bar")),
                        fmt::arg("sweeps", sweeps.value_or(0))));
}

}  // namespace hamgen
