#include "generator/formats/preamble.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

// Of two parts each has its line, if they are too long for one.
void write_cost(CodeWriter& out, const std::string& cost) {
  const std::string lead = "//   cost      ";
  const std::size_t end = cost.find("; ");
  if (out.fits(lead + cost) || end == std::string::npos) return out.comment(lead, cost);
  out.comment(lead, cost.substr(0, end + 1));
  out.comment("//             ", cost.substr(end + 2));
}

}  // namespace

void write_preamble(CodeWriter& out, const EmitContext& context) {
  const StepFacts& facts = context.program.facts;
  out.remark("// ", fmt::format("{}, {}.  Generated: change the model, not this file.",
                                facts.system, facts.scheme));
  out.line("//");
  out.line(
      fmt::format("//   made by   hamgen {}, in {}", HAMGEN_VERSION, context.dialect.language()));
  const EmitOptions& options = context.options;
  if (!options.command.empty()) out.remark("//   command   ", options.command);
  if (!options.model_path.empty()) out.remark("//   model     ", options.model_path);
  if (!options.model_digest.empty()) out.remark("//   sha256    ", options.model_digest);
  out.comment(facts.has_time ? "//   H(q, p, t) = " : "//   H(q, p) = ", facts.hamiltonian);
  for (const auto& [name, text] : facts.definitions) out.comment("//   " + name + " = ", text);
  out.remark("//   scheme    ", facts.properties);
  out.comment("//   step      ", facts.equations);
  if (!options.proved.empty()) out.comment("//   proved    ", options.proved);
  if (!options.tested.empty()) out.comment("//   tested    ", options.tested);
  if (!options.refuted.empty()) out.comment("//   refuted   ", options.refuted);
  out.comment("//   solve     ", facts.solver);
  if (options.lanes > 0) {
    const char* functions = options.library_functions ? "of <cmath>" : "below";
    out.comment("//   batch     ",
                fmt::format("{} trajectories in lanes, functions {}", options.lanes, functions));
  }
  bool first = true;
  for (const std::string& item : facts.left_out) {
    out.comment(first ? "//   left out  " : "//             ", item);
    first = false;
  }
  write_cost(out, facts.cost);
  out.line("//   flags     measured with -O3 -march=native -ffp-contract=off -fno-math-errno");
}

}  // namespace hamgen
