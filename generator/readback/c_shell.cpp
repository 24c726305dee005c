#include "generator/readback/c_shell.hpp"

#include <fmt/format.h>

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
        parts_(code_.substeps.size()),
        rest_(code_.has_rest()),
        carry_(code_.has_carry()),
        coefficients_(code_.record("Coefficients") != nullptr),
        start_(code_.record("Start") != nullptr),
        extrapolates_(code_.unknowns > 0) {}

  std::map<std::string, Pattern> patterns() {
    std::map<std::string, Pattern> result;
    if (start_) result["start"] = start();
    result["Propagator"] = record();
    result["Propagator_reset"] = reset();
    result["Propagator_make"] = make();
    result["Propagator_substep"] = substep();
    result["Propagator_step"] = whole_step();
    result["Propagator_advance"] = advance();
    result["Propagator_time"] = time();
    result["step"] = one_step();
    return result;
  }

 private:
  [[nodiscard]] static std::string method(const std::string& type, const std::string& name,
                                          const std::string& more = "") {
    return fmt::format("static inline {} N::Propagator_{}(N::Propagator* self{}) {{", type, name,
                       more);
  }
  [[nodiscard]] std::string for_parts(const char* index) const {
    return fmt::format("for (int {0} = 0; {0} < {1}; ++{0}) {{", index, parts_);
  }
  template <class Line>
  std::string each(const Line& line) const {
    std::string text;
    for (const Place& place : code_.changed) text += line(to_text(place).substr(1));
    return text;
  }

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
    std::string text = "typedef struct { N::Parameters par; Real h; N::State z;";
    if (carry_) text += "N::State carry;";
    text += fmt::format("long long steps; Real lengths[{}];", parts_);
    if (coefficients_) text += fmt::format("N::Coefficients k[{}];", parts_);
    if (start_) text += fmt::format("N::Start start[{}];", parts_);
    if (extrapolates_) text += fmt::format("N::History history[{}];", parts_);
    return {text + "} N::Propagator;"};
  }

  [[nodiscard]] std::string forget(const std::string& i) const {
    std::string text;
    if (start_) text += fmt::format("self->start[{}] = N::start();", i);
    if (extrapolates_) text += fmt::format("N::History_forget(&self->history[{}]);", i);
    return text;
  }

  [[nodiscard]] Pattern reset() const {
    std::string text = method("void", "reset", ", const N::State* z") + "self->z = *z;";
    if (carry_) text += "self->carry = (N::State){0};";
    text += "self->steps = 0;";
    if (start_ || extrapolates_) text += for_parts("i") + forget("i") + "}";
    return {text + "}"};
  }

  [[nodiscard]] Pattern make() const {
    std::string text =
        "static inline N::Propagator N::Propagator_make(const N::Parameters* par, Real h,"
        "const N::State* z) {";
    text += fmt::format("const Real fractions[{}] = {{", parts_);
    for (std::size_t i = 0; i < parts_; ++i) text += (i == 0 ? "" : ", ") + std::string(kConstant);
    text += "}; N::Propagator self = {0}; self.par = *par; self.h = h;" + for_parts("i") +
            "self.lengths[i] = h * fractions[i];";
    if (coefficients_) text += "self.k[i] = N::prepare(par, self.lengths[i]);";
    return {text + "} N::Propagator_reset(&self, z); return self; }", code_.substeps};
  }

  [[nodiscard]] std::string solve() const {
    const std::map<std::string, std::string> given = {{"par", "&self->par"},
                                                      {"k", "&self->k[i]"},
                                                      {"h", "self->lengths[i]"},
                                                      {"z", "z"},
                                                      {"carry", "carry"},
                                                      {"start", "&self->start[i]"},
                                                      {"dz", "&dz"},
                                                      {"rest", "&rest"}};
    std::string list;
    for (const Argument& argument : code_.routine("solve")->arguments) {
      const auto found = given.find(argument.name);
      list += (list.empty() ? "" : ", ") + (found == given.end() ? "?" : found->second);
    }
    return "N::solve(" + list + ")";
  }

  // One solve and the update; from an extrapolation, and where that fails from the state.
  [[nodiscard]] Pattern substep() const {
    std::string text =
        method(kReport, "substep",
               carry_ ? ", int i, N::State* z, N::State* carry" : ", int i, N::State* z");
    text += "N::State dz = {0};";
    if (rest_) text += "N::State rest = {0};";
    if (extrapolates_) {
      text +=
          "self->start[i].known = self->history[i].known > 0;"
          "if (self->start[i].known)"
          "N::History_extrapolate(&self->history[i], self->start[i].value);";
    }
    text += fmt::format("{} report = {};", kReport, solve());
    if (extrapolates_) {
      text += fmt::format(
          "if (!report.converged && self->start[i].known) {{"
          "const long long wasted = report.iterations; self->start[i] = N::start();"
          "report = {}; report.iterations += wasted; }}",
          solve());
    }
    if (!code_.unchecked) text += "if (!report.converged) return report;";
    for (const RuleOfNewton& rule : code_.rules)
      text += fmt::format(
          "N::History_watch(&self->history[i], &self->start[i].{}, self->start[i].value, {}, {});",
          rule.name, rule.first, rule.count);
    if (extrapolates_) text += "N::History_record(&self->history[i], self->start[i].value);";
    text += each([this](const std::string& x) {
      if (!carry_) return fmt::format("z->{0} += dz.{0};", x);
      return rest_ ? fmt::format(
                         "hamgen::two_sum_with_rest(&z->{0}, &carry->{0}, dz.{0}, rest.{0});", x)
                   : fmt::format("hamgen::two_sum(&z->{0}, &carry->{0}, dz.{0});", x);
    });
    return {text + "return report; }"};
  }

  [[nodiscard]] Pattern whole_step() const {
    std::string text = method(kReport, "step") + "N::State z = self->z;";
    if (carry_) text += "N::State carry = self->carry;";
    text += fmt::format("{0} total = {{0}}; {1} const {0} report =", kReport, for_parts("i"));
    text += fmt::format("N::Propagator_substep(self, i, &z{});", carry_ ? ", &carry" : "");
    text +=
        "total.iterations += report.iterations; total.increment = report.increment;"
        "if (!report.converged) {";
    if (extrapolates_ && parts_ > 1) text += for_parts("j") + forget("j") + "}";
    text += "return total; } } self->z = z;";
    if (carry_) text += "self->carry = carry;";
    return {text + "++self->steps; total.converged = true; return total; }"};
  }

  [[nodiscard]] Pattern advance() const {
    std::string text = method(kReport, "advance", ", long long steps");
    text += fmt::format(
        "{0} total = {{0}}; total.converged = true;"
        "for (long long i = 0; i < steps && total.converged; ++i) {{"
        "const {0} report = N::Propagator_step(self); total.iterations += report.iterations;"
        "total.increment = report.increment; total.converged = report.converged; }}",
        kReport);
    if (code_.unchecked) {
      text += "Real rest = 0;";
      text += each([](const std::string& x) {
        return fmt::format("rest += self->z.{0} - self->z.{0};", x);
      });
      text += "total.converged = rest == 0;";
    }
    return {text + "return total; }"};
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
  std::size_t parts_;
  bool rest_, carry_, coefficients_, start_, extrapolates_;
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
