#include "generator/formats/c_propagator.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

class CStepWriter {
 public:
  CStepWriter(CodeWriter& out, const EmitContext& context, const CDialect& dialect)
      : out_(out),
        context_(context),
        code_(context.program),
        c_(dialect),
        self_(dialect.named("Propagator")),
        report_(dialect.block("StepReport")),
        coefficients_(code_.record("Coefficients") != nullptr),
        start_(code_.record("Start") != nullptr),
        history_(code_.unknowns > 0),
        carry_(code_.has_carry()),
        each_(fmt::format("[{}]", code_.substeps.size())) {}

  void write() {
    if (start_) write_start();
    write_record();
    write_reset();
    write_make();
    write_substep();
    write_step();
    write_advance();
    write_functions();
  }

 private:
  // Opens a function of the Propagator.
  void open(const std::string& type, const std::string& name, const std::string& arguments = "") {
    out_.open(
        fmt::format("static inline {} {}_{}({}* self{})", type, self_, name, self_, arguments));
  }
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
    out_.line(carry_ ? "// Many steps: rounding errors of the updates are carried along."
                     : "// Many steps: sums are plain.");
    out_.open("typedef struct");
    out_.line(c_.record("Parameters") + " par;");
    out_.line(c_.real() + " h;");
    out_.line(c_.record("State") + " z;");
    if (carry_)
      out_.line(fmt::format("{} carry;  // what rounding took from z", c_.record("State")));
    out_.line("long long steps;  // since the first state");
    out_.line(fmt::format("{} lengths{};", c_.real(), each_));
    if (coefficients_) out_.line(fmt::format("{} k{};", c_.record("Coefficients"), each_));
    if (start_) out_.line(fmt::format("{} start{};", c_.record("Start"), each_));
    if (history_) out_.line(fmt::format("{} history{};", c_.named("History"), each_));
    out_.close(" " + self_ + ";");
    out_.line();
  }

  void forget(const std::string& i) {
    if (start_) out_.line(fmt::format("self->start[{}] = {}();", i, c_.named("start")));
    if (history_) out_.line(fmt::format("{}(&self->history[{}]);", c_.named("History_forget"), i));
  }

  void write_reset() {
    out_.line("// Begins anew at z.");
    open("void", "reset", fmt::format(", const {}* z", c_.record("State")));
    out_.line("self->z = *z;");
    if (carry_) out_.line(fmt::format("self->carry = {};", c_.empty_record("State")));
    out_.line("self->steps = 0;");
    if (start_ || history_) {
      out_.open(head_of_substeps());
      forget("i");
      out_.close();
    }
    close();
  }

  [[nodiscard]] std::string head_of_substeps() const {
    return fmt::format("for (int i = 0; i < {}; ++i)", code_.substeps.size());
  }

  void write_make() {
    std::string lengths;
    for (const Rational& length : code_.substeps) {
      lengths += (lengths.empty() ? "" : ", ") + literal(length, context_.scalar);
    }
    out_.open(fmt::format("static inline {0} {0}_make(const {1}* par, {2} h, const {3}* z)", self_,
                          c_.record("Parameters"), c_.real(), c_.record("State")));
    out_.line(fmt::format("const {} fractions{} = {{{}}};", c_.real(), each_, lengths));
    out_.line(self_ + " self = {0};");
    out_.line("self.par = *par;");
    out_.line("self.h = h;");
    out_.open(head_of_substeps());
    out_.line("self.lengths[i] = h * fractions[i];");
    if (coefficients_) {
      out_.line(fmt::format("self.k[i] = {}(par, self.lengths[i]);", c_.routine("prepare")));
    }
    out_.close();
    out_.line(self_ + "_reset(&self, z);");
    out_.line("return self;");
    close();
  }

  [[nodiscard]] std::string solve() const {
    std::string list;
    for (const Argument& argument : code_.routine("solve")->arguments) {
      const std::string& name = argument.name;
      const std::string text = name == "par"                    ? "&self->par"
                               : name == "h"                    ? "self->lengths[i]"
                               : name == "k" || name == "start" ? "&self->" + name + "[i]"
                               : name == "dz" || name == "rest" ? "&" + name
                                                                : name;
      list += (list.empty() ? "" : ", ") + text;
    }
    return c_.routine("solve") + "(" + list + ")";
  }

  void write_substep() {
    out_.line(carry_ ? "// Part i of a step, from *z + *carry." : "// Part i of a step.");
    open(report_, "substep",
         fmt::format(fmt::runtime(carry_ ? ", int i, {0}* z, {0}* carry" : ", int i, {0}* z"),
                     c_.record("State")));
    out_.line(c_.declaration("State", "dz"));
    if (code_.has_rest()) out_.line(c_.declaration("State", "rest"));
    if (history_) {
      out_.line("self->start[i].known = self->history[i].known > 0;");
      out_.line(
          fmt::format("if (self->start[i].known) {}(&self->history[i], self->start[i].value);",
                      c_.named("History_extrapolate")));
    }
    out_.line(fmt::format("{} report = {};", report_, solve()));
    if (history_) {
      out_.open("if (!report.converged && self->start[i].known)");
      out_.line("// Extrapolation may lead astray, the state itself seldom does.");
      out_.line("const long long wasted = report.iterations;");
      out_.line(fmt::format("self->start[i] = {}();", c_.named("start")));
      out_.line("report = " + solve() + ";");
      out_.line("report.iterations += wasted;");
      out_.close();
    }
    if (!code_.unchecked) out_.line("if (!report.converged) return report;");
    for (const RuleOfNewton& rule : code_.rules) {
      out_.line(
          fmt::format("{}(&self->history[i], &self->start[i].{}, self->start[i].value, {}, {});",
                      c_.named("History_watch"), rule.name, rule.first, rule.count));
    }
    if (history_) {
      out_.line(
          fmt::format("{}(&self->history[i], self->start[i].value);", c_.named("History_record")));
    }
    for (const Place& place : code_.changed) {
      const std::string x = to_text(place).substr(1);
      out_.line(!carry_ ? fmt::format("z->{0} += dz.{0};", x)
                : code_.has_rest()
                    ? fmt::format("{0}(&z->{1}, &carry->{1}, dz.{1}, rest.{1});",
                                  c_.block("two_sum_with_rest"), x)
                    : fmt::format("{0}(&z->{1}, &carry->{1}, dz.{1});", c_.block("two_sum"), x));
    }
    out_.line("return report;");
    close();
  }

  void write_step() {
    out_.line("// One step; on failure the state stays as it was.");
    open(report_, "step");
    out_.line(c_.record("State") + " z = self->z;");
    if (carry_) out_.line(c_.record("State") + " carry = self->carry;");
    out_.line(report_ + " total = {0};");
    out_.open(head_of_substeps());
    out_.line(fmt::format("const {} report = {}_substep(self, i, &z{});", report_, self_,
                          carry_ ? ", &carry" : ""));
    out_.line("total.iterations += report.iterations;");
    out_.line("total.increment = report.increment;");
    out_.open("if (!report.converged)");
    if (history_ && code_.substeps.size() > 1) {
      out_.line("// Those before have seen a step that will not be.");
      out_.open(fmt::format("for (int j = 0; j < {}; ++j)", code_.substeps.size()));
      forget("j");
      out_.close();
    }
    out_.line("return total;");
    out_.close();
    out_.close();
    out_.line("self->z = z;");
    if (carry_) out_.line("self->carry = carry;");
    out_.line("++self->steps;");
    out_.line("total.converged = true;");
    out_.line("return total;");
    close();
  }

  void write_advance() {
    out_.line(
        "// Up to `steps` steps; stops at the first failure.  The report sums the iterations.");
    open(report_, "advance", ", long long steps");
    out_.line(report_ + " total = {0};");
    out_.line("total.converged = true;");
    out_.open("for (long long i = 0; i < steps && total.converged; ++i)");
    out_.line(fmt::format("const {} report = {}_step(self);", report_, self_));
    out_.line("total.iterations += report.iterations;");
    out_.line("total.increment = report.increment;");
    out_.line("total.converged = report.converged;");
    out_.close();
    if (code_.unchecked) {
      out_.line("// H is a polynomial: no step fails, but where numbers end.");
      out_.line(c_.real() + " rest = 0;");
      for (const Place& place : code_.changed) {
        const std::string x = to_text(place).substr(1);
        out_.line(fmt::format("rest += self->z.{0} - self->z.{0};", x));
      }
      out_.line("total.converged = rest == 0;");
    }
    out_.line("return total;");
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
    out_.open(fmt::format("static inline {} {}(const {}* par, {} h, {}* z)", report_,
                          c_.named("step"), c_.record("Parameters"), c_.real(),
                          c_.record("State")));
    out_.line(fmt::format("{0} self = {0}_make(par, h, z);", self_));
    out_.line(fmt::format("const {} report = {}_step(&self);", report_, self_));
    out_.line("if (report.converged) *z = self.z;");
    out_.line("return report;");
    close();
  }

  CodeWriter& out_;
  const EmitContext& context_;
  const Program& code_;
  const CDialect& c_;
  std::string self_, report_;
  bool coefficients_, start_, history_, carry_;
  std::string each_;  // "[substeps]"
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

void write_c_propagator(CodeWriter& out, const EmitContext& context, const CDialect& dialect) {
  CStepWriter(out, context, dialect).write();
}

}  // namespace hamgen
