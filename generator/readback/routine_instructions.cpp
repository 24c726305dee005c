// What each kind of instruction looks like in the text.
#include <fmt/format.h>

#include <algorithm>

#include "generator/readback/findings.hpp"
#include "generator/readback/routine_reader.hpp"

namespace hamgen {

namespace {

MachineValue truth(bool value) { return machine_symbol(value ? "::true" : "::false"); }
MachineValue negated(MachineValue a) { return machine_call("prefix!", {std::move(a)}); }
MachineValue at(const Place& place) { return machine_symbol(symbol_of(place)); }
MachineValue integer_symbol(long value) { return machine_symbol("#" + std::to_string(value)); }

// What an object does, as a call of its member.
MachineValue action(const Place& object, const std::string& name,
                    std::vector<MachineValue> arguments = {}) {
  Place member = object;
  member.field += (member.field.empty() ? "" : ".") + name;
  return machine_call(symbol_of(member), std::move(arguments));
}

}  // namespace

void RoutineReader::operator()(const Let& let) { local("Real", let.symbol, meant(let.value)); }

void RoutineReader::operator()(const Array& node) {
  Values values;
  for (const Expression& e : node.values) values.push_back(meant(e));
  array(node.name, node.sizes, values);
}

void RoutineReader::operator()(const Matrix& matrix) {
  const bool eigen = matrix.large && !scope_.precision().is_quad();
  object(matrix.patterned
             ? "Matrix"
             : fmt::format("{}<{}>", eigen ? "EigenDenseMatrix" : "DenseMatrix", matrix.size),
         matrix.name);
}

void RoutineReader::operator()(const Copy& copy) {
  const MachineValue from =
      copy.from.empty() ? machine_call("::" + copy.record, {}) : machine_symbol("@" + copy.from);
  if (!copy.declares) return assignment(machine_symbol("@" + copy.to), "=", from);
  const CppStatement& found = declaration(copy.record, copy.to);
  if (!found.value || !found.sizes.empty())
    throw TextDifference(found.line, fmt::format("{} without its value", found.name));
  same(scope_.value(*found.value), from, found.line, "a copy of " + copy.from);
  scope_.declare(found.name, {Meaning::Kind::object, copy.to}, found.line);
}

void RoutineReader::operator()(const Assign& assign) {
  assignment(symbol(assign.symbol), "=", meant(assign.value));
}

void RoutineReader::operator()(const Collect& sum) {
  call(machine_call("::collect", {symbol(sum.symbol), symbol(sum.lost), meant(sum.value)}));
}

void RoutineReader::operator()(const Accumulate& sum) {
  assignment(symbol(sum.symbol), "+=", meant(sum.value));
}

void RoutineReader::operator()(const Clear& clear) { call(action(clear.matrix, "clear")); }

void RoutineReader::operator()(const Put& put) {
  const std::string what = fmt::format("{}.put", to_text(put.matrix));
  const CppStatement& found = next(CppStatement::Kind::expression, what);
  const CppExpression& e = *found.value;
  const bool puts = e.kind == CppExpression::Kind::call && e.parts.size() == 4 &&
                    e.parts[0].kind == CppExpression::Kind::member && e.parts[0].text == "put" &&
                    is_place(e.parts[0].parts[0], put.matrix) &&
                    scope_.index(e.parts[1]) == put.row && scope_.index(e.parts[2]) == put.column;
  if (!puts) throw TextDifference(found.line, "not the program's " + what);
  same(scope_.value(e.parts[3]), meant(put.value), found.line, "what the program has in " + what);
}

void RoutineReader::operator()(const SetFlag& set) {
  assignment(at(set.flag), "=", truth(set.value));
}

void RoutineReader::operator()(const For& node) {
  const CppStatement& found = loop(node.range);
  within(found, [&] { compare(node.body); });
  scope_.leave();
}

void RoutineReader::operator()(const hamgen::Scope& scope) {
  compare_inside(next(CppStatement::Kind::block, "a block"), scope.body);
}

void RoutineReader::operator()(const If& node) {
  const MachineValue flag = at(node.flag);
  compare_inside(branch(node.set ? flag : negated(flag)), node.then);
}

void RoutineReader::operator()(const Call& node) {
  if (!node.must_succeed) {
    const bool kept = !node.object.empty();
    const CppStatement& found =
        next(kept ? CppStatement::Kind::declaration : CppStatement::Kind::expression,
             "a call of " + node.routine);
    if (!found.value || !is_called(*found.value, node) || !found.sizes.empty() ||
        (kept && found.type != node.record))
      throw TextDifference(found.line, "not the program's call of " + node.routine);
    if (kept) scope_.declare(found.name, {Meaning::Kind::object, node.object}, found.line);
    return;
  }
  const CppStatement& found = next(CppStatement::Kind::branch, "a call of " + node.routine);
  const CppExpression* e = &*found.value;
  bool right = e->kind == CppExpression::Kind::prefix && e->text == "!";
  if (right) e = &e->parts[0];
  if (right && node.record == "StepReport") {
    right = e->kind == CppExpression::Kind::member && e->text == "converged";
    if (right) e = &e->parts[0];
  }
  if (!right || !is_called(*e, node))
    throw TextDifference(found.line, "not the program's call of " + node.routine);
  within(found, [this] { failure(); });
}

// if (patience == 0 && !first(...)) { between; patience = steps; }
// if (patience > 0) { --patience; if (!second(...)) failure }
void RoutineReader::operator()(const Alternate& node) {
  const MachineValue patience = at(node.patience);
  const CppStatement& tries = next(CppStatement::Kind::branch, "a call of " + node.first.routine);
  const CppExpression& condition = *tries.value;
  const bool both =
      condition.is_binary("&&") && condition.parts[1].kind == CppExpression::Kind::prefix &&
      condition.parts[1].text == "!" && is_called(condition.parts[1].parts[0], node.first);
  if (!both) throw TextDifference(tries.line, "not the program's call of " + node.first.routine);
  same(scope_.value(condition.parts[0]), machine_call("==", {patience, integer_symbol(0)}),
       tries.line, "the condition of the program");
  scope_.enter();
  within(tries, [&] {
    compare(node.between);
    assignment(patience, "=", integer_symbol(node.steps));
  });
  scope_.leave();
  within(branch(machine_call(">", {patience, integer_symbol(0)})), [&] {
    call(machine_call("prefix--", {patience}));
    Call second = node.second;
    second.must_succeed = true;
    second.record.clear();
    (*this)(second);
  });
}

void RoutineReader::operator()(const Factorise& node) {
  const CppStatement& found = branch(negated(action(node.matrix, "factorise")));
  within(found, [this] {
    if (iterates_)
      assignment(machine_symbol("@report.iterations"), "+=", machine_symbol("iteration "));
    failure();
  });
}

void RoutineReader::operator()(const SolveFactorised& node) {
  call(action(node.matrix, "solve", {at(node.vector)}));
}

void RoutineReader::operator()(const Invert& node) {
  const MachineValue regular = at(node.regular);
  assignment(
      regular, "=",
      machine_call("&&",
                   {machine_call("::invert", {machine_symbol("@" + node.matrix), at(node.inverse)}),
                    regular}));
}

void RoutineReader::operator()(const Return& end) {
  if (end.value) {
    const CppStatement& found = next(CppStatement::Kind::result, "the result");
    if (!found.value) throw TextDifference(found.line, "returns nothing");
    return same(scope_.value(*found.value), meant(*end.value), found.line, to_text(*end.value));
  }
  MachineValue success = truth(end.success);
  if (!end.finite.empty()) {
    MachineValue sum;
    for (std::size_t i = 0; i < end.finite.size(); ++i) {
      const MachineValue x = symbol(end.finite[i]);
      sum = i == 0 ? x * x : std::move(sum) + x * x;
    }
    if (end.ranges.empty()) {
      local("Real", "length ", sum);
    } else {
      local("Real", "length ", integer_symbol(0));
      for_elements(end.ranges, [&] { assignment(machine_symbol("length "), "+=", sum); });
    }
    success = machine_call("<=", {machine_symbol("length "),
                                  {.kind = MachineValue::Kind::number,
                                   .number = read_literal(scope_.precision().largest)->value}});
  }
  if (routine_.result.type != "StepReport") {
    const CppStatement& found = next(CppStatement::Kind::result, "the result");
    if (!found.value) throw TextDifference(found.line, "returns nothing");
    return same(scope_.value(*found.value), success, found.line, "whether it has succeeded");
  }
  const std::string report = "@report";
  const MachineValue converged = machine_symbol(report + ".converged");
  if (end.success) {
    assignment(converged, "=", success);
    if (!end.finite.empty()) {
      within(branch(negated(converged)), [&] {
        assignment(machine_symbol(report + ".increment"), "=", machine_symbol("length "));
      });
    }
    if (end.flag) assignment(at(*end.flag), "=", converged);
  }
  failure();
}

void RoutineReader::for_elements(const std::vector<KernelRange>& ranges,
                                 const std::function<void()>& lines, std::size_t depth) {
  if (depth == ranges.size()) return lines();
  const CppStatement& found = loop(ranges[depth]);
  within(found, [&] { for_elements(ranges, lines, depth + 1); });
  scope_.leave();
}

MachineValue RoutineReader::magnitude(const MachineValue& value) const {
  return machine_call("magnitude", {value});
}

MachineValue RoutineReader::length(const Unknown& u) {
  return magnitude(symbol(u.symbol)) + magnitude(meant(u.start));
}

MachineValue RoutineReader::length(const UnknownArray& u) {
  return magnitude(symbol(u.value)) + magnitude(meant(u.beside));
}

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

void RoutineReader::contraction(const IterateArray& iterate) {
  const Place rule{"start", iterate.name};
  const bool simplified = iterate.rule == Rule::simplified_newton;
  Values arguments;
  if (simplified) arguments = {at(*iterate.factorised)};
  call(action(rule, "begin", arguments));
  within(endless("iteration "), [&] {
    compare(iterate.body);
    object("Distance", "distance ");
    for_elements(iterate.ranges, [&] {
      for (const UnknownArray& u : iterate.unknowns) {
        call(action({"distance "}, "add", {magnitude(symbol(u.increment)), length(u)}));
      }
    });
    for_elements(iterate.ranges, [&] {
      for (const UnknownArray& u : iterate.unknowns)
        assignment(symbol(u.value), "+=", symbol(u.increment));
    });
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
    assignment(machine_symbol("more "), "=",
               machine_call(symbol_of(refine.refinement),
                            {at(refine.point), at(refine.lack), at(refine.gradient)}));
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
