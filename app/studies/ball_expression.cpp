#include "app/studies/ball_expression.hpp"

#include <vector>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {

Ball evaluate_in_balls(const Expression& e, const std::map<std::string, Ball>& values, long bits) {
  const auto operand = [&](std::size_t i) {
    return evaluate_in_balls(e.operands()[i], values, bits);
  };
  switch (e.kind()) {
    case Kind::number:
      return {e.number(), bits};
    case Kind::symbol: {
      if (const auto it = values.find(e.name()); it != values.end()) return it->second;
      return e.name() == "pi" ? Ball::pi(bits) : Ball(1) / Ball(0);
    }
    case Kind::sum:
    case Kind::product: {
      Ball result = operand(0);
      for (std::size_t i = 1; i < e.operands().size(); ++i)
        result = e.kind() == Kind::sum ? result + operand(i) : result * operand(i);
      return result;
    }
    case Kind::power: {
      const Ball exponent = operand(1);
      long n = 0;
      return exponent.is_integer(n) ? operand(0).power(n) : operand(0).power(exponent);
    }
    case Kind::function: {
      std::vector<Ball> arguments;
      for (std::size_t i = 0; i < e.operands().size(); ++i) arguments.push_back(operand(i));
      return Ball::function(e.name(), arguments);
    }
  }
  internal_error("no such kind of expression");
}

}  // namespace hamgen::app
