// What instructions look like that only the routines of a run have.
#pragma once

#include "generator/program/written_iterations.hpp"

namespace hamgen::written {

class RunWriter : public IterationWriter {
 public:
  using IterationWriter::IterationWriter;
  using IterationWriter::operator();

  void operator()(const Use& use) {
    std::vector<Value> list;
    for (const Place& place : use.arguments)
      list.push_back(place.object.empty() ? index(place.indices.front()) : object(place));
    // A function beside the block, where there are templates.
    const bool beside = use.action == "extrapolate_twice" && form_.references;
    if (beside) return void(add(Do{call(use.action, std::move(list))}));
    Value value = with_parts(use.action.empty() ? Value::Kind::call : Value::Kind::action,
                             use.action.empty() ? use.block : use.action, std::move(list));
    value.type = use.block;
    if (use.action.empty()) value.changed = 2;  // of a sum
    add(Do{std::move(value)});
  }
  void operator()(const Declare& declare) {
    if (form_.references) return void(add(declare));
    for (const std::string& name : declare.objects) {
      // The rules of a start do not begin with zeros.
      declare.record == "Start" ? add(Define{"Start", name, zeros("Start"), true})
                                : add(Declare{declare.record, {name}});
    }
  }
  void operator()(const Note& note) {
    add(Define{note.type, note.name, at(note.from), note.varies});
  }
  void operator()(const Count& count) {
    if (count.by) return set(at(count.count), at(*count.by), "+=");
    add(Do{prefix("++", at(count.count))});
  }
  void operator()(const Ask& ask) { set(at(ask.flag), joined(">", {at(ask.count), integer(0)})); }

  void operator()(const Forget& forget) {
    if (forget.each == 0) return begin(forget.what, forget.type);
    Place one = forget.what;
    if (form_.references) {
      one.object = one.object.substr(5);
      Body body = inside([&] { begin(one, forget.type); });
      return void(
          add(Each{forget.type == "History" ? "auto" : "Start", one.object, std::move(body)}));
    }
    one.object += "[j]";
    Body body = inside([&] { begin(one, forget.type); });
    add(Loop{"int", "j", 0, std::to_string(forget.each), std::move(body), Shape::line});
  }
  void operator()(const Repeat& repeat) {
    // C has no constant of that name.
    const bool number = repeat.count > 0 && !form_.references;
    const std::string times = number ? std::to_string(repeat.count) : repeat.times;
    Body body = inside(repeat.body);
    add(Loop{repeat.type, repeat.index, 0, times, std::move(body), Shape::fitting});
  }
  void operator()(const Break& leave) { add(leave); }
  void operator()(const RequireFinite& finite) {
    const Value rest = at({"rest "});
    const AffineIndex last{.constant = finite.count - 1, .factors = {}};
    std::vector<KernelRange> ranges;
    if (finite.count > 0) ranges.push_back({.index = "i", .lower = {}, .upper = last});
    add(Define{"Real", "rest ", integer(0), true});
    over(
        ranges,
        [&] {
          for (const Place& place : finite.numbers)
            set(rest, joined("-", {at(place), at(place)}), "+=");
        },
        Shape::braces);
    set(at({finite.report, "converged"}), joined("==", {rest, integer(0)}));
    set(at({finite.report, "increment"}), rest);
  }

 private:
  // A place becomes what it begins with.
  void begin(const Place& place, const std::string& type) {
    if (type == "Start" || type == "Derivatives") return set(object(place), zeros(type));
    if (type == "History" && form_.references)
      return void(add(Do{call("forget", {object(place)})}));
    if (type == "History") return void(add(Do{action(type, place, "forget")}));
    if (type == "bool") return set(object(place), word("false"));
    if (type == "int") return set(object(place), integer(0));
    if (!type.starts_with("Refine")) return set(object(place), list({}));
    add(Do{action(type, place, "forget")});
  }
};

}  // namespace hamgen::written
