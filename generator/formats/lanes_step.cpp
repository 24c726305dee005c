#include "generator/formats/lanes_step.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <utility>

namespace hamgen {

namespace {

class LaneStepWriter {
 public:
  LaneStepWriter(CodeWriter& out, const EmitContext& context)
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
    out_.remark("// ",
                "Trajectories side by side, each as if it were alone.  A lane whose step fails "
                "stays for good where it was before it, and the others go on.");
    out_.open("class Propagator");
    access(" public:");
    out_.line(fmt::format("static constexpr int lanes = {};", context_.options.lanes));
    if (composed_) {
      out_.line(fmt::format("static constexpr int substeps = {};", code_.substeps.size()));
    }
    out_.line();
    write_constructor();
    out_.line();
    composed_ ? write_composed_step() : write_single_step();
    out_.line();
    write_advance();
    out_.line();
    write_reset();
    out_.line();
    write_accessors();
    out_.line();
    access(" private:");
    if (composed_) write_substep();
    write_members();
    out_.close(";");
    out_.line();
    write_step_function();
  }

 private:
  void access(const char* line) {
    out_.dedent();
    out_.line(line);
    out_.indent();
  }

  // Arguments of solve that are called otherwise where it is called.
  using CallNames = std::map<std::string, std::string>;

  // What is large has its place in the Propagator.
  [[nodiscard]] std::string room(const std::string& name) const {
    return large_ ? name + "_" : name;
  }

  [[nodiscard]] std::string solve(const CallNames& names) const {
    std::string list;
    for (const Argument& argument : code_.routine("solve")->arguments) {
      const auto found = names.find(argument.name);
      list += (list.empty() ? "" : ", ") + (found == names.end() ? argument.name : found->second);
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
      return out_.close();
    }
    for (const Place& place : code_.changed) out_.line(line(to_text(place).substr(1)));
  }

  // The report of one solve; where it starts from what is known of earlier steps, and lanes fail,
  // it is tried again in these.
  void write_solve(const CallNames& names, const std::string& history) {
    if (code_.unknowns == 0) return out_.line("StepReport report = " + solve(names) + ";");
    const std::string& start = names.at("start");
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("{}.{}.stopped = !running_;", start, rule.name));
    }
    out_.line(fmt::format("{}.known = {}.known > 0;", start, history));
    out_.line(fmt::format("{}.extrapolate({}.value);", history, start));
    out_.line("StepReport report = " + solve(names) + ";");
    out_.line(fmt::format("const Mask astray = running_ & {}.known & !report.converged;", start));
    out_.open("if (any(astray))");
    out_.line("// Extrapolation may lead astray, the state itself seldom does.");
    write_solve_again(names);
    out_.close();
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("{0}.{1}.watch({2}, {0}.value, {3}, {4});", start, rule.name, history,
                            rule.first, rule.count));
    }
    out_.line(fmt::format("{}.record({}.value);", history, start));
  }

  void write_solve_again(CallNames names) {
    const std::string start = std::exchange(names["start"], "again");
    const std::string dz = std::exchange(names["dz"], "dz_again");
    const std::string rest = std::exchange(names["rest"], "rest_again");
    out_.line("Start again;");
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("again.{}.stopped = !astray;", rule.name));
    }
    out_.line(rest_ ? "State dz_again, rest_again;" : "State dz_again;");
    out_.line(fmt::format("take_lanes(astray, report, {});", solve(names)));
    write_each([&](const std::string& x) {
      return fmt::format("take_lanes(astray, {0}.{1}, dz_again.{1});", dz, x);
    });
    if (rest_) {
      write_each([&](const std::string& x) {
        return fmt::format("take_lanes(astray, {0}.{1}, rest_again.{1});", rest, x);
      });
    }
    out_.line(fmt::format("take_lanes(astray, {}.value, again.value);", start));
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(fmt::format("take_lanes(astray, {0}.{1}, again.{1});", start, rule.name));
    }
  }

  void write_constructor() {
    out_.line("// A step size for each lane.");
    const std::string head = "Propagator(const Parameters& par, const Real& h, const State& z)";
    std::string initialisers = "par_(par), h_(h), z_(z)";
    if (!composed_) {
      if (coefficients_) initialisers += ", k_(prepare(par, h))";
      out_.line(head);
      return out_.line("    : " + initialisers + " {}");
    }
    std::string lengths;
    for (const Rational& length : code_.substeps) {
      lengths += (lengths.empty() ? "" : ", ") + literal(length, context_.scalar);
    }
    out_.open(head + " : " + initialisers);
    out_.line(
        fmt::format("constexpr {} fractions[substeps] = {{{}}};", context_.scalar.cpp, lengths));
    out_.open("for (int i = 0; i < substeps; ++i)");
    out_.line("lengths_[i] = h * fractions[i];");
    if (coefficients_) out_.line("k_[i] = prepare(par, lengths_[i]);");
    out_.close();
    out_.close();
  }

  void write_single_step() {
    out_.line("// One step of the lanes that are running.");
    out_.open("StepReport step()");
    if (!large_) out_.line(rest_ ? "State dz, rest;" : "State dz;");
    const CallNames names = {{"par", "par_"},    {"k", "k_"},           {"h", "h_"},
                             {"z", "z_"},        {"carry", "carry_"},   {"start", "start_"},
                             {"dz", room("dz")}, {"rest", room("rest")}};
    write_solve(names, "history_");
    out_.line("stop_failed(running_, report);");
    write_each([&](const std::string& x) {
      if (!carry_)
        return fmt::format("z_.{0} = select(running_, z_.{0} + {1}.{0}, z_.{0});", x, room("dz"));
      return fmt::format(
          fmt::runtime(rest_ ? "move_lanes(running_, z_.{0}, carry_.{0}, {1}.{0}, {2}.{0});"
                             : "move_lanes(running_, z_.{0}, carry_.{0}, {1}.{0});"),
          x, room("dz"), room("rest"));
    });
    write_count();
    out_.line("return report;");
    out_.close();
  }

  void write_composed_step() {
    out_.remark("// ",
                "One step of the lanes that are running; a lane that fails is where it was before "
                "its first substep.");
    out_.open("StepReport step()");
    out_.line("State z = z_;");
    if (carry_) out_.line("State carry = carry_;");
    out_.line("StepReport total;");
    out_.line("total.converged = true;");
    out_.open("for (int i = 0; i < substeps; ++i)");
    out_.line(carry_ ? "add_substep(total, substep(i, z, carry));"
                     : "add_substep(total, substep(i, z));");
    out_.close();
    out_.line("stop_failed(running_, total);");
    write_each([](const std::string& x) {
      return fmt::format("z_.{0} = select(running_, z.{0}, z_.{0});", x);
    });
    if (carry_) {
      write_each([](const std::string& x) {
        return fmt::format("carry_.{0} = select(running_, carry.{0}, carry_.{0});", x);
      });
    }
    write_count();
    out_.line("return total;");
    out_.close();
  }

  void write_substep() {
    out_.line(carry_ ? "// Substep i from z + carry." : "// Substep i.");
    out_.open(carry_ ? "StepReport substep(int i, State& z, State& carry)"
                     : "StepReport substep(int i, State& z)");
    if (!large_) out_.line(rest_ ? "State dz, rest;" : "State dz;");
    const CallNames names = {{"par", "par_"},        {"k", "k_[i]"},     {"h", "lengths_[i]"},
                             {"start", "start_[i]"}, {"dz", room("dz")}, {"rest", room("rest")}};
    write_solve(names, "history_[i]");
    write_each([&](const std::string& x) {
      if (!carry_) return fmt::format("z.{0} += {1}.{0};", x, room("dz"));
      return fmt::format(
          fmt::runtime(rest_ ? "two_sum_with_rest(z.{0}, carry.{0}, {1}.{0}, {2}.{0});"
                             : "two_sum(z.{0}, carry.{0}, {1}.{0});"),
          x, room("dz"), room("rest"));
    });
    out_.line("return report;");
    out_.close();
    out_.line();
  }

  void write_count() {
    if (!has_time_) out_.line("steps_ = select(running_, steps_ + 1, steps_);");
  }

  void write_advance() {
    out_.lines(
        R"(// Up to `steps` steps, of every lane until it fails.  The report sums the iterations.
StepReport advance(long long steps) {
  StepReport total;
  for (long long i = 0; i < steps && any(running_); ++i) {
    const Mask moving = running_;
    const StepReport report = step();
    total.iterations += report.iterations;
    total.increment = select(moving, report.increment, total.increment);
  }
  total.converged = running_;
  return total;
}
)");
  }

  void write_reset() {
    out_.line("// All lanes begin anew at z, as in a new Propagator.");
    out_.open("void reset(const State& z)");
    out_.line("z_ = z;");
    if (carry_) out_.line("carry_ = State();");
    if (!has_time_) out_.line("steps_ = 0;");
    if (start_) write_start_anew();
    if (code_.unknowns > 0) {
      out_.line(composed_ ? "for (auto& history : history_) forget(history);"
                          : "forget(history_);");
    }
    out_.line("running_ = true;");
    out_.close();
  }

  // What decides how the next step begins; numbers are filled before they are read.
  void write_start_anew() {
    if (code_.unknowns > 0) {
      return out_.line(composed_ ? "for (Start& start : start_) start = Start();"
                                 : "start_ = Start();");
    }
    for (const Field& field : code_.record("Start")->fields) {
      if (field.type != "bool") continue;
      out_.line(fmt::format(fmt::runtime(composed_ ? "for (Start& start : start_) start.{} = false;"
                                                   : "start_.{} = false;"),
                            field.name));
    }
  }

  void write_accessors() {
    out_.line("[[nodiscard]] const State& state() const { return z_; }");
    if (carry_) {
      out_.line(
          "// What rounding took from the state: the sum of both is what the steps go on from.");
      out_.line("[[nodiscard]] const State& carry() const { return carry_; }");
    }
    out_.line("// The lanes none of whose steps has failed: running()[0], ...");
    out_.line("[[nodiscard]] const Mask& running() const { return running_; }");
    if (has_time_) {
      out_.line(fmt::format("[[nodiscard]] const Real& time() const {{ return z_.{}; }}",
                            context_.state_field(context_.n() - 1)));
    } else {
      out_.line("// Since the first state, of each lane.");
      out_.line("[[nodiscard]] Real time() const { return steps_ * h_; }");
    }
    out_.line("[[nodiscard]] const Real& h() const { return h_; }");
    out_.line("[[nodiscard]] const Parameters& parameters() const { return par_; }");
  }

  void write_members() {
    const char* each = composed_ ? "[substeps]" : "";
    out_.line("Parameters par_;");
    out_.line("Real h_;");
    out_.line("State z_;");
    if (carry_) out_.line("State carry_;");
    if (!has_time_) out_.line("Real steps_ = 0;");
    out_.line("Mask running_ = true;");
    if (composed_) out_.line("Real lengths_[substeps] = {};");
    if (coefficients_) out_.line(fmt::format("Coefficients k_{};", each));
    if (start_) out_.line(fmt::format("Start start_{};", each));
    if (code_.unknowns > 0) {
      out_.line(fmt::format("History<{}> history_{};", code_.unknowns, each));
    }
    if (large_) out_.line(rest_ ? "State dz_, rest_;" : "State dz_;");
  }

  void write_step_function() {
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

  CodeWriter& out_;
  const EmitContext& context_;
  const Program& code_;
  bool coefficients_, start_, rest_, carry_, composed_, large_, has_time_;
};

}  // namespace

void write_lane_steps(CodeWriter& out, const EmitContext& context) {
  LaneStepWriter(out, context).write();
}

}  // namespace hamgen
