#include "generator/readback/shell.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

// What a part of a step is called with.
struct PartNames {
  std::string par, k, h, z, carry, start, history, dz, rest;
};

std::string solve_call(const Program& code, const PartNames& names) {
  const std::map<std::string, std::string> given = {
      {"par", names.par},     {"k", names.k},         {"h", names.h},   {"z", names.z},
      {"carry", names.carry}, {"start", names.start}, {"dz", names.dz}, {"rest", names.rest}};
  std::string list;
  for (const Argument& argument : code.routine("solve")->arguments) {
    const auto found = given.find(argument.name);
    list += (list.empty() ? "" : ", ") + (found == given.end() ? argument.name : found->second);
  }
  return "solve(" + list + ")";
}

class PropagatorText {
 public:
  explicit PropagatorText(const ShellFacts& facts)
      : facts_(facts),
        code_(facts.code),
        rest_(code_.has_rest()),
        carry_(code_.has_carry()),
        composed_(code_.substeps.size() > 1),
        coefficients_(code_.record("Coefficients") != nullptr),
        start_(code_.record("Start") != nullptr),
        extrapolates_(code_.unknowns > 0) {}

  Pattern propagator() {
    text_ = "class Propagator { public: ";
    constructor();
    composed_ ? composed_step() : single_step();
    advance();
    reset();
    accessors();
    text_ += "private: ";
    if (composed_) {
      text_ += carry_ ? "StepReport substep(int i, State& z, State& carry) {"
                      : "StepReport substep(int i, State& z) {";
      part(
          {"par_", "k_[i]", "lengths_[i]", "z", "carry", "start_[i]", "history_[i]", "dz", "rest"});
      text_ += "}";
    }
    members();
    text_ += "};";
    return {text_, composed_ ? code_.substeps : std::vector<Rational>{}};
  }

  Pattern step() {
    text_ = "[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {";
    if (composed_ || facts_.arrays) {
      text_ +=
          "Propagator propagator(par, h, z); const StepReport report = propagator.step();"
          "if (report.converged) z = propagator.state(); return report; }";
      return {text_};
    }
    if (coefficients_) text_ += "const Coefficients k = prepare(par, h);";
    if (start_) text_ += "Start start;";
    text_ += rest_ ? "State dz, rest;" : "State dz;";
    text_ += "const StepReport report = " +
             solve_call(code_, {"par", "k", "h", "z", "State()", "start", "", "dz", "rest"}) + ";" +
             (code_.unchecked ? "" : "if (!report.converged) return report;");
    each([this](const std::string& x) {
      return fmt::format("z.{0} += dz.{0}{1};", x, rest_ ? " + rest." + x : "");
    });
    text_ += "return report; }";
    return {text_};
  }

 private:
  template <class Line>
  void each(const Line& line) {
    if (facts_.arrays) {
      const std::string i = composed_ ? "j" : "i";
      text_ += fmt::format("for (int {0} = 0; {0} < n; ++{0}) {{ {1} {2} }}", i,
                           line("q[" + i + "]"), line("p[" + i + "]"));
      return;
    }
    for (const Place& place : code_.changed) text_ += line(to_text(place).substr(1));
  }

  void constructor() {
    if (composed_)
      text_ += fmt::format("static constexpr int substeps = {};", code_.substeps.size());
    text_ += "Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z)";
    if (!composed_) {
      text_ += coefficients_ ? ", k_(prepare(par, h)) {}" : "{}";
      return;
    }
    text_ += "{ constexpr Real fractions[substeps] = {";
    for (std::size_t i = 0; i < code_.substeps.size(); ++i)
      text_ += (i == 0 ? "" : ", ") + std::string(kConstant);
    text_ += "}; for (int i = 0; i < substeps; ++i) { lengths_[i] = h * fractions[i];";
    if (coefficients_) text_ += "k_[i] = prepare(par, lengths_[i]);";
    text_ += "} }";
  }

  void single_step() {
    text_ += "StepReport step() {";
    part({"par_", "k_", "h_", "z_", "carry_", "start_", "history_", "dz", "rest"});
    text_ += "}";
  }

  // One solve and the update.
  void part(PartNames names) {
    if (facts_.arrays) {
      names.dz += "_";
      names.rest += "_";
    } else {
      text_ += rest_ ? "State dz, rest;" : "State dz;";
    }
    const std::string call = solve_call(code_, names);
    if (code_.retries) {
      tries(names, call);
    } else {
      text_ += "const StepReport report = " + call + ";";
      if (!code_.unchecked) text_ += "if (!report.converged) return report;";
    }
    each([&](const std::string& x) {
      if (!carry_) return fmt::format("{0}.{2} += {1}.{2};", names.z, names.dz, x);
      return rest_ ? fmt::format("two_sum_with_rest({1}.{0}, {2}.{0}, {3}.{0}, {4}.{0});", x,
                                 names.z, names.carry, names.dz, names.rest)
                   : fmt::format("two_sum({1}.{0}, {2}.{0}, {3}.{0});", x, names.z, names.carry,
                                 names.dz);
    });
    if (!composed_ && facts_.time.empty()) text_ += "++steps_;";
    text_ += "return report;";
  }

  // From an extrapolation, and where that fails from the state.
  void tries(const PartNames& names, const std::string& call) {
    const std::string& start = names.start;
    const std::string known = extrapolates_ ? start + ".known" : "known";
    text_ +=
        extrapolates_
            ? fmt::format("{0}.known = {1}.known > 0; if ({0}.known) {1}.extrapolate({0}.value);",
                          start, names.history)
            : fmt::format("const bool known = {}.known;", start);
    text_ += fmt::format(
        "StepReport report = {}; if (!report.converged && {}) {{"
        "const long long wasted = report.iterations;",
        call, known);
    if (extrapolates_) text_ += forgotten(start);
    text_ += fmt::format(
        "report = {}; report.iterations += wasted; }} if (!report.converged) return report;", call);
    for (const RuleOfNewton& rule : code_.rules)
      text_ += fmt::format("{0}.{1}.watch({2}, {0}.value, {3}, {4});", start, rule.name,
                           names.history, rule.first, rule.count);
    if (extrapolates_) text_ += fmt::format("{}.record({}.value);", names.history, start);
  }

  [[nodiscard]] std::string forgotten(const std::string& start) const {
    if (!facts_.arrays) return start + " = Start();";
    std::string text = start + ".known = false;";
    for (const RuleOfNewton& rule : code_.rules)
      text += fmt::format("{}.{} = {{}};", start, rule.name);
    return text;
  }

  void composed_step() {
    text_ += fmt::format(
        "StepReport step() {{ State z = z_; {} StepReport total;"
        "for (int i = 0; i < substeps; ++i) {{ const StepReport report = substep(i, z{});"
        "total.iterations += report.iterations; total.increment = report.increment;"
        "if (!report.converged)",
        carry_ ? "State carry = carry_;" : "", carry_ ? ", carry" : "");
    if (extrapolates_) {
      text_ += "{";
      if (facts_.arrays) {
        for (const RuleOfNewton& rule : code_.rules)
          text_ += fmt::format("for (Start& start : start_) start.{} = {{}};", rule.name);
      } else {
        text_ += "for (Start& start : start_) start = Start();";
      }
      text_ += "for (auto& history : history_) forget(history); return total; }";
    } else {
      text_ += "return total;";
    }
    text_ += carry_ ? "} z_ = z; carry_ = carry;" : "} z_ = z;";
    if (facts_.time.empty()) text_ += "++steps_;";
    text_ += "total.converged = true; return total; }";
  }

  void unchecked_advance() {
    text_ +=
        "StepReport advance(long long steps) { StepReport total;"
        "for (long long i = 0; i < steps; ++i) static_cast<void>(step()); Real rest = 0;";
    each([](const std::string& x) { return fmt::format("rest += z_.{0} - z_.{0};", x); });
    text_ += "total.converged = rest == 0; total.increment = rest; return total; }";
  }

  void advance() {
    if (code_.unchecked) return unchecked_advance();
    text_ +=
        "StepReport advance(long long steps) { StepReport total; total.converged = true;"
        "for (long long i = 0; i < steps; ++i) { const StepReport report = step();"
        "total.iterations += report.iterations; total.increment = report.increment;"
        "if (!report.converged) { total.converged = false; break; } } return total; }";
  }

  void reset() {
    text_ += "void reset(const State& z) { z_ = z;";
    if (carry_) text_ += "carry_ = State();";
    if (facts_.time.empty()) text_ += "steps_ = 0;";
    if (start_) start_anew();
    if (extrapolates_)
      text_ += composed_ ? "for (auto& history : history_) forget(history);" : "forget(history_);";
    text_ += "}";
  }

  void start_anew() {
    const std::string head = composed_ ? "for (Start& start : start_) " : "";
    const std::string name = composed_ ? "start" : "start_";
    if (!facts_.arrays) {
      text_ += head + name + " = Start();";
      return;
    }
    for (const Field& field : code_.record("Start")->fields) {
      if (!field.sizes.empty() || field.type == "Matrix") continue;
      const std::string value = field.type == "bool"               ? " = false"
                                : field.type == "int"              ? " = 0"
                                : field.type.starts_with("Refine") ? ".rounds = 0"
                                                                   : " = {}";
      text_ += head + name + "." + field.name + value + ";";
    }
  }

  void accessors() {
    text_ += "[[nodiscard]] const State& state() const { return z_; }";
    if (carry_) text_ += "[[nodiscard]] const State& carry() const { return carry_; }";
    text_ += "[[nodiscard]] Real time() const { return ";
    text_ += facts_.time.empty() ? "static_cast<Real>(steps_) * h_" : "z_." + facts_.time;
    text_ +=
        "; } [[nodiscard]] Real h() const { return h_; }"
        "[[nodiscard]] const Parameters& parameters() const { return par_; }";
  }

  void members() {
    const std::string each_part = composed_ ? "[substeps];" : ";";
    text_ += "Parameters par_; Real h_; State z_;";
    if (carry_) text_ += "State carry_;";
    if (facts_.time.empty()) text_ += "long long steps_ = 0;";
    if (composed_) text_ += "Real lengths_[substeps] = {};";
    if (coefficients_) text_ += "Coefficients k_" + each_part;
    if (start_) text_ += "Start start_" + each_part;
    if (extrapolates_) text_ += fmt::format("History<{}> history_{}", code_.unknowns, each_part);
    if (facts_.arrays) text_ += rest_ ? "State dz_, rest_;" : "State dz_;";
  }

  const ShellFacts& facts_;
  const Program& code_;
  bool rest_, carry_, composed_, coefficients_, start_, extrapolates_;
  std::string text_;
};

// Where row i of the matrix stands in the band.
std::string order_body(const ArrayMatrix& matrix) {
  const int length = matrix.size / matrix.arrays;
  const std::string k = matrix.arrays == 1 ? "i" : "k";
  const std::string folded =
      fmt::format("2 * {0} < {1} ? 2 * {0} : 2 * ({1} - 1 - {0}) + 1", k, length);
  if (matrix.arrays == 1) return fmt::format("return {};", matrix.folded ? folded : k);
  const std::string element = fmt::format("const int k = i % {};", length);
  if (!matrix.folded)
    return element + fmt::format("return {} * k + i / {};", matrix.arrays, length);
  return element + fmt::format("const int row = {}; return {} * row + i / {};", folded,
                               matrix.arrays, length);
}

}  // namespace

Pattern record_pattern(const Record& record) {
  Pattern pattern{"{"};
  for (const Field& field : record.fields) {
    std::string sizes;
    for (const int size : field.sizes) sizes += fmt::format("[{}]", size);
    std::string values;
    for (const Rational& value : field.values) {
      const bool number = field.type != "int" && field.type != "bool";
      if (number) pattern.constants.push_back(value);
      values += (values.empty() ? "" : ", ") + (number                ? std::string(kConstant)
                                                : field.type == "int" ? value.get_str()
                                                : value == 0          ? "false"
                                                                      : "true");
    }
    if (!field.sizes.empty()) {
      values = "{" + values + "}";
    } else if (values.empty() && field.type == "Real") {
      values = kConstant;
      pattern.constants.emplace_back(0);
    }
    pattern.text += fmt::format("{} {}{}{}{};", field.type, field.name, sizes,
                                values.empty() ? "" : " = ", values);
  }
  pattern.text += "};";
  return pattern;
}

Pattern propagator_pattern(const ShellFacts& facts) { return PropagatorText(facts).propagator(); }

Pattern step_pattern(const ShellFacts& facts) { return PropagatorText(facts).step(); }

Pattern modified_energy_pattern(const ShellFacts& facts) {
  return {
      fmt::format("inline Real modified_energy(const Parameters& par, Real h, const State& z) {{"
                  "Real values[{}]; modified_energies(par, h, z, values); return values[{}]; }}",
                  facts.modified, facts.modified - 1)};
}

Pattern gradient_pattern() {
  return {
      "inline void gradient(const Parameters& par, const State& z, Real (&values)[2 * n]) {"
      "gradient(par, z.q, z.p, values, values + n); }"};
}

Pattern matrix_pattern(const ArrayMatrix& matrix) {
  const auto plain = [&](const char* name) {
    return Pattern{fmt::format("using Matrix = {}<{}>;", name, matrix.size)};
  };
  if (matrix.kind == MatrixKind::dense) return plain("DenseMatrix");
  if (matrix.kind == MatrixKind::eigen_dense) return plain("EigenDenseMatrix");
  if (matrix.kind == MatrixKind::eigen_sparse) return plain("EigenSparseMatrix");
  if (matrix.bandwidth == 0) return plain("DiagonalMatrix");
  const std::string band = fmt::format("BandMatrix<{}, {}>", matrix.size, matrix.bandwidth);
  if (matrix.in_natural_order()) return {fmt::format("using Matrix = {};", band)};
  return {
      fmt::format("struct Order {{ static int row(int i) {{ {} }} }};"
                  "using Matrix = ReorderedMatrix<{}, Order>;",
                  order_body(matrix), band)};
}

}  // namespace hamgen
