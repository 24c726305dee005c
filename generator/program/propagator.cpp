#include "generator/program/propagator_parts.hpp"

namespace hamgen {

namespace {

class PropagatorBuilder : public PropagatorParts {
 public:
  explicit PropagatorBuilder(const Program& code) : PropagatorParts(code) {}

  Propagator build() {
    Propagator result = shell();
    result.remark = {remark_of_many()};
    if (composed_) result.routines.push_back(substep());
    result.routines.push_back(composed_ ? composed_step() : step());
    for (Routine& routine : result.routines) of_step(routine.body);
    result.routines.push_back(code_.unchecked ? unchecked_advance() : advance());
    result.routines.push_back(reset("Begins anew at z, as a new Propagator would."));
    return result;
  }

  Routine single() {
    Routine routine{
        .name = "step",
        .remark = {code_.unchecked ? "Advances z by one step of size h."
                                   : "Advances z by one step of size h.  On failure z is left "
                                     "unchanged."},
        .result = {kReport},
        .arguments = {{"par", "Parameters"}, {"h"}, {"z", "State", {}, true}}};
    if (coefficients_) {
      add(routine, Call{.routine = "prepare",
                        .arguments = {{"par"}, {"h"}},
                        .record = "Coefficients",
                        .object = "k"});
    }
    if (start_) add(routine, Declare{"Start", {"start"}});
    if (ahead_) add(routine, Declare{"Derivatives", {"at"}});
    add_room(routine);
    Call call = solve({{"carry", {"new State"}}});
    call.varies = other_;
    add(routine, call);
    call.again = true;
    if (other_) add_other(routine, body_of(call), {"start", "patience"});
    if (!code_.unchecked) add(routine, failed(body_of(Return{.report = "report"})));
    each(routine, [&](const Place& at) {
      Expression increment = number(routine, of("dz", at));
      if (rest_) increment = increment + number(routine, of("rest", at));
      return Instruction{Accumulate{number(routine, of("z", at)).name(), increment}};
    });
    add(routine, Return{.report = "report"});
    return routine;
  }

 private:
  [[nodiscard]] std::string remark_of_many() const {
    std::string text = "Many steps: ";
    if (code_.retries) text += "start values are extrapolated";
    if (carry_) {
      return text + (code_.retries ? ", rounding errors of the updates carried along."
                                   : "rounding errors of the updates are carried along.");
    }
    return text + (code_.retries ? "; sums are plain." : "sums are plain.");
  }

  // A solve and the update of z.
  void add_part(Routine& routine, const std::string& z, const std::string& carry) const {
    if (!large_) add_room(routine);
    const Call call = solve_kept(z, carry);
    if (code_.retries) {
      add_tries(routine, call);
    } else {
      add(routine, call);
      if (!code_.unchecked) add(routine, failed(body_of(Return{.report = "report"})));
    }
    add_update(routine, z, carry);
  }

  // Where the step has failed and there are times left to the other solver.
  static void add_other(Routine& routine, Body body, Place patience) {
    If failed{{"report", "converged"}, false, std::move(body), std::move(patience)};
    routine.body.push_back({std::move(failed), {kOther}});
  }

  // From what earlier steps make likely, and where that fails from the state.
  void add_tries(Routine& routine, Call call) const {
    const Place value{own("start"), "value"};
    const Place history{own("history")};
    const Place known = extrapolates_ ? Place{own("start"), "known"} : Place{"known"};
    if (extrapolates_) {
      add(routine, Ask{known, {history.object, "known"}});
      add(routine, If{known, true, body_of(Use{"History", "extrapolate", {history, value}})});
    } else {
      add(routine, Note{"bool", "known", {own("start"), "known"}, other_});
    }
    call.varies = true;
    add(routine, call);
    if (other_) add_other(routine, body_of(SetFlag{known}), {own("start"), "patience"});
    call.again = true;
    Body again = {{Note{"long long", "wasted", {"report", "iterations"}},
                   {"Extrapolation may lead astray, the state itself seldom does."}}};
    if (extrapolates_) forget_start(again);
    add(again, call);
    add(again, Count{{"report", "iterations"}, Place{"wasted"}});
    add(routine, If{{"report", "converged"}, false, std::move(again), known});
    add(routine, failed(body_of(Return{.report = "report"})));
    add_memory(routine);
  }

  // A matrix that is there stays, and what is large makes no temporary.
  void forget_start(Body& body) const {
    if (!large_) return add(body, Forget{{own("start")}, "Start"});
    add(body, Forget{{own("start"), "known"}, "bool"});
    for (const RuleOfNewton& rule : code_.rules) {
      add(body, Forget{{own("start"), rule.name}, "NewtonRule"});
    }
  }

  Routine step() const {
    Routine routine{
        .name = "step",
        .remark = {code_.unchecked ? "One step: H is a polynomial, and has a step everywhere."
                                   : "One step; on failure the state stays as it was."},
        .result = {kReport},
        .of_run = true};
    add_part(routine, "self.z", "self.carry");
    if (counts_) add(routine, Count{{"self", "steps"}});
    add(routine, Return{.report = "report"});
    return routine;
  }

  Routine substep() const {
    Routine routine = empty_substep();
    add_part(routine, "z", "carry");
    add(routine, Return{.report = "report"});
    return routine;
  }

  Routine composed_step() const {
    Routine routine{
        .name = "step",
        .remark = {"One step; on failure the state stays as it was before its first substep."},
        .result = {kReport},
        .of_run = true};
    begin_total(routine);
    Body body = body_of(call_of_substep());
    add_to_total(routine, body);
    Body end = body_of(Return{.report = "total"});
    if (extrapolates_) end = forget_all();
    add(body, failed(std::move(end)));
    add(routine, Repeat{"int", "i", "substeps", substeps(), body});
    add(routine, Copy{"State", "self.z", "z"});
    if (carry_) add(routine, Copy{"State", "self.carry", "carry"});
    if (counts_) add(routine, Count{{"self", "steps"}});
    add(routine, SetFlag{{"total", "converged"}});
    add(routine, Return{.report = "total"});
    return routine;
  }

  [[nodiscard]] Body forget_all() const {
    Body body;
    if (large_) {
      for (const RuleOfNewton& rule : code_.rules) {
        add(body, Forget{{"self.start", rule.name}, "NewtonRule", substeps()});
      }
    } else {
      add(body, Forget{{"self.start"}, "Start", substeps()});
    }
    add(body, Forget{{"self.history"}, "History", substeps()});
    body.front().remark = {"Those before have seen a step that will not be."};
    add(body, Return{.report = "total"});
    return body;
  }

  Routine advance() const {
    Routine routine{.name = "advance",
                    .remark = {"Up to `steps` steps; stops at the first failure.  The report sums "
                               "the iterations."},
                    .result = {kReport},
                    .arguments = {{.name = "steps", .count = "long long"}},
                    .of_run = true};
    add(routine, Declare{kReport, {"total"}});
    add(routine, SetFlag{{"total", "converged"}});
    Body body = {{Call{.routine = "step",
                       .arguments = {},
                       .record = kReport,
                       .object = "report",
                       .of_run = true}}};
    add_to_total(routine, body);
    add(body, failed(body_of(SetFlag{{"total", "converged"}, false}, Break{})));
    add(routine, Repeat{"long long", "i", "steps", 0, body});
    add(routine, Return{.report = "total"});
    return routine;
  }

  // Without a look at every step.
  Routine unchecked_advance() const {
    Routine routine =
        of_run("advance", "So many steps.  The report says whether the state is finite afterwards.",
               {{.name = "steps", .count = "long long"}});
    add(routine, Declare{kReport, {"total"}});
    const Call one{.routine = "step", .arguments = {}, .record = kReport, .of_run = true};
    add(routine, Repeat{"long long", "i", "steps", 0, body_of(one)});
    RequireFinite finite{.report = "total", .numbers = {}};
    const AffineIndex index{0, {{"i", 1}}};
    if (large_) {
      finite.numbers = {{"self.z", "q", {index}}, {"self.z", "p", {index}}};
      finite.count = code_.environment.degrees_of_freedom;
    } else {
      for (const Place& place : code_.changed) finite.numbers.push_back(of("self.z", place));
    }
    add(routine, finite);
    add(routine, Return{.report = "total"});
    return routine;
  }
};

}  // namespace

Propagator propagator_of(const Program& code) { return PropagatorBuilder(code).build(); }

Routine single_step(const Program& code) { return PropagatorBuilder(code).single(); }

const Record& step_report() {
  static const Record record{.name = "StepReport",
                             .fields = {{.name = "converged", .type = "bool"},
                                        {.name = "iterations", .type = "int"},
                                        {.name = "increment"}}};
  return record;
}

}  // namespace hamgen
