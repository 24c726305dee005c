// A symbol of a routine is either a local or a place.
#include <gtest/gtest.h>

#include <stdexcept>

#include "generator/program/names.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {
namespace {

// A coordinate y_i as a local, beside an array y.
Routine with_a_local(const std::string& name) {
  RoutineBuilder b({.name = "routine"});
  Body each;
  each.push_back({Let{name, Expression(1)}});
  const Expression element = b.at("y", "", {affine("i")});
  each.push_back({Assign{element.name(), Expression(2)}});
  b.body().push_back(for_each(counting("i", 3), std::move(each)));
  return b.take();
}

TEST(Symbols, OfALocalAndOfAPlaceAreNotOne) {
  EXPECT_NO_THROW(require_distinct_symbols(with_a_local("x[i]")));
  EXPECT_THROW(require_distinct_symbols(with_a_local("y[i]")), std::logic_error);
}

TEST(Symbols, OfAPlaceApartIsNoNameOfTheModel) {
  Routine routine = with_a_local("y[i + 1]");
  EXPECT_EQ(at_apart(routine, {"y", "", {affine("i", 1)}}).name(), "at y[i + 1]");
  EXPECT_NO_THROW(require_distinct_symbols(routine));
}

}  // namespace
}  // namespace hamgen
