#include "generator/specialise/new_names.hpp"

#include <algorithm>

namespace hamgen {

NewNames::NewNames(const Mechanics& mechanics) {
  for (const QuantityList::Run& run : mechanics.variables.runs()) taken_.insert(run.of.name);
  for (const auto* list : {&mechanics.parameters, &mechanics.constants}) {
    for (const Quantity& each : *list) taken_.insert(each.name.substr(0, each.name.find('[')));
  }
  for (const NamedExpression& each : mechanics.invariants) taken_.insert(each.name);
}

std::string NewNames::made_of(const std::string& name, const std::string& ending) {
  std::string result = name;
  std::erase(result, ']');
  std::ranges::replace(result, '[', '_');
  result += "_" + ending;
  while (!taken_.insert(result).second) result += "_";
  return result;
}

}  // namespace hamgen
