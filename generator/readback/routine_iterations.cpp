// Iterations in the text: their rule, what it is given, how they end.
#include <fmt/format.h>

#include "generator/readback/findings.hpp"
#include "generator/readback/routine_reader.hpp"
#include "generator/readback/text_values.hpp"

namespace hamgen {

namespace {

// Lanes(0)
bool is_zero_of_lanes(const CppExpression& e) {
  return e.kind == CppExpression::Kind::call && e.parts.size() == 2 &&
         e.parts[0].is_name("Lanes") && e.parts[1].kind == CppExpression::Kind::number &&
         e.parts[1].text == "0";
}

}  // namespace

// What an iteration's report counts, and how it goes on.
void RoutineReader::leave_with(const std::string& jump) {
  assignment(machine_symbol("@report.iterations"), "+=", machine_symbol("iteration "));
  if (jump == "failed") {
    assignment(machine_symbol("@report.increment"), "=", machine_symbol("size "));
    return failure();
  }
  next(CppStatement::Kind::leave, "the end of the iteration");
}

void RoutineReader::operator()(const Iterate& iterate) {
  for (const std::string& kept : iterate.kept)
    local("Real", kept, {.kind = MachineValue::Kind::number});
  const auto memory = [](const Unknown& u) {
    return at({"start", "value", {{.constant = u.memory, .factors = {}}}});
  };
  for (const Unknown& u : iterate.unknowns) {
    local("Real", u.symbol,
          machine_call("?:", {at({"start", "known"}), memory(u), meant(u.start)}));
  }
  const std::set<std::string> outer = kept_;
  kept_.insert(iterate.kept.begin(), iterate.kept.end());
  iterates_ = true;
  iterate.rule == Rule::newton ? newton(iterate) : fixed_point(iterate);
  iterates_ = false;
  for (const Unknown& u : iterate.unknowns) {
    MachineValue value = symbol(u.symbol);
    if (iterate.rule == Rule::newton) value = std::move(value) + meant(u.correction);
    assignment(memory(u), "=", value);
  }
}

void RoutineReader::newton(const Iterate& iterate) {
  const Place rule{"start", iterate.name};
  call(action(rule, "begin", {at({"start", "known"})}));
  within(endless("iteration "), [&] {
    compare(iterate.body);
    MachineValue size;
    MachineValue scale;
    Values corrections;
    for (const Unknown& u : iterate.unknowns) {
      const bool first = corrections.empty();
      corrections.push_back(meant(u.correction));
      const MachineValue part = magnitude(corrections.back());
      size = first ? part : std::move(size) + part;
      const MachineValue value = magnitude(symbol(u.symbol));
      scale = (first ? value : std::move(scale) + value) + magnitude(meant(u.start));
    }
    local("Real", "size ", size);
    local("Real", "scale ", scale);
    local("Verdict", "verdict ",
          machine_call(symbol_of(rule), {machine_symbol("size "), machine_symbol("scale "),
                                         machine_symbol("iteration ")}));
    end_newton();
    for (std::size_t j = 0; j < corrections.size(); ++j)
      assignment(symbol(iterate.unknowns[j].symbol), "+=", corrections[j]);
  });
  scope_.leave();
}

void RoutineReader::end_newton() {
  for (const char* verdict : {"failed", "done"}) {
    const MachineValue condition = machine_call(
        "==", {machine_symbol("verdict "), machine_symbol(fmt::format("::Verdict::{}", verdict))});
    within(branch(condition), [&] { leave_with(verdict); });
  }
}

void RoutineReader::operator()(const IterateArray& iterate) {
  iterates_ = true;
  iterate.rule == Rule::newton ? newton(iterate) : contraction(iterate);
  iterates_ = false;
}

void RoutineReader::newton(const IterateArray& iterate) {
  const Place rule{"start", iterate.name};
  call(action(rule, "begin", {at({"start", "known"})}));
  within(endless("iteration "), [&] {
    compare(iterate.body);
    local("Real", "size ", integer_symbol(0));
    local("Real", "scale ", integer_symbol(0));
    for_elements(iterate.ranges, [&] {
      for (const UnknownArray& u : iterate.unknowns) {
        assignment(machine_symbol("size "), "+=", magnitude(symbol(u.increment)));
        assignment(machine_symbol("scale "), "+=", length(u));
      }
    });
    local("Verdict", "verdict ",
          machine_call(symbol_of(rule), {machine_symbol("size "), machine_symbol("scale "),
                                         machine_symbol("iteration ")}));
    end_newton();
    for_elements(iterate.ranges, [&] {
      for (const UnknownArray& u : iterate.unknowns)
        assignment(symbol(u.value), "+=", symbol(u.increment));
    });
  });
  scope_.leave();
}

void RoutineReader::distance_of(const IterateArray& iterate) {
  const std::vector<WholeUnknowns> arrays = whole_unknowns(routine_, iterate);
  for (const WholeUnknowns& u : arrays) {
    const CppStatement& found = next(CppStatement::Kind::expression, "the distance of an array");
    const CppExpression& e = *found.value;
    // distance.add(...), or add_lanes(Lanes(0), distance, ...)
    const std::size_t first = iterate.lanes > 0 ? 3 : 1;
    bool adds = e.kind == CppExpression::Kind::call && e.parts.size() == first + 4;
    if (adds && iterate.lanes > 0) {
      adds = e.parts[0].is_name("add_lanes") && is_zero_of_lanes(e.parts[1]) &&
             is_place(e.parts[2], {"distance "});
    } else if (adds) {
      adds = e.parts[0].kind == CppExpression::Kind::member && e.parts[0].text == "add" &&
             is_place(e.parts[0].parts[0], {"distance "});
    }
    adds = adds && is_place(e.parts[first], u.increment) && is_place(e.parts[first + 1], u.value) &&
           is_place(e.parts[first + 2], u.beside) &&
           scope_.index(e.parts[first + 3]) == AffineIndex{u.count, {}};
    if (!adds) throw TextDifference(found.line, "not the distance of the program's unknowns");
  }
  if (!arrays.empty()) return;
  for_elements(iterate.ranges, [&] {
    for (const UnknownArray& u : iterate.unknowns) {
      call(action({"distance "}, "add", {magnitude(symbol(u.increment)), length(u)}));
    }
  });
}

void RoutineReader::contraction(const IterateArray& iterate) {
  const Place rule{"start", iterate.name};
  const bool simplified = iterate.rule == Rule::simplified_newton;
  Values arguments;
  if (simplified) arguments = {at(*iterate.factorised)};
  if (iterate.work) arguments = {integer_symbol(*iterate.work)};
  call(action(rule, "begin", arguments));
  within(endless("iteration "), [&] {
    compare(iterate.body);
    object("Distance", "distance ");
    distance_of(iterate);
    if (iterate.lanes > 0) {
      (*this)(moved_in_lanes(iterate));
    } else {
      for_elements(iterate.ranges, [&] {
        for (const UnknownArray& u : iterate.unknowns)
          assignment(symbol(u.value), "+=", symbol(u.increment));
      });
    }
    Values given = {machine_symbol("@distance ")};
    if (simplified) {
      given.push_back(symbol(iterate.residual));
      given.push_back(at(*iterate.factorised));
    }
    given.push_back(machine_symbol("iteration "));
    local("Verdict", "verdict ", machine_call(symbol_of(rule), std::move(given)));
    end_contraction(at({"start", iterate.name + ".size"}));
  });
  scope_.leave();
}

void RoutineReader::end_contraction(const MachineValue& size) {
  const auto verdict = [](const char* name) {
    return machine_call(
        "==", {machine_symbol("verdict "), machine_symbol(fmt::format("::Verdict::{}", name))});
  };
  const std::string report = "@report";
  within(branch(verdict("go_on")), [&] { next(CppStatement::Kind::next, "the next iteration"); });
  assignment(machine_symbol(report + ".iterations"), "+=", machine_symbol("iteration "));
  within(branch(verdict("done")),
         [&] { next(CppStatement::Kind::leave, "the end of the iteration"); });
  assignment(machine_symbol(report + ".increment"), "=", size);
  failure();
}

void RoutineReader::fixed_point(const Iterate& iterate) {
  object("FixedPointRule<2>", iterate.name);
  const Place rule{iterate.name};
  within(endless("iteration "), [&] {
    compare(iterate.body);
    Values increments;
    for (const Unknown& u : iterate.unknowns)
      increments.push_back(meant(u.correction - Expression::symbol(u.symbol)));
    array("increment ", {static_cast<int>(increments.size())}, increments);
    object("Distance", "distance ");
    for (std::size_t j = 0; j < increments.size(); ++j) {
      const Unknown& u = iterate.unknowns[j];
      const MachineValue increment =
          at({"increment ", {}, {{.constant = static_cast<long>(j), .factors = {}}}});
      call(action({"distance "}, "add", {magnitude(increment), length(u)}));
      assignment(symbol(u.symbol), "+=", increment);
    }
    local("Verdict", "verdict ",
          machine_call(symbol_of(rule),
                       {machine_symbol("@distance "), machine_symbol("iteration ")}));
    end_contraction(at({iterate.name, "size"}));
  });
  scope_.leave();
}

void RoutineReader::operator()(const Refine& refine) {
  const std::string kept = "kept " + refine.name;
  object(fmt::format("Refinement<{},{}>", refine.unknowns.size(), refine.gradient.size()),
         refine.name);
  if (!refine.kept.empty()) array(kept, {static_cast<int>(refine.kept.size())}, {});
  const CppStatement& found = next(CppStatement::Kind::loop, "a refinement");
  const CppStatement& begin = found.first.front();
  const bool plain = begin.type == "bool" && begin.value && begin.value->is_name("true") &&
                     found.value && found.value->is_name(begin.name) && !found.advance;
  if (!plain) throw TextDifference(found.line, "not a refinement");
  scope_.enter();
  scope_.declare(begin.name, {Meaning::Kind::number, "more "}, begin.line);
  within(found, [&] { refine_body(refine, kept); });
  scope_.leave();
  for (std::size_t j = 0; j < refine.kept.size(); ++j) {
    assignment(symbol(refine.kept[j]), "=",
               at({kept, {}, {{.constant = static_cast<long>(j), .factors = {}}}}));
  }
}

void RoutineReader::refine_body(const Refine& refine, const std::string& kept) {
  const auto element = [](const std::string& name, std::size_t j) {
    return at({name, {}, {{.constant = static_cast<long>(j), .factors = {}}}});
  };
  compare(refine.body);
  Values lack;
  Values point;
  Values slope;
  for (const Unknown& u : refine.unknowns) {
    lack.push_back(meant(u.correction - Expression::symbol(u.symbol)));
    point.push_back(symbol(u.symbol));
  }
  for (const Expression& e : refine.gradient) slope.push_back(meant(e));
  const auto count = static_cast<int>(refine.unknowns.size());
  array("lack ", {count}, lack);
  array("slope ", {static_cast<int>(slope.size())}, slope);
  if (!refine.kept.empty()) {
    within(branch(machine_call("==", {at({refine.name, "rounds"}), integer_symbol(0)})), [&] {
      for (std::size_t j = 0; j < refine.kept.size(); ++j)
        assignment(element(kept, j), "=", symbol(refine.kept[j]));
    });
  }
  array("point ", {count}, point);
  assignment(
      machine_symbol("more "), "=",
      machine_call(symbol_of({refine.name}), {machine_symbol("@point "), machine_symbol("@lack "),
                                              machine_symbol("@slope ")}));
  for (std::size_t j = 0; j < refine.unknowns.size(); ++j)
    assignment(symbol(refine.unknowns[j].symbol), "=", element("point ", j));
}

void RoutineReader::operator()(const RefineArray& refine) {
  const CppStatement& found = next(CppStatement::Kind::loop, "a refinement");
  const CppStatement& begin = found.first.front();
  const bool plain = begin.type == "bool" && begin.value && begin.value->is_name("true") &&
                     found.value && found.value->is_name(begin.name) && !found.advance;
  if (!plain) throw TextDifference(found.line, "not a refinement");
  scope_.enter();
  scope_.declare(begin.name, {Meaning::Kind::number, "more "}, begin.line);
  within(found, [&] {
    compare(refine.body);
    Values given = {at(refine.point), at(refine.lack), at(refine.gradient)};
    if (!refine.rule.empty()) given.insert(given.begin(), at({"start", refine.rule}));
    assignment(machine_symbol("more "), "=",
               machine_call(symbol_of(refine.refinement), std::move(given)));
  });
  scope_.leave();
}

void RoutineReader::operator()(const Sweep& sweep) {
  for (const Unknown& u : sweep.unknowns) local("Real", u.symbol, meant(u.start));
  const CppStatement& found =
      loop({.index = "sweep ", .lower = {}, .upper = {.constant = sweep.count - 1, .factors = {}}});
  within(found, [&] {
    compare(sweep.body);
    for (const Unknown& u : sweep.unknowns) local("Real", u.symbol + " next", meant(u.correction));
    for (const Unknown& u : sweep.unknowns)
      assignment(symbol(u.symbol), "=", machine_symbol(u.symbol + " next"));
  });
  scope_.leave();
  for (std::size_t j = 0; j < sweep.results.size(); ++j)
    local("Real", sweep.results[j], symbol(sweep.unknowns[j].symbol));
  assignment(machine_symbol("@report.iterations"), "=", integer_symbol(sweep.count));
}

}  // namespace hamgen
