#include "generator/readback/c_shell.hpp"

#include <fmt/format.h>

#include "generator/program/propagator.hpp"
#include "generator/readback/run_words.hpp"

namespace hamgen {

namespace {

constexpr const char* kReport = "hamgen::StepReport";

std::string sizes_of(const Field& field) {
  std::string sizes;
  for (const int size : field.sizes) sizes += fmt::format("[{}]", size);
  return sizes;
}

class CPropagatorText {
 public:
  explicit CPropagatorText(const ShellFacts& facts)
      : facts_(facts),
        code_(facts.code),
        propagator_(propagator_of(code_)),
        parts_(code_.substeps.size()),
        coefficients_(code_.record("Coefficients") != nullptr) {}

  std::map<std::string, Pattern> patterns() {
    std::map<std::string, Pattern> result;
    if (code_.record("Start") != nullptr) result["start"] = start();
    result["Propagator"] = record();
    for (const Routine& routine : propagator_.routines)
      result["Propagator_" + routine.name] = {words_of(routine, {.c = true})};
    result["Propagator_make"] = make();
    result["Propagator_time"] = time();
    result["step"] = one_step();
    return result;
  }

 private:
  [[nodiscard]] Pattern start() const {
    std::string text = "static inline N::Start N::start(void) { N::Start start = {0};";
    for (const Field& field : code_.record("Start")->fields) {
      if (field.type.starts_with("NewtonRule<"))
        text += fmt::format("start.{} = hamgen::NewtonRule_of_power({});", field.name,
                            field.type.substr(11, field.type.size() - 12));
    }
    return {text + "return start; }"};
  }

  [[nodiscard]] Pattern record() const {
    std::string text = "typedef struct {";
    for (const Field& field : propagator_.record.fields) {
      const bool history = field.type.starts_with("History");
      const bool number = field.type == "Real" || field.type == "long long";
      text += fmt::format("{}{} {}{};", number ? "" : "N::", history ? "History" : field.type,
                          field.name, sizes_of(field));
    }
    return {text + "} N::Propagator;"};
  }

  [[nodiscard]] Pattern make() const {
    std::string text =
        "static inline N::Propagator N::Propagator_make(const N::Parameters* par, Real h,"
        "const N::State* z) {";
    const bool composed = parts_ > 1;
    if (composed) {
      text += fmt::format("const Real fractions[{}] = {{", parts_);
      for (std::size_t i = 0; i < parts_; ++i)
        text += (i == 0 ? "" : ", ") + std::string(kConstant);
      text += "};";
    }
    text += "N::Propagator self = {0}; self.par = *par; self.h = h;";
    if (composed) {
      text += fmt::format("for (int i = 0; i < {}; ++i) {{ self.lengths[i] = h * fractions[i];",
                          parts_);
      if (coefficients_) text += "self.k[i] = N::prepare(par, self.lengths[i]);";
      text += "}";
    } else if (coefficients_) {
      text += "self.k = N::prepare(par, h);";
    }
    return {text + "N::Propagator_reset(&self, z); return self; }",
            composed ? code_.substeps : std::vector<Rational>{}};
  }

  [[nodiscard]] Pattern time() const {
    const std::string value =
        facts_.time.empty() ? "(Real)self->steps * self->h" : "self->z." + facts_.time;
    return {fmt::format(
        "static inline Real N::Propagator_time(const N::Propagator* self) {{ return {}; }}",
        value)};
  }

  [[nodiscard]] static Pattern one_step() {
    return {
        fmt::format("static inline {0} N::step(const N::Parameters* par, Real h, N::State* z) {{"
                    "N::Propagator self = N::Propagator_make(par, h, z);"
                    "const {0} report = N::Propagator_step(&self);"
                    "if (report.converged) *z = self.z; return report; }}",
                    kReport)};
  }

  const ShellFacts& facts_;
  const Program& code_;
  const Propagator propagator_;
  std::size_t parts_;
  bool coefficients_;
};

}  // namespace

Pattern c_record_pattern(const Record& record) {
  std::string text = "typedef struct {";
  for (const Field& field : record.fields) {
    const bool rule = field.type.starts_with("NewtonRule");
    text += fmt::format("{} {}{};", rule ? "hamgen::NewtonRule" : field.type, field.name,
                        sizes_of(field));
  }
  if (record.fields.empty()) text += "char none;";
  return {text + fmt::format("}} N::{};", record.name)};
}

Pattern c_defaults_pattern(const Record& parameters) {
  Pattern pattern;
  std::string values;
  for (const Field& field : parameters.fields) {
    std::string list;
    for (const Rational& value : field.values) {
      pattern.constants.push_back(value);
      list += (list.empty() ? "" : ", ") + std::string(kConstant);
    }
    values += (values.empty() ? "" : ", ") + (field.sizes.empty() ? list : "{" + list + "}");
  }
  pattern.text = fmt::format(
      "static inline N::Parameters N::default_parameters(void) {{ const N::Parameters par = {{{}}};"
      "return par; }}",
      values.empty() ? "0" : values);
  return pattern;
}

std::map<std::string, Pattern> c_propagator_patterns(const ShellFacts& facts) {
  return CPropagatorText(facts).patterns();
}

}  // namespace hamgen
