#include "generator/mechanics/operation_count.hpp"

#include <map>

namespace hamgen {

namespace {

constexpr long kRoot = 10;

// x^n by repeated squaring; a reciprocal is one division more, a root a function.
long power_cost(const Rational& exponent) {
  Integer n = abs(exponent.get_num());
  long cost = exponent < 0 ? 1 : 0;
  if (exponent.get_den() != 1) {
    cost += kRoot;
    n /= exponent.get_den();
  }
  while (n > 1) {
    cost += mpz_odd_p(n.get_mpz_t()) != 0 ? 2 : 1;
    n /= 2;
  }
  return cost;
}

}  // namespace

long operation_count(std::span<const Expression> values, const std::set<std::string>& varying,
                     long function) {
  std::map<const void*, bool> seen;  // does the node vary?
  long total = 0;
  auto visit = [&](auto&& self, const Expression& node) -> bool {
    if (node.is_number()) return false;
    if (node.kind() == Kind::symbol) return varying.contains(node.name());
    if (const auto it = seen.find(node.identity()); it != seen.end()) return it->second;
    long parts = 0;
    bool constant = false;
    for (const Expression& operand : node.operands()) {
      if (self(self, operand)) {
        ++parts;
      } else {
        // The constant operands are one coefficient; a sign is free.
        constant = constant || operand != Expression(-1);
      }
    }
    seen[node.identity()] = parts > 0;
    if (parts == 0) return false;
    switch (node.kind()) {
      case Kind::sum:
      case Kind::product:
        total += parts - 1 + (constant ? 1 : 0);
        break;
      case Kind::power:
        total +=
            node.operands()[1].is_number() ? power_cost(node.operands()[1].number()) : 2 * function;
        break;
      case Kind::function:
        total += function;
        break;
      case Kind::number:
      case Kind::symbol:
        break;
    }
    return true;
  };
  for (const Expression& value : values) visit(visit, value);
  return total;
}

}  // namespace hamgen
