#include "generator/formats/cpp_functions.hpp"

#include <fmt/format.h>

namespace hamgen {

void write_functions(CodeWriter& out, EmitContext& context) {
  context.write_routine(out, "energy");
  context.write_with_callees(out, "gradient");
  if (context.arrays()) {
    out.lines(R"(// grad H, the derivatives by q first.
inline void gradient(const Parameters& par, const State& z, Real (&values)[2 * n]) {
  gradient(par, z.q, z.p, values, values + n);
}

)");
  }
  context.write_routine(out, "invariants");
}

void write_modified_energies(CodeWriter& out, EmitContext& context) {
  const std::vector<int>& powers = context.program.facts.modified_powers;
  if (powers.empty()) return;
  context.write_routine(out, "modified_energies");
  out.line(fmt::format("// Cut off after h^{}.", powers.back()));
  out.open("inline Real modified_energy(const Parameters& par, Real h, const State& z)");
  out.line(fmt::format("Real values[{}];", powers.size()));
  out.line("modified_energies(par, h, z, values);");
  out.line(fmt::format("return values[{}];", powers.size() - 1));
  out.close();
  out.line();
}

}  // namespace hamgen
