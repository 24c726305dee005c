// The records that routines work on, and the places in them.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/exact.hpp"
#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// A member of a record: a number, an array of numbers, a flag, or a block of numerics/.
struct Field {
  std::string name;
  std::vector<int> sizes = {};  // of an array
  std::string remark = {};
  std::vector<Rational> values = {};  // to begin with; empty: zeros
  std::string type = "Real";          // or "bool", "Matrix", "NewtonRule<2>"
  bool operator==(const Field&) const = default;
};

struct Record {
  std::string name;  // "State"
  std::vector<Field> fields;
  std::vector<std::string> remark = {};
  bool extends = false;  // has it what the system's record of this name has, too?
  bool operator==(const Record&) const = default;
};

// An object of a routine, a field of it, or an element: z.q[i - 1], matrix[0][1].  Without object
// the index itself is the number.  What a run keeps from step to step are numbers of the object
// "self", and records "self.start", "self.start[i]" of substep i; "new State" is one as it begins.
struct Place {
  std::string object;
  std::string field = {};
  std::vector<AffineIndex> indices = {};
  bool operator==(const Place&) const = default;
};

// "z.q[i - 1]"
[[nodiscard]] std::string to_text(const Place& place);
[[nodiscard]] std::string to_text(const Record& record);

}  // namespace hamgen
