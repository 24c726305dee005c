#include "generator/formats/cpp_arrays.hpp"

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

// Which kernels a function sums, by what they read.
enum class Part { all, potential, kinetic };

constexpr std::string_view kLocals[] = {"x", "sum", "gradient", "put", "n"};

// A loop's index: the user's name unless the function around it uses that itself.
std::string loop_index(const std::string& name) {
  const bool taken = std::ranges::find(kLocals, name) != std::end(kLocals);
  return taken ? name + "_index" : identifier(name);
}

std::string affine(const AffineIndex& a) {
  std::string text;
  for (const auto& [index, factor] : a.factors) {
    const std::string name = loop_index(index);
    if (factor == 1) {
      text += (text.empty() ? "" : " + ") + name;
    } else {
      text += fmt::format("{}{} * {}", text.empty() ? "" : " + ", factor, name);
    }
  }
  if (text.empty()) return std::to_string(a.constant);
  if (a.constant > 0) text += fmt::format(" + {}", a.constant);
  if (a.constant < 0) text += fmt::format(" - {}", -a.constant);
  return text;
}

class ArrayWriter {
 public:
  ArrayWriter(CodeWriter& out, const Program& program, const ScalarType& scalar, bool builtins,
              const std::map<std::string, std::string>& parameter_text,
              std::set<std::string>& functions)
      : out_(out), program_(program), mechanics_(program.plan.equations.mechanics),
        scalar_(scalar), builtins_(builtins), parameter_text_(parameter_text), functions_(functions),
        method_(program.plan.arrays->method), constant_(program.plan.arrays->constant_matrix) {}

  void write() {
    write_energy();
    if (mechanics_.is_separable()) {
      write_gradient("potential_gradient", Part::potential, "Adds dH/dq to gradient[0..n-1].");
      write_gradient("kinetic_gradient", Part::kinetic, "Adds dH/dp to gradient[n..2n-1].");
    }
    write_full_gradient();
    if (is_newton()) {
      if (program_.plan.arrays->bandwidth) {
        write_band_matrix(*program_.plan.arrays->bandwidth);
      } else {
        write_sparse_matrix();
      }
      write_hessian(method_ == ArrayMethod::reduced_newton ? Part::potential : Part::all, "hessian");
      if (method_ == ArrayMethod::reduced_newton) write_hessian(Part::kinetic, "masses");
    }
  }

  [[nodiscard]] bool is_newton() const {
    return method_ == ArrayMethod::reduced_newton || method_ == ArrayMethod::full_newton;
  }

 private:
  [[nodiscard]] std::vector<const Kernel*> kernels(Part part) const {
    std::vector<const Kernel*> result;
    for (const Kernel& kernel : mechanics_.kernels) {
      const bool kinetic = uses_momenta(kernel);
      if (part == Part::all || kinetic == (part == Part::kinetic)) result.push_back(&kernel);
    }
    return result;
  }

  // Opens the kernel's loops and computes the wanted expressions; `use` gets them as C++.
  template <class Use>
  void write_kernel(const Kernel& kernel, const std::vector<Expression>& values, Use use) {
    Names names;
    for (const std::string_view local : kLocals) names.reserve(std::string(local));
    for (const KernelRange& range : kernel.ranges) names.reserve(loop_index(range.index));
    for (const Slot& slot : kernel.slots) names.set(slot.symbol, names.unique(slot_name(slot.symbol)));
    const CppExpression cpp(scalar_, [&](const std::string& symbol) -> std::string {
      if (const auto it = parameter_text_.find(symbol); it != parameter_text_.end()) {
        return it->second;
      }
      for (const ParameterSlot& slot : kernel.parameters) {
        if (slot.symbol != symbol) continue;
        return fmt::format("par.{}[{}]", member_identifier(slot.parameter), affine(slot.position));
      }
      for (const KernelRange& range : kernel.ranges) {
        if (range.index == symbol) return fmt::format("Real({})", loop_index(symbol));
      }
      if (symbol == "pi") return literal(*parse_decimal("3.14159265358979323846264338327950288"), scalar_);
      return names.local(symbol);
    }, builtins_);
    std::set<std::string> used;
    for (const Expression& value : values) collect_symbols(value, used);
    const Evaluation evaluation = evaluate_together(values);
    for (const KernelRange& range : kernel.ranges) {
      out_.open(fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", loop_index(range.index),
                            affine(range.lower), affine(range.upper)));
    }
    if (kernel.ranges.empty()) out_.open("");
    for (const Slot& slot : kernel.slots) {
      if (!used.contains(slot.symbol)) continue;
      out_.line(fmt::format("const Real {} = x[{}];", names.local(slot.symbol), affine(slot.position)));
    }
    for (const Statement& s : evaluation.statements) {
      const std::string text = cpp(s.value);
      out_.line(fmt::format("const Real {} = {};", names.local(s.name), text));
    }
    std::vector<std::string> texts;
    for (const Expression& result : evaluation.results) texts.push_back(cpp(result));
    use(texts);
    if (kernel.ranges.empty()) out_.close();
    for (std::size_t i = 0; i < kernel.ranges.size(); ++i) out_.close();
    functions_.insert(cpp.functions().begin(), cpp.functions().end());
  }

  static std::string slot_name(const std::string& symbol) {
    std::string text;
    for (const char c : symbol) {
      if (c == ']') continue;
      if (c == '[') {
        text += '_';
      } else if (c == '+') {
        text += "_plus_";
      } else if (c == '-') {
        text += "_minus_";
      } else if (c == '*') {
        text += "_times_";
      } else {
        text += c;
      }
    }
    return identifier(text);
  }

  void write_energy() {
    out_.line("// H(q, p).");
    out_.open("inline Real energy([[maybe_unused]] const Parameters& par, const State& z)");
    out_.line("const Real* x = z.q;  // p follows q");
    out_.line("Real sum = 0;");
    for (const Kernel& kernel : mechanics_.kernels) {
      write_kernel(kernel, {kernel.value}, [&](const std::vector<std::string>& texts) {
        out_.line("sum += " + texts[0] + ";");
      });
    }
    out_.line("return sum;");
    out_.close();
    out_.line();
  }

  void write_gradient(const std::string& name, Part part, const std::string& comment) {
    out_.line("// " + comment);
    out_.open(fmt::format("inline void {}([[maybe_unused]] const Parameters& par, "
                          "[[maybe_unused]] const Real* x, [[maybe_unused]] Real* gradient)",
                          name));
    for (const Kernel* kernel : kernels(part)) {
      std::vector<Expression> values;
      std::vector<std::string> targets;
      for (std::size_t i = 0; i < kernel->slots.size(); ++i) {
        if (kernel->gradient[i].is_zero()) continue;
        values.push_back(kernel->gradient[i]);
        targets.push_back(affine(kernel->slots[i].position));
      }
      write_kernel(*kernel, values, [&](const std::vector<std::string>& texts) {
        for (std::size_t i = 0; i < texts.size(); ++i) {
          out_.line(fmt::format("gradient[{}] += {};", targets[i], texts[i]));
        }
      });
    }
    out_.close();
    out_.line();
  }

  void write_full_gradient() {
    if (!mechanics_.is_separable()) {
      write_gradient("add_gradient", Part::all, "Adds grad H to gradient[0..2n-1].");
    }
    out_.line("// grad H: the derivatives by q first.");
    out_.open("inline void gradient(const Parameters& par, const Real* x, Real* values)");
    out_.line("for (int i = 0; i < 2 * n; ++i) values[i] = 0;");
    if (mechanics_.is_separable()) {
      out_.line("potential_gradient(par, x, values);");
      out_.line("kinetic_gradient(par, x, values);");
    } else {
      out_.line("add_gradient(par, x, values);");
    }
    out_.close();
    out_.line();
  }

  // put(row, column, value) for every entry, in an order that never changes.
  void write_hessian(Part part, const std::string& name) {
    out_.line("// put(row, column, value) for the second derivatives of H, repeated entries to be added.");
    out_.line("template <class Put>");
    out_.open(fmt::format("inline void {}([[maybe_unused]] const Parameters& par, "
                          "[[maybe_unused]] const Real* x, Put put)",
                          name));
    for (const Kernel* kernel : kernels(part)) {
      if (kernel->hessian.empty()) continue;
      std::vector<Expression> values;
      std::vector<std::pair<std::size_t, std::size_t>> places;
      for (const auto& [place, value] : kernel->hessian) {
        values.push_back(value);
        places.push_back(place);
      }
      write_kernel(*kernel, values, [&](const std::vector<std::string>& texts) {
        for (std::size_t k = 0; k < texts.size(); ++k) {
          const std::string row = affine(kernel->slots[places[k].first].position);
          const std::string column = affine(kernel->slots[places[k].second].position);
          if (places[k].first == places[k].second) {
            out_.line(fmt::format("put({}, {}, {});", row, column, texts[k]));
          } else {
            const std::string entry = fmt::format("entry_{}", k + 1);
            out_.line(fmt::format("const Real {} = {};", entry, texts[k]));
            out_.line(fmt::format("put({}, {}, {});", row, column, entry));
            out_.line(fmt::format("put({}, {}, {});", column, row, entry));
          }
        }
      });
    }
    out_.close();
    out_.line();
  }

  void write_band_matrix(int width) {
    out_.line(fmt::format("// A matrix whose entries lie within {} of the diagonal: elimination with partial",
                          width));
    out_.line("// pivoting, which fills as many diagonals again above it.  Row i holds columns i - width on.");
    out_.open("class BandMatrix");
    out_.dedent();
    out_.lines(fmt::format(R"( public:
  void clear() {{
    for (auto& row : entry_) {{
      for (Real& value : row) value = 0;
    }}
  }}
  void put(int row, int column, Real value) {{ entry_[row][column - row + width] += value; }}
  // False if the matrix is singular or not finite.
  bool factorise() {{
    for (int c = 0; c < n; ++c) {{
      const int last_row = c + width < n ? c + width : n - 1;
      const int last_column = c + 2 * width < n ? c + 2 * width : n - 1;
      int pivot = c;
      for (int r = c + 1; r <= last_row; ++r) {{
        if (magnitude(at(r, c)) > magnitude(at(pivot, c))) pivot = r;
      }}
      if (!(magnitude(at(pivot, c)) > 0)) return false;
      pivot_[c] = pivot;
      if (pivot != c) {{
        for (int j = c; j <= last_column; ++j) {{
          const Real kept = at(c, j);
          at(c, j) = at(pivot, j);
          at(pivot, j) = kept;
        }}
      }}
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {{
        const Real factor = at(r, c) * reciprocal;
        factor_[c][r - c - 1] = factor;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= factor * at(c, j);
      }}
    }}
    return true;
  }}
  void solve(Real (&vector)[n]) const {{
    for (int c = 0; c < n; ++c) {{
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
      const int last_row = c + width < n ? c + width : n - 1;
      for (int r = c + 1; r <= last_row; ++r) vector[r] -= factor_[c][r - c - 1] * vector[c];
    }}
    for (int r = n - 1; r >= 0; --r) {{
      const int last_column = r + 2 * width < n ? r + 2 * width : n - 1;
      for (int j = r + 1; j <= last_column; ++j) vector[r] -= at(r, j) * vector[j];
      vector[r] /= at(r, r);
    }}
  }}

 private:
  static constexpr int width = {width};
  static constexpr int columns = 3 * width + 1;
  Real& at(int row, int column) {{ return entry_[row][column - row + width]; }}
  const Real& at(int row, int column) const {{ return entry_[row][column - row + width]; }}
  Real entry_[n][columns] = {{}};
  Real factor_[n][width > 0 ? width : 1] = {{}};
  int pivot_[n] = {{}};
)",
                           fmt::arg("width", width)));
    out_.indent();
    out_.close(";");
    out_.line();
  }

  void write_sparse_matrix() {
    out_.lines(R"(// A sparse matrix that is filled again and again by the same sequence of entries.  The first filling
// finds the pattern, later ones only add values in place.
class SparseMatrix {
 public:
  explicit SparseMatrix(int size) : size_(size), matrix_(size, size) {}
  void clear() {
    next_ = 0;
    if (known_) std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), Real(0));
  }
  void put(int row, int column, Real value) {
    if (known_) {
      matrix_.valuePtr()[place_[next_++]] += value;
    } else {
      entries_.emplace_back(row, column, value);
    }
  }
  // False if the matrix is singular or not finite.
  bool factorise() {
    if (!known_) find_pattern();
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }
  void solve(Eigen::Matrix<Real, Eigen::Dynamic, 1>& vector) { vector = solver_.solve(vector).eval(); }

 private:
  void find_pattern() {
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    matrix_.makeCompressed();
    for (const Eigen::Triplet<Real>& entry : entries_) {
      const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col()];
      const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[entry.col() + 1];
      const int* found = std::lower_bound(begin, end, entry.row());
      place_.push_back(static_cast<std::size_t>(found - matrix_.innerIndexPtr()));
    }
    solver_.analyzePattern(matrix_);
    entries_.clear();
    known_ = true;
  }
  int size_;
  bool known_ = false;
  std::size_t next_ = 0;
  std::vector<Eigen::Triplet<Real>> entries_;
  std::vector<std::size_t> place_;
  Eigen::SparseMatrix<Real> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<Real>> solver_;
};

)");
  }

  CodeWriter& out_;
  const Program& program_;
  const Mechanics& mechanics_;
  const ScalarType& scalar_;
  bool builtins_;
  const std::map<std::string, std::string>& parameter_text_;
  std::set<std::string>& functions_;
  ArrayMethod method_;
  bool constant_;
};

std::string explicit_step(bool a) {
  // alpha = 0 has bar = (q, P), alpha = 1 has bar = (Q, p).
  if (a) {
    return R"(  StepReport step() {
    for (int i = 0; i < n; ++i) bar_[i] = z_.q[i];
    clear(gradient_);
    potential_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) bar_[n + i] = z_.p[i] - h_ * gradient_[i];
    kinetic_gradient(par_, bar_, gradient_);
    return update();
  }
)";
  }
  return R"(  StepReport step() {
    for (int i = 0; i < n; ++i) bar_[n + i] = z_.p[i];
    clear(gradient_);
    kinetic_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) bar_[i] = z_.q[i] + h_ * gradient_[n + i];
    potential_gradient(par_, bar_, gradient_);
    return update();
  }
)";
}

// Newton on qbar alone.  The kinetic energy is sum m_i p_i^2/2 + d_i p_i, so
//   pbar_i = (p_i - h (1 - alpha) V_i - h beta d_i) / (1 + h beta m_i)
// and the matrix is I + D V'' with D_i = h (h alpha (1 - alpha) m_i / (1 + h beta m_i) - gamma).
std::string reduced_solve(bool constant) {
  const std::string assemble = R"(        matrix_.clear();
        for (int i = 0; i < n; ++i) matrix_.put(i, i, 1);
        hessian(par_, bar_, [&](int row, int column, Real value) {
          matrix_.put(row, column, scale_[row] * value);
        });
        if (!matrix_.factorise()) break;
)";
  return std::string(R"(  // Newton's iteration from bar_; the torn momenta follow from the coordinates.
  bool iterate(StepReport& report) {
    rule_.begin();
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
      for (int i = 0; i < n; ++i) {
        residual_[i] = bar_[i] - z_.q[i] - h_ * (alpha_ * gradient_[n + i] + gamma_ * gradient_[i]);
      }
)") + (constant ? "      if (!factorised_) {\n" + assemble + "        factorised_ = true;\n      }\n"
                : "      {\n" + assemble + "      }\n") +
         R"(      matrix_.solve(residual_);
      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_[i]) + magnitude(z_.q[i]);
        bar_[i] -= residual_[i];
      }
      report.increment = size;
      const Verdict verdict = rule_(size, scale, iteration);
      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) break;
      evaluate();
      return true;
    }
    return false;
  }

  // The gradient at bar_, whose momenta are made from its coordinates.
  void evaluate() {
    clear(gradient_);
    potential_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) {
      const Real momentum = z_.p[i] - h_ * ((1 - alpha_) * gradient_[i] + beta_ * drift_[i]);
      bar_[n + i] = momentum / (1 + h_ * beta_ * mass_[i]);
    }
    kinetic_gradient(par_, bar_, gradient_);
  }
)";
}

std::string full_solve(bool constant) {
  const std::string assemble = R"(        matrix_.clear();
        for (int i = 0; i < 2 * n; ++i) matrix_.put(i, i, 1);
        hessian(par_, bar_, [&](int row, int column, Real value) {
          const int i = row < n ? row : row - n;
          const Real to_q = row < n ? gamma_ : alpha_;
          const Real to_p = row < n ? 1 - alpha_ : beta_;
          matrix_.put(i, column, -h_ * to_q * value);
          matrix_.put(n + i, column, h_ * to_p * value);
        });
        if (!matrix_.factorise()) break;
)";
  return std::string(R"(  // Newton's iteration from bar_ on all stage values.
  bool iterate(StepReport& report) {
    rule_.begin();
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      gradient(par_, bar_, gradient_);
      for (int i = 0; i < n; ++i) {
        const Real by_q = h_ * gradient_[i];
        const Real by_p = h_ * gradient_[n + i];
        residual_[i] = bar_[i] - z_.q[i] - (alpha_ * by_p + gamma_ * by_q);
        residual_[n + i] = bar_[n + i] - z_.p[i] + ((1 - alpha_) * by_q + beta_ * by_p);
      }
)") + (constant ? "      if (!factorised_) {\n" + assemble + "        factorised_ = true;\n      }\n"
                : "      {\n" + assemble + "      }\n") +
         R"(      matrix_.solve(residual_);
      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < 2 * n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_[i]) + magnitude(i < n ? z_.q[i] : z_.p[i - n]);
        bar_[i] -= residual_[i];
      }
      report.increment = size;
      const Verdict verdict = rule_(size, scale, iteration);
      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) break;
      gradient(par_, bar_, gradient_);
      return true;
    }
    return false;
  }
)";
}

}  // namespace

void write_array_program(CodeWriter& out, const Program& program, const ScalarType& scalar,
                         bool builtins, const std::map<std::string, std::string>& parameter_text,
                         std::set<std::string>& functions) {
  CodeWriter mathematics;
  ArrayWriter writer(mathematics, program, scalar, builtins, parameter_text, functions);
  writer.write();
  out.lines(mathematics.text());
  const ArrayPlan& plan = *program.plan.arrays;
  const bool reduced = plan.method == ArrayMethod::reduced_newton;
  const FamilyParameters member =
      uniform_parameters(program.plan.equations.scheme.member()).value();
  const CppExpression cpp(scalar, [&](const std::string& symbol) -> std::string {
    if (symbol == "h") return "h";
    const auto it = parameter_text.find(symbol);
    return it != parameter_text.end() ? it->second : symbol;
  }, builtins);
  out.line("// Many steps: start values are extrapolated, rounding errors of the updates carried along.");
  out.line("class Propagator {");
  out.line(" public:");
  out.indent();
  if (writer.is_newton()) {
    out.line("Propagator([[maybe_unused]] const Parameters& par, Real h, const State& z)");
    const std::string size = reduced ? "n" : "2 * n";
    out.line(fmt::format("    : par_(par), h_(h), z_(z), alpha_({}), beta_({}), gamma_({}){} {{",
                         cpp(member.alpha), cpp(member.beta), cpp(member.gamma),
                         plan.bandwidth ? "" : ", matrix_(" + size + "), residual_(" + size + ")"));
    out.indent();
    if (reduced) {
      out.line("clear(bar_);");
      out.line("clear(gradient_);");
      out.line("kinetic_gradient(par_, bar_, gradient_);");
      out.line("for (int i = 0; i < n; ++i) drift_[i] = gradient_[n + i];");
      out.line("masses(par_, bar_, [&](int row, int, Real value) { mass_[row - n] += value; });");
      out.open("for (int i = 0; i < n; ++i)");
      out.line("const Real inverse = alpha_ * (1 - alpha_) * mass_[i] / (1 + h_ * beta_ * mass_[i]);");
      out.line("scale_[i] = h_ * (h_ * inverse - gamma_);");
      out.close();
    }
    out.close();
  } else {
    out.line("Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}");
  }
  out.line();
  out.line("// One step; on failure the state stays as it was.");
  out.dedent();
  if (!writer.is_newton()) {
    out.lines(explicit_step(plan.method == ArrayMethod::explicit_a));
  } else {
    out.lines(R"(  StepReport step() {
    StepReport report;
    const bool known = history_.known > 0;
    if (known) {
      history_.extrapolate(start_);
      for (int i = 0; i < unknowns; ++i) bar_[i] = start_[i];
    } else {
      start_at_state();
    }
    bool solved = iterate(report);
    if (!solved && known) {
      // Extrapolation may lead astray, the state itself seldom does.
      rule_ = NewtonRule();
      history_ = History();
      start_at_state();
      solved = iterate(report);
    }
    if (!solved) return report;
    for (int i = 0; i < unknowns; ++i) start_[i] = bar_[i];
    const int iterations = report.iterations;
    report = update();
    report.iterations = iterations;
    if (report.converged) history_.record(start_);
    return report;
  }
)");
  }
  out.line();
  out.lines(R"(  // Up to `steps` steps; stops at the first failure.  The report sums the iterations.
  StepReport advance(long long steps) {
    StepReport total;
    total.converged = true;
    for (long long i = 0; i < steps && total.converged; ++i) {
      const StepReport report = step();
      total.iterations += report.iterations;
      total.increment = report.increment;
      total.converged = report.converged;
    }
    return total;
  }

  [[nodiscard]] const State& state() const { return z_; }

 private:
  static void clear(Real (&values)[2 * n]) {
    for (Real& value : values) value = 0;
  }
)");
  if (writer.is_newton()) {
    out.lines(R"(  void start_at_state() {
    for (int i = 0; i < n; ++i) {
      bar_[i] = z_.q[i];
      bar_[n + i] = z_.p[i];
    }
  }
)");
    out.lines(reduced ? reduced_solve(plan.constant_matrix) : full_solve(plan.constant_matrix));
  }
  out.lines(fmt::format(R"(
  // Z = z + h J grad H(zbar).
  StepReport update() {{
    StepReport report;
    Real length = 0;
    for (const Real g : gradient_) length += h_ * g * (h_ * g);
    report.converged = length <= {};
    if (!report.converged) {{
      report.increment = length;
      return report;
    }}
    for (int i = 0; i < n; ++i) {{
      add(z_.q[i], carry_.q[i], h_ * gradient_[n + i]);
      add(z_.p[i], carry_.p[i], -h_ * gradient_[i]);
    }}
    return report;
  }}

  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  Real bar_[2 * n] = {{}};
  Real gradient_[2 * n] = {{}};
)",
                        scalar.largest));
  out.indent();
  if (writer.is_newton()) {
    out.line("static constexpr int unknowns = History::unknowns;");
    out.line("Real alpha_, beta_, gamma_;");
    if (reduced) out.line("Real mass_[n] = {}, drift_[n] = {}, scale_[n] = {};");
    out.line(plan.bandwidth ? "BandMatrix matrix_;" : "SparseMatrix matrix_;");
    out.line(plan.bandwidth ? "Real residual_[n] = {};"
                            : "Eigen::Matrix<Real, Eigen::Dynamic, 1> residual_;");
    out.line("NewtonRule rule_;");
    out.line("History history_;");
    out.line("Real start_[unknowns] = {};");
    if (plan.constant_matrix) out.line("bool factorised_ = false;");
  }
  out.dedent();
  out.line("};");
  out.line();
}

}  // namespace hamgen
