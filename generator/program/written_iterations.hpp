// What iterations look like: what they declare, their loop, and how it ends.
#pragma once

#include <fmt/format.h>

#include <set>

#include "generator/program/refinement_type.hpp"
#include "generator/program/written_rules.hpp"

namespace hamgen::written {

class IterationWriter : public RuleWriter {
 public:
  using RuleWriter::RuleWriter;

  void operator()(const Iterate& iterate) {
    for (const std::string& symbol : iterate.kept) add(Define{"Real", symbol, formula(0), true});
    for (const Unknown& u : iterate.unknowns) {
      std::vector<Value> parts = {at({"start", "known"}), memory_of(u), formula(u.start)};
      Value begin = form_.lanes ? call("select", std::move(parts))
                                : with_parts(Value::Kind::choice, "", std::move(parts));
      add(Define{"Real", u.symbol, std::move(begin), true});
    }
    kept_.insert(iterate.kept.begin(), iterate.kept.end());
    iterates_ = true;
    iterate.rule == Rule::newton ? newton(iterate) : fixed_point(iterate);
    iterates_ = false;
    for (const Unknown& u : iterate.unknowns) {
      Value value = symbol(u.symbol);
      if (iterate.rule == Rule::newton)
        value = joined("+", {std::move(value), formula(u.correction)});
      set_number(memory_of(u), std::move(value), form_.lanes);
    }
  }

  void operator()(const IterateArray& iterate) {
    iterates_ = true;
    const bool by_size = iterate.rule == Rule::newton || iterate.rule == Rule::linear;
    by_size ? newton(iterate) : contraction(iterate);
    iterates_ = false;
  }

  void operator()(const Refine& refine) {
    const std::string kept = kept_name(refine);
    add(Declare{refinement_type(static_cast<int>(refine.unknowns.size()),
                                static_cast<int>(refine.gradient.size()), !refine.beside.is_zero()),
                {refine.name}});
    set_beside({refine.name}, refine.beside);
    if (!refine.kept.empty()) {
      add(Define{"Real", kept, list({}), true, {static_cast<int>(refine.kept.size())}});
    }
    add(While{inside([&] { refine_once(refine, kept); })});
    require_found({refine.name});
    for (std::size_t j = 0; j < refine.kept.size(); ++j)
      set(symbol(refine.kept[j]), element(kept, j));
  }

  void operator()(const RefineArray& refine) {
    set_beside(refine.refinement, refine.beside);
    std::vector<Value> given = turn();
    if (!refine.rule.empty()) given.push_back(object({"start", refine.rule}));
    for (const Place& place : {refine.point, refine.lack, refine.gradient})
      given.push_back(object(place));
    Value refined = action("Refinement", refine.refinement, "", std::move(given));
    const bool begins = refine.first.empty() && !refine.begun;
    write(refine.first);
    if (refine.begun && !refine.rule.empty()) {
      const Value moved = makes_last(refine.rule);
      branch(form_.lanes ? call("any", {moved}) : moved, Shape::braces,
             [&] { write(refine.body); });
    }
    add(While{inside([&] {
      if (begins) write(refine.body);
      set(at({"more "}), std::move(refined));
      if (begins) return;
      branch(at({"more "}), Shape::braces, [&] { write(refine.body); });
    })});
    if (refine.gives_up) give_up(action("ContractionRule", {"start", refine.rule}, "gives_up", {}));
    require_found(refine.refinement, refine.patience, refine.steps);
  }

  void operator()(const Sweep& sweep) {
    for (const Unknown& u : sweep.unknowns) add(Define{"Real", u.symbol, formula(u.start), true});
    const KernelRange range{.index = "sweep", .lower = {}, .upper = {sweep.count - 1, {}}};
    const auto lines = [&] {
      write(sweep.body);
      for (const Unknown& u : sweep.unknowns)
        add(Define{"Real", u.symbol + kNext, formula(u.correction)});
      for (const Unknown& u : sweep.unknowns) set(symbol(u.symbol), symbol(u.symbol + kNext));
    };
    over({range}, lines, Shape::braces);
    for (std::size_t j = 0; j < sweep.results.size(); ++j)
      add(Define{"Real", sweep.results[j], symbol(sweep.unknowns[j].symbol)});
    set(at({"report", "iterations"}), integer(sweep.count));
  }

 protected:
  // What a block is given besides that knows of lanes.
  [[nodiscard]] std::vector<Value> turn() const {
    if (!form_.lanes) return {};
    return {object({"start", "turn"})};
  }
  [[nodiscard]] std::vector<Value> with_turn(std::vector<Value> given) const {
    if (form_.lanes) given.push_back(turn().front());
    return given;
  }
  void count_iterations() { set(at({"report", "iterations"}), at({"iteration "}), "+="); }

  std::set<std::string> kept_;  // locals that an iteration changes
  bool iterates_ = false;
  Place rule_;  // that it iterates by
  std::string rule_type_ = "NewtonRule";

 private:
  // A length that all unknowns are rounded with besides.
  void set_beside(Place refinement, const Expression& length) {
    if (length.is_zero()) return;
    refinement.field += refinement.field.empty() ? "beside" : ".beside";
    set(at(refinement), formula(length));
  }
  Value is_verdict(const std::string& name) const {
    const std::string verdict = (form_.references ? "Verdict::" : "") + name;
    return joined("==", {at({"verdict "}), with_parts(Value::Kind::constant, verdict, {})});
  }

  static Value memory_of(const Unknown& u) {
    return at({"start", "value", {{.constant = u.memory, .factors = {}}}});
  }

  static std::vector<Value> lacks_of(const std::vector<Unknown>& unknowns) {
    std::vector<Value> list;
    for (const Unknown& u : unknowns)
      list.push_back(formula(u.correction - Expression::symbol(u.symbol)));
    return list;
  }

  // Where the values of the body at the rounded unknowns wait: kept_0 beside refinement_0.
  static std::string kept_name(const Refine& refine) {
    return "kept" + refine.name.substr(refine.name.rfind('_')) + " ";
  }

  void iterate_with(const Lines& lines) { add(Loop{"int", "iteration ", 1, "", inside(lines)}); }

  void newton(const Iterate& iterate) {
    const Place rule{"start", iterate.name};
    add(Do{action("NewtonRule", rule, "begin", with_turn({at({"start", "known"})}))}).remark =
        *remark_;
    rule_ = rule;
    iterate_with([&] {
      write(iterate.body);
      Value verdict = judged_of_each(iterate.unknowns, rule);
      if (form_.lanes) {
        look_at_moving(std::move(verdict));
        for (const Unknown& u : iterate.unknowns)
          move_lanes(at({"moving "}), symbol(u.symbol), formula(u.correction));
        return;
      }
      add(Define{"Verdict", "verdict ", std::move(verdict)});
      end_newton();
      for (const Unknown& u : iterate.unknowns) set(symbol(u.symbol), formula(u.correction), "+=");
    });
    if (form_.lanes) end_lanes(rule);
  }

  // --- of trajectories in lanes: those that are done stand still until all are -----------------

  void look_at_moving(Value moving) {
    add(Define{"Mask", "moving ", std::move(moving)});
    break_unless_any(at({"moving "}));
  }
  void break_unless_any(Value lanes) {
    branch(prefix("!", call("any", {std::move(lanes)})), Shape::line, [this] { add(Break{}); });
  }
  void move_lanes(Value lanes, const Value& x, Value by) {
    set(x, selected(std::move(lanes), joined("+", {x, std::move(by)}), x));
  }
  void end_lanes(const Place& rule) {
    std::vector<Value> given = {object({"report"}), turn().front(), object(rule)};
    add(Do{call("end_iteration", std::move(given))});
  }

  void newton(const IterateArray& iterate) {
    const Place rule{"start", iterate.name};
    const bool linear = iterate.rule == Rule::linear;
    const char* type = linear ? "LinearRule" : "NewtonRule";
    // Linear equations are the same wherever their solution is looked for.
    std::vector<Value> from = turn();
    if (!linear) from.insert(from.begin(), at({"start", "known"}));
    add(Do{action(type, rule, "begin", std::move(from))});
    rule_ = rule;
    rule_type_ = type;
    iterate_with([&] {
      write(iterate.body);
      Value verdict = linear ? judged_of_lengths(iterate) : judged_of_parts(iterate);
      if (form_.lanes) {
        look_at_moving(std::move(verdict));
        return move(iterate, at({"moving "}));
      }
      add(Define{"Verdict", "verdict ", std::move(verdict)});
      end_newton();
      move(iterate);
    });
    if (form_.lanes) end_lanes(rule);
  }

  // Of trajectories in lanes in these.
  void move(const IterateArray& iterate, const std::optional<Value>& lanes = {}) {
    over_unknowns(iterate, [&](const UnknownArray& u) {
      lanes ? move_lanes(*lanes, symbol(u.value), symbol(u.increment))
            : set(symbol(u.value), symbol(u.increment), "+=");
    });
  }

  void end_newton() {
    branch(is_verdict("failed"), Shape::braces, [&] {
      count_iterations();
      const Place last{rule_.object, rule_.field + ".previous"};
      set(at({"report", "increment"}), at(rule_type_ == "NewtonRule" ? last : Place{"size "}));
      fail();
    });
    branch(is_verdict("done"), Shape::braces, [this] {
      count_iterations();
      add(Break{});
    });
  }

  void fixed_point(const Iterate& iterate) {
    const Place rule{iterate.name};
    const std::string type = iterate.type.substr(0, iterate.type.find('<'));
    add(Declare{iterate.type, {iterate.name}});
    if (form_.lanes) add(Do{action(type, rule, "begin", turn())});
    iterate_with([&] {
      write(iterate.body);
      add(numbers("increment ", lacks_of(iterate.unknowns)));
      add(Declare{"Distance", {"distance "}});
      for (std::size_t j = 0; j < iterate.unknowns.size(); ++j) {
        const Unknown& u = iterate.unknowns[j];
        const Value increment = element("increment ", j);
        add(Do{action("Distance", {"distance "}, "add",
                      {call("magnitude", {increment}), length(u.symbol, u.beside)})});
        // Nothing that the last one has computed is read behind the loop.
        form_.lanes ? move_lanes(at({iterate.name, "open"}), symbol(u.symbol), increment)
                    : set(symbol(u.symbol), increment, "+=");
      }
      judge(rule, action(type, rule, "", {object({"distance "}), at({"iteration "})}));
    });
    if (form_.lanes) end_lanes(rule);
  }

  // The fixed point, and Newton with a matrix that serves for many steps.
  void contraction(const IterateArray& iterate) {
    const Place rule{"start", iterate.name};
    const bool newton = iterate.rule == Rule::simplified_newton;
    std::vector<Value> served = turn();
    if (newton) served.push_back(object(*iterate.factorised));
    if (iterate.work) served.push_back(integer(*iterate.work));
    add(Do{action("ContractionRule", rule, "begin", served)});
    rule_ = rule;
    iterate_with([&] {
      // Only they may want another matrix.
      if (form_.lanes && newton) set(lanes_in_turn(), at({"start", iterate.name + ".open"}));
      write(iterate.body);
      add(Declare{"Distance", {"distance "}});
      if (iterate.leaves_last) add(Do{action("Distance", {"distance "}, "narrow", {})});
      distance_of(iterate);
      // In a loop of their own: g++ 12.2 -O3 loses the last stores where both are in one.
      if (iterate.lanes > 0) write({{moved_in_lanes(iterate)}});
      const bool is_heard_first = form_.lanes || iterate.leaves_last;
      if (iterate.lanes == 0 && !is_heard_first) move(iterate);
      std::vector<Value> judged = {object({"distance "})};
      if (newton) judged.push_back(symbol(iterate.residual));
      if (newton) judged.push_back(object(*iterate.factorised));
      judged.push_back(at({"iteration "}));
      Value verdict = action("ContractionRule", rule, "", std::move(judged));
      if (!form_.lanes) return judge(rule, std::move(verdict), iterate);
      look_at_moving(std::move(verdict));
      move(iterate, at({"moving "}));
    });
    if (!form_.lanes) return;
    end_lanes(rule);
    if (!iterate.leaves_last) return move(iterate, lanes_in_turn());
    if (!iterate.work) return;
    foresee(iterate);
    move(iterate, joined("&", {lanes_in_turn(), makes_last(iterate.name)}));
  }
  // What follows the last increment, before it is made.
  void foresee(const IterateArray& iterate) {
    const std::vector<WholeUnknowns> arrays = whole_unknowns(routine_, iterate);
    if (iterate.refinement.empty() || arrays.size() != 1) return;
    const WholeUnknowns& u = arrays.front();
    std::vector<Value> given = {object({"start", iterate.name})};
    for (const Place& array : {u.value, u.increment, u.beside}) given.push_back(object(array));
    add(Do{action("Refinement", {"start", iterate.refinement}, "foresee", std::move(given))});
  }
  static Value makes_last(const std::string& rule) {
    return action("ContractionRule", {"start", rule}, "moves", {});
  }

  // What the rule says of an iteration, and what follows from it.
  void judge(const Place& rule, Value verdict, const std::optional<IterateArray>& moves = {}) {
    if (form_.lanes) return break_unless_any(std::move(verdict));
    add(Define{"Verdict", "verdict ", std::move(verdict)});
    if (moves && moves->leaves_last) {
      Value goes_on = is_verdict("go_on");
      if (moves->work) goes_on = joined("||", {std::move(goes_on), makes_last(moves->name)});
      branch(std::move(goes_on), Shape::braces, [&] {
        foresee(*moves);
        move(*moves);
      });
    }
    Place size = rule;
    size.field += size.field.empty() ? "size" : ".size";
    branch(is_verdict("go_on"), Shape::line, [this] { add(Continue{}); });
    count_iterations();
    branch(is_verdict("done"), Shape::line, [this] { add(Break{}); });
    set(at({"report", "increment"}), at(size));
    fail();
  }

  void refine_once(const Refine& refine, const std::string& kept) {
    write(refine.body);
    std::vector<Value> slopes;
    for (const Expression& e : refine.gradient) slopes.push_back(formula(e));
    add(numbers("lack ", lacks_of(refine.unknowns)));
    add(numbers("slope ", std::move(slopes)));
    if (!refine.kept.empty()) {
      branch(joined("==", {at({refine.name, "rounds"}), integer(0)}), Shape::braces, [&] {
        for (std::size_t j = 0; j < refine.kept.size(); ++j)
          set(element(kept, j), symbol(refine.kept[j]));
      });
    }
    std::vector<Value> points;
    for (const Unknown& u : refine.unknowns) points.push_back(symbol(u.symbol));
    add(numbers("point ", std::move(points), true));
    std::vector<Value> given = turn();
    for (const char* array : {"point ", "lack ", "slope "}) given.push_back(object({array}));
    set(at({"more "}), action("Refinement", {refine.name}, "", std::move(given)));
    for (std::size_t j = 0; j < refine.unknowns.size(); ++j)
      set(symbol(refine.unknowns[j].symbol), element("point ", j));
  }
};

}  // namespace hamgen::written
