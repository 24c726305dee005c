#include "generator/formats/cpp_member.hpp"

#include <fmt/format.h>

#include "generator/formats/cpp_refinement.hpp"
#include "generator/formats/cpp_support.hpp"

namespace hamgen {

namespace {

std::string elimination_text(const CppContext& context, const MemberParts& parts) {
  return parts.eigen ? cpp_eigen_solve() : cpp_elimination(context.scalar);
}

}  // namespace

MemberParts member_parts(const Program& program, const ScalarType& scalar) {
  MemberParts parts;
  for (const Stage& stage : program.stages) {
    if (!stage.solve) continue;
    const Solve& solve = *stage.solve;
    if (solve.linear_solver != LinearSolver::written_out) {
      // Eigen does not know quad numbers.
      const bool quad = scalar.digits == 113;
      (solve.linear_solver == LinearSolver::eigen_dense && !quad ? parts.eigen
                                                                 : parts.elimination) = true;
      if (solve.constant_matrix) parts.inverse = true;
    }
    if (solve.kind == BlockKind::newton) parts.newton = true;
    if (solve.simplified) parts.simplified = true;
    if (solve.kind == BlockKind::fixed_point && !solve.sweeps) parts.fixed_point = true;
    if (!solve.sweeps) {
      for (const LoopVariable& v : solve.variables) parts.unknowns.push_back(v.name);
    }
  }
  parts.rest = !program.rests.empty();
  parts.coefficients = !program.coefficients.empty() || parts.inverse;
  return parts;
}

std::string inverse_name(std::size_t stage) { return fmt::format("inverse_{}", stage); }

CoefficientText write_prepare(CodeWriter& out, CppContext& context, const MemberParts& parts,
                              const std::vector<ScaledNumbers>& scaled) {
  CoefficientText coefficient_text;
  Names names;
  const CppExpression cpp = context.expression(names);
  std::vector<std::pair<std::string, std::string>> members;
  CodeWriter code;
  Substitution meaning;
  int count = 0;
  for (const Statement& s : context.program.coefficients) {
    const std::string field = fmt::format("c{}", ++count);
    const Expression full = substitute(s.value, meaning);
    meaning[s.name] = full;
    std::string text = to_text(full);
    if (text.size() > 70) text = text.substr(0, 67) + "...";
    members.emplace_back(fmt::format("Real {} = {};", field, literal(0, context.scalar)), text);
    code.line(fmt::format("k.{} = {};", field, cpp(s.value)));
    names.set(s.name, "k." + field);
    coefficient_text[s.name] = "k." + field;
  }
  for (std::size_t s = 0; s < context.program.stages.size(); ++s) {
    const auto& solve = context.program.stages[s].solve;
    if (!solve || !solve->constant_matrix) continue;
    const std::size_t m = solve->matrix.size();
    members.emplace_back(fmt::format("Real {}[{}][{}] = {{}};", inverse_name(s), m, m), "");
    code.line(fmt::format("Real matrix_{}[{}][{}] = {{}};", s, m, m));
    write_matrix(code, cpp, fmt::format("matrix_{}", s), *solve);
    code.line(fmt::format("k.regular = invert(matrix_{}, k.{}) && k.regular;", s, inverse_name(s)));
  }
  if (parts.inverse) members.emplace_back("bool regular = true;", "");
  for (const auto& [name, values] : scaled) {
    members.emplace_back(fmt::format("Real {}[{}] = {{}};", name, values.size()), "");
    for (std::size_t i = 0; i < values.size(); ++i) {
      code.line(fmt::format("k.{}[{}] = {} * h;", name, i, literal(values[i], context.scalar)));
    }
  }
  if (parts.inverse) out.lines(elimination_text(context, parts) + "\n" + cpp_inverse() + "\n");
  out.line("// What depends on h and the parameters alone.");
  out.open("struct Coefficients");
  out.aligned(members);
  out.close(";");
  out.line();
  out.open(
      "inline Coefficients prepare([[maybe_unused]] const Parameters& par, "
      "[[maybe_unused]] Real h)");
  out.line("Coefficients k;");
  out.lines(code.text());
  out.line("return k;");
  out.close();
  out.line();
  context.note(cpp);
  return coefficient_text;
}

void write_matrix(CodeWriter& out, const CppExpression& cpp, const std::string& name,
                  const Solve& solve) {
  for (std::size_t i = 0; i < solve.matrix.size(); ++i) {
    for (std::size_t j = 0; j < solve.matrix[i].size(); ++j) {
      if (solve.matrix[i][j].is_zero()) continue;
      out.line(fmt::format("{}[{}][{}] = {};", name, i, j, cpp(solve.matrix[i][j])));
    }
  }
}

void write_support(CodeWriter& out, const CppContext& context, const MemberParts& parts) {
  out.lines(cpp_two_sum() + "\n");
  if (parts.rest) out.lines(cpp_sum_with_rest() + "\n");
  if ((parts.elimination || parts.eigen) && !parts.inverse)
    out.lines(elimination_text(context, parts) + "\n");
  if (parts.newton) out.lines(cpp_newton_rule(context.scalar, parts.simplified) + "\n");
  if (parts.fixed_point) {
    out.lines(cpp_fixed_point_rule(context.scalar) + "\n");
    out.lines(cpp_refinement(context.scalar) + "\n");
  }
  if (parts.has_start()) {
    out.line("// Start values of the implicit equations and what is remembered of their solution.");
    out.open("struct Start");
    out.line(fmt::format("Real value[{}] = {{}};", parts.unknowns.size()));
    out.line("bool known = false;  // else the state itself is the start");
    for (std::size_t s = 0; s < context.program.stages.size(); ++s) {
      const auto& solve = context.program.stages[s].solve;
      if (solve && solve->kind == BlockKind::newton)
        out.line(fmt::format("NewtonRule rule_{};", s));
    }
    out.close(";");
    out.line();
  }
}

}  // namespace hamgen
