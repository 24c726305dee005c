// What the routines of a Propagator consist of, of one trajectory and of trajectories in lanes.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "generator/program/propagator.hpp"

namespace hamgen {

class PropagatorParts {
 protected:
  explicit PropagatorParts(const Program& code)
      : code_(code),
        composed_(code.substeps.size() > 1),
        large_(code.environment.arrays),
        coefficients_(code.record("Coefficients") != nullptr),
        start_(code.record("Start") != nullptr),
        extrapolates_(code.unknowns > 0),
        other_(!extrapolates_ && has_patience(code)),
        ahead_(code.record("Derivatives") != nullptr),
        rest_(code.has_rest()),
        carry_(code.has_carry()),
        counts_(!code.facts.has_time) {}

  static constexpr const char* kReport = "StepReport";

  static Routine of_run(const std::string& name, const std::string& remark,
                        std::vector<Argument> arguments = {}) {
    return {.name = name,
            .remark = {remark},
            .result = {kReport},
            .arguments = std::move(arguments),
            .of_run = true};
  }
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

  // Of a fixed point that has not found its solution: times that are left to Newton.
  static bool has_patience(const Program& code) {
    const Record* start = code.record("Start");
    return start &&
           std::ranges::find(start->fields, "patience", &Field::name) != start->fields.end();
  }
  static constexpr const char* kOther = "Newton may find what the fixed point has not.";

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
    const auto add_field = [&](const std::string& type, const std::string& name, bool own_of_each,
                               const std::string& remark = {}) {
      Field field{.name = name, .remark = remark, .type = type};
      if (own_of_each && composed_) field.sizes = {substeps()};
      result.fields.push_back(std::move(field));
    };
    add_field("Parameters", "par", false);
    add_field("Real", "h", false);
    add_field("State", "z", false);
    if (carry_) add_field("State", "carry", false, "what rounding took from z");
    if (counts_) {
      add_field("long long", "steps", false, "since the first state");
      result.fields.back().values = {0};
    }
    if (composed_) add_field("Real", "lengths", true);
    if (coefficients_) add_field("Coefficients", "k", true);
    if (start_) add_field("Start", "start", true);
    if (ahead_) add_field("Derivatives", "at", true);
    if (extrapolates_) add_field(fmt::format("History<{}>", code_.unknowns), "history", true);
    if (large_) add_field("State", "dz", false);
    if (large_ && rest_) add_field("State", "rest", false);
    return result;
  }

  // All but what it does, and what is said of it.
  [[nodiscard]] Propagator shell() const {
    Propagator result{.record = record()};
    if (composed_) {
      result.constants = {{"substeps", substeps()}};
      result.fractions = code_.substeps;
    }
    result.beginnings = {{"par", "Parameters", "par"}, {"h", "", "h"}, {"z", "State", "z"}};
    if (coefficients_) {
      (composed_ ? result.substep_beginnings : result.beginnings)
          .push_back({"k", "Coefficients", composed_ ? "lengths" : "h", "prepare"});
    }
    result.accessors = {{"state", "State", Place{"self", "z"}}};
    if (carry_) {
      result.accessors.push_back(
          {"carry",
           "State",
           Place{"self", "carry"},
           {"What rounding took from the state: the sum of both is what the steps go on from."}});
    }
    result.accessors.push_back({"time", "Real", time()});
    if (!result.accessors.back().place) result.accessors.back().remark = {"Since the first state."};
    result.accessors.push_back({"h", "Real", Place{"self", "h"}});
    result.accessors.push_back({"parameters", "Parameters", Place{"self", "par"}});
    return result;
  }
  // None where steps are counted.
  [[nodiscard]] std::optional<Place> time() const {
    if (counts_) return std::nullopt;
    const auto last = static_cast<std::size_t>(code_.environment.degrees_of_freedom - 1);
    return code_.environment.state_layout.in("self.z", last);
  }

  // What is done in every step.
  static void of_step(Body& body) {
    for (Instruction& instruction : body) {
      instruction.origin.when = When::step;
      for (Body* inner : inner_bodies(instruction)) of_step(*inner);
    }
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

  [[nodiscard]] Routine empty_substep() const {
    Routine routine = of_run("substep", carry_ ? "Substep i from z + carry." : "Substep i.",
                             {{.name = "i", .count = "int"}, {"z", "State", {}, true}});
    if (carry_) routine.arguments.push_back({"carry", "State", {}, true});
    return routine;
  }
  // What the substeps of a step change, and the sum of their reports.
  void begin_total(Routine& routine) const {
    add(routine, Copy{"State", "z", "self.z", true});
    if (carry_) add(routine, Copy{"State", "carry", "self.carry", true});
    add(routine, Declare{kReport, {"total"}});
  }
  [[nodiscard]] Call call_of_substep() const {
    Call part{.routine = "substep",
              .arguments = {{"i"}, {"z"}},
              .record = kReport,
              .object = "report",
              .of_run = true};
    if (carry_) part.arguments.push_back({"carry"});
    return part;
  }
  // How the solution lies beside those of earlier steps, for the steps to come.
  void add_memory(Routine& routine) const {
    for (const RuleOfNewton& rule : code_.rules) {
      add(routine, Use{"NewtonRule",
                       "watch",
                       {{own("start"), rule.name},
                        {own("history")},
                        {own("start"), "value"},
                        {"", "", {{rule.first, {}}}},
                        {"", "", {{rule.count, {}}}}}});
    }
    if (ahead_) look_ahead(routine);
    if (extrapolates_)
      add(routine, Use{"History", "record", {{own("history")}, {own("start"), "value"}}});
  }
  // Note [derivatives ahead]: where the solutions before this one predict the next.
  void look_ahead(Routine& routine) const {
    const std::string at = own("at");
    Call derivatives{.routine = "derivatives", .arguments = {}};
    for (const Argument& argument : code_.routine("derivatives")->arguments)
      derivatives.arguments.push_back({own(argument.name)});
    add(routine, If{{own("start"), "known"},
                    true,
                    body_of(Use{"History", "extrapolate_twice", {{own("history")}, {at, "point"}}},
                            derivatives, SetFlag{{at, "ready"}})});
    routine.body.back().remark = {
        "What the next step takes of H is evaluated where the solutions before this one predict "
        "it:",
        "nothing of that waits for this step."};
  }
  // With what the run keeps.
  [[nodiscard]] Call solve_kept(const std::string& z, const std::string& carry) const {
    return solve({{"par", {"self.par"}},
                  {"k", {own("k")}},
                  {"h", {"self", composed_ ? "lengths[i]" : "h"}},
                  {"z", {z}},
                  {"carry", {carry}},
                  {"start", {own("start")}},
                  {"at", {own("at")}},
                  {"dz", room("dz")},
                  {"rest", room("rest")}});
  }
  // z + carry += dz + rest
  void add_update(Routine& routine, const std::string& z, const std::string& carry) const {
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
  // report of a part, which the total counts.
  void add_to_total(Routine& routine, Body& body) const {
    add(body, Count{{"total", "iterations"}, Place{"report", "iterations"}});
    add(body, Assign{number(routine, {"total", "increment"}).name(),
                     number(routine, {"report", "increment"})});
  }

  Routine reset(const std::string& remark) const {
    Routine routine{.name = "reset",
                    .remark = {remark},
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
    if (ahead_) add(routine, Forget{{"self.at"}, "Derivatives", substeps()});
    if (extrapolates_) add(routine, Forget{{"self.history"}, "History", substeps()});
    return routine;
  }

  const Program& code_;
  bool composed_, large_, coefficients_, start_, extrapolates_, other_, ahead_, rest_, carry_,
      counts_;
};

}  // namespace hamgen
