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
bool advances(const CppExpression& e, const std::string& index, int lanes) {
  if (lanes == 0)
    return e.kind == CppExpression::Kind::prefix && e.text == "++" && e.parts[0].is_name(index);
  return e.is_binary("+=") && e.parts[0].is_name(index) &&
         e.parts[1].kind == CppExpression::Kind::number && e.parts[1].text == std::to_string(lanes);
}

// What is no object but stands for itself.
bool is_value(const written::Define& define) {
  return written::is_number(define) || define.type == "bool" || define.type == "int" ||
         define.type == "long long" || define.type == "Verdict";
}

}  // namespace

RoutineReader::RoutineReader(const CppFunction& function, const Routine& routine,
                             const TextOf& text)
    : function_(function),
      routine_(routine),
      c_(text.c),
      lanes_(text.lanes),
      scope_(text.precision, text.n, text.lanes),
      statements_(function.body),
      end_line_(function.line) {
  if (text.run == nullptr) return;
  if (c_) scope_.declare("self", {Meaning::Kind::object, "self"}, function.line);
  for (const Field& field : text.run->fields) {
    if (!c_)
      scope_.declare(field.name + "_", {Meaning::Kind::object, "self." + field.name},
                     function.line);
  }
  if (!c_) scope_.declare("substeps", {Meaning::Kind::index, "substeps"}, function.line);
}

void RoutineReader::compare() {
  compare_signature();
  compare(written::body_of(
      routine_,
      {.references = !c_, .lanes = lanes_, .eigen = !scope_.precision().is_quad() && !lanes_}));
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
  std::string type = argument.record.empty() ? "Real" : argument.record;
  if (!argument.count.empty()) type = argument.count;
  Pass pass = argument.sizes.empty() ? Pass::reference : Pass::array;
  if (argument.decays) pass = Pass::pointer;
  // In C both are the same.
  if (c_ && argument.sizes.size() == 1 && written.pass == Pass::pointer) pass = Pass::pointer;
  if (number && !argument.decays && (!lanes_ || !argument.count.empty())) pass = Pass::value;
  bool same = written.type == type && written.pass == pass;
  if (!c_) same = same && written.alone == argument.alone;
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
  const Meaning::Kind kind = !argument.count.empty()      ? Meaning::Kind::index
                             : number && !argument.decays ? Meaning::Kind::number
                                                          : Meaning::Kind::object;
  scope_.declare(written.name, {kind, argument.name}, function_.line);
}

void RoutineReader::compare(const written::Body& body) {
  for (const written::Statement& statement : body)
    std::visit([this](const auto& node) { read(node); }, statement.value);
}

// The body in these statements, all of them.  The caller enters a frame.
void RoutineReader::compare_inside(const CppStatement& statement, const written::Body& body) {
  const Statements outer = statements_;
  const std::size_t at = at_;
  statements_ = statement.body;
  at_ = 0;
  compare(body);
  if (const CppStatement* more = peek())
    throw TextDifference(more->line, fmt::format("a statement that {} has not", routine_.name));
  statements_ = outer;
  at_ = at;
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

const CppStatement& RoutineReader::declaration(std::string type, const std::string& what) {
  const CppStatement& found = next(CppStatement::Kind::declaration, what);
  std::erase(type, ' ');
  std::string written = found.type;
  std::erase(written, ' ');
  if (written != type)
    throw TextDifference(found.line,
                         fmt::format("{} is a {}, not a {}", found.name, found.type, type));
  return found;
}

void RoutineReader::require_same(const CppExpression& e, const written::Value& value, int line,
                                 const std::string& what) {
  if (!same(e, value)) throw TextDifference(line, "not " + what);
}

void RoutineReader::read(const Declare& declare) {
  for (const std::string& name : declare.objects) {
    const CppStatement& found = declaration(declare.record, name);
    if (found.value || !found.sizes.empty())
      throw TextDifference(found.line, fmt::format("{} with a value", found.name));
    scope_.declare(found.name, {Meaning::Kind::object, name}, found.line);
  }
}

void RoutineReader::read(const written::Define& define) {
  const CppStatement& found = declaration(define.type, define.name);
  bool right = found.value && found.sizes.size() == define.sizes.size();
  for (std::size_t i = 0; right && i < define.sizes.size(); ++i) {
    right = scope_.index(found.sizes[i]) == AffineIndex{.constant = define.sizes[i], .factors = {}};
  }
  if (!right) throw TextDifference(found.line, fmt::format("not {} with its value", define.name));
  require_same(*found.value, define.value, found.line, define.name + " of the program");
  scope_.declare(found.name,
                 {is_value(define) ? Meaning::Kind::number : Meaning::Kind::object, define.name},
                 found.line);
}

// a = b, a += b and the like.
void RoutineReader::read(const written::Set& set) {
  const CppStatement& found = next(CppStatement::Kind::expression, "an assignment");
  const CppExpression& e = *found.value;
  // x -= a is x += -a.
  const bool subtracted =
      e.is_binary("-=") && set.sign == "+=" && set.value.kind == written::Value::Kind::formula;
  if (!subtracted && !e.is_binary(set.sign))
    throw TextDifference(found.line, "not an assignment by " + set.sign);
  require_same(e.parts[0], set.to, found.line, "the assignment of the program");
  if (!subtracted)
    return require_same(e.parts[1], set.value, found.line, "the value of the program");
  if (!is_same(-scope_.value(e.parts[1]), meant(set.value.formula), scope_.precision()))
    throw TextDifference(found.line, "not the value of the program");
}

void RoutineReader::read(const written::Do& action) {
  const std::string what = "the program's call of " + action.value.text;
  const CppStatement& found = next(CppStatement::Kind::expression, what);
  require_same(*found.value, action.value, found.line, what);
}

void RoutineReader::read(const written::For& node) {
  const CppStatement& found = loop(node.range, node.lanes);
  if (node.lanes > 0) scope_.set_lanes(node.range.index);
  compare_inside(found, node.body);
  if (node.lanes > 0) scope_.set_lanes("");
}

void RoutineReader::read(const written::Loop& node) {
  const CppStatement& found = counter(node.type, "an iteration");
  const CppStatement& begin = found.first.front();
  bool limited = !found.value;
  if (!node.limit.empty()) {
    limited = found.value && found.value->is_binary("<") &&
              found.value->parts[0].is_name(begin.name) &&
              scope_.is_count(found.value->parts[1], node.limit);
  }
  const bool first = begin.value->kind == CppExpression::Kind::number &&
                     begin.value->text == std::to_string(node.first);
  if (!first || !limited) throw TextDifference(found.line, "not an iteration");
  scope_.enter();
  const bool counts = node.limit.empty();
  scope_.declare(begin.name, {counts ? Meaning::Kind::number : Meaning::Kind::index, node.index},
                 begin.line);
  compare_inside(found, node.body);
}

void RoutineReader::read(const written::Each& node) {
  const CppStatement& found = next(CppStatement::Kind::each, "a loop over " + node.name);
  const CppStatement& one = found.first.front();
  const bool right = one.type == node.type + "&" && !one.value && one.sizes.empty() &&
                     scope_.is_place(*found.value, {"self." + node.name});
  if (!right) throw TextDifference(found.line, "not a loop over " + node.name);
  scope_.enter();
  scope_.declare(one.name, {Meaning::Kind::object, node.name}, one.line);
  compare_inside(found, node.body);
}

void RoutineReader::read(const written::While& node) {
  const CppStatement& found = next(CppStatement::Kind::loop, "a refinement");
  const CppStatement& begin = found.first.front();
  const bool plain = begin.type == "bool" && begin.value && begin.value->is_name("true") &&
                     found.value && found.value->is_name(begin.name) && !found.advance;
  if (!plain) throw TextDifference(found.line, "not a refinement");
  scope_.enter();
  scope_.declare(begin.name, {Meaning::Kind::number, "more "}, begin.line);
  compare_inside(found, node.body);
}

void RoutineReader::read(const written::If& branch) {
  const CppStatement& found = next(CppStatement::Kind::branch, "a condition");
  require_same(*found.value, branch.condition, found.line, "the condition of the program");
  scope_.enter();
  compare_inside(found, branch.body);
}

void RoutineReader::read(const written::Block& block) {
  const CppStatement& found = next(CppStatement::Kind::block, "a block");
  scope_.enter();
  compare_inside(found, block.body);
}

void RoutineReader::read(const Break& /*leave*/) {
  next(CppStatement::Kind::leave, "the end of the iteration");
}
void RoutineReader::read(const written::Continue& /*next*/) {
  next(CppStatement::Kind::next, "the next iteration");
}

void RoutineReader::read(const written::Return& end) {
  const CppStatement& found = next(CppStatement::Kind::result, "the result");
  if (!found.value) throw TextDifference(found.line, "returns nothing");
  require_same(*found.value, end.value, found.line, "the result of the program");
}

// for (type name = ...; ...; ++name)
const CppStatement& RoutineReader::counter(const std::string& type, const std::string& what,
                                           int lanes) {
  const CppStatement& found = next(CppStatement::Kind::loop, what);
  const CppStatement& begin = found.first.front();
  const bool counts = begin.type == type && begin.value && begin.sizes.empty() && found.advance &&
                      advances(*found.advance, begin.name, lanes);
  if (!counts) throw TextDifference(found.line, "not " + what);
  return found;
}

// The caller leaves the frame.
const CppStatement& RoutineReader::loop(const KernelRange& range, int lanes) {
  const CppStatement& found = counter("int", "a loop over " + range.index, lanes);
  const CppStatement& begin = found.first.front();
  if (!found.value) throw TextDifference(found.line, "not a loop over " + range.index);
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

std::string RoutineReader::meaning_of(const std::string& name) const {
  const auto place = routine_.places.find(name);
  if (place != routine_.places.end()) return symbol_of(place->second);
  return name == "pi" ? "::pi" : name;
}

MachineValue RoutineReader::meant(const Expression& e) {
  if (!is_computed_as_meant(e))
    throw TextDifference(end_line_,
                         "the operations of the program do not compute " + shortened(to_text(e)));
  return machine_value(e, [this](const std::string& name) { return meaning_of(name); });
}

int instructions_of(const Body& body) {
  int count = 0;
  for (const Instruction& instruction : body) {
    ++count;
    for (const Body* inner : inner_bodies(instruction)) count += instructions_of(*inner);
  }
  return count;
}

}  // namespace hamgen
