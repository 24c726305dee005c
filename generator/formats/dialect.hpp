// How a language spells what all of them have: routines, records and expressions are printed
// through it.  A new language is a Dialect, what stands around the routines, and the fixed blocks
// it needs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/formats/literal.hpp"
#include "generator/program/code.hpp"

namespace hamgen {

class Dialect {
 public:
  // n: the degrees of freedom, where the text has a constant of that name; else 0.
  Dialect(const ScalarType& scalar_type, int count) : scalar(scalar_type), n(count) {}
  Dialect(const Dialect&) = delete;
  Dialect& operator=(const Dialect&) = delete;
  virtual ~Dialect() = default;

  const ScalarType& scalar;
  const int n;

  [[nodiscard]] virtual std::string language() const = 0;  // "C++17"
  // The type of a number, and an integer as one.
  [[nodiscard]] virtual std::string real() const = 0;
  [[nodiscard]] virtual std::string number(const std::string& integer) const = 0;
  // A function of the mathematical library: "sin" is std::sin.
  [[nodiscard]] virtual std::string function(const std::string& name) const = 0;
  // That of lanes, which are numbers side by side.
  [[nodiscard]] virtual std::string lane_function(const std::string& name) const {
    return function(name);
  }
  // Is a number a pack of as many as there are trajectories?
  [[nodiscard]] virtual bool has_lanes() const { return false; }
  // Names that its routines use besides and a local must not have.
  [[nodiscard]] virtual std::vector<std::string> taken_names() const { return {}; }
  // What the program calls a type or a routine, what a block calls a function, and what the text
  // defines: pi, Verdict::done.
  [[nodiscard]] virtual std::string type(const std::string& name) const { return name; }
  [[nodiscard]] virtual std::string routine(const std::string& name) const { return name; }
  [[nodiscard]] virtual std::string block(const std::string& name) const { return name; }
  [[nodiscard]] virtual std::string constant(const std::string& name) const { return name; }
  // A record of zeros.
  [[nodiscard]] virtual std::string empty_record(const std::string& name) const = 0;
  // Are records given by reference?  Else by their address.
  [[nodiscard]] virtual bool has_references() const = 0;
  // An argument; `name` is empty if nothing reads it.
  [[nodiscard]] virtual std::string argument(const Argument& argument, const std::string& name,
                                             const std::string& sizes) const = 0;
  // The first line of a routine with these arguments.
  [[nodiscard]] virtual std::string head(const Routine& routine,
                                         const std::vector<std::string>& arguments) const = 0;
  // What a block, of which `object` is one, does: rule.begin().  Without `action` what it is for.
  [[nodiscard]] virtual std::string call(const std::string& type, const std::string& object,
                                         const std::string& action,
                                         const std::string& arguments) const = 0;
  // What a run keeps: "start[i]" is start_[i].
  [[nodiscard]] virtual std::string kept(const std::string& name) const = 0;
  // A number of a record that is kept, or what is kept itself.
  [[nodiscard]] std::string kept_place(const Place& place) const;
  // A call of a routine that is given that.
  [[nodiscard]] virtual std::string call_of_run(const std::string& routine_name,
                                                const std::string& arguments) const = 0;
};

[[nodiscard]] std::string joined_texts(const std::vector<std::string>& items,
                                       const char* separator);

}  // namespace hamgen
