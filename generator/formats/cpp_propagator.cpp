// What takes steps: the function step and the class Propagator.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/formats/cpp_step.hpp"

namespace hamgen {

namespace {

// What the arguments of solve are called where it is called.
struct CallNames {
  std::string par, k, h, z, carry, start, history;
  std::string dz = "dz", rest = "rest";
};

class StepWriter {
 public:
  StepWriter(CodeWriter& out, const EmitContext& context)
      : out_(out),
        context_(context),
        code_(context.program),
        coefficients_(code_.record("Coefficients") != nullptr),
        start_(code_.record("Start") != nullptr),
        rest_(code_.has_rest()),
        carry_(code_.has_carry()),
        composed_(code_.substeps.size() > 1),
        large_(context.arrays()),
        has_time_(context.program.facts.has_time) {}

  void write() {
    const bool by_propagator = composed_ || large_;
    if (!by_propagator) write_step();
    write_propagator();
    if (by_propagator) write_step_of_propagator();
  }

 private:
  [[nodiscard]] std::string call(const CallNames& names) const {
    std::string list;
    for (const Argument& argument : code_.routine("solve")->arguments) {
      const std::string text = argument.name == "par"     ? names.par
                               : argument.name == "k"     ? names.k
                               : argument.name == "h"     ? names.h
                               : argument.name == "z"     ? names.z
                               : argument.name == "carry" ? names.carry
                               : argument.name == "start" ? names.start
                               : argument.name == "dz"    ? names.dz
                               : argument.name == "rest"  ? names.rest
                                                          : argument.name;
      list += (list.empty() ? "" : ", ") + text;
    }
    return "solve(" + list + ")";
  }

  // The line for every component that changes.
  void write_each(const std::function<std::string(const std::string&)>& line) {
    if (large_) {
      const char* i = composed_ ? "j" : "i";  // a substep has its number i
      out_.open(fmt::format("for (int {0} = 0; {0} < n; ++{0})", i));
      out_.line(line(fmt::format("q[{}]", i)));
      out_.line(line(fmt::format("p[{}]", i)));
      out_.close();
      return;
    }
    for (const Place& place : code_.changed) {
      const std::string field = to_text(place).substr(1);
      out_.line(line(field));
    }
  }

  void write_step() {
    out_.line(code_.unchecked
                  ? "// Advances z by one step of size h."
                  : "// Advances z by one step of size h.  On failure z is left unchanged.");
    out_.open("[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z)");
    if (coefficients_) out_.line("const Coefficients k = prepare(par, h);");
    if (start_) out_.line("Start start;");
    out_.line(rest_ ? "State dz, rest;" : "State dz;");
    out_.line("const StepReport report = " + call({"par", "k", "h", "z", "State()", "start", ""}) +
              ";");
    if (!code_.unchecked) out_.line("if (!report.converged) return report;");
    write_each([this](const std::string& x) {
      return fmt::format(fmt::runtime(rest_ ? "z.{0} += dz.{0} + rest.{0};" : "z.{0} += dz.{0};"),
                         x);
    });
    out_.line("return report;");
    out_.close();
    out_.line();
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
    write_remark();
    out_.open("class Propagator");
    access(" public:");
    composed_ ? write_constructor_of_composition() : write_constructor();
    out_.line();
    if (composed_) {
      write_composed_step();
    } else {
      out_.line(code_.unchecked ? "// One step: H is a polynomial, and has a step everywhere."
                                : "// One step; on failure the state stays as it was.");
      out_.open("StepReport step()");
      write_solve(with_room({"par_", "k_", "h_", "z_", "carry_", "start_", "history_"}));
      out_.close();
    }
    out_.line();
    write_advance();
    out_.line();
    write_reset();
    out_.line();
    write_accessors();
    out_.line();
    access(" private:");
    if (composed_) {
      out_.line(carry_ ? "// Substep i from z + carry." : "// Substep i.");
      out_.open(carry_ ? "StepReport substep(int i, State& z, State& carry)"
                       : "StepReport substep(int i, State& z)");
      write_solve(
          with_room({"par_", "k_[i]", "lengths_[i]", "z", "carry", "start_[i]", "history_[i]"}));
      out_.close();
      out_.line();
    }
    write_members();
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

  // What is large has its place in the Propagator.
  [[nodiscard]] CallNames with_room(CallNames names) const {
    if (large_) names.dz = "dz_";
    if (large_) names.rest = "rest_";
    return names;
  }

  // One solve, tried again without what is known from earlier steps, and the update.
  void write_solve(const CallNames& names) {
    if (!large_) out_.line(rest_ ? "State dz, rest;" : "State dz;");
    if (!code_.retries) {
      out_.line("const StepReport report = " + call(names) + ";");
      if (!code_.unchecked) out_.line("if (!report.converged) return report;");
    } else {
      write_solve_with_memory(names);
    }
    write_each([&](const std::string& x) {
      if (!carry_) return fmt::format("{0}.{2} += {1}.{2};", names.z, names.dz, x);
      return fmt::format(
          fmt::runtime(rest_ ? "two_sum_with_rest({0}.{2}, {1}.{2}, {3}.{2}, {4}.{2});"
                             : "two_sum({0}.{2}, {1}.{2}, {3}.{2});"),
          names.z, names.carry, x, names.dz, names.rest);
    });
    if (!composed_ && !has_time_) out_.line("++steps_;");
    out_.line("return report;");
  }

  void write_solve_with_memory(const CallNames& names) {
    const std::string& start = names.start;
    const std::string& history = names.history;
    const bool extrapolates = code_.unknowns > 0;
    if (extrapolates) {
      out_.line(fmt::format("{}.known = {}.known > 0;", start, history));
      out_.line(fmt::format("if ({0}.known) {1}.extrapolate({0}.value);", start, history));
    } else {
      out_.line(fmt::format("const bool known = {}.known;", start));
    }
    out_.line("StepReport report = " + call(names) + ";");
    out_.open(
        fmt::format("if (!report.converged && {})", extrapolates ? start + ".known" : "known"));
    out_.line("// Extrapolation may lead astray, the state itself seldom does.");
    out_.line("const long long wasted = report.iterations;");
    if (extrapolates) write_forget(start);
    out_.line("report = " + call(names) + ";");
    out_.line("report.iterations += wasted;");
    out_.close();
    out_.line("if (!report.converged) return report;");
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("{0}.{1}.watch({2}, {0}.value, {3}, {4});", start, rule.name, history,
                            rule.first, rule.count));
    }
    if (extrapolates) out_.line(fmt::format("{}.record({}.value);", history, start));
  }

  // A matrix that is there stays, and what is large makes no temporary.
  void write_forget(const std::string& start) {
    if (!large_) return out_.line(start + " = Start();");
    out_.line(start + ".known = false;");
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("{}.{} = {{}};", start, rule.name));
    }
  }

  void write_composed_step() {
    out_.line("// One step; on failure the state stays as it was before its first substep.");
    out_.open("StepReport step()");
    out_.line("State z = z_;");
    if (carry_) out_.line("State carry = carry_;");
    out_.line("StepReport total;");
    out_.open("for (int i = 0; i < substeps; ++i)");
    out_.line(carry_ ? "const StepReport report = substep(i, z, carry);"
                     : "const StepReport report = substep(i, z);");
    out_.line("total.iterations += report.iterations;");
    out_.line("total.increment = report.increment;");
    if (code_.unknowns > 0) {
      out_.open("if (!report.converged)");
      out_.line("// Those before have seen a step that will not be.");
      if (large_) {
        for (const RuleOfNewton& rule : code_.rules) {
          out_.line(fmt::format("for (Start& start : start_) start.{} = {{}};", rule.name));
        }
      } else {
        out_.line("for (Start& start : start_) start = Start();");
      }
      out_.line("for (auto& history : history_) forget(history);");
      out_.line("return total;");
      out_.close();
    } else {
      out_.line("if (!report.converged) return total;");
    }
    out_.close();
    out_.line("z_ = z;");
    if (carry_) out_.line("carry_ = carry;");
    if (!has_time_) out_.line("++steps_;");
    out_.line("total.converged = true;");
    out_.line("return total;");
    out_.close();
  }

  void write_members() {
    const char* each = composed_ ? "[substeps]" : "";
    out_.line("Parameters par_;");
    out_.line("Real h_;");
    out_.line("State z_;");
    if (carry_) out_.line("State carry_;");
    if (!has_time_) out_.line("long long steps_ = 0;");
    if (composed_) out_.line("Real lengths_[substeps] = {};");
    if (coefficients_) out_.line(fmt::format("Coefficients k_{};", each));
    if (start_) out_.line(fmt::format("Start start_{};", each));
    if (code_.unknowns > 0) out_.line(fmt::format("History<{}> history_{};", code_.unknowns, each));
    if (large_) out_.line(rest_ ? "State dz_, rest_;" : "State dz_;");
  }

  // Without a look at every step.
  void write_unchecked_advance() {
    out_.lines(R"(// So many steps.  The report says whether the state is finite afterwards.
StepReport advance(long long steps) {
  StepReport total;
  for (long long i = 0; i < steps; ++i) static_cast<void>(step());
  Real rest = 0;
)");
    out_.indent();
    write_each([](const std::string& x) { return fmt::format("rest += z_.{0} - z_.{0};", x); });
    out_.line("total.converged = rest == 0;");
    out_.line("total.increment = rest;");
    out_.line("return total;");
    out_.close();
  }

  void write_advance() {
    if (code_.unchecked) return write_unchecked_advance();
    out_.lines(
        R"(// Up to `steps` steps; stops at the first failure.  The report sums the iterations.
StepReport advance(long long steps) {
  StepReport total;
  total.converged = true;
  for (long long i = 0; i < steps; ++i) {
    const StepReport report = step();
    total.iterations += report.iterations;
    total.increment = report.increment;
    if (!report.converged) {
      total.converged = false;
      break;
    }
  }
  return total;
}
)");
  }

  void write_reset() {
    out_.line("// Begins anew at z, as a new Propagator would.");
    out_.open("void reset(const State& z)");
    out_.line("z_ = z;");
    if (carry_) out_.line("carry_ = State();");
    if (!has_time_) out_.line("steps_ = 0;");
    if (start_ && composed_ && !large_) {
      out_.line("for (Start& start : start_) start = Start();");
    } else if (start_ && composed_) {
      write_start_anew("start", "for (Start& start : start_) ");
    } else if (start_) {
      large_ ? write_start_anew("start_", "") : out_.line("start_ = Start();");
    }
    if (code_.unknowns > 0) {
      out_.line(composed_ ? "for (auto& history : history_) forget(history);"
                          : "forget(history_);");
    }
    out_.close();
  }

  // What decides how the next step begins; arrays and matrices are filled before they are read.
  void write_start_anew(const std::string& start, const std::string& head) {
    for (const Field& field : code_.record("Start")->fields) {
      const std::string name = start + "." + field.name;
      if (!field.sizes.empty() || field.type == "Matrix") continue;
      const std::string line = field.type == "bool"               ? name + " = false;"
                               : field.type == "int"              ? name + " = 0;"
                               : field.type.starts_with("Refine") ? name + ".rounds = 0;"
                                                                  : name + " = {};";
      out_.line(head + line);
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
  const EmitContext& context_;
  const Program& code_;
  bool coefficients_, start_, rest_, carry_, composed_, large_, has_time_;
};

}  // namespace

void write_steps(CodeWriter& out, const EmitContext& context) { StepWriter(out, context).write(); }

}  // namespace hamgen
