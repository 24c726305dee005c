#include "generator/readback/run_words.hpp"

#include <fmt/format.h>

#include <set>

#include "generator/base/diagnostic.hpp"
#include "generator/readback/pattern.hpp"

namespace hamgen {

namespace {

class RunWords {
 public:
  RunWords(const Routine& routine, const RunLanguage& language)
      : routine_(routine), c_(language.c), n_(language.n) {
    for (const Argument& argument : routine.arguments) {
      if (!argument.record.empty()) addresses_.insert(argument.name);
    }
  }

  std::string all() {
    const std::string type = routine_.result.type.empty() ? "void" : of_type(routine_.result.type);
    std::string arguments = c_ && routine_.of_run ? "N::Propagator* self" : "";
    for (const Argument& argument : routine_.arguments)
      arguments += (arguments.empty() ? "" : ", ") + declared(argument);
    std::string name = routine_.name;
    if (c_) {
      name = "static inline " + type + (routine_.of_run ? " N::Propagator_" : " N::") + name;
    } else {
      name = (routine_.of_run ? "" : "[[nodiscard]] inline ") + type + " " + name;
    }
    words_ = fmt::format("{}({})", name, arguments);
    block(routine_.body);
    return words_;
  }

  void operator()(const Accumulate& sum) {
    say("{} += {};", of_symbol(sum.symbol), of_value(sum.value));
  }
  void operator()(const Assign& assign) {
    say("{} = {};", of_symbol(assign.symbol), of_value(assign.value));
  }
  void operator()(const SetFlag& set) { say("{} = {};", at(set.flag), set.value); }
  void operator()(const Copy& copy) {
    const std::string from = copy.from.empty() ? zeros(copy.record) : whole(copy.from);
    say("{}{} = {};", copy.declares ? of_type(copy.record) + " " : "", whole(copy.to), from);
    if (copy.declares) records_.insert(copy.to);
  }
  void operator()(const If& branch) {
    say("if ({}{}{})", branch.set ? "" : "!", at(branch.flag),
        branch.also ? " && " + at(*branch.also) : "");
    inside(branch.then);
  }
  void operator()(const For& loop) {
    const long count = loop.range.upper.constant + 1;
    say("for (int {0} = 0; {0} < {1}; ++{0})", loop.range.index, count_words(count));
    block(loop.body);
  }
  void operator()(const Call& call) {
    if (call.object.empty())
      return say("{}({});", c_ ? "(void)" : "static_cast<void>", called(call));
    const std::string type = call.again    ? ""
                             : call.varies ? of_type(call.record)
                                           : "const " + of_type(call.record);
    say("{} {} = {};", type, call.object, called(call));
    if (call.record != kReport) records_.insert(call.object);
  }
  void operator()(const Use& use) {
    std::string list;
    const bool acts = !use.action.empty();
    for (std::size_t i = acts ? 1 : 0; i < use.arguments.size(); ++i) {
      const bool address = c_ && !acts && i < 2;  // of a sum what changes
      list += (list.empty() ? "" : ", ") + (address ? "&" : std::string()) + at(use.arguments[i]);
    }
    if (!acts) return say("{}{}({});", c_ ? "hamgen::" : "", use.block, list);
    const std::string object = at(use.arguments.front());
    if (!c_) return say("{}.{}({});", object, use.action, list);
    if (use.action != "watch") return say("N::History_{}(&{}, {});", use.action, object, list);
    const std::size_t comma = list.find(',');
    say("N::History_watch(&{}, &{}{});", list.substr(0, comma), object, list.substr(comma));
  }
  void operator()(const Declare& declare) {
    std::string list;
    for (const std::string& object : declare.objects) {
      records_.insert(object);
      list += (list.empty() ? "" : ", ") + object;
      const bool start = declare.record == "Start";
      if (c_) say("{} {} = {};", of_type(declare.record), object, start ? "N::start()" : "{0}");
    }
    if (!c_) say("{} {};", declare.record, list);
  }
  void operator()(const Note& note) {
    say("const {} {} = {};", note.type, note.name, at(note.from));
  }
  void operator()(const Count& count) {
    if (!count.by) return say("++{};", at(count.count));
    say("{} += {};", at(count.count), at(*count.by));
  }
  void operator()(const Ask& ask) { say("{} = {} > 0;", at(ask.flag), at(ask.count)); }
  void operator()(const Forget& forget) {
    if (forget.each == 0) return begins(at(forget.what), forget.type);
    const std::string name = forget.what.object.substr(5);
    const std::string field = forget.what.field.empty() ? "" : "." + forget.what.field;
    if (c_) {
      say("for (int j = 0; j < {}; ++j)", forget.each);
    } else {
      say("for ({}& {} : {}_)", forget.type == "History" ? "auto" : "Start", name, name);
    }
    begins((c_ ? "self->" + name + "[j]" : name) + field, forget.type);
  }
  void operator()(const Repeat& repeat) {
    say("for ({0} {1} = 0; {1} < {2}; ++{1})", repeat.type, repeat.index,
        c_ && repeat.count > 0 ? std::to_string(repeat.count) : repeat.times);
    inside(repeat.body);
  }
  void operator()(const Break&) { say("break;"); }
  void operator()(const RequireFinite& finite) {
    say("Real rest = 0;");
    if (finite.count > 0) say("for (int i = 0; i < {}; ++i) {{", count_words(finite.count));
    for (const Place& place : finite.numbers) say("rest += {0} - {0};", at(place));
    if (finite.count > 0) say("}}");
    say("{0}.converged = rest == 0; {0}.increment = rest;", finite.report);
  }
  void operator()(const Return& end) { say("return {};", end.report); }
  template <class Other>
  void operator()(const Other&) {
    internal_error("an instruction that no routine of a run has");
  }

 private:
  static constexpr const char* kReport = "StepReport";

  template <class... Words>
  void say(fmt::format_string<Words...> format, Words&&... words) {
    words_ += fmt::format(format, std::forward<Words>(words)...) + " ";
  }
  void block(const Body& body) {
    say("{{");
    for (const Instruction& instruction : body) std::visit(*this, instruction.value);
    say("}}");
  }
  // Braces around what is no simple statement, and where the line has no room for it.
  void inside(const Body& body) {
    const bool simple = body.size() == 1 && body[0].remark.empty() &&
                        (std::holds_alternative<Call>(body[0].value) ||
                         std::holds_alternative<Use>(body[0].value) ||
                         std::holds_alternative<Break>(body[0].value) ||
                         std::holds_alternative<Return>(body[0].value));
    if (!simple) return block(body);
    say("{}", kOpen);
    std::visit(*this, body[0].value);
    say("{}", kClose);
  }

  [[nodiscard]] std::string of_type(const std::string& record) const {
    return c_ ? (record == kReport ? "hamgen::" : "N::") + record : record;
  }
  [[nodiscard]] std::string declared(const Argument& argument) const {
    if (!argument.count.empty()) return argument.count + " " + argument.name;
    if (argument.record.empty()) return "Real " + argument.name;
    return fmt::format("{}{}{} {}", argument.changes ? "" : "const ", of_type(argument.record),
                       c_ ? "*" : "&", argument.name);
  }
  [[nodiscard]] std::string zeros(const std::string& record) const {
    if (!c_) return record + "()";
    return record == "Start" ? "N::start()" : fmt::format("(N::{}){{0}}", record);
  }
  [[nodiscard]] std::string kept(const std::string& name) const {
    if (c_) return "self->" + name;
    const std::size_t bracket = std::min(name.find('['), name.size());
    return name.substr(0, bracket) + "_" + name.substr(bracket);
  }
  [[nodiscard]] bool is_address(const std::string& object) const {
    return c_ && addresses_.contains(object);
  }
  // Without the star of an address.
  [[nodiscard]] std::string object(const std::string& name) const {
    if (name.starts_with("self.")) return kept(name.substr(5));
    if (name.starts_with("new ")) return zeros(name.substr(4));
    return name;
  }
  [[nodiscard]] std::string whole(const std::string& name) const {
    return (is_address(name) ? "*" : "") + object(name);
  }
  [[nodiscard]] std::string at(const Place& place) const {
    if (place.object == "self") return kept(place.field);
    if (place.object.empty()) return to_text(place.indices.front());
    std::string text = object(place.object);
    if (!place.field.empty()) text += (is_address(place.object) ? "->" : ".") + place.field;
    for (const AffineIndex& index : place.indices) text += "[" + to_text(index) + "]";
    return text;
  }
  // As it is handed on.
  [[nodiscard]] std::string given(const Place& place) const {
    const bool record = records_.contains(place.object) || place.object.starts_with("self.") ||
                        place.object.starts_with("new ");
    return (c_ && record ? "&" : "") + at(place);
  }
  [[nodiscard]] std::string called(const Call& call) const {
    std::string list = c_ && call.of_run ? "self" : "";
    for (const Place& place : call.arguments) list += (list.empty() ? "" : ", ") + given(place);
    const char* begin = !c_ ? "" : call.of_run ? "N::Propagator_" : "N::";
    return fmt::format("{}{}({})", begin, call.routine, list);
  }
  [[nodiscard]] std::string of_symbol(const std::string& symbol) const {
    return at(routine_.places.at(symbol));
  }
  // One number, or the sum of two.
  [[nodiscard]] std::string of_value(const Expression& value) const {
    if (value.kind() == Kind::symbol) return of_symbol(value.name());
    std::string text;
    for (const Expression& part : value.operands())
      text += (text.empty() ? "" : " + ") + of_symbol(part.name());
    return text;
  }
  [[nodiscard]] std::string count_words(long count) const {
    return count == n_ ? "n" : std::to_string(count);
  }
  void begins(const std::string& place, const std::string& type) {
    if (type == "Start") return say("{} = {};", place, zeros(type));
    if (type == "History") return say("{}{});", c_ ? "N::History_forget(&" : "forget(", place);
    if (type == "bool") return say("{} = false;", place);
    if (type == "int") return say("{} = 0;", place);
    if (type.starts_with("Refine")) return say("{}.rounds = 0;", place);
    say("{} = {{}};", place);
  }

  const Routine& routine_;
  bool c_;
  int n_;
  std::string words_;
  std::set<std::string> addresses_;
  std::set<std::string> records_;  // that are locals
};

}  // namespace

std::string words_of(const Routine& routine, const RunLanguage& language) {
  return RunWords(routine, language).all();
}

}  // namespace hamgen
