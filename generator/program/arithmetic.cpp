#include "generator/program/arithmetic.hpp"

#include <algorithm>
#include <span>

namespace hamgen {

namespace {

Arithmetic number(const Rational& value) {
  Arithmetic result{.number = abs(value)};
  if (value < 0) return {.operation = Operation::negate, .operands = {std::move(result)}};
  return result;
}

Arithmetic combine(Operation operation, Arithmetic a, Arithmetic b) {
  Arithmetic result{.operation = operation};
  result.operands.reserve(2);
  result.operands.push_back(std::move(a));
  result.operands.push_back(std::move(b));
  return result;
}

// From the left.
Arithmetic product_of(std::vector<Arithmetic> factors) {
  Arithmetic result = std::move(factors.front());
  for (std::size_t i = 1; i < factors.size(); ++i) {
    result = combine(Operation::multiply, std::move(result), std::move(factors[i]));
  }
  return result;
}

Arithmetic call(std::string name, std::span<const Expression> arguments) {
  Arithmetic result{.operation = Operation::call, .name = std::move(name)};
  for (const Expression& argument : arguments) result.operands.push_back(arrange(argument));
  return result;
}

bool is_reciprocal(const Expression& e) {
  return e.kind() == Kind::power && e.operands()[1] == Expression(-1);
}

Arithmetic power(const Expression& e) {
  const Expression& base = e.operands()[0];
  if (is_reciprocal(e)) return combine(Operation::divide, number(1), arrange(base));
  if (e.operands()[1].is_number()) {
    const Rational& exponent = e.operands()[1].number();
    if (exponent == Rational(1, 2)) return call("sqrt", {&base, 1});
    if (exponent > 0 && exponent <= 8 && exponent.get_den() == 1) {
      const auto factors = static_cast<std::size_t>(exponent.get_num().get_si());
      return product_of(std::vector<Arithmetic>(factors, arrange(base)));
    }
  }
  return call("pow", e.operands());
}

Arithmetic product(const Expression& e) {
  const auto [coefficient, rest] = e.split_coefficient();
  std::vector<Arithmetic> factors;
  std::vector<Arithmetic> divisors;
  if (abs(coefficient) != 1) factors.push_back(number(abs(coefficient)));
  const auto operands = rest.kind() == Kind::product ? rest.operands() : std::span(&rest, 1);
  for (const Expression& operand : operands) {
    if (is_reciprocal(operand)) {
      divisors.push_back(arrange(operand.operands()[0]));
    } else {
      factors.push_back(arrange(operand));
    }
  }
  if (factors.empty()) factors.push_back(number(1));
  // The sign belongs to the first factor: rounding does not know it.
  if (coefficient < 0) {
    factors.front() = {.operation = Operation::negate, .operands = {std::move(factors.front())}};
  }
  Arithmetic result = product_of(std::move(factors));
  if (divisors.empty()) return result;
  return combine(Operation::divide, std::move(result), product_of(std::move(divisors)));
}

// Is its first factor, or the term itself, negated?
bool begins_with_sign(const Arithmetic& term) {
  const Arithmetic* first = &term;
  while (first->operation == Operation::multiply || first->operation == Operation::divide) {
    first = &first->operands.front();
  }
  return first->operation == Operation::negate;
}

Arithmetic without_sign(Arithmetic term) {
  Arithmetic* first = &term;
  while (first->operation == Operation::multiply || first->operation == Operation::divide) {
    first = &first->operands.front();
  }
  Arithmetic inner = std::move(first->operands.front());
  *first = std::move(inner);
  return term;
}

Arithmetic sum(std::span<const Expression> operands) {
  std::vector<Arithmetic> terms;
  for (const Expression& operand : operands) terms.push_back(arrange(operand));
  const auto positive =
      std::ranges::find_if(terms, [](const Arithmetic& term) { return !begins_with_sign(term); });
  if (positive != terms.end()) std::rotate(terms.begin(), positive, positive + 1);
  Arithmetic result = std::move(terms.front());
  for (std::size_t i = 1; i < terms.size(); ++i) {
    result =
        begins_with_sign(terms[i])
            ? combine(Operation::subtract, std::move(result), without_sign(std::move(terms[i])))
            : combine(Operation::add, std::move(result), std::move(terms[i]));
  }
  return result;
}

}  // namespace

bool multiplies_exactly(const Expression& factor) {
  return factor.is_number() && abs(factor.number().get_num()) == 1 &&
         factor.number().get_den() <= 2;
}

Arithmetic arrange(const Expression& e) {
  switch (e.kind()) {
    case Kind::number:
      return number(e.number());
    case Kind::symbol:
      return {.operation = Operation::symbol, .name = e.name()};
    case Kind::function:
      return call(e.name(), e.operands());
    case Kind::power:
      return power(e);
    case Kind::product:
      return product(e);
    case Kind::sum:
      return sum(e.operands());
  }
  return {};
}

}  // namespace hamgen
