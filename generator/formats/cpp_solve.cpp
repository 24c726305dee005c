// The function that solves the equations of a member's step.
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_member.hpp"

namespace hamgen {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class SolveWriter {
 public:
  SolveWriter(CppContext& context, const MemberParts& parts, const CoefficientText& coefficients)
      : context_(context), parts_(parts), coefficient_text_(coefficients) {}

  void write(CodeWriter& out) {
    Names names;
    for (const char* local :
         {"size", "scale", "iteration", "verdict", "progress", "length", "matrix", "increment",
          "carry", "vector", "regular", "sweep", "part", "i", "j", "rule"}) {
      names.reserve(local);
    }
    for (const auto& [symbol, text] : coefficient_text_) names.set(symbol, text);
    const CppExpression cpp = context_.expression(names);
    std::set<std::string> used;
    auto collect = [&](const std::vector<Statement>& statements) {
      for (const Statement& s : statements) collect_symbols(s.value, used);
    };
    for (const Stage& stage : context_.program.stages) {
      collect(stage.before);
      collect(stage.after);
      if (!stage.solve) continue;
      const Solve& solve = *stage.solve;
      collect(solve.body);
      for (const LoopVariable& v : solve.variables) {
        for (const Expression& e : {v.cold, v.next, v.correction}) collect_symbols(e, used);
      }
      for (const Expression& e : solve.residual) collect_symbols(e, used);
    }
    for (const Expression& e : context_.program.increments) collect_symbols(e, used);
    for (int i = 0; i < 2 * context_.n(); ++i) {
      names.set("carry(" + context_.variable_name(i) + ")", "carry." + context_.state_field(i));
    }
    // Loop variables that are started from the state need it for their scale too.
    out.line("// dz = Z - z for one step from z + carry.");
    std::string signature =
        "[[nodiscard]] inline StepReport solve([[maybe_unused]] const Parameters& par, ";
    if (parts_.coefficients) signature += "const Coefficients& k, ";
    signature +=
        "[[maybe_unused]] Real h, [[maybe_unused]] const State& z, [[maybe_unused]] const State& "
        "carry, ";
    if (parts_.has_start()) signature += "Start& start, ";
    const bool moves = std::ranges::any_of(context_.program.increments,
                                           [](const Expression& e) { return !e.is_zero(); });
    out.open(signature + (moves ? "State& dz)" : "[[maybe_unused]] State& dz)"));
    out.line("StepReport report;");
    if (parts_.inverse) out.line("if (!k.regular) return report;");
    context_.load_state(out, names, used);
    int unknown = 0;
    for (std::size_t s = 0; s < context_.program.stages.size(); ++s) {
      const Stage& stage = context_.program.stages[s];
      write_statements(out, cpp, names, stage.before);
      if (stage.solve) write_loop(out, cpp, names, *stage.solve, s, unknown);
      if (stage.solve && stage.solve->kind == BlockKind::newton) {
        out.line(
            "// The last increments correct the gradient to first order: no evaluation at the "
            "solution.");
      }
      write_statements(out, cpp, names, stage.after);
    }
    std::string size;
    for (int i = 0; i < 2 * context_.n(); ++i) {
      if (context_.program.increments[at(i)].is_zero()) continue;
      out.line(fmt::format("dz.{} = {};", context_.state_field(i),
                           cpp(context_.program.increments[at(i)])));
      size += (size.empty() ? "" : " + ") + fmt::format("dz.{0} * dz.{0}", context_.state_field(i));
    }
    if (!size.empty()) {
      out.line("// False for infinities and NaN alike.");
      out.line("const Real length = " + size + ";");
      out.line(fmt::format("report.converged = length <= {};", context_.scalar.largest));
      out.line("if (!report.converged) report.increment = length;");
    } else {
      out.line("report.converged = true;");
    }
    out.line("return report;");
    out.close();
    out.line();
    context_.note(cpp);
  }

 private:
  static std::string magnitude(const std::string& x) {
    return x.starts_with('-') ? "magnitude(" + x.substr(1) + ")" : "magnitude(" + x + ")";
  }

  void write_loop(CodeWriter& out, const CppExpression& cpp, Names& names, const Solve& solve,
                  std::size_t s, int& unknown) {
    // What the loop computes and later code uses is declared before the loop.
    std::set<std::string> needed;
    for (const LoopVariable& v : solve.variables) collect_symbols(v.correction, needed);
    for (std::size_t later = s; later < context_.program.stages.size(); ++later) {
      const Stage& stage = context_.program.stages[later];
      for (const Statement& st : stage.after) collect_symbols(st.value, needed);
      if (later == s) continue;
      for (const Statement& st : stage.before) collect_symbols(st.value, needed);
      if (stage.solve) {
        for (const Statement& st : stage.solve->body) collect_symbols(st.value, needed);
        for (const Expression& e : stage.solve->residual) collect_symbols(e, needed);
        for (const auto& row : stage.solve->matrix) {
          for (const Expression& e : row) collect_symbols(e, needed);
        }
        for (const LoopVariable& v : stage.solve->variables) {
          for (const Expression& e : {v.cold, v.next, v.correction}) collect_symbols(e, needed);
        }
      }
    }
    for (const Expression& e : context_.program.increments) collect_symbols(e, needed);
    if (solve.kind == BlockKind::linear) {
      write_linear(out, cpp, names, solve, s);
      return;
    }
    if (solve.sweeps) {
      write_sweeps(out, cpp, names, solve);
      return;
    }
    const int first = unknown;
    const auto size = static_cast<int>(solve.variables.size());
    unknown += size;
    std::set<std::string> declared;
    for (const Statement& st : solve.body) {
      if (!needed.contains(st.name)) continue;
      declared.insert(st.name);
      out.line(fmt::format("Real {} = {};", names.local(st.name), literal(0, context_.scalar)));
    }
    const bool array = !solve.corrections.empty();
    for (int j = 0; j < size; ++j) {
      const LoopVariable& v = solve.variables[at(j)];
      out.line(fmt::format("Real {} = start.known ? start.value[{}] : {};", names.local(v.name),
                           first + j, cpp(v.cold)));
    }
    if (array) {
      for (const std::string& c : solve.corrections) {
        out.line(fmt::format("Real {} = {};", names.local(c), literal(0, context_.scalar)));
      }
    }
    if (solve.kind == BlockKind::newton) {
      write_newton(out, cpp, names, solve, s, declared);
    } else {
      write_fixed_point(out, cpp, names, solve, s, declared);
    }
    for (int j = 0; j < size; ++j) {
      const LoopVariable& v = solve.variables[at(j)];
      std::string value = names.local(v.name);
      if (solve.kind == BlockKind::newton) {
        value += " + " + (array ? names.local(solve.corrections[at(j)]) : cpp(v.correction));
      }
      out.line(fmt::format("start.value[{}] = {};", first + j, value));
    }
  }

  std::string scale_of(const Solve& solve, const CppExpression& cpp, Names& names) {
    std::string scale;
    for (const LoopVariable& v : solve.variables) {
      scale += (scale.empty() ? "" : " + ") + length_of(v, cpp, names);
    }
    return scale;
  }
  // What an unknown is rounded with.
  static std::string length_of(const LoopVariable& v, const CppExpression& cpp, Names& names) {
    return magnitude(names.local(v.name)) + " + " + magnitude(cpp(v.cold));
  }

  void write_newton(CodeWriter& out, const CppExpression& cpp, Names& names, const Solve& solve,
                    std::size_t s, const std::set<std::string>& declared) {
    const std::string rule = fmt::format("start.rule_{}", s);
    const bool array = !solve.corrections.empty();
    out.line(
        "// Newton's iteration for the stage values: residual R, its derivatives, increments "
        "delta.");
    out.line(rule + ".begin();");
    out.open("for (int iteration = 1;; ++iteration)");
    write_statements(out, cpp, names, solve.body, declared);
    std::vector<std::string> corrections;
    if (array) {
      const std::size_t m = solve.matrix.size();
      out.line(matrix_type(parts_, m) + " matrix;");
      write_matrix(out, cpp, "matrix", solve);
      std::string values;
      for (const Expression& r : solve.residual) values += (values.empty() ? "" : ", ") + cpp(-r);
      out.line(fmt::format("Real vector[{}] = {{{}}};", m, values));
      out.line("const bool regular = matrix.factorise();");
      out.line("if (regular) matrix.solve(vector);");
      for (std::size_t j = 0; j < m; ++j) {
        corrections.push_back(names.local(solve.corrections[j]));
        out.line(fmt::format("{} = vector[{}];", corrections.back(), j));
      }
    } else {
      for (const LoopVariable& v : solve.variables) corrections.push_back(cpp(v.correction));
    }
    std::string size;
    for (const std::string& c : corrections) size += (size.empty() ? "" : " + ") + magnitude(c);
    out.line(fmt::format("const Real size = {};", size));
    out.line(fmt::format("const Real scale = {};", scale_of(solve, cpp, names)));
    out.line(fmt::format("const Verdict verdict = {}(size, scale, iteration);", rule));
    out.open(array ? "if (verdict == Verdict::failed || !regular)"
                   : "if (verdict == Verdict::failed)");
    out.line("report.iterations += iteration;");
    out.line("report.increment = size;");
    out.line("return report;");
    out.close();
    out.open("if (verdict == Verdict::done)");
    out.line("report.iterations += iteration;");
    out.line("break;");
    out.close();
    for (std::size_t j = 0; j < corrections.size(); ++j) {
      out.line(fmt::format("{} += {};", names.local(solve.variables[j].name), corrections[j]));
    }
    out.close();
  }

  void write_fixed_point(CodeWriter& out, const CppExpression& cpp, Names& names,
                         const Solve& solve, std::size_t s, const std::set<std::string>& declared) {
    const std::size_t m = solve.variables.size();
    const std::string rule = fmt::format("rule_{}", s);
    out.line(fmt::format("FixedPointRule<{}, 2> {};", m, rule));
    out.open("for (int iteration = 1;; ++iteration)");
    write_statements(out, cpp, names, solve.body, declared);
    std::string values;
    for (const LoopVariable& v : solve.variables) {
      values += (values.empty() ? "" : ", ") + cpp(v.next - Expression::symbol(v.name));
    }
    out.line(fmt::format("const Real increment[{}] = {{{}}};", m, values));
    std::string lengths;
    std::string scale;
    for (std::size_t j = 0; j < m; ++j) {
      lengths += (j == 0 ? "" : ", ") + length_of(solve.variables[j], cpp, names);
      scale += fmt::format("{}length[{}]", j == 0 ? "" : " + ", j);
    }
    out.line(fmt::format("const Real length[{}] = {{{}}};", m, lengths));
    out.line("const Real scale = " + scale + ";");
    for (std::size_t j = 0; j < m; ++j) {
      out.line(fmt::format("{} += increment[{}];", names.local(solve.variables[j].name), j));
    }
    out.line("const Verdict verdict = " + rule + "(increment, length, scale, iteration);");
    out.line("if (verdict == Verdict::go_on) continue;");
    out.line("report.iterations += iteration;");
    out.line("if (verdict == Verdict::done) break;");
    out.line("report.increment = " + rule + ".size;");
    out.line("return report;");
    out.close();
  }

  void write_sweeps(CodeWriter& out, const CppExpression& cpp, Names& names, const Solve& solve) {
    out.line("// Predictor: grad H at z.");
    for (const LoopVariable& v : solve.variables) {
      out.line(fmt::format("Real {} = {};", names.local(v.name), cpp(v.cold)));
    }
    out.open(fmt::format("for (int sweep = 0; sweep < {}; ++sweep)", *solve.sweeps));
    write_statements(out, cpp, names, solve.body);
    std::vector<std::string> next;
    for (const LoopVariable& v : solve.variables) {
      next.push_back(names.unique(names.local(v.name) + "_next"));
      out.line(fmt::format("const Real {} = {};", next.back(), cpp(v.next)));
    }
    for (std::size_t j = 0; j < next.size(); ++j) {
      out.line(fmt::format("{} = {};", names.local(solve.variables[j].name), next[j]));
    }
    out.close();
    for (const LoopVariable& v : solve.variables) {
      out.line(fmt::format("const Real {} = {};", names.local(v.name + "*"), names.local(v.name)));
    }
    out.line(fmt::format("report.iterations = {};", *solve.sweeps));
  }

  // A linear system too large to be written out.
  void write_linear(CodeWriter& out, const CppExpression& cpp, Names& names, const Solve& solve,
                    std::size_t s) {
    const std::size_t m = solve.matrix.size();
    std::string values;
    for (const Expression& r : solve.residual) values += (values.empty() ? "" : ", ") + cpp(-r);
    const std::string vector = fmt::format("vector_{}", s);
    out.line(fmt::format("{}Real {}[{}] = {{{}}};", solve.constant_matrix ? "const " : "", vector,
                         m, values));
    if (solve.constant_matrix) {
      const std::string product = fmt::format("product_{}", s);
      out.line(fmt::format("Real {}[{}] = {{}};", product, m));
      out.open(fmt::format("for (int i = 0; i < {}; ++i)", m));
      out.line(fmt::format("for (int j = 0; j < {}; ++j) {}[i] += k.{}[i][j] * {}[j];", m, product,
                           inverse_name(s), vector));
      out.close();
      for (std::size_t j = 0; j < m; ++j) {
        out.line(
            fmt::format("const Real {} = {}[{}];", names.local(solve.corrections[j]), product, j));
      }
      return;
    }
    const std::string matrix = fmt::format("matrix_{}", s);
    out.line(fmt::format("{} {};", matrix_type(parts_, m), matrix));
    write_matrix(out, cpp, matrix, solve);
    out.line(fmt::format("if (!{}.factorise()) return report;", matrix));
    out.line(fmt::format("{}.solve({});", matrix, vector));
    for (std::size_t j = 0; j < m; ++j) {
      out.line(
          fmt::format("const Real {} = {}[{}];", names.local(solve.corrections[j]), vector, j));
    }
  }

  CppContext& context_;
  const MemberParts& parts_;
  const CoefficientText& coefficient_text_;
};

}  // namespace

void write_solve(CodeWriter& out, CppContext& context, const MemberParts& parts,
                 const CoefficientText& coefficients) {
  SolveWriter(context, parts, coefficients).write(out);
}

}  // namespace hamgen
