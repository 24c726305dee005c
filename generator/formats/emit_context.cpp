#include "generator/formats/emit_context.hpp"

#include <fmt/format.h>

namespace hamgen {

EmitContext::EmitContext(const Program& the_program, const EmitOptions& the_options,
                         const Dialect& the_dialect)
    : program(the_program),
      options(the_options),
      dialect(the_dialect),
      scalar(the_dialect.scalar),
      parameter_fields(place_texts(program.environment.parameter_layout)),
      state_fields(place_texts(program.environment.state_layout)),
      contents(contents_of(program, {.own_space = !options.spaces.method.empty(),
                                     .tangent = options.tangent,
                                     .lanes = options.lanes})) {}

std::string sizes_text(const Field& field) {
  std::string text;
  for (const int size : field.sizes) text += fmt::format("[{}]", size);
  return text;
}

}  // namespace hamgen
