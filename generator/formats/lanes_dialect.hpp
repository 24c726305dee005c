// C++ in which a number is a pack: one number of each of W trajectories.
#pragma once

#include "generator/formats/cpp_dialect.hpp"

namespace hamgen {

class LanesDialect : public CppDialect {
 public:
  LanesDialect(const ScalarType& scalar_type, int count, bool library)
      : CppDialect(scalar_type, count, false, library) {}

  [[nodiscard]] bool has_lanes() const override { return true; }
  [[nodiscard]] std::string function(const std::string& name) const override {
    return lane_function(name);
  }
  [[nodiscard]] std::vector<std::string> taken_names() const override {
    std::vector<std::string> names = CppDialect::taken_names();
    names.insert(names.end(), {"Mask", "any", "select", "moving", "part", "tried", "found",
                               "end_iteration", "require_finite", "collect_lanes"});
    return names;
  }
  // A pack is handed on by reference: as a value it is handed on otherwise by the instructions of
  // every machine.
  [[nodiscard]] std::string argument(const Argument& argument, const std::string& name,
                                     const std::string& sizes) const override {
    const bool number = argument.sizes.empty() && argument.record.empty() && argument.count.empty();
    if (!number) return CppDialect::argument(argument, name, sizes);
    return name.empty() ? "const Real&" : "const Real& " + name;
  }
};

}  // namespace hamgen
