// The structs of an emitted file.
#include <fmt/format.h>

#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_step.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

void write_types(CodeWriter& out, CppContext& context, bool with_vocabulary) {
  for (const char* name : {"Parameters", "State"}) {
    write_record(out, *context.code.record(name), context.scalar);
    out.line();
  }
  out.line(
      "// On failure the increment says how far the iteration was from its end; it is not finite");
  out.line("// where the step left the domain of H.");
  out.open("struct StepReport");
  out.line("bool converged = false;");
  out.line("long long iterations = 0;");
  out.line(fmt::format("Real increment = {};", literal(0, context.scalar)));
  out.close(";");
  out.line();
  if (!with_vocabulary) return;
  out.lines(cpp_vocabulary(context.scalar, context.options.builtins));
  context.used.functions.insert("fabs");
}

}  // namespace hamgen
