#include "generator/formats/cpp_member.hpp"

#include <fmt/format.h>

#include "generator/formats/numerics.hpp"

namespace hamgen {

std::string matrix_numerics(const MemberParts& parts) {
  return cpp_numerics(parts.eigen ? "eigen_dense_matrix" : "dense_matrix");
}

std::string matrix_type(const MemberParts& parts, std::size_t size) {
  return fmt::format("{}<{}>", parts.eigen ? "EigenDenseMatrix" : "DenseMatrix", size);
}

MemberParts member_parts(const Program& program, const ScalarType& scalar) {
  MemberParts parts;
  for (std::size_t s = 0; s < program.stages.size(); ++s) {
    if (!program.stages[s].solve) continue;
    const Solve& solve = *program.stages[s].solve;
    if (solve.linear_solver != LinearSolver::written_out) {
      // Eigen does not know quad numbers.
      const bool quad = scalar.digits == 113;
      (solve.linear_solver == LinearSolver::eigen_dense && !quad ? parts.eigen
                                                                 : parts.elimination) = true;
      if (solve.constant_matrix) parts.inverse = true;
    }
    if (solve.kind == BlockKind::newton) {
      parts.newton = true;
      parts.newton_blocks.push_back({s, parts.unknowns.size(), solve.variables.size()});
    }
    if (solve.simplified) parts.simplified = true;
    if (solve.kind == BlockKind::fixed_point && !solve.sweeps) parts.fixed_point = true;
    if (solve.kind != BlockKind::linear && !solve.sweeps) {
      for (const LoopVariable& v : solve.variables) parts.unknowns.push_back(v.name);
    }
  }
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
    code.line(fmt::format("{} matrix_{};", matrix_type(parts, m), s));
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
  if (parts.inverse) out.lines(matrix_numerics(parts) + cpp_numerics("inverse"));
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
      out.line(fmt::format("{}.put({}, {}, {});", name, i, j, cpp(solve.matrix[i][j])));
    }
  }
}

void write_support(CodeWriter& out, const CppContext& context, const MemberParts& parts) {
  out.lines(cpp_numerics("two_sum"));
  if ((parts.elimination || parts.eigen) && !parts.inverse) out.lines(matrix_numerics(parts));
  if (parts.newton || parts.fixed_point) out.lines(cpp_numerics("verdict"));
  if (parts.newton) out.lines(cpp_numerics("newton_rule"));
  if (parts.fixed_point) out.lines(cpp_numerics("fixed_point_rule"));
  if (parts.has_start()) {
    out.line("// Start values of the implicit equations and what is remembered of their solution.");
    out.open("struct Start");
    out.line(fmt::format("Real value[{}] = {{}};", parts.unknowns.size()));
    out.line("bool known = false;  // else the state itself is the start");
    for (std::size_t s = 0; s < context.program.stages.size(); ++s) {
      const auto& solve = context.program.stages[s].solve;
      if (solve && solve->kind == BlockKind::newton)
        out.line(fmt::format("NewtonRule<{}> rule_{};", parts.simplified ? 1 : 2, s));
    }
    out.close(";");
    out.line();
  }
}

}  // namespace hamgen
