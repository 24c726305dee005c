#pragma once

#include "generator/base/c_family.hpp"
#include "generator/formats/dialect.hpp"
#include "generator/formats/emit_options.hpp"

namespace hamgen {

// C11.  It has no namespaces: names begin with those of the system and the method,
// pendulum_energy, pendulum_stormer_verlet_step; what is fixed begins with hamgen_ and ends in f or
// l for float and long double numbers.  Of another language of its family it is this text, but for
// the names of functions.
class CDialect : public Dialect {
 public:
  CDialect(const CFamily& family, const ScalarType& scalar_type, const EmittedSpaces& spaces);

  [[nodiscard]] std::string language() const override { return std::string(family.language); }
  [[nodiscard]] std::string real() const override { return std::string(scalar.cpp); }
  [[nodiscard]] std::string number(const std::string& integer) const override {
    return "(" + real() + ")(" + integer + ")";
  }
  [[nodiscard]] std::string function(const std::string& name) const override;
  [[nodiscard]] std::string type(const std::string& name) const override;
  [[nodiscard]] std::string routine(const std::string& name) const override { return named(name); }
  [[nodiscard]] std::string block(const std::string& name) const override;
  [[nodiscard]] std::string constant(const std::string& name) const override { return block(name); }
  [[nodiscard]] std::string empty_record(const std::string& name) const override {
    return name == "Start" ? named("start") + "()" : "(" + type(name) + "){0}";
  }
  [[nodiscard]] bool has_references() const override { return false; }
  [[nodiscard]] std::string argument(const Argument& argument, const std::string& name,
                                     const std::string& sizes) const override;
  [[nodiscard]] std::string head(const Routine& routine,
                                 const std::vector<std::string>& arguments) const override;
  [[nodiscard]] std::string call(const std::string& type, const std::string& object,
                                 const std::string& action,
                                 const std::string& arguments) const override;
  [[nodiscard]] std::string kept(const std::string& name) const override { return "self->" + name; }
  [[nodiscard]] std::string call_of_run(const std::string& routine_name,
                                        const std::string& arguments) const override;

  // Of the system where all methods have it, else of the method.
  [[nodiscard]] std::string named(const std::string& name) const;
  [[nodiscard]] const std::string& system() const { return system_; }
  [[nodiscard]] const std::string& method() const { return method_; }

  const CFamily& family;

 private:
  std::string system_, method_;
};

}  // namespace hamgen
