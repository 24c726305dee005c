#include "generator/formats/cpp_pieces.hpp"

#include <fmt/format.h>

#include "generator/program/written_code.hpp"

namespace hamgen {

namespace {

std::string initial_value(const Field& field, const ScalarType& scalar) {
  std::string values;
  for (const Rational& value : field.values) {
    const std::string text = field.type == "int"                            ? value.get_str()
                             : field.type != "bool" && field.type != "Mask" ? literal(value, scalar)
                             : value == 0                                   ? "false"
                                                                            : "true";
    values += (values.empty() ? "" : ", ") + text;
  }
  if (!field.sizes.empty()) return " = {" + values + "}";
  if (!values.empty()) return " = " + values;
  return field.type == "Real" ? " = " + literal(0, scalar) : "";
}

class PieceWriter {
 public:
  PieceWriter(CodeWriter& out, EmitContext& context) : out_(out), context_(context) {}

  void operator()(const Record& record) {
    for (const std::string& line : record.remark) out_.remark("// ", line);
    std::string head = "struct " + record.name;
    if (record.extends) head += " : ::" + context_.options.spaces.system + "::" + record.name;
    if (record.fields.empty()) {
      out_.line(head + " {};");
      return out_.line();
    }
    out_.open(head);
    std::vector<std::pair<std::string, std::string>> members;
    for (const Field& field : record.fields) {
      members.emplace_back(fmt::format("{} {}{}{};", field.type, field.name, sizes_text(field),
                                       initial_value(field, context_.scalar)),
                           field.remark);
    }
    out_.aligned(members);
    out_.close(";");
    out_.line();
  }
  void operator()(const Routine& routine) { print(out_, routine, context_.dialect, context_.used); }
  void operator()(const ArrayMatrix& matrix) {
    out_.line(fmt::format("using Matrix = {};", written::type_of(matrix)));
    out_.line();
  }
  void operator()(const Propagator& propagator) { write_propagator(out_, context_, propagator); }
  void operator()(const Watch& watch) { write_watch(out_, context_, watch); }
  void operator()(const StepOfPropagator&) {
    const bool lanes = context_.dialect.has_lanes();
    out_.line(lanes ? "// Advances the lanes of z by one step of size h.  One that fails is left "
                      "unchanged."
                    : "// Advances z by one step of size h.  On failure z is left unchanged.");
    out_.open(
        fmt::format("[[nodiscard]] inline StepReport step(const Parameters& par, {} h, State& z)",
                    lanes ? "const Real&" : "Real"));
    out_.line("Propagator propagator(par, h, z);");
    out_.line("const StepReport report = propagator.step();");
    out_.line(lanes ? "z = propagator.state();" : "if (report.converged) z = propagator.state();");
    out_.line("return report;");
    out_.close();
    out_.line();
  }

 private:
  CodeWriter& out_;
  EmitContext& context_;
};

}  // namespace

void write_pieces(CodeWriter& out, EmitContext& context, const std::vector<Piece>& pieces) {
  PieceWriter writer(out, context);
  for (const Piece& piece : pieces) std::visit(writer, piece);
}

}  // namespace hamgen
