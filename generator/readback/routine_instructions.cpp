// What each kind of instruction looks like in the text.
#include <fmt/format.h>

#include <algorithm>

#include "generator/readback/findings.hpp"
#include "generator/readback/routine_reader.hpp"
#include "generator/readback/text_values.hpp"

namespace hamgen {

void RoutineReader::operator()(const Let& let) {
  local(scope_.in_lanes() ? "Lanes" : "Real", let.symbol, meant(let.value));
}

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
  if (is_of_stages(assign.symbol))
    return lanes_assignment("Lanes::put", assign.symbol, assign.value);
  assignment(symbol(assign.symbol), "=", meant(assign.value));
}

bool RoutineReader::is_of_stages(const std::string& symbol) const {
  const auto place = routine_.places.find(symbol);
  return place != routine_.places.end() && scope_.is_of_stages(place->second);
}

// Lanes::put(array + i, value)
void RoutineReader::lanes_assignment(const std::string& how, const std::string& to,
                                     const Expression& value) {
  const CppStatement& found = next(CppStatement::Kind::expression, to + " of the stages");
  const CppExpression& e = *found.value;
  const bool puts =
      e.kind == CppExpression::Kind::call && e.parts.size() == 3 && e.parts[0].is_name(how);
  if (!puts) throw TextDifference(found.line, "not " + to + " of the stages");
  same(machine_symbol(symbol_of(scope_.lanes(e.parts[1]))), symbol(to), found.line,
       "the assignment to " + to);
  same(scope_.value(e.parts[2]), meant(value), found.line, to + " of the program");
}

void RoutineReader::operator()(const Collect& sum) {
  call(machine_call("::collect", {symbol(sum.symbol), symbol(sum.lost), meant(sum.value)}));
}

void RoutineReader::operator()(const Accumulate& sum) {
  if (is_of_stages(sum.symbol)) return lanes_assignment("Lanes::add", sum.symbol, sum.value);
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
  const CppStatement& found = loop(node.range, node.lanes > 0 ? node.lanes : 1);
  if (node.lanes > 0) scope_.set_lanes(node.range.index);
  within(found, [&] { compare(node.body); });
  if (node.lanes > 0) scope_.set_lanes("");
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
    const std::vector<Place> arrays = finite_arrays(routine_, end);
    for (const Place& array : arrays) {
      const MachineValue squares = machine_call("::squares_of", {machine_symbol(symbol_of(array))});
      sum = &array == &arrays.front() ? squares : std::move(sum) + squares;
    }
    for (std::size_t i = 0; i < end.finite.size() && arrays.empty(); ++i) {
      const MachineValue x = symbol(end.finite[i]);
      sum = i == 0 ? x * x : std::move(sum) + x * x;
    }
    if (end.ranges.empty() || !arrays.empty()) {
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

}  // namespace hamgen
