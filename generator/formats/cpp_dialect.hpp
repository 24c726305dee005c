#pragma once

#include "generator/formats/dialect.hpp"

namespace hamgen {

class CppDialect : public Dialect {
 public:
  // With builtins, functions are the compiler's own (__builtin_sin), which need no header: reading
  // <cmath> takes three times as long as compiling a small plugin.
  // library: elementary functions of lanes are those of <cmath>, one after the other.
  CppDialect(const ScalarType& scalar_type, int count, bool builtins, bool library = false)
      : Dialect(scalar_type, count), builtins_(builtins), library_(library) {}

  [[nodiscard]] std::string language() const override { return "C++17"; }
  [[nodiscard]] std::string real() const override { return "Real"; }
  [[nodiscard]] std::string number(const std::string& integer) const override {
    return "Real(" + integer + ")";
  }
  [[nodiscard]] std::string function(const std::string& name) const override;
  // The functions of lanes.
  [[nodiscard]] std::vector<std::string> taken_names() const override;
  [[nodiscard]] std::string lane_function(const std::string& name) const override;
  // Is the function on lanes a block of ours?  If not, lanes have the library's.
  [[nodiscard]] static bool has_own_lanes(const std::string& name);
  [[nodiscard]] std::string empty_record(const std::string& name) const override {
    return name + "()";
  }
  [[nodiscard]] bool has_references() const override { return true; }
  [[nodiscard]] std::string argument(const Argument& argument, const std::string& name,
                                     const std::string& sizes) const override;
  [[nodiscard]] std::string head(const Routine& routine,
                                 const std::vector<std::string>& arguments) const override;
  [[nodiscard]] std::string call(const std::string& type, const std::string& object,
                                 const std::string& action,
                                 const std::string& arguments) const override;
  [[nodiscard]] std::string kept(const std::string& name) const override;
  [[nodiscard]] std::string call_of_run(const std::string& routine_name,
                                        const std::string& arguments) const override {
    return routine_name + "(" + arguments + ")";
  }

 private:
  bool builtins_, library_;
};

}  // namespace hamgen
