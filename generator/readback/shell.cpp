#include "generator/readback/shell.hpp"

#include <fmt/format.h>

#include "generator/program/propagator.hpp"
#include "generator/readback/run_words.hpp"

namespace hamgen {

namespace {

class PropagatorText {
 public:
  explicit PropagatorText(const ShellFacts& facts)
      : facts_(facts),
        code_(facts.code),
        propagator_(propagator_of(code_)),
        language_{.n = facts.arrays ? code_.environment.degrees_of_freedom : 0},
        composed_(code_.substeps.size() > 1),
        coefficients_(code_.record("Coefficients") != nullptr) {}

  Pattern propagator() {
    text_ = "class Propagator { public: ";
    constructor();
    for (const Routine& routine : propagator_.routines) {
      if (routine.name != "substep") text_ += words_of(routine, language_);
    }
    accessors();
    text_ += "private: ";
    if (composed_) text_ += words_of(propagator_.routines.front(), language_);
    members();
    text_ += "};";
    return {text_, composed_ ? code_.substeps : std::vector<Rational>{}};
  }

  Pattern step() {
    if (!composed_ && !facts_.arrays) return {words_of(single_step(code_), language_)};
    return {
        "[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {"
        "Propagator propagator(par, h, z); const StepReport report = propagator.step();"
        "if (report.converged) z = propagator.state(); return report; }"};
  }

 private:
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

  void accessors() {
    text_ += "[[nodiscard]] const State& state() const { return z_; }";
    if (code_.has_carry()) text_ += "[[nodiscard]] const State& carry() const { return carry_; }";
    text_ += "[[nodiscard]] Real time() const { return ";
    text_ += facts_.time.empty() ? "static_cast<Real>(steps_) * h_" : "z_." + facts_.time;
    text_ +=
        "; } [[nodiscard]] Real h() const { return h_; }"
        "[[nodiscard]] const Parameters& parameters() const { return par_; }";
  }

  void members() {
    const std::vector<Field>& fields = propagator_.record.fields;
    for (const Field& field : fields) {
      if (field.name == "rest") continue;  // beside dz
      text_ +=
          fmt::format("{} {}_{}", field.type, field.name, field.sizes.empty() ? "" : "[substeps]");
      if (field.name == "dz" && code_.has_rest()) text_ += ", rest_";
      text_ += field.name == "steps" ? " = 0;" : field.name == "lengths" ? " = {};" : ";";
    }
  }

  const ShellFacts& facts_;
  const Program& code_;
  const Propagator propagator_;
  RunLanguage language_;
  bool composed_, coefficients_;
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
