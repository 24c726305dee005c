#include "generator/formats/c_propagator.hpp"

#include <fmt/format.h>

#include "generator/program/propagator.hpp"

namespace hamgen {

namespace {

class CStepWriter {
 public:
  CStepWriter(CodeWriter& out, EmitContext& context, const CDialect& dialect)
      : out_(out),
        context_(context),
        code_(context.program),
        c_(dialect),
        propagator_(propagator_of(code_)),
        self_(dialect.named("Propagator")),
        coefficients_(code_.record("Coefficients") != nullptr) {}

  void write() {
    if (code_.record("Start") != nullptr) write_start();
    write_record();
    for (const Routine& routine : propagator_.routines) print(out_, routine, c_, context_.used);
    write_make();
    write_functions();
  }

 private:
  void close() {
    out_.close();
    out_.line();
  }

  void write_start() {
    const std::string type = c_.record("Start");
    out_.open(fmt::format("static inline {} {}(void)", type, c_.named("start")));
    out_.line(type + " start = {0};");
    for (const Field& field : code_.record("Start")->fields) {
      if (!field.type.starts_with("NewtonRule")) continue;
      out_.line(fmt::format("start.{} = {}({});", field.name, c_.block("NewtonRule_of_power"),
                            field.type == "NewtonRule<2>" ? 2 : 1));
    }
    out_.line("return start;");
    close();
  }

  void write_record() {
    out_.line(code_.has_carry() ? "// Many steps: rounding errors of the updates are carried along."
                                : "// Many steps: sums are plain.");
    out_.open("typedef struct");
    std::vector<std::pair<std::string, std::string>> members;
    for (const Field& field : propagator_.record.fields) {
      const std::string type = field.type == "Real"                ? c_.real()
                               : field.type == "long long"         ? field.type
                               : field.type.starts_with("History") ? c_.named("History")
                                                                   : c_.record(field.type);
      members.emplace_back(fmt::format("{} {}{};", type, field.name, sizes_text(field)),
                           field.name == "carry"   ? "what rounding took from z"
                           : field.name == "steps" ? "since the first state"
                                                   : "");
    }
    out_.aligned(members);
    out_.close(" " + self_ + ";");
    out_.line();
  }

  void write_make() {
    out_.open(fmt::format("static inline {0} {0}_make(const {1}* par, {2} h, const {3}* z)", self_,
                          c_.record("Parameters"), c_.real(), c_.record("State")));
    const std::size_t substeps = code_.substeps.size();
    if (substeps > 1) {
      std::vector<std::string> lengths;
      for (const Rational& length : code_.substeps)
        lengths.push_back(literal(length, context_.scalar));
      out_.line(fmt::format("const {} fractions[{}] = {{{}}};", c_.real(), substeps,
                            joined_texts(lengths, ", ")));
    }
    out_.line(self_ + " self = {0};");
    out_.line("self.par = *par;");
    out_.line("self.h = h;");
    if (substeps > 1) {
      out_.open(fmt::format("for (int i = 0; i < {}; ++i)", substeps));
      out_.line("self.lengths[i] = h * fractions[i];");
      if (coefficients_)
        out_.line(fmt::format("self.k[i] = {}(par, self.lengths[i]);", c_.routine("prepare")));
      out_.close();
    } else if (coefficients_) {
      out_.line(fmt::format("self.k = {}(par, h);", c_.routine("prepare")));
    }
    out_.line(self_ + "_reset(&self, z);");
    out_.line("return self;");
    close();
  }

  void write_functions() {
    const std::string t = context_.program.facts.has_time
                              ? "self->z." + context_.state_field(context_.n() - 1)
                              : "(" + c_.real() + ")self->steps * self->h";
    out_.line("// Since the first state, or t where the model has it.");
    out_.open(fmt::format("static inline {0} {1}_time(const {1}* self)", c_.real(), self_));
    out_.line("return " + t + ";");
    close();
    out_.line("// Advances *z by one step of size h.  On failure it is left unchanged.");
    out_.open(fmt::format("static inline {} {}(const {}* par, {} h, {}* z)", c_.block("StepReport"),
                          c_.named("step"), c_.record("Parameters"), c_.real(),
                          c_.record("State")));
    out_.line(fmt::format("{0} self = {0}_make(par, h, z);", self_));
    out_.line(fmt::format("const {} report = {}_step(&self);", c_.block("StepReport"), self_));
    out_.line("if (report.converged) *z = self.z;");
    out_.line("return report;");
    close();
  }

  CodeWriter& out_;
  EmitContext& context_;
  const Program& code_;
  const CDialect& c_;
  const Propagator propagator_;
  std::string self_;
  bool coefficients_;
};

}  // namespace

void write_c_record(CodeWriter& out, const Record& record, const CDialect& dialect) {
  for (const std::string& line : record.remark) out.remark("// ", line);
  out.open("typedef struct");
  std::vector<std::pair<std::string, std::string>> members;
  for (const Field& field : record.fields) {
    const std::string type = field.type == "Real"                   ? dialect.real()
                             : field.type.starts_with("NewtonRule") ? dialect.block("NewtonRule")
                                                                    : field.type;
    members.emplace_back(fmt::format("{} {}{};", type, field.name, sizes_text(field)),
                         field.remark);
  }
  if (members.empty()) members.emplace_back("char none;", "C has no empty records");
  out.aligned(members);
  out.close(" " + dialect.record(record.name) + ";");
  out.line();
}

void write_c_propagator(CodeWriter& out, EmitContext& context, const CDialect& dialect) {
  CStepWriter(out, context, dialect).write();
}

}  // namespace hamgen
