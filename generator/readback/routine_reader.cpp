#include "generator/readback/routine_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

constexpr std::size_t kLongest = 100;  // of a formula in a message

std::string shortened(std::string text) {
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

// ++i, or i += 8
bool advances(const CppExpression& e, const std::string& index, int step) {
  if (step == 1)
    return e.kind == CppExpression::Kind::prefix && e.text == "++" && e.parts[0].is_name(index);
  return e.is_binary("+=") && e.parts[0].is_name(index) &&
         e.parts[1].kind == CppExpression::Kind::number && e.parts[1].text == std::to_string(step);
}

}  // namespace

RoutineReader::RoutineReader(const CppFunction& function, const Routine& routine,
                             const Precision& precision, int n)
    : function_(function),
      routine_(routine),
      scope_(precision, n),
      statements_(function.body),
      end_line_(function.line) {}

void RoutineReader::compare() {
  compare_signature();
  const Result& result = routine_.result;
  if (!result.object.empty()) {
    const CppStatement& first = declaration(result.type, "what the routine returns");
    if (first.value || !first.sizes.empty())
      throw TextDifference(first.line, fmt::format("{} begins with a value", first.name));
    scope_.declare(first.name, {Meaning::Kind::object, result.object}, first.line);
  }
  compare(routine_.body);
  const bool filled = !result.object.empty() && result.type != "StepReport";
  if (filled) {
    const CppStatement& last = next(CppStatement::Kind::result, "the routine's end");
    if (!last.value || !is_place(*last.value, {result.object}))
      throw TextDifference(last.line, "returns something else than " + result.object);
  }
  if (const CppStatement* more = peek())
    throw TextDifference(more->line, fmt::format("a statement that {} has not", routine_.name));
}

void RoutineReader::compare_signature() {
  const std::string type = routine_.result.type.empty() ? "void" : routine_.result.type;
  if (function_.type != type)
    throw TextDifference(function_.line,
                         fmt::format("{} returns {}, not {}", routine_.name, function_.type, type));
  if (function_.arguments.size() != routine_.arguments.size())
    throw TextDifference(function_.line,
                         fmt::format("{} has {} arguments, not {}", routine_.name,
                                     function_.arguments.size(), routine_.arguments.size()));
  for (std::size_t i = 0; i < routine_.arguments.size(); ++i)
    compare_argument(function_.arguments[i], routine_.arguments[i]);
}

void RoutineReader::compare_argument(const CppArgument& written, const Argument& argument) {
  using Pass = CppArgument::Pass;
  const bool number = argument.record.empty() && argument.sizes.empty();
  const std::string type = argument.record.empty() ? "Real" : argument.record;
  Pass pass = argument.sizes.empty() ? Pass::reference : Pass::array;
  if (argument.decays) pass = Pass::pointer;
  if (number && !argument.decays) pass = Pass::value;
  bool same = written.type == type && written.pass == pass;
  if (pass != Pass::value) same = same && written.constant != argument.changes;
  if (pass == Pass::array) {
    same = same && written.sizes.size() == argument.sizes.size();
    for (std::size_t i = 0; same && i < argument.sizes.size(); ++i) {
      same = scope_.index(written.sizes[i]) ==
             AffineIndex{.constant = argument.sizes[i], .factors = {}};
    }
  }
  if (!same)
    throw TextDifference(function_.line, fmt::format("argument {} of {} is not the program's",
                                                     argument.name, routine_.name));
  if (written.name.empty()) return;
  scope_.declare(
      written.name,
      {pass == Pass::value ? Meaning::Kind::number : Meaning::Kind::object, argument.name},
      function_.line);
}

void RoutineReader::compare(const Body& body) {
  for (const Instruction& instruction : body) {
    const auto* let = std::get_if<Let>(&instruction.value);
    if (let != nullptr && kept_.contains(let->symbol)) {
      (*this)(Assign{let->symbol, let->value});
    } else {
      std::visit(*this, instruction.value);
    }
    ++instructions_;
  }
}

void RoutineReader::within(const CppStatement& statement, const std::function<void()>& inside) {
  const Statements outer = statements_;
  const std::size_t at = at_;
  statements_ = statement.body;
  at_ = 0;
  inside();
  if (const CppStatement* more = peek())
    throw TextDifference(more->line, fmt::format("a statement that {} has not", routine_.name));
  statements_ = outer;
  at_ = at;
}

void RoutineReader::compare_inside(const CppStatement& statement, const Body& body) {
  scope_.enter();
  within(statement, [&] { compare(body); });
  scope_.leave();
}

const CppStatement* RoutineReader::peek() const {
  return at_ < statements_.size() ? &statements_[at_] : nullptr;
}

const CppStatement& RoutineReader::next(CppStatement::Kind kind, const std::string& what) {
  const CppStatement* statement = peek();
  if (statement == nullptr)
    throw TextDifference(end_line_, fmt::format("{} is missing after this", shortened(what)));
  end_line_ = statement->line;
  if (statement->kind != kind)
    throw TextDifference(statement->line, fmt::format("not {}", shortened(what)));
  ++at_;
  return *statement;
}

const CppStatement& RoutineReader::declaration(const std::string& type, const std::string& what) {
  const CppStatement& found = next(CppStatement::Kind::declaration, what);
  if (found.type != type)
    throw TextDifference(found.line,
                         fmt::format("{} is a {}, not a {}", found.name, found.type, type));
  return found;
}

void RoutineReader::same(const MachineValue& written, const MachineValue& exact, int line,
                         const std::string& what) {
  if (!is_same(written, exact, scope_.precision()))
    throw TextDifference(line, "not " + shortened(what));
}

void RoutineReader::local(const std::string& type, const std::string& symbol_name,
                          const MachineValue& value) {
  const CppStatement& found = declaration(type, symbol_name);
  if (!found.value || !found.sizes.empty())
    throw TextDifference(found.line, fmt::format("{} without its value", found.name));
  same(scope_.value(*found.value), value, found.line, symbol_name + " of the program");
  scope_.declare(found.name, {Meaning::Kind::number, symbol_name}, found.line);
}

void RoutineReader::object(const std::string& type, const std::string& name) {
  const CppStatement& found = declaration(type, name);
  if (found.value || !found.sizes.empty())
    throw TextDifference(found.line, fmt::format("{} with a value", found.name));
  scope_.declare(found.name, {Meaning::Kind::object, name}, found.line);
}

void RoutineReader::array(const std::string& name, const std::vector<int>& sizes,
                          const Values& values) {
  const CppStatement& found = declaration("Real", name);
  bool right = found.value && found.sizes.size() == sizes.size();
  for (std::size_t i = 0; right && i < sizes.size(); ++i) {
    right = scope_.index(found.sizes[i]) == AffineIndex{.constant = sizes[i], .factors = {}};
  }
  if (!right) throw TextDifference(found.line, fmt::format("not the array {}", name));
  same(scope_.value(*found.value), machine_call("{}", values), found.line,
       "the values of the array " + name);
  scope_.declare(found.name, {Meaning::Kind::object, name}, found.line);
}

void RoutineReader::assignment(const MachineValue& to, const std::string& sign,
                               const MachineValue& value) {
  const std::string what = to.name.substr(to.name.starts_with('@') ? 1 : 0);
  const CppStatement& found = next(CppStatement::Kind::expression, what + " " + sign + " ...");
  const CppExpression& e = *found.value;
  if (e.kind != CppExpression::Kind::binary || e.text.back() != '=' || e.text == "==" ||
      e.text == "<=" || e.text == ">=")
    throw TextDifference(found.line, fmt::format("not {} {} ...", what, sign));
  same(scope_.value(e.parts[0]), to, found.line, "the assignment to " + what);
  MachineValue right = scope_.value(e.parts[1]);
  // x -= a is x += -a.
  const bool subtracted = e.text == "-=" && sign == "+=";
  if (!subtracted && e.text != sign)
    throw TextDifference(found.line, fmt::format("{} {} ..., not {}", what, e.text, sign));
  same(subtracted ? -std::move(right) : right, value, found.line, what + " of the program");
}

void RoutineReader::call(const MachineValue& value) {
  const CppStatement& found = next(CppStatement::Kind::expression, "a call of " + value.name);
  same(scope_.value(*found.value), value, found.line, "the call of " + value.name);
}

const CppStatement& RoutineReader::branch(const MachineValue& condition) {
  const CppStatement& found = next(CppStatement::Kind::branch, "a condition");
  same(scope_.value(*found.value), condition, found.line, "the condition of the program");
  return found;
}

// The caller enters a frame and leaves it.
const CppStatement& RoutineReader::loop(const KernelRange& range, int step) {
  const CppStatement& found = next(CppStatement::Kind::loop, "a loop over " + range.index);
  const CppStatement& begin = found.first.front();
  const bool plain = begin.type == "int" && begin.value && begin.sizes.empty() && found.value &&
                     found.advance && advances(*found.advance, begin.name, step);
  if (!plain) throw TextDifference(found.line, "not a loop over " + range.index);
  const AffineIndex lower = scope_.index(*begin.value);
  const CppExpression& condition = *found.value;
  const bool strict = condition.is_binary("<");
  if ((!strict && !condition.is_binary("<=")) || !condition.parts[0].is_name(begin.name))
    throw TextDifference(found.line, "not a loop over " + range.index);
  AffineIndex upper = scope_.index(condition.parts[1]);
  if (strict) --upper.constant;
  if (lower != range.lower || upper != range.upper)
    throw TextDifference(found.line, fmt::format("{} does not run from {} to {}", range.index,
                                                 to_text(range.lower), to_text(range.upper)));
  scope_.enter();
  scope_.declare(begin.name, {Meaning::Kind::index, range.index}, begin.line);
  return found;
}

const CppStatement& RoutineReader::endless(const std::string& symbol_name) {
  const CppStatement& found = next(CppStatement::Kind::loop, "an iteration");
  const CppStatement& begin = found.first.front();
  const bool counts = begin.type == "int" && begin.value && begin.sizes.empty() && !found.value &&
                      found.advance && found.advance->kind == CppExpression::Kind::prefix &&
                      found.advance->text == "++" && found.advance->parts[0].is_name(begin.name);
  if (!counts) throw TextDifference(found.line, "not an iteration");
  same(scope_.value(*begin.value), machine_symbol("#1"), begin.line, "counted from 1");
  scope_.enter();
  scope_.declare(begin.name, {Meaning::Kind::number, symbol_name}, begin.line);
  return found;
}

bool RoutineReader::is_place(const CppExpression& written, const Place& place) const {
  if (place.indices.empty()) {
    const std::optional<Place> found = scope_.place(written);
    return found && *found == place;
  }
  const std::optional<Place> found = scope_.element(written);
  return found && *found == place;
}

bool RoutineReader::is_called(const CppExpression& written, const Call& call) const {
  if (written.kind != CppExpression::Kind::call || !written.parts[0].is_name(call.routine))
    return false;
  if (scope_.place(written.parts[0])) return false;  // a local of that name
  if (written.parts.size() != call.arguments.size() + 1) return false;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (!is_place(written.parts[i + 1], call.arguments[i])) return false;
  }
  return true;
}

void RoutineReader::failure() {
  const CppStatement& found = next(CppStatement::Kind::result, "the end without success");
  const bool report = routine_.result.type == "StepReport";
  const bool right = found.value && (report ? is_place(*found.value, {routine_.result.object})
                                            : found.value->is_name("false"));
  if (!right) throw TextDifference(found.line, "not the end without success");
}

std::string RoutineReader::meaning_of(const std::string& name) const {
  const auto place = routine_.places.find(name);
  if (place != routine_.places.end()) return symbol_of(place->second);
  return name == "pi" ? "::pi" : name;
}

MachineValue RoutineReader::symbol(const std::string& name) const {
  return machine_symbol(meaning_of(name));
}

MachineValue RoutineReader::meant(const Expression& e) {
  if (!is_computed_as_meant(e))
    throw TextDifference(end_line_,
                         "the operations of the program do not compute " + shortened(to_text(e)));
  return machine_value(e, [this](const std::string& name) { return meaning_of(name); });
}

}  // namespace hamgen
