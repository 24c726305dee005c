#include "generator/formats/c_pieces.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

class CPieceWriter {
 public:
  CPieceWriter(CodeWriter& out, EmitContext& context, const CDialect& dialect)
      : out_(out), context_(context), c_(dialect), self_(dialect.named("Propagator")) {}

  void operator()(const Record& record) {
    for (const std::string& line : record.remark) out_.remark("// ", line);
    write_record(record);
    if (record.name == "Parameters") write_defaults(record);
    if (record.name == "Start") write_start(record);
  }
  void operator()(const Routine& routine) { print(out_, routine, c_, context_.used); }
  void operator()(const Propagator& propagator) {
    for (const std::string& line : propagator.remark) out_.remark("// ", line);
    write_record(propagator.record);
    for (const Routine& routine : propagator.routines) (*this)(routine);
    write_make(propagator);
    for (const Accessor& accessor : propagator.accessors) {
      if (accessor.name == "time") write_time(accessor);  // the others are fields
    }
  }
  void operator()(const StepOfPropagator&) {
    out_.line("// Advances *z by one step of size h.  On failure it is left unchanged.");
    out_.open(fmt::format("static inline {} {}(const {}* par, {} h, {}* z)", c_.block("StepReport"),
                          c_.named("step"), c_.type("Parameters"), c_.real(), c_.type("State")));
    out_.line(fmt::format("{0} self = {0}_make(par, h, z);", self_));
    out_.line(fmt::format("const {} report = {}_step(&self);", c_.block("StepReport"), self_));
    out_.line("if (report.converged) *z = self.z;");
    out_.line("return report;");
    close();
  }
  // Refused: see require_c.
  void operator()(const ArrayMatrix&) {}
  void operator()(const Watch&) {}

 private:
  void close() {
    out_.close();
    out_.line();
  }

  void write_record(const Record& record) {
    out_.open("typedef struct");
    std::vector<std::pair<std::string, std::string>> members;
    for (const Field& field : record.fields) {
      members.emplace_back(
          fmt::format("{} {}{};", c_.type(field.type), field.name, sizes_text(field)),
          field.remark);
    }
    if (members.empty()) members.emplace_back("char none;", "C has no empty records");
    out_.aligned(members);
    out_.close(" " + c_.type(record.name) + ";");
    out_.line();
  }

  void write_defaults(const Record& parameters) {
    const std::string type = c_.type(parameters.name);
    out_.open(fmt::format("static inline {} {}(void)", type, c_.named("default_parameters")));
    std::vector<std::string> values;
    for (const Field& field : parameters.fields) {
      std::vector<std::string> list;
      for (const Rational& value : field.values) list.push_back(literal(value, context_.scalar));
      const std::string text = joined_texts(list, ", ");
      values.push_back(field.sizes.empty() ? text : "{" + text + "}");
    }
    out_.line(fmt::format("const {} par = {{{}}};", type,
                          values.empty() ? "0" : joined_texts(values, ", ")));
    out_.line("return par;");
    close();
  }

  void write_start(const Record& record) {
    const std::string type = c_.type(record.name);
    out_.open(fmt::format("static inline {} {}(void)", type, c_.named("start")));
    out_.line(type + " start = {0};");
    for (const Field& field : record.fields) {
      if (!field.type.starts_with("NewtonRule")) continue;
      out_.line(fmt::format("start.{} = {}({});", field.name, c_.block("NewtonRule_of_power"),
                            field.type.find("<2") != std::string::npos ? 2 : 1));
    }
    out_.line("return start;");
    close();
  }

  void write_make(const Propagator& propagator) {
    out_.open(fmt::format("static inline {0} {0}_make(const {1}* par, {2} h, const {3}* z)", self_,
                          c_.type("Parameters"), c_.real(), c_.type("State")));
    const std::size_t substeps = propagator.fractions.size();
    std::vector<std::string> fractions;
    for (const Rational& each : propagator.fractions)
      fractions.push_back(literal(each, context_.scalar));
    if (substeps > 0)
      out_.line(fmt::format("const {} fractions[{}] = {{{}}};", c_.real(), substeps,
                            joined_texts(fractions, ", ")));
    out_.line(self_ + " self = {0};");
    for (const Beginning& each : propagator.beginnings) {
      if (each.field == "z") continue;  // what reset does
      const std::string from = each.record.empty() ? each.from : "*" + each.from;
      out_.line(fmt::format("self.{} = {};", each.field,
                            each.routine.empty() ? from : made(each, each.from)));
    }
    if (substeps > 0) {
      out_.open(fmt::format("for (int i = 0; i < {}; ++i)", substeps));
      out_.line("self.lengths[i] = h * fractions[i];");
      for (const Beginning& each : propagator.substep_beginnings)
        out_.line(fmt::format("self.{}[i] = {};", each.field, made(each, "self.lengths[i]")));
      out_.close();
    }
    out_.line(self_ + "_reset(&self, z);");
    out_.line("return self;");
    close();
  }
  [[nodiscard]] std::string made(const Beginning& beginning, const std::string& from) const {
    return fmt::format("{}(par, {})", c_.routine(beginning.routine), from);
  }

  void write_time(const Accessor& accessor) {
    for (const std::string& line : accessor.remark) out_.remark("// ", line);
    out_.open(
        fmt::format("static inline {0} {1}_{2}(const {1}* self)", c_.real(), self_, accessor.name));
    out_.line(fmt::format("return {};", accessor.place ? c_.kept_place(*accessor.place)
                                                       : c_.number("self->steps") + " * self->h"));
    close();
  }

  CodeWriter& out_;
  EmitContext& context_;
  const CDialect& c_;
  std::string self_;
};

}  // namespace

void write_pieces(CodeWriter& out, EmitContext& context, const CDialect& dialect,
                  const std::vector<Piece>& pieces) {
  CPieceWriter writer(out, context, dialect);
  for (const Piece& piece : pieces) std::visit(writer, piece);
}

}  // namespace hamgen
