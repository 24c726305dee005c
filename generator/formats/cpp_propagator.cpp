// Many steps of a member.
#include <fmt/format.h>

#include "generator/formats/cpp_member.hpp"
#include "generator/formats/cpp_support.hpp"

namespace hamgen {

namespace {

std::string solve_call(const MemberParts& parts, const std::string& par, const std::string& k,
                       const std::string& h, const std::string& z, const std::string& carry,
                       const std::string& start) {
  std::string text = "solve(" + par + ", ";
  if (parts.coefficients) text += k + ", ";
  text += h + ", " + z + ", " + carry + ", ";
  if (parts.has_start()) text += start + ", ";
  return text + (parts.rest ? "dz, rest)" : "dz)");
}

}  // namespace

void write_advance(CodeWriter& out) {
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
  out.line("// What rounding took from the state: the sum of both is what the steps go on from.");
  out.line("[[nodiscard]] const State& carry() const { return carry_; }");
}

void write_member_step(CodeWriter& out, const CppContext& context, const MemberParts& parts) {
  out.line("// Advances z by one step of size h.  On failure z is left unchanged.");
  out.open("[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z)");
  if (parts.coefficients) out.line("const Coefficients k = prepare(par, h);");
  if (parts.has_start()) out.line("Start start;");
  out.line(parts.rest ? "State dz, rest;" : "State dz;");
  out.line("const StepReport report = " +
           solve_call(parts, "par", "k", "h", "z", "State()", "start") + ";");
  out.line("if (!report.converged) return report;");
  for (int i = 0; i < 2 * context.n(); ++i) {
    if (context.program.increments[static_cast<std::size_t>(i)].is_zero()) continue;
    out.line(
        fmt::format(fmt::runtime(parts.rest ? "z.{0} += dz.{0} + rest.{0};" : "z.{0} += dz.{0};"),
                    context.state_field(i)));
  }
  out.line("return report;");
  out.close();
  out.line();
}

std::string class_name(StepRole role) {
  return role == StepRole::propagator ? "Propagator" : "Substep";
}

void write_substep_access(CodeWriter& out, const std::string& reset) {
  out.line("// Goes on from a state of another substep.");
  out.open("void begin_at(const State& z, const State& carry)");
  out.line("z_ = z;");
  out.line("carry_ = carry;");
  out.close();
  if (reset.empty()) return;
  out.line("// Drops the start values.");
  out.open("void forget()");
  out.lines(reset);
  out.close();
}

void write_member_propagator(CodeWriter& out, const CppContext& context, const MemberParts& parts,
                             StepRole role) {
  if (parts.has_start()) out.lines(cpp_history(static_cast<int>(parts.unknowns.size())) + "\n");
  out.line(parts.has_start() ? "// Many steps: start values are extrapolated, rounding errors of "
                               "the updates carried along."
                             : "// Many steps: rounding errors of the updates are carried along.");
  const std::string name = class_name(role);
  out.open("class " + name);
  out.dedent();
  out.line(" public:");
  out.indent();
  std::string initialisers = "par_(par), h_(h), z_(z)";
  if (parts.coefficients) initialisers += ", k_(prepare(par, h))";
  const std::string constructor = name + "(const Parameters& par, Real h, const State& z)";
  if (constructor.size() + initialisers.size() > 90) {
    out.line(constructor);
    out.line("    : " + initialisers + " {}");
  } else {
    out.line(constructor + " : " + initialisers + " {}");
  }
  out.line();
  out.line("// One step; on failure the state stays as it was.");
  out.open("StepReport step()");
  out.line(parts.rest ? "State dz, rest;" : "State dz;");
  const std::string call = solve_call(parts, "par_", "k_", "h_", "z_", "carry_", "start_");
  if (parts.has_start()) {
    out.line("start_.known = history_.known > 0;");
    out.line("if (start_.known) history_.extrapolate(start_.value);");
    out.line("StepReport report = " + call + ";");
    out.open("if (!report.converged && start_.known)");
    out.line("// Extrapolation may lead astray, the state itself seldom does.");
    out.line("const long long wasted = report.iterations;");
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
  for (int i = 0; i < 2 * context.n(); ++i) {
    if (context.program.increments[static_cast<std::size_t>(i)].is_zero()) continue;
    out.line(fmt::format(fmt::runtime(parts.rest ? "add(z_.{0}, carry_.{0}, dz.{0}, rest.{0});"
                                                 : "two_sum(z_.{0}, carry_.{0}, dz.{0});"),
                         context.state_field(i)));
  }
  out.line("return report;");
  out.close();
  out.line();
  write_advance(out);
  if (role == StepRole::substep) {
    write_substep_access(out,
                         parts.has_start() ? "start_ = Start();\nhistory_ = History();\n" : "");
  }
  out.line();
  out.dedent();
  out.line(" private:");
  out.indent();
  out.line("Parameters par_;");
  out.line("Real h_;");
  out.line("State z_;");
  out.line("State carry_;");
  if (parts.coefficients) out.line("Coefficients k_;");
  if (parts.has_start()) {
    out.line("Start start_;");
    out.line("History history_;");
  }
  out.close(";");
  out.line();
}

}  // namespace hamgen
