#include "generator/program/coefficients.hpp"

#include <fmt/format.h>

#include "generator/program/linear_terms.hpp"

namespace hamgen {

std::string inverse_name(std::size_t stage) { return fmt::format("inverse_{}", stage); }

bool is_inverted(const Solve& solve) {
  return solve.constant_matrix && solve.linear_solver != LinearSolver::written_out;
}

void put_matrix(Body& body, const std::string& name,
                const std::vector<std::vector<Expression>>& entries, MatrixForm form) {
  const auto size = static_cast<int>(entries.size());
  const bool symmetric = form == MatrixForm::symmetric;
  body.push_back({Matrix{
      .name = name, .size = size, .large = form == MatrixForm::large, .symmetric = symmetric}});
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < (symmetric ? i + 1 : size); ++j) {
      const Expression& entry = entries[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      if (!entry.is_zero()) body.push_back({Put{{name}, {i, {}}, {j, {}}, entry}});
    }
  }
}

MatrixForm form_of(const Solve& solve) {
  if (solve.linear_solver == LinearSolver::eigen_dense) return MatrixForm::large;
  for (std::size_t i = 0; i < solve.matrix.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (solve.matrix[i][j] != solve.matrix[j][i]) return MatrixForm::plain;
    }
  }
  return MatrixForm::symmetric;
}

namespace {

// A text that is too long to be read says nothing: the assignment does.
std::string remark_of(const std::string& name, const Expression& value) {
  const std::string whole = is_high_part(name) ? to_text(value / kHighPart) : "";
  const std::string text =
      whole.empty() ? to_text(value) : fmt::format("most of {}, and no simple fraction", whole);
  return text.size() > 70 ? "" : text;
}

}  // namespace

Coefficients coefficients_of(const Environment& environment, const LoweredStep& lowered,
                             const std::vector<ScaledNumbers>& scaled) {
  Coefficients result{.record = {.name = "Coefficients",
                                 .fields = {},
                                 .remark = {"What depends on h and the parameters alone."}},
                      .prepare = {.name = "prepare",
                                  .result = {.type = "Coefficients", .object = "k"},
                                  .arguments = {parameters_argument(), {.name = "h"}}},
                      .places = {}};
  std::vector<Field>& fields = result.record.fields;
  Routine& prepare = result.prepare;
  Substitution meaning;
  for (const Statement& s : lowered.coefficients) {
    const std::string field = fmt::format("c{}", fields.size() + 1);
    const Expression full = substitute(s.value, meaning);
    meaning[s.name] = full;
    fields.push_back({.name = field, .remark = remark_of(s.name, full)});
    result.places[s.name] = {.object = "k", .field = field};
    prepare.body.push_back({Assign{s.name, s.value}});
  }
  bool inverted = false;
  for (std::size_t s = 0; s < lowered.stages.size(); ++s) {
    const auto& solve = lowered.stages[s].solve;
    if (!solve || !is_inverted(*solve)) continue;
    inverted = true;
    const auto size = static_cast<int>(solve->matrix.size());
    const std::string matrix = fmt::format("matrix_{}", s);
    fields.push_back({.name = inverse_name(s), .sizes = {size, size}});
    put_matrix(
        prepare.body, matrix, solve->matrix,
        solve->linear_solver == LinearSolver::eigen_dense ? MatrixForm::large : MatrixForm::plain);
    prepare.body.push_back({Invert{matrix, {"k", inverse_name(s)}, {"k", "regular"}}});
  }
  if (inverted) fields.push_back({.name = "regular", .values = {1}, .type = "bool"});
  for (const auto& [name, values] : scaled) {
    fields.push_back({.name = name, .sizes = {static_cast<int>(values.size())}});
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string symbol = fmt::format("k.{}({})", name, i);
      prepare.places[symbol] = {"k", name, {{.constant = static_cast<long>(i), .factors = {}}}};
      prepare.body.push_back({Assign{symbol, Expression(numeric_value(values[i])) * step_size()}});
    }
  }
  environment.bind_parameters(prepare);
  for (const auto& [symbol, place] : result.places) prepare.places.insert_or_assign(symbol, place);
  return result;
}

}  // namespace hamgen
