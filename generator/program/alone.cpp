#include "generator/program/alone.hpp"

#include <algorithm>

#include "generator/program/propagator.hpp"

namespace hamgen {

namespace {

// Is one of them the other, or a part of it?
bool overlap(const Place& a, const Place& b) {
  const std::string first = to_text(a);
  const std::string second = to_text(b);
  const auto holds = [](const std::string& whole, const std::string& part) {
    if (!part.starts_with(whole)) return false;
    const char next = part.size() > whole.size() ? part[whole.size()] : '.';
    return next == '.' || next == '[';
  };
  return holds(first, second) || holds(second, first);
}

class Calls {
 public:
  explicit Calls(Program& code) : code_(code) {}

  void look_at(const Body& body) {
    for (const Instruction& instruction : body) {
      if (const auto* call = std::get_if<Call>(&instruction.value)) look_at(*call);
      if (const auto* two = std::get_if<Alternate>(&instruction.value)) {
        look_at(two->first);
        look_at(two->second);
      }
      for (const Body* inner : inner_bodies(instruction)) look_at(*inner);
    }
  }

 private:
  void look_at(const Call& call) {
    const auto called = std::ranges::find(code_.routines, call.routine, &Routine::name);
    if (called == code_.routines.end()) return;
    const std::vector<Place>& given = call.arguments;
    for (std::size_t i = 0; i < given.size(); ++i) {
      for (std::size_t j = 0; j < given.size(); ++j) {
        if (i != j && overlap(given[i], given[j])) called->arguments[i].alone = false;
      }
    }
  }

  Program& code_;
};

}  // namespace

void find_alone(Program& code) {
  for (Routine& routine : code.routines) {
    for (Argument& argument : routine.arguments) {
      argument.alone = argument.changes && !argument.record.empty();
    }
  }
  Calls calls(code);
  for (const Routine& routine : code.routines) calls.look_at(routine.body);
  for (const Routine& routine : propagator_of(code).routines) calls.look_at(routine.body);
}

}  // namespace hamgen
