// What is known of the scene that an integrator is made for.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "generator/algebra/exact.hpp"
#include "generator/language/scene.hpp"

namespace hamgen {

struct SceneFacts {
  SceneRequest asked;
  SceneValues values;          // what it means
  std::set<std::string> kept;  // variables and parameters that may get other values
  bool sees_all = false;       // degrees of freedom that nothing observed depends on are wanted
  std::map<std::string, Rational> parameters = {};  // those of `values`, by name
};

// Values such as sin(pi/9) are known to 50 digits, of which no scalar has more than 34.
[[nodiscard]] inline bool is_same_number(const Rational& a, const Rational& b) {
  static const Rational tolerance = *integer_power(Rational(10), -40);
  return a == b || abs(Rational(a - b)) <= tolerance * std::max(Rational(abs(a)), Rational(abs(b)));
}

}  // namespace hamgen
