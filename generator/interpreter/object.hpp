// Records at run time.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/interpreter/numerics.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// A record at run time: its numbers, field after field, and what else is in it.
template <class Real>
struct Object {
  std::vector<Real> numbers;
  std::map<std::string, int> flags;
  std::map<std::string, std::unique_ptr<AnyNewtonRule<Real>>> rules;
  std::map<std::string, std::unique_ptr<AnyFixedPointRule<Real>>> contractions;
  std::map<std::string, std::unique_ptr<AnySimplifiedNewtonRule<Real>>> simplified;
  std::map<std::string, std::unique_ptr<AnyRefinement<Real>>> refinements;
  std::map<std::string, std::unique_ptr<AnyMatrix<Real>>> matrices;
  std::unique_ptr<AnyHistory<Real>> history;
};
// What a run keeps from step to step, by the names of the Propagator's fields: of some one for each
// substep.
template <class Real>
struct RunMemory {
  std::map<std::string, std::vector<Object<Real>>> fields;
  std::size_t substep = 0;  // that is going on
};
// With the values its fields begin with.  A field "Matrix" has the size of the code's.
template <class Real>
[[nodiscard]] Object<Real> make_object(const Record& record, const Program& code);
// The fields that are numbers, a Refinement's slope and change among them.
[[nodiscard]] std::vector<Field> numeric_fields(const Record& record);
// Where the numbers of a field begin.
[[nodiscard]] long offset_of(const Record& record, const std::string& field);

// The product of the sizes: 1 of a number.
[[nodiscard]] long product(const std::vector<int>& sizes);

}  // namespace hamgen
