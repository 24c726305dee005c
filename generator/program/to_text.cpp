// A program as text: what `hamgen show --stage program` prints.
#include <fmt/format.h>

#include "generator/program/loops_text.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

namespace {

void print(std::string& text, const std::vector<Statement>& statements, const char* indent) {
  for (const Statement& s : statements) {
    text += fmt::format("{}{} = {}\n", indent, s.name, to_text(s.value));
  }
}

}  // namespace

std::string to_text(const Program& program) {
  if (program.plan.arrays) return loops_text(program);
  std::string text = to_text(program.sequence) + "once per run:\n";
  print(text, program.coefficients, "  ");
  for (const Stage& stage : program.stages) {
    text += "straight-line:\n";
    print(text, stage.before, "  ");
    if (stage.solve) {
      const Solve& solve = *stage.solve;
      text += solve.sweeps                      ? fmt::format("{} sweeps:\n", *solve.sweeps)
              : solve.kind == BlockKind::linear ? std::string("solve:\n")
                                                : std::string("iterate:\n");
      print(text, solve.body, "  ");
      for (std::size_t i = 0; i < solve.residual.size(); ++i) {
        text += fmt::format("  residual {} = {}\n", i + 1, to_text(solve.residual[i]));
        for (std::size_t j = 0; j < solve.matrix[i].size(); ++j) {
          if (solve.matrix[i][j].is_zero()) continue;
          text += fmt::format("  matrix {} {} = {}\n", i + 1, j + 1, to_text(solve.matrix[i][j]));
        }
      }
      for (const LoopVariable& v : solve.variables) {
        if (solve.kind == BlockKind::fixed_point) {
          text += fmt::format("  next {} = {}\n", v.name, to_text(v.next));
        }
      }
      text += "then:\n";
      print(text, stage.after, "  ");
    }
  }
  text += "increments:\n";
  for (std::size_t i = 0; i < program.increments.size(); ++i) {
    text += fmt::format("  {}: {}\n", program.plan.equations.mechanics.variables[i].name,
                        to_text(program.increments[i]));
  }
  return text;
}

}  // namespace hamgen
