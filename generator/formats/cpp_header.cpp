#include "generator/formats/cpp_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/code_writer.hpp"
#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_expression.hpp"
#include "generator/formats/cpp_support.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

constexpr const char* kArguments =
    "[[maybe_unused]] const Parameters& par, [[maybe_unused]] const State& z";

// Elements of one declared name: a scalar member or an array member of a struct.
struct Group {
  std::string name;  // of the member
  bool is_array = false;
  long first = 0;
  std::vector<const Quantity*> elements;
};

std::vector<Group> group(const std::vector<Quantity>& quantities, std::set<std::string> taken = {}) {
  std::vector<Group> groups;
  std::string last;
  for (const Quantity& quantity : quantities) {
    const ElementName element = split_element(quantity.name);
    if (groups.empty() || !element.indexed || last != element.base) {
      std::string name = member_identifier(element.base);
      while (!taken.insert(name).second) name += "_";
      groups.push_back({name, element.indexed, element.index, {}});
      last = element.indexed ? element.base : "";
    }
    groups.back().elements.push_back(&quantity);
  }
  return groups;
}

// "q" or "q[2]" as a member of a struct: field name per quantity, in order.
std::vector<std::string> fields(const std::vector<Group>& groups) {
  std::vector<std::string> result;
  for (const Group& g : groups) {
    for (std::size_t i = 0; i < g.elements.size(); ++i) {
      result.push_back(g.is_array ? fmt::format("{}[{}]", g.name, i) : g.name);
    }
  }
  return result;
}

// The user's words as the end of a // comment: a line's end there, or a backslash before it, would
// let the compiler read on.
std::string one_line(std::string text) {
  std::ranges::replace_if(text, [](unsigned char c) { return c < ' '; }, ' ');
  return text.ends_with('\\') ? text + "." : text;
}

std::string remark(const Quantity& quantity) {
  std::string text = quantity.comment;
  std::ranges::replace(text, '\\', '/');
  if (!quantity.unit.empty()) text += (text.empty() ? "[" : " [") + quantity.unit + "]";
  return text;
}

class HeaderWriter {
 public:
  HeaderWriter(const Program& program, const CppOptions& options)
      : program_(program), options_(options), scalar_(find_scalar(options.scalar)),
        equations_(program.plan.equations), mechanics_(equations_.mechanics) {
    // A large system's state is two arrays, whatever the model calls their parts.
    for (int i = 0; i < 2 * n(); ++i) {
      variables_.push_back(mechanics_.variables[at(i)]);
      if (!arrays()) continue;
      variables_.back() = {fmt::format("{}[{}]", i < n() ? "q" : "p", i % n()), "", "", 0};
    }
    parameters_ = mechanics_.parameters;
    if (uses_energy_parameter()) {
      parameters_.push_back({"E0", "", "energy of the initial state: set it before use", 0});
    }
    parameter_groups_ = group(parameters_);
    state_groups_ = group(variables_);
    state_fields_ = fields(state_groups_);
    const std::vector<std::string> parameter_fields = fields(parameter_groups_);
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      parameter_text_[parameters_[i].name] = "par." + parameter_fields[i];
    }
    collect_loops();
  }

  std::string header() {
    CodeWriter body;
    write_body(body);
    CodeWriter out;
    write_preamble(out);
    out.line("#pragma once");
    write_includes(out);
    out.line();
    out.lines(body.text());
    return out.text();
  }

  std::string plugin() {
    CodeWriter body;
    write_body(body);
    CodeWriter out;
    write_preamble(out);
    out.line("#include \"plugin.h\"");
    write_includes(out);
    out.line();
    out.lines(body.text());
    write_interface(out);
    return out.text();
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] int n() const { return mechanics_.degrees_of_freedom; }
  [[nodiscard]] bool arrays() const { return program_.plan.arrays.has_value(); }
  [[nodiscard]] bool array_newton() const {
    return arrays() && program_.plan.arrays->method != ArrayMethod::explicit_a &&
           program_.plan.arrays->method != ArrayMethod::explicit_b;
  }
  [[nodiscard]] bool quad() const { return scalar_.digits == 113; }

  [[nodiscard]] bool uses_energy_parameter() const {
    std::set<std::string> used;
    for (const auto& [place, value] : equations_.stage_matrix) collect_symbols(value, used);
    return used.contains("E0");
  }

  void collect_loops() {
    for (const Stage& stage : program_.stages) {
      if (!stage.solve) continue;
      const Solve& solve = *stage.solve;
      if (solve.linear_solver != LinearSolver::written_out) {
        // Eigen does not know quad numbers.
        (solve.linear_solver == LinearSolver::eigen_dense && !quad() ? eigen_ : elimination_) = true;
        if (solve.constant_matrix) inverse_ = true;
      }
      if (solve.kind == BlockKind::newton) newton_ = true;
      if (solve.kind == BlockKind::fixed_point && !solve.sweeps) fixed_point_ = true;
      if (solve.kind != BlockKind::linear && !solve.sweeps) {
        for (const LoopVariable& v : solve.variables) unknowns_.push_back(v.name);
      }
    }
    coefficients_ = !program_.coefficients.empty() || inverse_;
  }

  [[nodiscard]] bool has_start() const { return !unknowns_.empty(); }

  // A namer for one function: parameters as par.x, the rest as locals.
  [[nodiscard]] CppExpression expression(Names& names) {
    return CppExpression(scalar_, [this, &names](const std::string& symbol) -> std::string {
      if (symbol == "pi") {
        uses_pi_ = true;
        return "pi";
      }
      if (symbol == "h") return "h";
      if (const auto it = parameter_text_.find(symbol); it != parameter_text_.end()) {
        return it->second;
      }
      return names.local(symbol);
    }, options_.builtins);
  }

  void note(const CppExpression& cpp) {
    functions_.insert(cpp.functions().begin(), cpp.functions().end());
  }

  void write_preamble(CodeWriter& out) {
    const Scheme& scheme = equations_.scheme;
    out.line(fmt::format("// {}, {}.  Generated: change the model, not this file.",
                         mechanics_.name, scheme.name));
    out.line("//");
    out.line(fmt::format("//   made by   hamgen {}", HAMGEN_VERSION));
    if (!options_.command.empty()) out.line("//   command   " + one_line(options_.command));
    if (!options_.model_path.empty()) out.line("//   model     " + one_line(options_.model_path));
    std::string formula = mechanics_.hamiltonian_text;
    std::ranges::replace(formula, '\n', ' ');
    out.comment("//   H(q, p) = ", formula);
    out.line(fmt::format("//   scheme    {}: order {}{}{}", scheme.description, scheme.order,
                         scheme.symmetric ? ", symmetric" : "",
                         program_.plan.sweeps ? ", not symplectic" : ", symplectic"));
    out.comment("//   solve     ", program_.plan.solver);
    bool first = true;
    for (const std::string& item : program_.plan.left_out) {
      out.comment(first ? "//   left out  " : "//             ", item);
      first = false;
    }
    Cost straight;
    Cost iteration;
    auto accumulate = [](Cost& total, const Cost& more) {
      total.additions += more.additions;
      total.multiplications += more.multiplications;
      total.divisions += more.divisions;
      total.functions += more.functions;
    };
    for (const Stage& stage : program_.stages) {
      accumulate(straight, cost(stage.before));
      accumulate(straight, cost(stage.after));
      if (stage.solve) accumulate(iteration, cost(stage.solve->body));
    }
    if (arrays()) return;
    if (iteration == Cost{}) {
      out.line("//   cost      per step: " + to_text(straight));
    } else {
      out.line(fmt::format("//   cost      per iteration: {}; per step besides: {}",
                           to_text(iteration), to_text(straight)));
    }
  }

  void write_includes(CodeWriter& out) {
    if (quad()) {
      // Declared here rather than by <quadmath.h>, which clang does not find.
      std::set<std::string> declared;
      for (const std::string& function : functions_) {
        const Function* row = find_function(function);
        const bool two = function == "pow" || (row != nullptr && row->arity == 2);
        const std::string name = row != nullptr ? std::string(row->quad) : function + "q";
        if (function == "fabs" || !declared.insert(name).second) continue;
        if (declared.size() == 1) {
          out.line();
          out.line("extern \"C\" {");
        }
        out.line(fmt::format("__extension__ __float128 {}(__float128{}) noexcept;", name,
                             two ? ", __float128" : ""));
      }
      if (!declared.empty()) out.line("}");
    } else if (!functions_.empty() && !options_.builtins) {
      out.line("#include <cmath>");
    }
    if (array_newton() && !program_.plan.arrays->bandwidth) {
      out.line("#include <algorithm>");
      out.line("#include <vector>");
      out.line();
      out.line("#include <Eigen/SparseLU>");
    } else if (eigen_) {
      out.line();
      out.line("#include <Eigen/LU>");
    }
  }

  void write_body(CodeWriter& out) {
    CodeWriter inner;
    write_types(inner);
    if (arrays()) {
      inner.lines(cpp_compensated_sum() + "\n");
      if (array_newton()) {
        const bool reduced = program_.plan.arrays->method == ArrayMethod::reduced_newton;
        inner.lines(cpp_newton_rule(scalar_) + "\n");
        inner.lines(cpp_history(reduced ? n() : 2 * n()) + "\n");
      }
      write_array_program(inner, program_, scalar_, options_.builtins, parameter_text_, functions_);
      write_invariants(inner);
      open_namespace(out);
      out.line(fmt::format("inline constexpr int n = {};  // degrees of freedom", n()));
      out.line();
      out.lines(inner.text());
      out.line(fmt::format("}}  // namespace {}", options_.name_space));
      return;
    }
    write_functions(inner);
    if (coefficients_) write_prepare(inner);
    write_support(inner);
    write_solve(inner);
    write_step(inner);
    write_propagator(inner);
    open_namespace(out);
    out.line();
    out.lines(inner.text());
    out.line(fmt::format("}}  // namespace {}", options_.name_space));
  }

  void open_namespace(CodeWriter& out) {
    out.line(fmt::format("namespace {} {{", options_.name_space));
    out.line();
    out.line(quad() ? "__extension__ typedef __float128 Real;"
                    : fmt::format("using Real = {};", scalar_.cpp));
    if (uses_pi_) {
      // 50 digits, rounded by the compiler where the type is standard.
      const Rational pi = *parse_decimal("3.14159265358979323846264338327950288419716939937510");
      out.line(fmt::format("inline constexpr Real pi = {};", literal(pi, scalar_)));
    }
  }

  void write_struct(CodeWriter& out, const std::string& name, const std::vector<Group>& groups,
                    bool defaults) {
    if (groups.empty()) {
      out.line("struct " + name + " {};");
      return;
    }
    out.open("struct " + name);
    std::vector<std::pair<std::string, std::string>> members;
    for (const Group& g : groups) {
      const Quantity& first = *g.elements.front();
      if (g.is_array) {
        std::string values;
        for (const Quantity* element : g.elements) {
          if (!defaults) break;
          values += (values.empty() ? "" : ", ") + literal(element->value, scalar_);
        }
        members.emplace_back(fmt::format("Real {}[{}] = {{{}}};", g.name, g.elements.size(), values),
                             remark(first));
      } else {
        members.emplace_back(fmt::format("Real {} = {};", g.name,
                                         literal(defaults ? first.value : Rational(0), scalar_)),
                             remark(first));
      }
    }
    out.aligned(members);
    out.close(";");
  }

  void write_types(CodeWriter& out) {
    write_struct(out, "Parameters", parameter_groups_, true);
    out.line();
    write_struct(out, "State", state_groups_, false);
    out.line();
    out.line("// On failure the increment says how far the iteration was from its end; it is not finite");
    out.line("// where the step left the domain of H.");
    out.open("struct StepReport");
    out.line("bool converged = false;");
    out.line("int iterations = 0;");
    out.line(fmt::format("Real increment = {};", literal(0, scalar_)));
    out.close(";");
    out.line();
    if (newton_ || fixed_point_ || elimination_ || array_newton()) {
      out.lines(cpp_magnitude(scalar_, options_.builtins) + "\n");
      functions_.insert("fabs");
    }
  }

  // Locals for the state variables that the statements use.
  void load_state(CodeWriter& out, Names& names, const std::set<std::string>& used) {
    for (int i = 0; i < 2 * n(); ++i) {
      const std::string& name = mechanics_.variables[at(i)].name;
      if (!used.contains(name)) continue;
      out.line(fmt::format("const Real {} = z.{};", names.local(name), state_fields_[at(i)]));
    }
  }

  void write_statements(CodeWriter& out, CppExpression& cpp, Names& names,
                        const std::vector<Statement>& statements,
                        const std::set<std::string>& declared = {}) {
    for (const Statement& s : statements) {
      const std::string value = cpp(s.value);
      const std::string& name = names.local(s.name);
      if (declared.contains(s.name)) {
        out.line(fmt::format("{} = {};", name, value));
      } else {
        out.line(fmt::format("const Real {} = {};", name, value));
      }
    }
  }

  static std::set<std::string> used_symbols(const std::vector<Statement>& statements) {
    std::set<std::string> used;
    for (const Statement& s : statements) collect_symbols(s.value, used);
    return used;
  }

  void write_evaluation(CodeWriter& out, const std::string& signature, const Evaluation& evaluation,
                        const std::function<void(CodeWriter&, CppExpression&)>& finish) {
    Names names;
    names.reserve("values");
    CppExpression cpp = expression(names);
    std::set<std::string> used = used_symbols(evaluation.statements);
    for (const Expression& e : evaluation.results) collect_symbols(e, used);
    out.open(signature);
    load_state(out, names, used);
    write_statements(out, cpp, names, evaluation.statements);
    finish(out, cpp);
    out.close();
    out.line();
    note(cpp);
  }

  void write_functions(CodeWriter& out) {
    out.line("// H(q, p).");
    write_evaluation(out, "inline Real energy(" + std::string(kArguments) + ")", program_.energy,
                     [&](CodeWriter& w, CppExpression& cpp) {
                       w.line("return " + cpp(program_.energy.results[0]) + ";");
                     });
    write_invariants(out);
    if (options_.gradient) {
      out.line("// grad H, the derivatives by q first.");
      write_evaluation(out,
                       fmt::format("inline void gradient({}, Real (&values)[{}])", kArguments, 2 * n()),
                       program_.gradient, [&](CodeWriter& w, CppExpression& cpp) {
                         for (std::size_t i = 0; i < program_.gradient.results.size(); ++i) {
                           w.line(fmt::format("values[{}] = {};", i,
                                              cpp(program_.gradient.results[i])));
                         }
                       });
    }
  }

  void write_invariants(CodeWriter& out) {
    if (!mechanics_.invariants.empty()) {
      std::string list;
      for (const NamedExpression& i : mechanics_.invariants) {
        list += (list.empty() ? "" : ", ") + i.name;
      }
      out.line("// The model's invariants: " + list + ".");
      write_evaluation(
          out,
          fmt::format("inline void invariants({}, Real (&values)[{}])", kArguments,
                      mechanics_.invariants.size()),
          program_.invariants, [&](CodeWriter& w, CppExpression& cpp) {
            for (std::size_t i = 0; i < program_.invariants.results.size(); ++i) {
              w.line(fmt::format("values[{}] = {};", i, cpp(program_.invariants.results[i])));
            }
          });
    }
  }

  static std::string inverse_name(std::size_t stage) { return fmt::format("inverse_{}", stage); }

  // What h and the parameters alone decide: computed once per run.
  void write_prepare(CodeWriter& out) {
    Names names;
    CppExpression cpp = expression(names);
    std::vector<std::pair<std::string, std::string>> members;
    CodeWriter code;
    Substitution meaning;
    int count = 0;
    for (const Statement& s : program_.coefficients) {
      const std::string field = fmt::format("c{}", ++count);
      const Expression full = substitute(s.value, meaning);
      meaning[s.name] = full;
      std::string text = to_text(full);
      if (text.size() > 70) text = text.substr(0, 67) + "...";
      members.emplace_back(fmt::format("Real {} = {};", field, literal(0, scalar_)), text);
      code.line(fmt::format("k.{} = {};", field, cpp(s.value)));
      names.set(s.name, "k." + field);
      coefficient_text_[s.name] = "k." + field;
    }
    for (std::size_t s = 0; s < program_.stages.size(); ++s) {
      const auto& solve = program_.stages[s].solve;
      if (!solve || !solve->constant_matrix) continue;
      const std::size_t m = solve->matrix.size();
      members.emplace_back(fmt::format("Real {}[{}][{}] = {{}};", inverse_name(s), m, m), "");
      code.line(fmt::format("Real matrix_{}[{}][{}] = {{}};", s, m, m));
      write_matrix(code, cpp, fmt::format("matrix_{}", s), *solve);
      code.line(fmt::format("k.regular = invert(matrix_{}, k.{}) && k.regular;", s, inverse_name(s)));
    }
    if (inverse_) members.emplace_back("bool regular = true;", "");
    if (inverse_) out.lines(elimination_text() + "\n" + cpp_inverse() + "\n");
    support_written_ = inverse_;
    out.line("// What depends on h and the parameters alone.");
    out.open("struct Coefficients");
    out.aligned(members);
    out.close(";");
    out.line();
    out.open("inline Coefficients prepare([[maybe_unused]] const Parameters& par, "
             "[[maybe_unused]] Real h)");
    out.line("Coefficients k;");
    out.lines(code.text());
    out.line("return k;");
    out.close();
    out.line();
    note(cpp);
  }

  void write_matrix(CodeWriter& out, CppExpression& cpp, const std::string& name,
                    const Solve& solve) {
    for (std::size_t i = 0; i < solve.matrix.size(); ++i) {
      for (std::size_t j = 0; j < solve.matrix[i].size(); ++j) {
        if (solve.matrix[i][j].is_zero()) continue;
        out.line(fmt::format("{}[{}][{}] = {};", name, i, j, cpp(solve.matrix[i][j])));
      }
    }
  }

  [[nodiscard]] std::string elimination_text() const {
    return eigen_ ? cpp_eigen_solve() : cpp_elimination(scalar_);
  }

  void write_support(CodeWriter& out) {
    out.lines(cpp_compensated_sum() + "\n");
    if ((elimination_ || eigen_) && !support_written_) out.lines(elimination_text() + "\n");
    if (newton_) out.lines(cpp_newton_rule(scalar_) + "\n");
    if (fixed_point_) out.lines(cpp_fixed_point_rule(scalar_) + "\n");
    if (has_start()) {
      out.line("// Start values of the implicit equations and what is remembered of their solution.");
      out.open("struct Start");
      out.line(fmt::format("Real value[{}] = {{}};", unknowns_.size()));
      out.line("bool known = false;  // else the state itself is the start");
      for (std::size_t s = 0; s < program_.stages.size(); ++s) {
        const auto& solve = program_.stages[s].solve;
        if (solve && solve->kind == BlockKind::newton) out.line(fmt::format("NewtonRule rule_{};", s));
      }
      out.close(";");
      out.line();
    }
  }

  // Names for the step function: coefficients as k.c1, everything else local.
  void write_solve(CodeWriter& out) {
    Names names;
    for (const char* local : {"size", "scale", "iteration", "verdict", "progress", "length", "matrix",
                              "increment", "vector", "regular", "sweep", "part", "i", "j", "rule"}) {
      names.reserve(local);
    }
    for (const auto& [symbol, text] : coefficient_text_) names.set(symbol, text);
    CppExpression cpp = expression(names);
    std::set<std::string> used;
    auto collect = [&](const std::vector<Statement>& statements) {
      for (const Statement& s : statements) collect_symbols(s.value, used);
    };
    for (const Stage& stage : program_.stages) {
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
    for (const Expression& e : program_.increments) collect_symbols(e, used);
    // Loop variables that are started from the state need it for their scale too.
    out.line("// dz = Z - z for one step from z.");
    std::string signature = "[[nodiscard]] inline StepReport solve([[maybe_unused]] const Parameters& par, ";
    if (coefficients_) signature += "const Coefficients& k, ";
    signature += "[[maybe_unused]] Real h, [[maybe_unused]] const State& z, ";
    if (has_start()) signature += "Start& start, ";
    out.open(signature + "State& dz)");
    out.line("StepReport report;");
    if (inverse_) out.line("if (!k.regular) return report;");
    load_state(out, names, used);
    int unknown = 0;
    for (std::size_t s = 0; s < program_.stages.size(); ++s) {
      const Stage& stage = program_.stages[s];
      write_statements(out, cpp, names, stage.before);
      if (stage.solve) write_loop(out, cpp, names, *stage.solve, s, unknown);
      if (stage.solve && stage.solve->kind == BlockKind::newton) {
        out.line("// The last increments correct the gradient to first order: no evaluation at the solution.");
      }
      write_statements(out, cpp, names, stage.after);
    }
    std::string size;
    for (int i = 0; i < 2 * n(); ++i) {
      if (program_.increments[at(i)].is_zero()) continue;
      out.line(fmt::format("dz.{} = {};", state_fields_[at(i)], cpp(program_.increments[at(i)])));
      size += (size.empty() ? "" : " + ") + fmt::format("dz.{0} * dz.{0}", state_fields_[at(i)]);
    }
    if (!size.empty()) {
      out.line("// False for infinities and NaN alike.");
      out.line("const Real length = " + size + ";");
      out.line(fmt::format("report.converged = length <= {};", scalar_.largest));
      out.line("if (!report.converged) report.increment = length;");
    } else {
      out.line("report.converged = true;");
    }
    out.line("return report;");
    out.close();
    out.line();
    note(cpp);
  }

  static std::string magnitude(const std::string& x) {
    return x.starts_with('-') ? "magnitude(" + x.substr(1) + ")" : "magnitude(" + x + ")";
  }

  void write_loop(CodeWriter& out, CppExpression& cpp, Names& names, const Solve& solve,
                  std::size_t s, int& unknown) {
    // What the loop computes and later code uses is declared before the loop.
    std::set<std::string> needed;
    for (std::size_t later = s; later < program_.stages.size(); ++later) {
      const Stage& stage = program_.stages[later];
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
    for (const Expression& e : program_.increments) collect_symbols(e, needed);
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
      out.line(fmt::format("Real {} = {};", names.local(st.name), literal(0, scalar_)));
    }
    const bool array = !solve.corrections.empty();
    for (int j = 0; j < size; ++j) {
      const LoopVariable& v = solve.variables[at(j)];
      out.line(fmt::format("Real {} = start.known ? start.value[{}] : {};", names.local(v.name),
                           first + j, cpp(v.cold)));
    }
    if (array) {
      for (const std::string& c : solve.corrections) {
        out.line(fmt::format("Real {} = {};", names.local(c), literal(0, scalar_)));
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

  std::string scale_of(const Solve& solve, CppExpression& cpp, Names& names) {
    std::string scale;
    for (const LoopVariable& v : solve.variables) {
      scale += (scale.empty() ? "" : " + ") + magnitude(names.local(v.name)) + " + " +
               magnitude(cpp(v.cold));
    }
    return scale;
  }

  void write_newton(CodeWriter& out, CppExpression& cpp, Names& names, const Solve& solve,
                    std::size_t s, const std::set<std::string>& declared) {
    const std::string rule = fmt::format("start.rule_{}", s);
    const bool array = !solve.corrections.empty();
    out.line("// Newton's iteration for the stage values: residual R, its derivatives, increments delta.");
    out.line(rule + ".begin();");
    out.open("for (int iteration = 1;; ++iteration)");
    write_statements(out, cpp, names, solve.body, declared);
    std::vector<std::string> corrections;
    if (array) {
      const std::size_t m = solve.matrix.size();
      out.line(fmt::format("Real matrix[{0}][{0}] = {{}};", m));
      write_matrix(out, cpp, "matrix", solve);
      std::string values;
      for (const Expression& r : solve.residual) values += (values.empty() ? "" : ", ") + cpp(-r);
      out.line(fmt::format("Real vector[{}] = {{{}}};", m, values));
      out.line("const bool regular = eliminate(matrix, vector);");
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

  void write_fixed_point(CodeWriter& out, CppExpression& cpp, Names& names, const Solve& solve,
                         std::size_t s, const std::set<std::string>& declared) {
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
  }

  void write_sweeps(CodeWriter& out, CppExpression& cpp, Names& names, const Solve& solve) {
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
  void write_linear(CodeWriter& out, CppExpression& cpp, Names& names, const Solve& solve,
                    std::size_t s) {
    const std::size_t m = solve.matrix.size();
    std::string values;
    for (const Expression& r : solve.residual) values += (values.empty() ? "" : ", ") + cpp(-r);
    const std::string vector = fmt::format("vector_{}", s);
    out.line(fmt::format("{}Real {}[{}] = {{{}}};", solve.constant_matrix ? "const " : "", vector, m,
                         values));
    if (solve.constant_matrix) {
      const std::string product = fmt::format("product_{}", s);
      out.line(fmt::format("Real {}[{}] = {{}};", product, m));
      out.open(fmt::format("for (int i = 0; i < {}; ++i)", m));
      out.line(fmt::format("for (int j = 0; j < {}; ++j) {}[i] += k.{}[i][j] * {}[j];", m, product,
                           inverse_name(s), vector));
      out.close();
      for (std::size_t j = 0; j < m; ++j) {
        out.line(fmt::format("const Real {} = {}[{}];", names.local(solve.corrections[j]), product, j));
      }
      return;
    }
    const std::string matrix = fmt::format("matrix_{}", s);
    out.line(fmt::format("Real {}[{}][{}] = {{}};", matrix, m, m));
    write_matrix(out, cpp, matrix, solve);
    out.line(fmt::format("if (!eliminate({}, {})) return report;", matrix, vector));
    for (std::size_t j = 0; j < m; ++j) {
      out.line(fmt::format("const Real {} = {}[{}];", names.local(solve.corrections[j]), vector, j));
    }
  }

  [[nodiscard]] std::string solve_call(const std::string& par, const std::string& k,
                                       const std::string& h, const std::string& z,
                                       const std::string& start) const {
    std::string text = "solve(" + par + ", ";
    if (coefficients_) text += k + ", ";
    text += h + ", " + z + ", ";
    if (has_start()) text += start + ", ";
    return text + "dz)";
  }

  void write_step(CodeWriter& out) {
    out.line("// Advances z by one step of size h.  On failure z is left unchanged.");
    out.open("[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z)");
    if (coefficients_) out.line("const Coefficients k = prepare(par, h);");
    if (has_start()) out.line("Start start;");
    out.line("State dz;");
    out.line("const StepReport report = " + solve_call("par", "k", "h", "z", "start") + ";");
    out.line("if (!report.converged) return report;");
    for (int i = 0; i < 2 * n(); ++i) {
      if (program_.increments[at(i)].is_zero()) continue;
      out.line(fmt::format("z.{0} += dz.{0};", state_fields_[at(i)]));
    }
    out.line("return report;");
    out.close();
    out.line();
  }

  void write_propagator(CodeWriter& out) {
    if (has_start()) out.lines(cpp_history(static_cast<int>(unknowns_.size())) + "\n");
    out.line(has_start()
                 ? "// Many steps: start values are extrapolated, rounding errors of the updates carried along."
                 : "// Many steps: rounding errors of the updates are carried along.");
    out.open("class Propagator");
    out.dedent();
    out.line(" public:");
    out.indent();
    std::string initialisers = "par_(par), h_(h), z_(z)";
    if (coefficients_) initialisers += ", k_(prepare(par, h))";
    const std::string constructor = "Propagator(const Parameters& par, Real h, const State& z)";
    if (constructor.size() + initialisers.size() > 90) {
      out.line(constructor);
      out.line("    : " + initialisers + " {}");
    } else {
      out.line(constructor + " : " + initialisers + " {}");
    }
    out.line();
    out.line("// One step; on failure the state stays as it was.");
    out.open("StepReport step()");
    out.line("State dz;");
    const std::string call = solve_call("par_", "k_", "h_", "z_", "start_");
    if (has_start()) {
      out.line("start_.known = history_.known > 0;");
      out.line("if (start_.known) history_.extrapolate(start_.value);");
      out.line("StepReport report = " + call + ";");
      out.open("if (!report.converged && start_.known)");
      out.line("// Extrapolation may lead astray, the state itself seldom does.");
      out.line("const int wasted = report.iterations;");
      out.line("start_ = Start();");
      out.line("report = " + call + ";");
      out.line("report.iterations += wasted;");
      out.close();
      out.line("if (!report.converged) return report;");
      out.line("history_.record(start_.value);");
    } else {
      out.line("const StepReport report = " + call + ";");
      out.line("if (!report.converged) return report;");
    }
    for (int i = 0; i < 2 * n(); ++i) {
      if (program_.increments[at(i)].is_zero()) continue;
      out.line(fmt::format("add(z_.{0}, carry_.{0}, dz.{0});", state_fields_[at(i)]));
    }
    out.line("return report;");
    out.close();
    out.line();
    out.line("// Up to `steps` steps; stops at the first failure.  The report sums the iterations.");
    out.open("StepReport advance(long long steps)");
    out.line("StepReport total;");
    out.line("total.converged = true;");
    out.open("for (long long i = 0; i < steps; ++i)");
    out.line("const StepReport report = step();");
    out.line("total.iterations += report.iterations;");
    out.line("total.increment = report.increment;");
    out.open("if (!report.converged)");
    out.line("total.converged = false;");
    out.line("break;");
    out.close();
    out.close();
    out.line("return total;");
    out.close();
    out.line();
    out.line("[[nodiscard]] const State& state() const { return z_; }");
    out.line();
    out.dedent();
    out.line(" private:");
    out.indent();
    out.line("Parameters par_;");
    out.line("Real h_;");
    out.line("State z_;");
    out.line("State carry_;");
    if (coefficients_) out.line("Coefficients k_;");
    if (has_start()) {
      out.line("Start start_;");
      out.line("History history_;");
    }
    out.close(";");
    out.line();
  }

  // Copies an array of doubles into a struct's fields.
  void write_fill(CodeWriter& out, const std::string& target, const std::vector<std::string>& names,
                  const std::string& values) {
    if (arrays() && target == "result" && values == "state") {
      const std::string low = scalar_.digits <= 53 ? "" : " + (state_lo ? Real(state_lo[{0}]) : Real(0))";
      out.open("for (int i = 0; i < n; ++i)");
      out.line("result.q[i] = static_cast<Real>(state[i])" + fmt::format(fmt::runtime(low), "i") + ";");
      out.line("result.p[i] = static_cast<Real>(state[n + i])" + fmt::format(fmt::runtime(low), "n + i") + ";");
      out.close();
      return;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (scalar_.digits <= 53) {
        out.line(fmt::format("{}.{} = static_cast<Real>({}[{}]);", target, names[i], values, i));
      } else {
        out.line(fmt::format("{0}.{1} = Real({2}[{3}]) + ({2}_lo ? Real({2}_lo[{3}]) : Real(0));",
                             target, names[i], values, i));
      }
    }
  }

  void write_interface(CodeWriter& out) {
    const std::string description = fmt::format("{}, {}", mechanics_.name, equations_.scheme.name);
    const auto parameter_fields = fields(parameter_groups_);
    out.line();
    out.line("// The interface of plugin.h.");
    out.line(fmt::format("using namespace {};", options_.name_space));
    out.line();
    out.open("struct hamgen_run");
    out.line("Propagator propagator;");
    out.line("Parameters par;");
    out.close(";");
    out.line();
    out.line("namespace {");
    out.line();
    auto fill = [&](const std::string& name, const std::string& type,
                    const std::vector<std::string>& names, const std::string& values) {
      out.open(fmt::format("{0} {1}([[maybe_unused]] const double* {2}, [[maybe_unused]] const "
                           "double* {2}_lo)",
                           type, name, values));
      out.line(type + " result;");
      write_fill(out, "result", names, values);
      out.line("return result;");
      out.close();
      out.line();
    };
    fill("read_parameters", "Parameters", parameter_fields, "parameters");
    fill("read_state", "State", state_fields_, "state");
    out.lines(R"(hamgen_run* create(const double* parameters, const double* parameters_lo, double h, double h_lo,
                   const double* state, const double* state_lo) {
  const Parameters par = read_parameters(parameters, parameters_lo);
  return new hamgen_run{Propagator(par, static_cast<Real>(h) + static_cast<Real>(h_lo), read_state(state, state_lo)), par};
}

void destroy(hamgen_run* run) { delete run; }

void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  hamgen_report total{HAMGEN_DONE, 0, 0, 0, 0.0, 0.0, 0.0, 0.0};
  for (long long i = 0; i < steps; ++i) {
    const StepReport last = run->propagator.step();
    total.last_iterations = last.iterations;
    total.last_increment = static_cast<double>(last.increment);
    if (!last.converged) {
      const bool finite = total.last_increment - total.last_increment == 0.0;
      total.status = finite ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE;
      break;
    }
    total.iterations += last.iterations;
    ++total.steps_done;
    if (watch_energy) {
      const double now = static_cast<double>(energy(run->par, run->propagator.state()));
      if (i == 0 || now < total.energy_min) total.energy_min = now;
      if (i == 0 || now > total.energy_max) total.energy_max = now;
      total.energy_last = now;
      if (!(now - now == 0.0)) {
        total.status = HAMGEN_NOT_FINITE;
        break;
      }
    }
  }
  *report = total;
}
)");
    out.line();
    out.open("void get_state(const hamgen_run* run, double* state, double* state_lo)");
    out.line("const State& z = run->propagator.state();");
    if (arrays()) {
      out.open("for (int i = 0; i < 2 * n; ++i)");
      out.line("const Real value = i < n ? z.q[i] : z.p[i - n];");
      out.line("state[i] = static_cast<double>(value);");
      out.line("if (state_lo) state_lo[i] = static_cast<double>(value - static_cast<Real>(state[i]));");
      out.close();
    }
    for (int i = 0; i < (arrays() ? 0 : 2 * n()); ++i) {
      out.line(fmt::format("state[{}] = static_cast<double>(z.{});", i, state_fields_[at(i)]));
      out.line(fmt::format("if (state_lo) state_lo[{0}] = static_cast<double>(z.{1} - "
                           "static_cast<Real>(state[{0}]));",
                           i, state_fields_[at(i)]));
    }
    out.close();
    out.line();
    out.open("double energy_of(const double* parameters, const double* state)");
    out.line("return static_cast<double>(energy(read_parameters(parameters, nullptr), "
             "read_state(state, nullptr)));");
    out.close();
    out.line();
    auto vector_function = [&](const std::string& name, const std::string& function,
                               std::size_t count) {
      out.open(fmt::format("void {}([[maybe_unused]] const double* parameters, [[maybe_unused]] const "
                           "double* state, [[maybe_unused]] double* values)",
                           name));
      if (count != 0) {
        out.line(fmt::format("Real result[{}];", count));
        const bool flat = arrays() && function == "gradient";
        out.line(fmt::format("{}(read_parameters(parameters, nullptr), read_state(state, nullptr){}, result);",
                             function, flat ? ".q" : ""));
        out.line(fmt::format("for (int i = 0; i < {}; ++i) values[i] = static_cast<double>(result[i]);",
                             count));
      }
      out.close();
      out.line();
    };
    vector_function("invariants_of", "invariants", mechanics_.invariants.size());
    vector_function("gradient_of", "gradient", static_cast<std::size_t>(2 * n()));
    out.line(fmt::format("const hamgen_plugin plugin = {{HAMGEN_PLUGIN_VERSION, {}, {}, {}, {}, \"{}\", "
                         "\"{}\", create, destroy, advance, get_state, energy_of, invariants_of, "
                         "gradient_of}};",
                         n(), parameters_.size(), mechanics_.invariants.size(), scalar_.digits,
                         description, program_.plan.solver));
    out.line();
    out.line("}  // namespace");
    out.line();
    out.line("extern \"C\" const hamgen_plugin* hamgen_plugin_entry() { return &plugin; }");
  }

  const Program& program_;
  const CppOptions& options_;
  const ScalarType& scalar_;
  const StepEquations& equations_;
  const Mechanics& mechanics_;
  std::vector<Quantity> variables_;
  std::vector<Quantity> parameters_;
  std::vector<Group> parameter_groups_;
  std::vector<Group> state_groups_;
  std::vector<std::string> state_fields_;
  std::map<std::string, std::string> parameter_text_;
  std::map<std::string, std::string> coefficient_text_;
  std::vector<std::string> unknowns_;
  std::set<std::string> functions_;
  bool newton_ = false, fixed_point_ = false, elimination_ = false, eigen_ = false;
  bool inverse_ = false, coefficients_ = false, support_written_ = false, uses_pi_ = false;
};

}  // namespace

std::string cpp_header(const Program& program, const CppOptions& options) {
  return HeaderWriter(program, options).header();
}

std::string cpp_plugin(const Program& program, const CppOptions& options) {
  CppOptions with_gradient = options;
  with_gradient.gradient = true;
  with_gradient.builtins = true;
  return HeaderWriter(program, with_gradient).plugin();
}

bool needs_eigen(const Program& program) {
  if (program.plan.arrays) return uses_sparse_matrix(*program.plan.arrays);
  return std::ranges::any_of(program.stages, [](const Stage& stage) {
    return stage.solve && stage.solve->linear_solver == LinearSolver::eigen_dense;
  });
}

}  // namespace hamgen
