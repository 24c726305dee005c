// Trajectories in lanes: a lane whose step fails stays where it was, and the others go on.
#include <algorithm>

#include "generator/program/propagator_parts.hpp"

namespace hamgen {

namespace {

class LanePropagatorBuilder : public PropagatorParts {
 public:
  LanePropagatorBuilder(const Program& code, int lanes) : PropagatorParts(code), lanes_(lanes) {}

  Propagator build() {
    Propagator result = shell();
    result.remark = {
        "Trajectories side by side, each as if it were alone.  A lane whose step fails stays where",
        "it was before it, for good, and the others go on."};
    result.constants.insert(result.constants.begin(), {"lanes", lanes_});
    const auto h = std::ranges::find(result.accessors, "time", &Accessor::name);
    if (!h->place) h->remark = {"Since the first state, of each lane."};
    result.accessors.insert(h, {"running",
                                "Mask",
                                running(),
                                {"The lanes none of whose steps has failed: running()[0], ..."}});
    std::vector<Field>& fields = result.record.fields;
    const auto of_all = std::ranges::find(fields, "steps", &Field::name);
    if (of_all != fields.end()) of_all->type = "Real";
    fields.push_back({.name = "running", .values = {1}, .type = "Mask"});
    if (composed_) result.routines.push_back(substep());
    result.routines.push_back(composed_ ? composed_step() : step());
    result.routines.push_back(advance());
    result.routines.push_back(reset("All lanes begin anew at z, as in a new Propagator."));
    add(result.routines.back(), SetFlag{{"self", "running"}});
    return result;
  }

 private:
  int lanes_;

  static Place running() { return {"self", "running"}; }
  static Use in_lanes(const std::string& block, const Place& lanes, std::vector<Place> arguments) {
    arguments.insert(arguments.begin(), lanes);
    return {.block = block, .arguments = std::move(arguments)};
  }
  // A solve; where it starts from what is known of earlier steps, and lanes fail, it is tried again
  // in these.
  void add_solve(Routine& routine, const std::string& z, const std::string& carry) const {
    if (!large_) add_room(routine);
    Call call = solve_kept(z, carry);
    call.varies = true;
    if (!code_.retries) return add(routine, call);
    const std::string start = own("start");
    const Place known = extrapolates_ ? Place{start, "known"} : Place{"known"};
    add(routine, Use{"Turn", "begin", {{start, "turn"}, running()}});
    if (extrapolates_) {
      add(routine, Ask{known, {own("history"), "known"}});
      add(routine, Use{"History", "extrapolate", {{own("history")}, {start, "value"}}});
    } else {
      add(routine, Note{"Mask", "known", {start, "known"}});
    }
    add(routine, call);
    std::vector<Place> seen = {running(), known, {"report"}};
    if (other_) seen.push_back({start, "patience"});
    add(routine, Call{.routine = "astray_lanes",
                      .arguments = std::move(seen),
                      .record = "Mask",
                      .object = "astray"});
    add_again(routine, call);
    add_memory(routine);
  }

  void add_again(Routine& routine, Call call) const {
    const std::string start = own("start");
    const Place astray{"astray"};
    const std::string lanes = number(routine, {start, "turn.lanes"}).name();
    Body body = {{Assign{lanes, number(routine, astray)},
                  {"Extrapolation may lead astray, the state itself seldom does."}}};
    if (extrapolates_) add(body, SetFlag{{start, "known"}, false});
    for (const RuleOfNewton& rule : code_.rules)
      add(body, Use{"NewtonRule", "forget", {{start, rule.name}, astray}});
    call.object = "second";
    call.varies = false;
    add(body, call);
    add(body, in_lanes("take_lanes", astray, {{"report"}, {"second"}}));
    add(routine, If{.flag = astray, .then = std::move(body), .any = true});
  }

  // The state of the lanes that run, and how many steps they have taken.
  void end_step(Routine& routine, const std::string& report,
                const std::function<Instruction(const Place&)>& change) const {
    add(routine, Use{.block = "stop_failed", .arguments = {running(), {report}}});
    each(routine, change);
  }
  void add_count(Routine& routine, const std::string& report) const {
    const Place one{"", "", {{1, {}}}};
    if (counts_) add(routine, in_lanes("move_lanes", running(), {{"self", "steps"}, one}));
    add(routine, Return{.report = report});
  }

  Routine step() const {
    Routine routine = of_run("step", "One step of the lanes that are running.");
    add_solve(routine, "self.z", "self.carry");
    end_step(routine, "report", [this](const Place& at) -> Instruction {
      std::vector<Place> moved = {of("self.z", at)};
      if (carry_) moved.push_back(of("self.carry", at));
      moved.push_back(of(room("dz").object, at));
      if (rest_) moved.push_back(of(room("rest").object, at));
      return {in_lanes("move_lanes", running(), moved)};
    });
    add_count(routine, "report");
    return routine;
  }

  Routine substep() const {
    Routine routine = empty_substep();
    add_solve(routine, "z", "carry");
    add_update(routine, "z", "carry");
    add(routine, Return{.report = "report"});
    return routine;
  }

  Routine composed_step() const {
    Routine routine{.name = "step",
                    .remark = {"One step of the lanes that are running; a lane that fails is where "
                               "it was before its first substep."},
                    .result = {kReport},
                    .of_run = true};
    begin_total(routine);
    add(routine, SetFlag{{"total", "converged"}});
    add(routine, Repeat{"int", "i", "substeps", substeps(),
                        body_of(call_of_substep(), Use{.block = "add_substep",
                                                       .arguments = {{"total"}, {"report"}}})});
    end_step(routine, "total", [](const Place& at) -> Instruction {
      return {in_lanes("take_lanes", running(), {of("self.z", at), of("z", at)})};
    });
    if (carry_) {
      each(routine, [](const Place& at) -> Instruction {
        return {in_lanes("take_lanes", running(), {of("self.carry", at), of("carry", at)})};
      });
    }
    add_count(routine, "total");
    return routine;
  }

  Routine advance() const {
    Routine routine = of_run("advance",
                             "Up to `steps` steps, of every lane until it fails.  The report "
                             "sums the iterations.",
                             {{.name = "steps", .count = "long long"}});
    add(routine, Declare{kReport, {"total"}});
    const Place increment{"total", "increment"};
    Body body =
        body_of(If{.flag = running(), .set = false, .then = body_of(Break{}), .any = true},
                Note{"Mask", "moving", running()},
                Call{.routine = "step", .record = kReport, .object = "report", .of_run = true},
                Count{{"total", "iterations"}, Place{"report", "iterations"}},
                in_lanes("take_lanes", {"moving"}, {increment, {"report", "increment"}}));
    add(routine, Repeat{"long long", "i", "steps", 0, std::move(body)});
    add(routine,
        Assign{number(routine, {"total", "converged"}).name(), number(routine, running())});
    add(routine, Return{.report = "total"});
    return routine;
  }
};

}  // namespace

Propagator lane_propagator_of(const Program& code, int lanes) {
  return LanePropagatorBuilder(code, lanes).build();
}

}  // namespace hamgen
