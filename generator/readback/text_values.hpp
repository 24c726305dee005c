// Values that the text of a routine has beside its formulas.
#pragma once

#include "generator/readback/text_scope.hpp"

namespace hamgen {

[[nodiscard]] inline MachineValue truth(bool value) {
  return machine_symbol(value ? "::true" : "::false");
}
[[nodiscard]] inline MachineValue negated(MachineValue a) {
  return machine_call("prefix!", {std::move(a)});
}
[[nodiscard]] inline MachineValue at(const Place& place) {
  return machine_symbol(symbol_of(place));
}
[[nodiscard]] inline MachineValue integer_symbol(long value) {
  return machine_symbol("#" + std::to_string(value));
}
// What an object does, as a call of its member.
[[nodiscard]] inline MachineValue action(const Place& object, const std::string& name,
                                         std::vector<MachineValue> arguments = {}) {
  Place member = object;
  member.field += (member.field.empty() ? "" : ".") + name;
  return machine_call(symbol_of(member), std::move(arguments));
}

}  // namespace hamgen
