// The records of an emitted step and where in them its quantities stand.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/code.hpp"

namespace hamgen {

// A record whose components are the quantities, in their order: elements of one declared array are
// one field.
struct Layout {
  Record record;
  bool in_loops = false;  // its components are met in loops only
  [[nodiscard]] Place in(const std::string& object, std::size_t component) const;
};

// "q", "q[2]": how they stand in their record, unless they are met in loops only.
[[nodiscard]] std::vector<std::string> place_texts(const Layout& layout);

// Whether the values of the quantities are what the fields begin with.
enum class Defaults { none, values };
[[nodiscard]] Layout layout(const std::string& name, const std::vector<Quantity>& quantities,
                            Defaults defaults);

// q and p as two arrays, whatever the model calls their parts.
[[nodiscard]] Layout array_state(const QuantityList& variables);

}  // namespace hamgen
