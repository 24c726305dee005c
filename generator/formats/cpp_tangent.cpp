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

class LinearisationWriter {
 public:
  LinearisationWriter(CodeWriter& out, CppContext& context, const MemberParts& parts)
      : out_(out), context_(context), parts_(parts), value_(*context.program.linearisation) {}

  void write(const std::string& name) {
    const int size = 2 * context_.n();
    write_elimination();
    Names names;
    for (const char* local : {"column", "size", "u", "m", "i", "j"}) names.reserve(local);
    for (int i = 0; i < size; ++i) {
      const std::string& variable = context_.variable_name(i);
      names.set("dz(" + variable + ")", "dz." + context_.state_field(i));
      names.set("u(" + variable + ")", fmt::format("u[{}]", i));
    }
    const CppExpression cpp = context_.expression(names);
    out_.line(
        "// M = dZ/dz of the step that moves z by dz, solved as the step is: a displacement u");
    out_.line(
        "// moves the stage by dzbar = u + h (I/2 + C) J H'' dzbar, and Z by u + h J H'' dzbar.");
    out_.line("// False if that has no solution.");
    out_.open(fmt::format(
        "inline bool {0}([[maybe_unused]] const Parameters& par, [[maybe_unused]] Real h, "
        "[[maybe_unused]] const State& z, [[maybe_unused]] const State& dz, Real (&m)[{1}][{1}])",
        name, size));
    context_.load_state(out_, names, used_symbols(value_.once));
    write_statements(out_, cpp, names, value_.once);
    for (std::size_t s = 0; s < value_.stages.size(); ++s) write_inverse(cpp, s);
    out_.line("Real size = 0;");
    out_.open(fmt::format("for (int column = 0; column < {}; ++column)", size));
    out_.line(fmt::format("Real u[{}] = {{}};", size));
    out_.line("u[column] = 1;");
    for (std::size_t s = 0; s < value_.stages.size(); ++s) {
      write_statements(out_, cpp, names, value_.stages[s].before);
      write_solution(cpp, names, s);
    }
    for (int i = 0; i < size; ++i) {
      out_.line(fmt::format("m[{}][column] = {};", i, cpp(value_.results[at(i)])));
    }
    out_.line(
        fmt::format("for (int i = 0; i < {}; ++i) size += m[i][column] * m[i][column];", size));
    out_.close();
    out_.line("// False for infinities and NaN alike.");
    out_.line(fmt::format("return size <= {};", context_.scalar.largest));
    out_.close();
    out_.line();
    context_.note(cpp);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  // The elimination of the step's own Newton iteration, if that has one.
  void write_elimination() {
    bool needed = false;
    for (const Linearisation::Stage& stage : value_.stages) needed = needed || stage.solve;
    if (!needed) return;
    if (!parts_.elimination && !parts_.eigen) out_.lines(matrix_numerics(parts_));
    if (!parts_.inverse) out_.lines(cpp_numerics("inverse"));
  }

  void write_inverse(const CppExpression& cpp, std::size_t s) {
    if (!value_.stages[s].solve) return;
    const LinearisedSolve& solve = *value_.stages[s].solve;
    const std::size_t size = solve.matrix.size();
    out_.line(fmt::format("{} matrix_{};", matrix_type(parts_, size), s));
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        if (solve.matrix[i][j].is_zero()) continue;
        out_.line(fmt::format("matrix_{}.put({}, {}, {});", s, i, j, cpp(solve.matrix[i][j])));
      }
    }
    out_.line(fmt::format("Real inverse_{0}[{1}][{1}];", s, size));
    out_.line(fmt::format("if (!invert(matrix_{0}, inverse_{0})) return false;", s));
  }

  void write_solution(const CppExpression& cpp, Names& names, std::size_t s) {
    if (!value_.stages[s].solve) return;
    const LinearisedSolve& solve = *value_.stages[s].solve;
    const std::size_t size = solve.matrix.size();
    std::string values;
    for (const Expression& e : solve.right_side) values += (values.empty() ? "" : ", ") + cpp(e);
    out_.line(fmt::format("const Real vector_{}[{}] = {{{}}};", s, size, values));
    out_.line(fmt::format("Real product_{}[{}] = {{}};", s, size));
    out_.open(fmt::format("for (int i = 0; i < {}; ++i)", size));
    out_.line(fmt::format(
        "for (int j = 0; j < {1}; ++j) product_{0}[i] += inverse_{0}[i][j] * vector_{0}[j];", s,
        size));
    out_.close();
    for (std::size_t j = 0; j < size; ++j) {
      out_.line(
          fmt::format("const Real {} = product_{}[{}];", names.local(solve.solution[j]), s, j));
    }
  }

  CodeWriter& out_;
  CppContext& context_;
  const MemberParts& parts_;
  const Linearisation& value_;
};

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

void write_member_tangent(CodeWriter& out, CppContext& context, const MemberParts& parts,
                          StepRole role) {
  if (!context.program.plan.sweeps) {
    LinearisationWriter(out, context, parts).write(tangent_name(role));
    return;
  }
  write_hessian_function(out, context);
  write_stage_matrix(out, context);
  out.lines(fmt::format(kSwept, fmt::arg("name", tangent_name(role)),
                        fmt::arg("size", 2 * context.n()), fmt::arg("half", context.n()),
                        fmt::arg("moved", moved_fields(context, "bar")),
                        fmt::arg("sweeps", *context.program.plan.sweeps)));
}

}  // namespace hamgen
