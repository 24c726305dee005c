// Names and their values, in the order in which they are computed, found by value.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/program/statement.hpp"

namespace hamgen {

class DefinedValues {
 public:
  [[nodiscard]] const std::vector<Statement>& all() const { return all_; }
  [[nodiscard]] std::size_t size() const { return all_.size(); }
  void add(const std::string& name, const Expression& value);
  // Where a name stands.
  [[nodiscard]] std::optional<std::size_t> place(const std::string& name) const;
  void change(std::size_t place, const Expression& value);
  // The last place with this value; or of numbers that have the same values, or these with the
  // other sign, by other names: what is rounded of them is the same.
  [[nodiscard]] std::optional<std::size_t> computed_as(const Expression& exact);

 private:
  using Places = ExpressionMap<std::set<std::size_t>>;

  void compare();
  void forget_from(std::size_t place);

  std::vector<Statement> all_;
  std::map<std::string, std::size_t> places_;
  Places by_value_;
  // Of those that have been compared: their values by the first names of equal numbers.
  std::vector<Expression> compared_;
  Places by_compared_;
  Substitution first_name_;
};

}  // namespace hamgen
