// A named value: an instruction of straight-line code.
#pragma once

#include <string>

#include "generator/algebra/expression.hpp"

namespace hamgen {

struct Statement {
  std::string name;
  Expression value;
};

}  // namespace hamgen
