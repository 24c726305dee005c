// Writes one routine as statements: instructions in written_code.cpp, those of a run in
// written_run.cpp, iterations in written_iterations.cpp.
#pragma once

#include <functional>
#include <initializer_list>
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
[[nodiscard]] inline Value joined(const std::string& sign, std::vector<Value> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return with_parts(Value::Kind::joined, sign, std::move(parts));
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

class RoutineWriter {
 public:
  RoutineWriter(const Routine& routine, const Form& form) : routine_(routine), form_(form) {}

  Body run();

  void operator()(const Let& let);
  void operator()(const Array& array);
  void operator()(const Matrix& matrix);
  void operator()(const Copy& copy);
  void operator()(const Assign& assign);
  void operator()(const Collect& sum);
  void operator()(const Accumulate& sum);
  void operator()(const Clear& clear);
  void operator()(const Put& put);
  void operator()(const SetFlag& set);
  void operator()(const hamgen::For& loop);
  void operator()(const Scope& scope);
  void operator()(const hamgen::If& branch);
  void operator()(const Call& call);
  void operator()(const Alternate& alternate);
  void operator()(const Factorise& factorise);
  void operator()(const SolveFactorised& solve);
  void operator()(const Invert& invert);
  void operator()(const Iterate& iterate);
  void operator()(const IterateArray& iterate);
  void operator()(const Refine& refine);
  void operator()(const RefineArray& refine);
  void operator()(const Sweep& sweep);
  void operator()(const Use& use);
  void operator()(const Declare& declare);
  void operator()(const Note& note);
  void operator()(const Count& count);
  void operator()(const Ask& ask);
  void operator()(const Forget& forget);
  void operator()(const Repeat& repeat);
  void operator()(const Break& leave);
  void operator()(const RequireFinite& finite);
  void operator()(const hamgen::Return& end);

 private:
  using Lines = std::function<void()>;

  template <class Node>
  Statement& add(Node node) {
    return body_.emplace_back(Statement{std::move(node)});
  }
  void write(const hamgen::Body& body);
  // What the lines add, as a body of its own.
  [[nodiscard]] Body inside(const Lines& lines);
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
            std::size_t depth = 0);
  // The routine ends without success.
  void fail();
  // All numbers that should be finite, squared and added.
  void length_of(const hamgen::Return& end);
  void report_success(const hamgen::Return& end, const Value& success);
  [[nodiscard]] static Value called(const Call& call);
  // A place becomes what it begins with.
  void begin(const Place& place, const std::string& type);

  void newton(const Iterate& iterate);
  void correct_lanes(const Iterate& iterate, const Place& rule);
  void fixed_point(const Iterate& iterate);
  void newton(const IterateArray& iterate);
  void contraction(const IterateArray& iterate);
  void distance_of(const IterateArray& iterate);
  void move(const IterateArray& iterate);
  void end_newton();
  void end_contraction(const Place& size);
  void count_iterations();
  void iterate_with(const Lines& lines);
  void refine_once(const Refine& refine, const std::string& kept);

  const Routine& routine_;
  const Form& form_;
  Body body_;
  std::set<std::string> kept_;  // locals that an iteration changes
  bool iterates_ = false;
  Place rule_;                                        // that it iterates by
  const std::vector<std::string>* remark_ = nullptr;  // of the instruction
};

}  // namespace hamgen::written
