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
        lanes_(context.options.lanes),
        has_time_(context.program.facts.has_time),
        number_(lanes_ > 0 ? "const Real&" : "Real") {}

  void write() {
    const bool by_propagator = composed_ || context_.arrays() || lanes_ > 0;
    if (!by_propagator) write_routine(single_step(code_));
    write_propagator();
    if (by_propagator) write_step_of_propagator();
  }

 private:
  void write_routine(const Routine& routine) {
    print(out_, routine, context_.dialect, context_.used);
  }

  void write_step_of_propagator() {
    if (lanes_ > 0) return write_step_of_lanes();
    out_.lines(R"(// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  Propagator propagator(par, h, z);
  const StepReport report = propagator.step();
  if (report.converged) z = propagator.state();
  return report;
}

)");
  }

  void write_step_of_lanes() {
    out_.lines(
        R"(// Advances the lanes of z by one step of size h.  One that fails is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, const Real& h, State& z) {
  Propagator propagator(par, h, z);
  const StepReport report = propagator.step();
  z = propagator.state();
  return report;
}

)");
  }

  void write_propagator() {
    const Propagator propagator = lanes_ > 0 ? lane_propagator_of(code_) : propagator_of(code_);
    write_remark();
    out_.open("class Propagator");
    access(" public:");
    write_constants();
    if (lanes_ > 0) out_.line("// A step size for each lane.");
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
    if (lanes_ > 0) {
      return out_.remark("// ",
                         "Trajectories side by side, each as if it were alone.  A lane whose step "
                         "fails stays for good where it was before it, and the others go on.");
    }
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

  void write_constants() {
    if (lanes_ > 0) out_.line(fmt::format("static constexpr int lanes = {};", lanes_));
    if (composed_)
      out_.line(fmt::format("static constexpr int substeps = {};", code_.substeps.size()));
    if (lanes_ > 0 || composed_) out_.line();
  }

  [[nodiscard]] std::string head_of_constructor() const {
    return fmt::format("Propagator(const Parameters& par, {} h, const State& z)", number_);
  }

  void write_constructor() {
    std::string initialisers = "par_(par), h_(h), z_(z)";
    if (coefficients_) initialisers += ", k_(prepare(par, h))";
    const std::string head = head_of_constructor();
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
    out_.open(head_of_constructor() + " : par_(par), h_(h), z_(z)");
    out_.line(fmt::format("constexpr {} fractions[substeps] = {{{}}};",
                          lanes_ > 0 ? context_.scalar.cpp : "Real", lengths));
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
                                : field.name == "running" ? " = true"
                                                          : "";
      if (field.name == "rest") continue;  // beside dz
      const bool pair = field.name == "dz" && code_.has_rest();
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
    if (lanes_ > 0) {
      out_.line("// The lanes none of whose steps has failed: running()[0], ...");
      out_.line("[[nodiscard]] const Mask& running() const { return running_; }");
    }
    if (has_time_) {
      const std::string& t = context_.state_field(context_.n() - 1);
      out_.line(fmt::format("[[nodiscard]] {} time() const {{ return z_.{}; }}", number_, t));
    } else if (lanes_ > 0) {
      out_.line("// Since the first state, of each lane.");
      out_.line("[[nodiscard]] Real time() const { return steps_ * h_; }");
    } else {
      out_.line("// Since the first state.");
      out_.line("[[nodiscard]] Real time() const { return static_cast<Real>(steps_) * h_; }");
    }
    out_.line(fmt::format("[[nodiscard]] {} h() const {{ return h_; }}", number_));
    out_.line("[[nodiscard]] const Parameters& parameters() const { return par_; }");
  }

  CodeWriter& out_;
  EmitContext& context_;
  const Program& code_;
  bool coefficients_, carry_, composed_;
  int lanes_;
  bool has_time_;
  const char* number_;  // as it is handed on
};

}  // namespace

void write_steps(CodeWriter& out, EmitContext& context) { StepWriter(out, context).write(); }

}  // namespace hamgen
