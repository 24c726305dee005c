// Problems whose solution at some time is known, for tests of `hamgen bench`'s reference.
#pragma once

#include <string>
#include <vector>

namespace hamgen::app_test {

// A value of the state at the end: q1..qn, p1..pn from place 0.
struct Expected {
  std::size_t place = 0;
  const char* value = "";
  long double tolerance = 0;  // 0: two units of the last digit
};

struct Problem {
  const char* name = "";
  const char* model = "";                 // of hamiltonians/, or the text of a model
  std::vector<std::string> options = {};  // scene, --set, --initial
  const char* time = "";
  std::vector<Expected> expected = {};
};

// The reference that `hamgen bench` prints for it has these values, and a small error of its own.
void expect_reference(const Problem& problem);
void expect_references(const std::vector<Problem>& problems);

}  // namespace hamgen::app_test
