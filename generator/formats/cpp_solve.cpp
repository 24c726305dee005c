// The function that solves the equations of a member's step.
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_member.hpp"
#include "generator/formats/cpp_refinement.hpp"

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
         {"size",    "scale",  "iteration", "verdict", "progress", "length", "matrix", "increment",
          "carry",   "vector", "regular",   "sweep",   "part",     "i",      "j",      "rule",
          "product", "rest",   "more",      "lack",    "gradient", "point"}) {
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
      for (const Expression& e : solve.gradient) collect_symbols(e, used);
    }
    for (const Expression& e : context_.program.increments) collect_symbols(e, used);
    for (const Expression& e : context_.program.rests) collect_symbols(e, used);
    for (int i = 0; i < 2 * context_.n(); ++i) {
      names.set("carry(" + context_.variable_name(i) + ")", "carry." + context_.state_field(i));
    }
    // Loop variables that are started from the state need it for their scale too.
    out.line(parts_.rest ? "// dz + rest = Z - z for one step from z + carry; rest is small."
                         : "// dz = Z - z for one step from z + carry.");
    std::string signature =
        "[[nodiscard]] inline StepReport solve([[maybe_unused]] const Parameters& par, ";
    if (parts_.coefficients) signature += "const Coefficients& k, ";
    signature +=
        "[[maybe_unused]] Real h, [[maybe_unused]] const State& z, [[maybe_unused]] const State& "
        "carry, ";
    if (parts_.has_start()) signature += "Start& start, ";
    const bool moves = std::ranges::any_of(context_.program.increments,
                                           [](const Expression& e) { return !e.is_zero(); });
    signature += moves ? "State& dz" : "[[maybe_unused]] State& dz";
    if (parts_.rest) signature += moves ? ", State& rest" : ", [[maybe_unused]] State& rest";
    out.open(signature + ")");
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
      if (parts_.rest) {
        out.line(fmt::format("rest.{} = {};", context_.state_field(i),
                             cpp(context_.program.rests[at(i)])));
      }
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
    for (const Expression& e : context_.program.rests) collect_symbols(e, needed);
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
      scale += (scale.empty() ? "" : " + ") + magnitude(names.local(v.name)) + " + " +
               magnitude(cpp(v.cold));
    }
    return scale;
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
      for (const std::string& c : solve.corrections) corrections.push_back(names.local(c));
      write_system(out, cpp, solve, s, corrections);
    } else {
      for (const LoopVariable& v : solve.variables) corrections.push_back(cpp(v.correction));
    }
    std::string size;
    for (const std::string& c : corrections) size += (size.empty() ? "" : " + ") + magnitude(c);
    out.line(fmt::format("const Real size = {};", size));
    out.line(fmt::format("const Real scale = {};", scale_of(solve, cpp, names)));
    out.line(fmt::format("const Verdict verdict = {}(size, scale, iteration);", rule));
    out.open(array && !solve.constant_matrix ? "if (verdict == Verdict::failed || !regular)"
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

  // The increments -matrix^-1 residual: by elimination, or with the inverse of a constant matrix.
  void write_system(CodeWriter& out, const CppExpression& cpp, const Solve& solve, std::size_t s,
                    const std::vector<std::string>& increments) {
    const std::size_t m = solve.matrix.size();
    if (!solve.constant_matrix) {
      out.line(fmt::format("Real matrix[{0}][{0}] = {{}};", m));
      write_matrix(out, cpp, "matrix", solve);
    }
    std::string values;
    for (const Expression& r : solve.residual) values += (values.empty() ? "" : ", ") + cpp(-r);
    out.line(fmt::format("{}Real vector[{}] = {{{}}};", solve.constant_matrix ? "const " : "", m,
                         values));
    if (solve.constant_matrix) {
      out.line(fmt::format("Real product[{}] = {{}};", m));
      out.open(fmt::format("for (int i = 0; i < {}; ++i)", m));
      out.line(fmt::format("for (int j = 0; j < {}; ++j) product[i] += k.{}[i][j] * vector[j];", m,
                           inverse_name(s)));
      out.close();
    } else {
      out.line("const bool regular = eliminate(matrix, vector);");
    }
    for (std::size_t j = 0; j < m; ++j) {
      out.line(fmt::format("{} = {}[{}];", increments[j],
                           solve.constant_matrix ? "product" : "vector", j));
    }
  }

  void write_fixed_point(CodeWriter& out, const CppExpression& cpp, Names& names,
                         const Solve& solve, std::size_t s, const std::set<std::string>& declared) {
    const std::size_t m = solve.variables.size();
    const std::string rule = fmt::format("rule_{}", s);
    out.line(fmt::format("FixedPointRule<{}> {};", m, rule));
    out.open("for (int iteration = 1;; ++iteration)");
    write_statements(out, cpp, names, solve.body, declared);
    std::string values;
    for (const LoopVariable& v : solve.variables) {
      values += (values.empty() ? "" : ", ") + cpp(v.next - Expression::symbol(v.name));
    }
    out.line(fmt::format("const Real increment[{}] = {{{}}};", m, values));
    out.line(fmt::format("const Real scale = {};", scale_of(solve, cpp, names)));
    for (std::size_t j = 0; j < m; ++j) {
      out.line(fmt::format("{} += increment[{}];", names.local(solve.variables[j].name), j));
    }
    out.line("const Progress progress = " + rule + "(increment, scale, iteration);");
    out.line("if (progress == Progress::go_on) continue;");
    out.line("report.iterations += iteration;");
    out.line("if (progress == Progress::done) break;");
    out.line("for (const Real part : increment) report.increment += magnitude(part);");
    out.line("return report;");
    out.close();
    write_refinement(out, cpp, names, solve, s, declared);
  }

  // What the equations lack at the rounded solution, solved for as well: see cpp_refinement.hpp.
  void write_refinement(CodeWriter& out, const CppExpression& cpp, Names& names, const Solve& solve,
                        std::size_t s, const std::set<std::string>& declared) {
    const std::size_t m = solve.variables.size();
    const std::size_t components = solve.gradient.size();
    const auto list = [](std::size_t count, const auto& item) {
      std::string text;
      for (std::size_t j = 0; j < count; ++j) text += (j == 0 ? "" : ", ") + item(j);
      return text;
    };
    out.comment("// ", refinement_remark());
    out.line(fmt::format("Refinement<{}, {}> refinement_{};", m, components, s));
    const std::vector<std::string> kept(declared.begin(), declared.end());
    out.line(fmt::format("Real kept_{}[{}] = {{}};", s, std::max<std::size_t>(kept.size(), 1)));
    out.open(fmt::format("for (bool more = true; more;)"));
    write_statements(out, cpp, names, solve.body, declared);
    out.line(fmt::format("const Real lack[{}] = {{{}}};", m, list(m, [&](std::size_t j) {
                           const LoopVariable& v = solve.variables[j];
                           return cpp(v.next - Expression::symbol(v.name));
                         })));
    out.line(fmt::format("const Real gradient[{}] = {{{}}};", components,
                         list(components, [&](std::size_t j) { return cpp(solve.gradient[j]); })));
    out.open(fmt::format("if (refinement_{}.rounds == 0)", s));
    for (std::size_t j = 0; j < kept.size(); ++j) {
      out.line(fmt::format("kept_{}[{}] = {};", s, j, names.local(kept[j])));
    }
    out.close();
    out.line(fmt::format("Real point[{}] = {{{}}};", m, list(m, [&](std::size_t j) {
                           return names.local(solve.variables[j].name);
                         })));
    out.line(fmt::format("more = refinement_{}(point, lack, gradient);", s));
    for (std::size_t j = 0; j < m; ++j) {
      out.line(fmt::format("{} = point[{}];", names.local(solve.variables[j].name), j));
    }
    out.close();
    for (std::size_t j = 0; j < kept.size(); ++j) {
      out.line(fmt::format("{} = kept_{}[{}];", names.local(kept[j]), s, j));
    }
    for (std::size_t j = 0; j < components; ++j) {
      names.set(solve.changes[j], fmt::format("refinement_{}.change[{}]", s, j));
    }
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
