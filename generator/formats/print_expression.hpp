// Expressions in the words of a dialect.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "generator/formats/dialect.hpp"
#include "generator/program/arithmetic.hpp"

namespace hamgen {

class ExpressionPrinter {
 public:
  using Namer = std::function<std::string(const std::string&)>;

  ExpressionPrinter(const Dialect& dialect, Namer namer)
      : dialect_(dialect), namer_(std::move(namer)) {}

  // The expression with the fewest parentheses; notes the functions it calls.
  [[nodiscard]] std::string operator()(const Expression& e) const;
  // From now on: are numbers side by side meant?
  void set_lanes(bool lanes) { lanes_ = lanes; }
  // Functions of the mathematical library used so far: they decide the includes.
  [[nodiscard]] const std::set<std::string>& functions() const { return functions_; }

 private:
  [[nodiscard]] std::string print(const Arithmetic& a, int context) const;
  [[nodiscard]] std::string call(const std::string& function, const std::string& arguments) const;

  const Dialect& dialect_;
  Namer namer_;
  bool lanes_ = false;
  mutable std::set<std::string> functions_;
};

}  // namespace hamgen
