// Calls, what a run does with what it keeps from step to step, and what should be finite.
#include <fmt/format.h>

#include "generator/formats/routine_printer.hpp"

namespace hamgen {

namespace {

// What a place of the type begins with, as an assignment to it.
std::string beginning(const std::string& place, const std::string& type, const Dialect& dialect) {
  if (type == "Start") return place + " = " + dialect.empty_record(type);
  if (type == "History") return dialect.forget(place);
  if (type == "bool") return place + " = false";
  if (type == "int") return place + " = 0";
  return place + (type.starts_with("Refine") ? ".rounds = 0" : " = {}");
}

}  // namespace

std::string Dialect::kept_place(const Place& place) const {
  if (place.object == "self") return kept(place.field);
  const std::string within = to_text(Place{"", place.field, place.indices});
  return kept(place.object.substr(5)) + within;
}

std::string RoutinePrinter::call_text(const Call& call) const {
  std::vector<std::string> arguments;
  for (const Place& place : call.arguments) arguments.push_back(given(place));
  const std::string list = joined_texts(arguments, ", ");
  if (call.of_run) return dialect_.call_of_run(call.routine, list);
  return fmt::format("{}({})", dialect_.routine(call.routine), list);
}

void RoutinePrinter::operator()(const Call& call) {
  if (call.must_succeed) {
    const char* success = call.record == "StepReport" ? ".converged" : "";
    return out_.line(fmt::format("if (!{}{}) {}", call_text(call), success, failure()));
  }
  if (call.object.empty()) {
    return out_.line((call.record.empty() ? call_text(call) : dialect_.unused(call_text(call))) +
                     ";");
  }
  const std::string type =
      call.again ? "" : (call.varies ? "" : "const ") + dialect_.record(call.record) + " ";
  out_.line(fmt::format("{}{} = {};", type, call.object, call_text(call)));
}
void RoutinePrinter::operator()(const Use& use) {
  std::vector<std::string> list;
  for (const Place& place : use.arguments) {
    const bool integer = place.object.empty();
    list.push_back(integer ? text(place.indices.front()) : text(place));
  }
  if (!use.action.empty()) {
    const std::string object = list.front();
    list.erase(list.begin());
    const std::string call = dialect_.call(use.block, object, use.action, joined_texts(list, ", "));
    return out_.line(call + ";");
  }
  // What a sum changes stands first.
  for (std::size_t i = 0; i < 2 && !dialect_.has_references(); ++i) list[i] = "&" + list[i];
  out_.line(fmt::format("{}({});", dialect_.block(use.block), joined_texts(list, ", ")));
}
void RoutinePrinter::operator()(const Declare& declare) {
  if (dialect_.has_references())
    return out_.line(dialect_.declaration(declare.record, joined_texts(declare.objects, ", ")));
  for (const std::string& object : declare.objects)
    out_.line(dialect_.declaration(declare.record, object));
}
void RoutinePrinter::operator()(const Note& note) {
  out_.line(fmt::format("const {} {} = {};", note.type, note.name, text(note.from)));
}
void RoutinePrinter::operator()(const Count& count) {
  if (!count.by) return out_.line(fmt::format("++{};", text(count.count)));
  out_.line(fmt::format("{} += {};", text(count.count), text(*count.by)));
}
void RoutinePrinter::operator()(const Ask& ask) {
  out_.line(fmt::format("{} = {} > 0;", text(ask.flag), text(ask.count)));
}
void RoutinePrinter::operator()(const Forget& forget) {
  if (forget.each == 0) {
    return out_.line(beginning(text(forget.what), forget.type, dialect_) + ";");
  }
  const auto [head, one] =
      dialect_.for_each(forget.what.object.substr(5), forget.type, forget.each);
  const std::string field = forget.what.field.empty() ? "" : "." + forget.what.field;
  out_.line(fmt::format("{} {};", head, beginning(one + field, forget.type, dialect_)));
}
void RoutinePrinter::operator()(const Repeat& repeat) {
  // C has no constant of that name.
  const bool number = repeat.count > 0 && !dialect_.has_references();
  print_inside(fmt::format("for ({0} {1} = 0; {1} < {2}; ++{1})", repeat.type, repeat.index,
                           number ? std::to_string(repeat.count) : repeat.times),
               repeat.body);
}
void RoutinePrinter::operator()(const Break&) { out_.line("break;"); }
void RoutinePrinter::operator()(const RequireFinite& finite) {
  out_.line(dialect_.real() + " rest = 0;");
  if (finite.count > 0)
    out_.open(fmt::format("for (int i = 0; i < {}; ++i)", count_text(finite.count)));
  for (const Place& place : finite.numbers)
    out_.line(fmt::format("rest += {0} - {0};", text(place)));
  if (finite.count > 0) out_.close();
  out_.line(finite.report + ".converged = rest == 0;");
  out_.line(finite.report + ".increment = rest;");
}

void RoutinePrinter::length_of(const Return& end) {
  std::vector<std::string> squares;
  const bool lanes = dialect_.has_lanes();
  for (const Place& array : lanes ? std::vector<Place>() : finite_arrays(routine_, end)) {
    squares.push_back(fmt::format("{}({})", dialect_.block("squares_of"), text(array)));
  }
  if (!squares.empty()) {
    out_.line("// False for infinities and NaN alike.");
    return out_.line(
        fmt::format("const {} length = {};", dialect_.real(), joined_texts(squares, " + ")));
  }
  for (const std::string& symbol : end.finite) {
    squares.push_back(fmt::format("{0} * {0}", name(symbol)));
  }
  const std::string sum = joined_texts(squares, " + ");
  if (!end.ranges.empty()) {
    out_.line(dialect_.real() + " length = 0;");
    for (std::size_t i = 0; i + 1 < end.ranges.size(); ++i) out_.open(head(end.ranges[i]));
    out_.line(head(end.ranges.back()) + " length += " + sum + ";");
    for (std::size_t i = 0; i + 1 < end.ranges.size(); ++i) out_.close();
  }
  if (!dialect_.has_lanes()) out_.line("// False for infinities and NaN alike.");
  if (end.ranges.empty()) out_.line(fmt::format("const {} length = {};", dialect_.real(), sum));
}

}  // namespace hamgen
