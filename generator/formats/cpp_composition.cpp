// A composition: a substep after the other, each with its own start values, for the stage values of
// one substep are what is equally spaced in time.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_schemes.hpp"
#include "generator/formats/cpp_step.hpp"

namespace hamgen {

void write_single_step(CodeWriter& out) {
  out.lines(R"(// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  Propagator propagator(par, h, z);
  const StepReport report = propagator.step();
  if (report.converged) z = propagator.state();
  return report;
}

)");
}

void write_array_composition(CodeWriter& out, const CppContext& context) {
  const std::vector<Substep>& substeps = context.program.sequence.substeps;
  const std::size_t count = substeps.size();
  const bool solves = iterates(*context.program.plan.arrays);
  out.line("// Many steps, each a composition of substeps.");
  out.open("class Propagator");
  out.dedent();
  out.line(" public:");
  out.indent();
  out.line("Propagator(const Parameters& par, Real h, const State& z)");
  out.line("    : z_(z),");
  for (std::size_t i = 0; i < count; ++i) {
    out.line(fmt::format("      {}Substep(par, h * {}, z){}", i == 0 ? "substep_{" : "         ",
                         literal(numeric_value(substeps[i].length), context.scalar),
                         i + 1 < count ? "," : "} {}"));
  }
  out.line();
  out.line("// One step; on failure the state stays as it was before its first substep.");
  out.open("StepReport step()");
  out.line("State z = z_;");
  out.line("State carry = carry_;");
  out.line("StepReport total;");
  out.open("for (Substep& substep : substep_)");
  out.line("substep.begin_at(z, carry);");
  out.line("const StepReport report = substep.step();");
  out.line("total.iterations += report.iterations;");
  out.line("total.increment = report.increment;");
  if (solves) {
    out.open("if (!report.converged)");
    out.line("// Those before have seen a step that will not be.");
    out.line("for (Substep& each : substep_) each.forget();");
    out.line("return total;");
    out.close();
  } else {
    out.line("if (!report.converged) return total;");
  }
  out.line("z = substep.state();");
  out.line("carry = substep.carry();");
  out.close();
  out.line("z_ = z;");
  out.line("carry_ = carry;");
  out.line("total.converged = true;");
  out.line("return total;");
  out.close();
  out.line();
  write_advance(out);
  out.line();
  out.dedent();
  out.line(" private:");
  out.indent();
  out.line("State z_;");
  out.line("State carry_;");
  out.line(fmt::format("Substep substep_[{}];", count));
  out.close(";");
  out.line();
  write_single_step(out);
}

}  // namespace hamgen
