// The class Propagator.
#include <fmt/format.h>

#include "generator/formats/cpp_pieces.hpp"

namespace hamgen {

namespace {

class PropagatorWriter {
 public:
  PropagatorWriter(CodeWriter& out, EmitContext& context, const Propagator& propagator)
      : out_(out),
        context_(context),
        propagator_(propagator),
        composed_(!propagator.fractions.empty()),
        lanes_(context.dialect.has_lanes()),
        number_(lanes_ ? "const Real&" : "Real") {}

  void write() {
    for (const std::string& line : propagator_.remark) out_.remark("// ", line);
    out_.open("class Propagator");
    access(" public:");
    for (const auto& [name, value] : propagator_.constants)
      out_.line(fmt::format("static constexpr int {} = {};", name, value));
    if (!propagator_.constants.empty()) out_.line();
    if (lanes_) out_.line("// A step size for each lane.");
    write_constructor();
    out_.line();
    for (const Routine& routine : propagator_.routines) {
      if (routine.name != "substep") write_routine(routine);
    }
    for (const Accessor& accessor : propagator_.accessors) write_accessor(accessor);
    out_.line();
    access(" private:");
    if (composed_) write_routine(propagator_.routines.front());
    write_members();
    out_.close(";");
    out_.line();
  }

 private:
  void write_routine(const Routine& routine) {
    print(out_, routine, context_.dialect, context_.used);
  }

  void access(const char* line) {
    out_.dedent();
    out_.line(line);
    out_.indent();
  }

  void write_constructor() {
    std::string initialisers;
    for (const Beginning& each : propagator_.beginnings) {
      const std::string value =
          each.routine.empty() ? each.from : fmt::format("{}(par, {})", each.routine, each.from);
      initialisers += fmt::format("{}{}_({})", initialisers.empty() ? "" : ", ", each.field, value);
    }
    const std::string head =
        fmt::format("Propagator(const Parameters& par, {} h, const State& z)", number_);
    if (composed_) {
      out_.open(head + " : " + initialisers);
      write_substeps();
      out_.close();
    } else if (head.size() + initialisers.size() > 90) {
      out_.line(head);
      out_.line("    : " + initialisers + " {}");
    } else {
      out_.line(head + " : " + initialisers + " {}");
    }
  }

  void write_substeps() {
    std::vector<std::string> fractions;
    for (const Rational& each : propagator_.fractions)
      fractions.push_back(literal(each, context_.scalar));
    out_.line(fmt::format("constexpr {} fractions[substeps] = {{{}}};",
                          lanes_ ? context_.scalar.cpp : "Real", joined_texts(fractions, ", ")));
    out_.open("for (int i = 0; i < substeps; ++i)");
    out_.line("lengths_[i] = h * fractions[i];");
    for (const Beginning& each : propagator_.substep_beginnings)
      out_.line(fmt::format("{}_[i] = {}(par, {}_[i]);", each.field, each.routine, each.from));
    out_.close();
  }

  void write_accessor(const Accessor& accessor) {
    for (const std::string& line : accessor.remark) out_.remark("// ", line);
    const bool number = accessor.type == "Real";
    const std::string type = !number          ? "const " + accessor.type + "&"
                             : accessor.place ? number_
                                              : "Real";
    out_.line(fmt::format("[[nodiscard]] {} {}() const {{ return {}; }}", type, accessor.name,
                          accessor.place ? context_.dialect.kept_place(*accessor.place)
                          : lanes_       ? "steps_ * h_"
                                         : "static_cast<Real>(steps_) * h_"));
  }

  void write_members() {
    const std::vector<Field>& fields = propagator_.record.fields;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field& field = fields[i];
      if (field.name == "rest") continue;  // beside dz
      const bool pair = i + 1 < fields.size() && fields[i + 1].name == "rest";
      const bool numbers = !field.sizes.empty() && field.type == "Real";
      std::string value = numbers ? " = {}" : "";
      if (!field.values.empty())
        value = field.type == "Mask" ? " = true" : " = " + field.values.front().get_str();
      out_.line(fmt::format("{} {}_{}{}{};", field.type, field.name,
                            field.sizes.empty() ? "" : "[substeps]", value, pair ? ", rest_" : ""));
    }
  }

  CodeWriter& out_;
  EmitContext& context_;
  const Propagator& propagator_;
  bool composed_, lanes_;
  const char* number_;  // as it is handed on
};

}  // namespace

void write_propagator(CodeWriter& out, EmitContext& context, const Propagator& propagator) {
  PropagatorWriter(out, context, propagator).write();
}

}  // namespace hamgen
