// Tangent maps of splittings, compositions and Runge-Kutta methods.
#include <fmt/format.h>

#include "generator/formats/cpp_tangent.hpp"

namespace hamgen {

namespace {

constexpr const char* kSignature =
    R"(inline bool tangent(const Parameters& par, Real h, const State& z, const State&,
                    Real (&m)[{size}][{size}]) {{
)";

// "now.q += move[0];" for the fields of a state.
std::string each_field(const CppContext& context, int first, int count, const std::string& line) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += fmt::format(fmt::runtime(line), fmt::arg("x", context.state_field(first + i)),
                        fmt::arg("i", i));
  }
  return text;
}

std::string row_of(const std::vector<Expression>& values, const ScalarType& scalar) {
  std::string text;
  for (const Expression& e : values) {
    text += (text.empty() ? "" : ", ") + literal(numeric_value(e), scalar);
  }
  return "{" + text + "}";
}

constexpr const char* kSubstepOfArrays = R"(    Substep substep(par, h * length, now);
    substep.begin_at(now, carry);
    if (!substep.step().converged) return false;
    const State& end = substep.state();
    State dz;
)";

// dz by solve, from now + carry.
std::string substep_of(const CppContext& context) {
  std::string text;
  std::string arguments;
  for (const Argument& argument : context.code.routine("solve")->arguments) {
    if (argument.name == "k") text += "    const Coefficients k = prepare(par, h * length);\n";
    if (argument.name == "start") text += "    Start start;\n";
    const std::string name = argument.name == "h"   ? "h * length"
                             : argument.name == "z" ? "now"
                                                    : argument.name;
    arguments += (arguments.empty() ? "" : ", ") + name;
  }
  const char* result = context.code.has_rest() ? "    State dz, rest;\n" : "    State dz;\n";
  return text + result + "    if (!solve(" + arguments + ").converged) return false;\n";
}

}  // namespace

void write_splitting_tangent(CodeWriter& out, CppContext& context) {
  context.write_routine(out, "hessian");
  const int n = context.n();
  const auto& substeps = context.program.sequence.substeps;
  const bool kick_first = substeps.front().kind == SubstepKind::kick;
  const std::string text =
      "// M = dZ/dz, the product over the substeps: a kick adds -b h V'' of its rows of\n"
      "// coordinates to those of momenta, a drift a h T'' of these to those.\n" +
      std::string(kSignature) + R"(  constexpr int n = {n};
  const Coefficients k = prepare(par, h);
  State now = z;
  Real length = 0;
  for (int i = 0; i < 2 * n; ++i) {{
    for (int j = 0; j < 2 * n; ++j) m[i][j] = i == j ? 1 : 0;
  }}
  for (int substep = 0; substep < {count}; ++substep) {{
    const bool is_kick = substep % 2 == {kick};
    const Real size = is_kick ? -k.kick[substep / 2] : k.drift[substep / 2];
    const int from = is_kick ? 0 : n;
    const int to = is_kick ? n : 0;
    Real second[2 * n][2 * n] = {{}};
    hessian(par, now, second);
    for (int i = 0; i < n; ++i) {{
      for (int j = 0; j < 2 * n; ++j) {{
        Real sum = 0;
        for (int l = 0; l < n; ++l) sum += second[from + i][from + l] * m[from + l][j];
        m[to + i][j] += size * sum;
        length += m[to + i][j] * m[to + i][j];
      }}
    }}
    Real slope[n] = {{}};
    if (is_kick) {{
      potential_gradient(par, k, now, slope);
{kicks}    }} else {{
      kinetic_gradient(par, k, now, slope);
{drifts}    }}
  }}
  // False for infinities and NaN alike.
  return length <= {largest};
}}

)";
  out.lines(fmt::format(
      fmt::runtime(text), fmt::arg("size", 2 * n), fmt::arg("n", n),
      fmt::arg("count", substeps.size()), fmt::arg("kick", kick_first ? 0 : 1),
      fmt::arg("kicks", each_field(context, n, n, "      now.{x} += size * slope[{i}];\n")),
      fmt::arg("drifts", each_field(context, 0, n, "      now.{x} += size * slope[{i}];\n")),
      fmt::arg("largest", context.scalar.largest)));
}

void write_composition_tangent(CodeWriter& out, const CppContext& context) {
  const int size = 2 * context.n();
  std::vector<Expression> lengths = lengths_of(context.program.sequence, SubstepKind::member);
  const std::string text = "// M = dZ/dz, the product of those of the substeps.\n" +
                           std::string(kSignature) +
                           R"(  constexpr int size = {size};
  constexpr Real lengths[] = {lengths};
  State now = z;
  State carry;
  for (int i = 0; i < size; ++i) {{
    for (int j = 0; j < size; ++j) m[i][j] = i == j ? 1 : 0;
  }}
  for (const Real length : lengths) {{
{solve}    Real factor[size][size];
    if (!{factor}(par, h * length, now, dz, factor)) return false;
    Real product[size][size] = {{}};
    for (int i = 0; i < size; ++i) {{
      for (int l = 0; l < size; ++l) {{
        for (int j = 0; j < size; ++j) product[i][j] += factor[i][l] * m[l][j];
      }}
    }}
    for (int i = 0; i < size; ++i) {{
      for (int j = 0; j < size; ++j) m[i][j] = product[i][j];
    }}
{update}  }}
  return true;
}}

)";
  out.lines(fmt::format(
      fmt::runtime(text), fmt::arg("size", size),
      fmt::arg("lengths", row_of(lengths, context.scalar)),
      fmt::arg("factor", tangent_name(StepRole::substep)),
      fmt::arg("solve", context.arrays() ? kSubstepOfArrays : substep_of(context)),
      fmt::arg("update", context.arrays()
                             ? "    now = end;\n    carry = substep.carry();\n"
                             : each_field(context, 0, size,
                                          context.code.has_rest()
                                              ? "    add(now.{x}, carry.{x}, dz.{x}, rest.{x});\n"
                                              : "    two_sum(now.{x}, carry.{x}, dz.{x});\n"))));
}

void write_explicit_tangent(CodeWriter& out, const CppContext& context) {
  const StageTable& table = context.program.sequence.stages;
  std::string rows;
  for (const auto& row : table.coupling) {
    rows += "      " + row_of(row, context.scalar) + ",\n";
  }
  const std::string text =
      "// M = dZ/dz = 1 + h sum b_i K_i with K_i = J H''(Y_i) (1 + h sum a_ij K_j).\n" +
      std::string(kSignature) + R"(  constexpr int stages = {stages};
  constexpr int half = dimension / 2;
  constexpr Real a[stages][stages] = {{
{rows}  }};
  constexpr Real b[stages] = {weights};
  Real x[dimension];
  read(z, x);
  Real f[stages][dimension];
  Real slope[stages][dimension][dimension];
  Real length = 0;
  for (int i = 0; i < dimension; ++i) {{
    for (int j = 0; j < dimension; ++j) m[i][j] = i == j ? 1 : 0;
  }}
  for (int i = 0; i < stages; ++i) {{
    Real y[dimension];
    Real moved[dimension][dimension];
    for (int k = 0; k < dimension; ++k) {{
      y[k] = x[k];
      for (int j = 0; j < i; ++j) y[k] += h * a[i][j] * f[j][k];
      for (int l = 0; l < dimension; ++l) {{
        moved[k][l] = k == l ? 1 : 0;
        for (int j = 0; j < i; ++j) moved[k][l] += h * a[i][j] * slope[j][k][l];
      }}
    }}
    vector_field(par, y, f[i]);
    Real second[dimension][dimension] = {{}};
    hessian(par, y, second);
    for (int k = 0; k < dimension; ++k) {{
      for (int l = 0; l < dimension; ++l) {{
        slope[i][k][l] = 0;
        for (int r = 0; r < dimension; ++r) {{
          const Real entry = k < half ? second[half + k][r] : -second[k - half][r];
          slope[i][k][l] += entry * moved[r][l];
        }}
        m[k][l] += h * b[i] * slope[i][k][l];
        length += m[k][l] * m[k][l];
      }}
    }}
  }}
  // False for infinities and NaN alike.
  return length <= {largest};
}}

)";
  out.lines(fmt::format(fmt::runtime(text), fmt::arg("size", "dimension"),
                        fmt::arg("stages", table.weight.size()), fmt::arg("rows", rows),
                        fmt::arg("weights", row_of(table.weight, context.scalar)),
                        fmt::arg("largest", context.scalar.largest)));
}

// With L_j = h b_j f(Y_j) a displacement u moves Y_i by dY_i = u + sum coupling_ij h b_j f'(Y_j)
// dY_j: the matrix of Newton's iteration, here with the Hessian of every stage, and Z by u + sum h
// b_j f'(Y_j) dY_j.
std::string stages_tangent() {
  return R"(
  // M = dZ/dz of the last step: the matrix of Newton's iteration with the Hessian of every stage,
  // eliminated as there.  False if it is singular.
  bool tangent(Real (&m)[dimension][dimension]) const {
    constexpr int half = dimension / 2;
    Real slope[stages][dimension][dimension];  // h b_j J H''(Y_j)
    for (int j = 0; j < stages; ++j) {
      Real x[dimension];
      for (int k = 0; k < dimension; ++k) x[k] = y_[k] + increment_[j][k];
      Real values[dimension][dimension] = {};
      hessian(par_, x, values);
      for (int k = 0; k < dimension; ++k) {
        for (int l = 0; l < dimension; ++l) {
          slope[j][k][l] = scaled_[j] * (k < half ? values[half + k][l] : -values[k - half][l]);
        }
      }
    }
    Elimination matrix;
    for (int row = 0; row < Elimination::size; ++row) {
      for (int column = 0; column < Elimination::size; ++column) {
        const int i = row / dimension;
        const int j = column / dimension;
        matrix.put(row, column,
                   (row == column ? 1 : 0) -
                       coupling[i][j] * slope[j][row % dimension][column % dimension]);
      }
    }
    if (!matrix.factorise()) return false;
    for (int column = 0; column < dimension; ++column) {
      Real vector[Elimination::size];
      for (int row = 0; row < Elimination::size; ++row) vector[row] = row % dimension == column ? 1 : 0;
      matrix.solve(vector);
      for (int k = 0; k < dimension; ++k) {
        m[k][column] = k == column ? 1 : 0;
        for (int row = 0; row < Elimination::size; ++row) {
          m[k][column] += slope[row / dimension][k][row % dimension] * vector[row];
        }
      }
    }
    return true;
  }
)";
}

void write_stages_tangent(CodeWriter& out) {
  out.lines("// M = dZ/dz of one step.\n" + fmt::format(kSignature, fmt::arg("size", "dimension")) +
            R"(  Propagator propagator(par, h, z);
  return propagator.step().converged && propagator.tangent(m);
}

)");
}

}  // namespace hamgen
