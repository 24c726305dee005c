// What writes a routine as statements is made of: values, and a body that grows.
#pragma once

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/program/written_code.hpp"

namespace hamgen::written {

[[nodiscard]] inline Value formula(Expression e) { return {.formula = std::move(e)}; }
[[nodiscard]] inline Value symbol(const std::string& name) {
  return formula(Expression::symbol(name));
}
[[nodiscard]] inline Value word(const std::string& text) {
  return {.kind = Value::Kind::word, .text = text};
}
[[nodiscard]] inline Value at(Place place, Value::Kind kind = Value::Kind::place) {
  return {.kind = kind, .place = std::move(place)};
}
[[nodiscard]] inline Value object(Place place) { return at(std::move(place), Value::Kind::object); }
[[nodiscard]] inline Value element(const std::string& array, std::size_t j) {
  return at({array, {}, {{.constant = static_cast<long>(j), .factors = {}}}});
}
[[nodiscard]] inline Value index(const AffineIndex& a, Value::Kind kind = Value::Kind::index) {
  return at({{}, {}, {a}}, kind);
}
[[nodiscard]] inline Value integer(long number) {
  return index({.constant = number, .factors = {}});
}
[[nodiscard]] inline Value with_parts(Value::Kind kind, const std::string& text,
                                      std::vector<Value> parts) {
  return {.kind = kind, .text = text, .parts = std::move(parts)};
}
[[nodiscard]] inline Value call(const std::string& block, std::vector<Value> arguments) {
  return with_parts(Value::Kind::call, block, std::move(arguments));
}
// |-x| = |x|
[[nodiscard]] inline Value magnitude(const Expression& e) {
  return call("magnitude", {formula(e.split_coefficient().first < 0 ? -e : e)});
}
[[nodiscard]] inline Value in_parentheses(Value of) { return call("", {std::move(of)}); }
[[nodiscard]] inline Value list(std::vector<Value> parts) {
  return with_parts(Value::Kind::list, "", std::move(parts));
}
[[nodiscard]] inline Value zeros(const std::string& record) {
  return with_parts(Value::Kind::zeros, record, {});
}
[[nodiscard]] inline Value joined(const std::string& sign, std::vector<Value> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return with_parts(Value::Kind::joined, sign, std::move(parts));
}
// What an unknown is rounded with, and its way in a step that it begins beside.
[[nodiscard]] inline Value length(const std::string& unknown, const Expression& beside) {
  return joined("+", {magnitude(Expression::symbol(unknown)), magnitude(beside)});
}
[[nodiscard]] inline Value way(const std::string& unknown, const Expression& beside) {
  return magnitude(Expression::symbol(unknown) - beside);
}
[[nodiscard]] inline Value prefix(const std::string& sign, Value of) {
  return with_parts(Value::Kind::prefix, sign, {std::move(of)});
}
[[nodiscard]] inline Value action(const std::string& type, Place of, const std::string& name,
                                  std::vector<Value> arguments = {}) {
  arguments.insert(arguments.begin(), object(std::move(of)));
  Value result = with_parts(Value::Kind::action, name, std::move(arguments));
  result.type = type;
  return result;
}

class StatementWriter {
 public:
  StatementWriter(const Routine& routine, const Form& form) : routine_(routine), form_(form) {}
  StatementWriter(const StatementWriter&) = delete;
  StatementWriter& operator=(const StatementWriter&) = delete;
  virtual ~StatementWriter() = default;

 protected:
  using Lines = std::function<void()>;

  virtual void write(const hamgen::Body& body) = 0;

  template <class Node>
  Statement& add(Node node) {
    return body_.emplace_back(Statement{std::move(node)});
  }
  // What the lines add, as a body of its own.
  [[nodiscard]] Body inside(const Lines& lines) {
    Body outer;
    std::swap(outer, body_);
    lines();
    std::swap(outer, body_);
    return outer;
  }
  [[nodiscard]] Body inside(const hamgen::Body& body) {
    return inside([&] { write(body); });
  }
  void set(Value to, Value value, const char* sign = "=") {
    add(Set{std::move(to), sign, std::move(value)});
  }
  void branch(Value condition, Shape shape, const Lines& lines) {
    Body body = inside(lines);
    add(If{std::move(condition), std::move(body), shape});
  }
  // Over all elements.
  void over(const std::vector<KernelRange>& ranges, const Lines& lines, Shape innermost,
            std::size_t depth = 0) {
    if (depth == ranges.size()) return lines();
    Body body = inside([&] { over(ranges, lines, innermost, depth + 1); });
    const bool last = depth + 1 == ranges.size();
    add(For{ranges[depth], std::move(body), last ? innermost : Shape::braces});
  }

  // --- of trajectories in lanes --------------------------------------------------------------

  // Those that have a part in what is done.
  [[nodiscard]] static Value lanes_in_turn() { return at({"start", "turn.lanes"}); }
  // Does the routine change the object or field in these alone?
  [[nodiscard]] bool is_in_turn(const Place& place) const {
    return std::ranges::any_of(routine_.in_turn, [&](const Place& each) {
      return each.object == place.object && (each.field.empty() || each.field == place.field);
    });
  }
  [[nodiscard]] bool is_in_turn(const std::string& symbol) const {
    const auto found = routine_.places.find(symbol);
    return found != routine_.places.end() && is_in_turn(found->second);
  }
  void set_number(Value to, Value value, bool in_turn) {
    if (in_turn) value = selected(lanes_in_turn(), std::move(value), to);
    set(std::move(to), std::move(value));
  }
  [[nodiscard]] static Value selected(Value lanes, Value value, Value other) {
    const bool number = value.kind == Value::Kind::index ||
                        (value.kind == Value::Kind::formula && value.formula.is_number());
    if (number) value = call("Real", {std::move(value)});
    return call("select", {std::move(lanes), std::move(value), std::move(other)});
  }
  void increase(const std::string& number, Value by) {
    const Value to = symbol(number);
    if (!is_in_turn(number)) return set(to, std::move(by), "+=");
    const bool sum = by.kind == Value::Kind::formula && by.formula.kind() == hamgen::Kind::sum;
    if (sum) by = in_parentheses(std::move(by));
    set_number(to, joined("+", {to, std::move(by)}), true);
  }
  // In these lanes, and in no others, what the lines say.
  void narrow(Value lanes, Shape shape, const Lines& lines) {
    add(Block{inside([&] {
      add(Define{"Mask", "part ", lanes_in_turn()});
      set(lanes_in_turn(), joined("&", {at({"part "}), std::move(lanes)}));
      branch(call("any", {lanes_in_turn()}), shape, lines);
      set(lanes_in_turn(), at({"part "}));
    })});
  }

  // The routine ends without success.
  void fail() {
    add(Return{routine_.result.type == "StepReport" ? object({"report"}) : word("false")});
  }

  const Routine& routine_;
  const Form& form_;
  Body body_;
  const std::vector<std::string>* remark_ = nullptr;  // of the instruction
};

}  // namespace hamgen::written
