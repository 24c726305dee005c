// What takes steps: the function step and the class Propagator.
#include <fmt/format.h>

#include "generator/formats/cpp_step.hpp"
#include "generator/program/propagator.hpp"

namespace hamgen {

namespace {

class StepWriter {
 public:
  StepWriter(CodeWriter& out, EmitContext& context)
      : out_(out),
        context_(context),
        code_(context.program),
        coefficients_(code_.record("Coefficients") != nullptr),
        carry_(code_.has_carry()),
        composed_(code_.substeps.size() > 1),
        has_time_(context.program.facts.has_time) {}

  void write() {
    const bool by_propagator = composed_ || context_.arrays();
    if (!by_propagator) write_routine(single_step(code_));
    write_propagator();
    if (by_propagator) write_step_of_propagator();
  }

 private:
  void write_routine(const Routine& routine) {
    print(out_, routine, context_.dialect, context_.used);
  }

  void write_step_of_propagator() {
    out_.lines(R"(// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  Propagator propagator(par, h, z);
  const StepReport report = propagator.step();
  if (report.converged) z = propagator.state();
  return report;
}

)");
  }

  void write_propagator() {
    const Propagator propagator = propagator_of(code_);
    write_remark();
    out_.open("class Propagator");
    access(" public:");
    composed_ ? write_constructor_of_composition() : write_constructor();
    out_.line();
    for (const Routine& routine : propagator.routines) {
      if (routine.name != "substep") write_routine(routine);
    }
    write_accessors();
    out_.line();
    access(" private:");
    if (composed_) write_routine(propagator.routines.front());
    write_members(propagator.record);
    out_.close(";");
    out_.line();
  }

  void write_remark() {
    if (!carry_) {
      return out_.line(code_.retries
                           ? "// Many steps: start values are extrapolated; sums are plain."
                           : "// Many steps: sums are plain.");
    }
    out_.line(code_.retries ? "// Many steps: start values are extrapolated, rounding errors of "
                              "the updates carried along."
                            : "// Many steps: rounding errors of the updates are carried along.");
  }

  void access(const char* line) {
    out_.dedent();
    out_.line(line);
    out_.indent();
  }

  void write_constructor() {
    std::string initialisers = "par_(par), h_(h), z_(z)";
    if (coefficients_) initialisers += ", k_(prepare(par, h))";
    const std::string head = "Propagator(const Parameters& par, Real h, const State& z)";
    if (head.size() + initialisers.size() > 90) {
      out_.line(head);
      out_.line("    : " + initialisers + " {}");
    } else {
      out_.line(head + " : " + initialisers + " {}");
    }
  }

  void write_constructor_of_composition() {
    std::string lengths;
    for (const Rational& length : code_.substeps) {
      lengths += (lengths.empty() ? "" : ", ") + literal(length, context_.scalar);
    }
    out_.line(fmt::format("static constexpr int substeps = {};", code_.substeps.size()));
    out_.line();
    out_.open(
        "Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z)");
    out_.line(fmt::format("constexpr Real fractions[substeps] = {{{}}};", lengths));
    out_.open("for (int i = 0; i < substeps; ++i)");
    out_.line("lengths_[i] = h * fractions[i];");
    if (coefficients_) out_.line("k_[i] = prepare(par, lengths_[i]);");
    out_.close();
    out_.close();
  }

  void write_members(const Record& record) {
    for (const Field& field : record.fields) {
      const std::string each = field.sizes.empty() ? "" : "[substeps]";
      const std::string value = field.name == "steps"     ? " = 0"
                                : field.name == "lengths" ? " = {}"
                                                          : "";
      if (field.name == "rest") continue;  // beside dz
      const bool pair = field.name == "dz" && record.fields.back().name == "rest";
      out_.line(
          fmt::format("{} {}_{}{}{};", field.type, field.name, each, value, pair ? ", rest_" : ""));
    }
  }

  void write_accessors() {
    out_.line("[[nodiscard]] const State& state() const { return z_; }");
    if (carry_) {
      out_.line(
          "// What rounding took from the state: the sum of both is what the steps go on from.");
      out_.line("[[nodiscard]] const State& carry() const { return carry_; }");
    }
    if (has_time_) {
      const std::string& t = context_.state_field(context_.n() - 1);
      out_.line(fmt::format("[[nodiscard]] Real time() const {{ return z_.{}; }}", t));
    } else {
      out_.line("// Since the first state.");
      out_.line("[[nodiscard]] Real time() const { return static_cast<Real>(steps_) * h_; }");
    }
    out_.line("[[nodiscard]] Real h() const { return h_; }");
    out_.line("[[nodiscard]] const Parameters& parameters() const { return par_; }");
  }

  CodeWriter& out_;
  EmitContext& context_;
  const Program& code_;
  bool coefficients_, carry_, composed_, has_time_;
};

}  // namespace

void write_steps(CodeWriter& out, EmitContext& context) { StepWriter(out, context).write(); }

}  // namespace hamgen
