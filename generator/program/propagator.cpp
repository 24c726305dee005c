#include "generator/program/propagator.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

namespace hamgen {

namespace {

constexpr const char* kReport = "StepReport";

class PropagatorBuilder {
 public:
  explicit PropagatorBuilder(const Program& code)
      : code_(code),
        composed_(code.substeps.size() > 1),
        large_(code.environment.arrays),
        coefficients_(code.record("Coefficients") != nullptr),
        start_(code.record("Start") != nullptr),
        extrapolates_(code.unknowns > 0),
        rest_(code.has_rest()),
        carry_(code.has_carry()),
        counts_(!code.facts.has_time) {}

  Propagator build() {
    Propagator result;
    result.record = record();
    if (composed_) result.routines.push_back(substep());
    result.routines.push_back(composed_ ? composed_step() : step());
    result.routines.push_back(code_.unchecked ? unchecked_advance() : advance());
    result.routines.push_back(reset());
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
    add_room(routine);
    add(routine, solve({{"carry", {"new State"}}}));
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
  template <class... Node>
  static Body body_of(Node... nodes) {
    return {Instruction{std::move(nodes)}...};
  }
  template <class Node>
  static void add(Body& body, Node node) {
    body.push_back(Instruction{std::move(node)});
  }
  template <class Node>
  static void add(Routine& routine, Node node) {
    add(routine.body, std::move(node));
  }
  // A number at a place, as a symbol of the routine.
  static Expression number(Routine& routine, const Place& place) {
    const std::string symbol = to_text(place);
    routine.places[symbol] = place;
    return Expression::symbol(symbol);
  }
  static Place of(const std::string& object, Place place) {
    place.object = object;
    return place;
  }
  // What each substep of a composition has its own of.
  [[nodiscard]] std::string own(const std::string& name) const {
    return "self." + name + (composed_ ? "[i]" : "");
  }
  // How many there are of it, or 0 of a method that is no composition.
  [[nodiscard]] int substeps() const {
    return composed_ ? static_cast<int>(code_.substeps.size()) : 0;
  }
  static If failed(Body then) { return {{"report", "converged"}, false, std::move(then)}; }

  // The instruction for every component that changes.
  void each(Routine& routine, const std::function<Instruction(const Place&)>& one) const {
    if (!large_) {
      for (const Place& place : code_.changed)
        routine.body.push_back(one({"", place.field, place.indices}));
      return;
    }
    const std::string i = composed_ ? "j" : "i";  // a substep has its number i
    const AffineIndex index{0, {{i, 1}}};
    add(routine, For{{i, {}, {code_.environment.degrees_of_freedom - 1, {}}},
                     {one({"", "q", {index}}), one({"", "p", {index}})}});
  }

  [[nodiscard]] Record record() const {
    Record result{.name = "Propagator", .fields = {}};
    const auto add_field = [&](const std::string& type, const std::string& name, bool own_of_each) {
      std::vector<int> sizes;
      if (own_of_each && composed_) sizes.push_back(static_cast<int>(code_.substeps.size()));
      result.fields.push_back({.name = name, .sizes = std::move(sizes), .type = type});
    };
    add_field("Parameters", "par", false);
    add_field("Real", "h", false);
    add_field("State", "z", false);
    if (carry_) add_field("State", "carry", false);
    if (counts_) add_field("long long", "steps", false);
    if (composed_) add_field("Real", "lengths", true);
    if (coefficients_) add_field("Coefficients", "k", true);
    if (start_) add_field("Start", "start", true);
    if (extrapolates_) add_field(fmt::format("History<{}>", code_.unknowns), "history", true);
    if (large_) add_field("State", "dz", false);
    if (large_ && rest_) add_field("State", "rest", false);
    return result;
  }

  // What is large has its place in the Propagator.
  [[nodiscard]] Place room(const std::string& name) const {
    return {(large_ ? "self." : "") + name};
  }
  void add_room(Routine& routine) const {
    if (rest_) return add(routine, Declare{"State", {"dz", "rest"}});
    add(routine, Declare{"State", {"dz"}});
  }

  [[nodiscard]] Call solve(const std::map<std::string, Place>& names) const {
    Call call{.routine = "solve", .arguments = {}, .record = kReport, .object = "report"};
    for (const Argument& argument : code_.routine("solve")->arguments) {
      const auto found = names.find(argument.name);
      call.arguments.push_back(found == names.end() ? Place{argument.name} : found->second);
    }
    return call;
  }

  // A solve and the update of z.
  void add_part(Routine& routine, const std::string& z, const std::string& carry) const {
    if (!large_) add_room(routine);
    const Call call = solve({{"par", {"self.par"}},
                             {"k", {own("k")}},
                             {"h", {"self", composed_ ? "lengths[i]" : "h"}},
                             {"z", {z}},
                             {"carry", {carry}},
                             {"start", {own("start")}},
                             {"dz", room("dz")},
                             {"rest", room("rest")}});
    if (code_.retries) {
      add_tries(routine, call);
    } else {
      add(routine, call);
      if (!code_.unchecked) add(routine, failed(body_of(Return{.report = "report"})));
    }
    each(routine, [&](const Place& at) -> Instruction {
      if (!carry_) {
        return {Accumulate{number(routine, of(z, at)).name(),
                           number(routine, of(room("dz").object, at))}};
      }
      Use sum{.block = "two_sum",
              .arguments = {of(z, at), of(carry, at), of(room("dz").object, at)}};
      if (rest_) {
        sum.block = "two_sum_with_rest";
        sum.arguments.push_back(of(room("rest").object, at));
      }
      return {sum};
    });
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
      add(routine, Note{"bool", "known", {own("start"), "known"}});
    }
    call.varies = true;
    add(routine, call);
    call.again = true;
    Body again = {{Note{"long long", "wasted", {"report", "iterations"}},
                   {"Extrapolation may lead astray, the state itself seldom does."}}};
    if (extrapolates_) forget_start(again);
    add(again, call);
    add(again, Count{{"report", "iterations"}, Place{"wasted"}});
    add(routine, If{{"report", "converged"}, false, std::move(again), known});
    add(routine, failed(body_of(Return{.report = "report"})));
    for (const RuleOfNewton& rule : code_.rules) {
      add(routine, Use{"NewtonRule",
                       "watch",
                       {{own("start"), rule.name},
                        history,
                        value,
                        {"", "", {{rule.first, {}}}},
                        {"", "", {{rule.count, {}}}}}});
    }
    if (extrapolates_) add(routine, Use{"History", "record", {history, value}});
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
    Routine routine{.name = "substep",
                    .remark = {carry_ ? "Substep i from z + carry." : "Substep i."},
                    .result = {kReport},
                    .arguments = {{.name = "i", .count = "int"}, {"z", "State", {}, true}},
                    .of_run = true};
    if (carry_) routine.arguments.push_back({"carry", "State", {}, true});
    add_part(routine, "z", "carry");
    add(routine, Return{.report = "report"});
    return routine;
  }

  // report of a part, which the total counts.
  void add_to_total(Routine& routine, Body& body) const {
    add(body, Count{{"total", "iterations"}, Place{"report", "iterations"}});
    add(body, Assign{number(routine, {"total", "increment"}).name(),
                     number(routine, {"report", "increment"})});
  }

  Routine composed_step() const {
    Routine routine{
        .name = "step",
        .remark = {"One step; on failure the state stays as it was before its first substep."},
        .result = {kReport},
        .of_run = true};
    add(routine, Copy{"State", "z", "self.z", true});
    if (carry_) add(routine, Copy{"State", "carry", "self.carry", true});
    add(routine, Declare{kReport, {"total"}});
    Call part{.routine = "substep",
              .arguments = {{"i"}, {"z"}},
              .record = kReport,
              .object = "report",
              .of_run = true};
    if (carry_) part.arguments.push_back({"carry"});
    Body body = body_of(part);
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
    Routine routine{
        .name = "advance",
        .remark = {"So many steps.  The report says whether the state is finite afterwards."},
        .result = {kReport},
        .arguments = {{.name = "steps", .count = "long long"}},
        .of_run = true};
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

  Routine reset() const {
    Routine routine{.name = "reset",
                    .remark = {"Begins anew at z, as a new Propagator would."},
                    .result = {},
                    .arguments = {{"z", "State"}},
                    .of_run = true};
    add(routine, Copy{"State", "self.z", "z"});
    if (carry_) add(routine, Copy{"State", "self.carry", ""});
    if (counts_) add(routine, Forget{{"self", "steps"}, "int"});
    if (start_ && !large_) add(routine, Forget{{"self.start"}, "Start", substeps()});
    if (start_ && large_) {
      // What decides how the next step begins; arrays and matrices are filled before they are read.
      for (const Field& field : code_.record("Start")->fields) {
        if (!field.sizes.empty() || field.type == "Matrix") continue;
        add(routine, Forget{{"self.start", field.name}, field.type, substeps()});
      }
    }
    if (extrapolates_) add(routine, Forget{{"self.history"}, "History", substeps()});
    return routine;
  }

  const Program& code_;
  bool composed_, large_, coefficients_, start_, extrapolates_, rest_, carry_, counts_;
};

}  // namespace

Propagator propagator_of(const Program& code) { return PropagatorBuilder(code).build(); }

Routine single_step(const Program& code) { return PropagatorBuilder(code).single(); }

const Record& step_report() {
  static const Record record{.name = kReport,
                             .fields = {{.name = "converged", .type = "bool"},
                                        {.name = "iterations", .type = "int"},
                                        {.name = "increment"}}};
  return record;
}

}  // namespace hamgen
