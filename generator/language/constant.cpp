#include "generator/language/constant.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "generator/algebra/functions.hpp"

namespace hamgen {
namespace {

constexpr long most_constant_terms = 1'000'000;
constexpr long largest_integer = 999'999'999'999'999;

// About as many decimal digits have numerator and denominator together.
std::size_t digits(const Rational& value) {
  return mpz_sizeinbase(value.get_num_mpz_t(), 10) + mpz_sizeinbase(value.get_den_mpz_t(), 10);
}

Constant in_range(Rational value) {
  if (digits(value) > most_digits) return too_long();
  const double rounded = to_double(value);
  const bool lost = rounded == 0.0 && sgn(value) != 0;
  if (std::isfinite(rounded) && !lost) return value;
  return Undefined{"this constant is outside the range of a double",
                   "numbers lie between 4.9e-324 and 1.7e308; choose other units"};
}

Constant power(const Rational& base, const Rational& exponent) {
  if (const auto mistake = check_exponent(exponent)) return *mistake;
  if (sgn(base) == 0 && sgn(exponent) == 0) {
    return Undefined{"0^0 is undefined", "write 1 if that is meant"};
  }
  if (sgn(base) == 0 && sgn(exponent) < 0) {
    return Undefined{"division by zero", "0 has no negative power"};
  }
  if (static_cast<double>(digits(base)) * std::fabs(to_double(exponent)) > 10.0 * most_digits)
    return too_long();
  if (const auto value = evaluate_power(base, exponent)) return in_range(*value);
  if (sgn(base) < 0) {
    return Undefined{
        fmt::format("({})^({}) is not a real number", short_text(base), short_text(exponent)),
        "a negative number has integer powers only"};
  }
  return Undefined{"this constant is outside the range of a double",
                   "numbers lie between 4.9e-324 and 1.7e308; choose other units"};
}

class Evaluator {
 public:
  explicit Evaluator(const Lookup& lookup) : lookup_(lookup) {}

  Rational value(const NodePtr& node) {
    return std::visit([&](const auto& each) { return of(*node, each); }, node->value);
  }

  long integer(const NodePtr& node) {
    const Rational result = value(node);
    if (result.get_den() != 1 || abs(result) > largest_integer) {
      throw ConstantError{{Severity::error, node->span,
                           fmt::format("{} is not an integer", short_text(result)),
                           "an integer of at most 15 digits is needed here"}};
    }
    return result.get_num().get_si();
  }

 private:
  static Rational take(const Node& node, const Constant& constant) {
    if (const auto* mistake = std::get_if<Undefined>(&constant)) {
      throw ConstantError{{Severity::error, node.span, mistake->message, mistake->help}};
    }
    return std::get<Rational>(constant);
  }

  static Rational of(const Node&, const NumberNode& number) { return number.value; }
  Rational of(const Node& node, const NameNode& name) {
    if (!name.subscript) {
      if (name.name == "pi") return pi();
      if (const auto index = indices_.find(name.name); index != indices_.end()) {
        return Rational(index->second);
      }
      return lookup_(node, name, std::nullopt);
    }
    return lookup_(node, name, integer(name.subscript));
  }
  Rational of(const Node&, const NegateNode& negate) { return -value(negate.operand); }
  Rational of(const Node& node, const BinaryNode& binary) {
    const Rational left = value(binary.left);
    return take(node, combine(binary.operation, left, value(binary.right)));
  }
  Rational of(const Node& node, const CallNode& call) {
    std::vector<Rational> arguments;
    for (const NodePtr& argument : call.arguments) arguments.push_back(value(argument));
    return take(node, call_function(call.function, arguments));
  }
  Rational of(const Node& node, const SumNode& sum) {
    Rational total = 0;
    add(node, sum, 0, total);
    return take(node, in_range(total));
  }

  void add(const Node& node, const SumNode& sum, std::size_t depth, Rational& total) {
    if (depth == sum.ranges.size()) {
      if (++terms_ > most_constant_terms) {
        throw ConstantError{
            {Severity::error, node.span,
             fmt::format("a constant sum of more than {} terms", most_constant_terms),
             "give its value"}};
      }
      total += value(sum.body);
      if (digits(total) > most_digits) take(node, too_long());
      return;
    }
    const SumRange& range = sum.ranges[depth];
    const long first = integer(range.lower);
    const long last = integer(range.upper);
    for (long i = first; i <= last; ++i) {
      indices_[range.index] = i;
      add(node, sum, depth + 1, total);
    }
    indices_.erase(range.index);
  }

  const Lookup& lookup_;
  std::map<std::string, long> indices_;
  long terms_ = 0;
};

}  // namespace

Undefined too_long() {
  return {fmt::format("this constant has more than {} digits", most_digits),
          "it is exact: round what it is made of, 0.33333333333333333 for 1/3"};
}

std::optional<Undefined> check_exponent(const Rational& exponent) {
  if (abs(exponent) <= largest_exponent) return std::nullopt;
  return Undefined{fmt::format("the exponent {} is too large", short_text(exponent)),
                   fmt::format("exponents lie between -{0} and {0}", largest_exponent)};
}

Constant combine(BinaryOperator operation, const Rational& left, const Rational& right) {
  switch (operation) {
    case BinaryOperator::add:
      return in_range(left + right);
    case BinaryOperator::subtract:
      return in_range(left - right);
    case BinaryOperator::multiply:
      return in_range(left * right);
    case BinaryOperator::divide:
      if (sgn(right) == 0) return Undefined{"division by zero", "the divisor is 0"};
      return in_range(left / right);
    case BinaryOperator::power:
      return power(left, right);
  }
  internal_error("unknown operator");
}

Constant call_function(std::string_view function, std::span<const Rational> arguments) {
  const Function* row = find_function(function);
  if (row == nullptr) internal_error("unknown function in a checked expression");
  if (const auto value = evaluate_function(function, arguments)) return in_range(*value);
  std::string list;
  for (const Rational& argument : arguments) {
    list += (list.empty() ? "" : ", ") + short_text(argument);
  }
  if (row->domain == "all x") {
    return Undefined{fmt::format("{}({}) is outside the range of a double", function, list),
                     "numbers lie between 4.9e-324 and 1.7e308; choose other units"};
  }
  return Undefined{fmt::format("{}({}) is not a real number", function, list),
                   fmt::format("{} is defined for {}", function, row->domain)};
}

const Rational& pi() {
  static const Rational value = evaluate_function("pi", {}).value();
  return value;
}

std::string short_text(const Rational& value) {
  if (value.get_den() != 1 && value.get_den() <= 1000 && abs(value.get_num()) <= 1000 &&
      parse_decimal(shortest_decimal(std::abs(to_double(value)))) != Rational(abs(value))) {
    return to_text(value);
  }
  std::string text = shortest_decimal(to_double(value));
  if (text == "inf" || text == "-inf" || to_double(value) == 0.0) {
    // Too large or too small for a double: its digits are no help to anybody.
    if (sgn(value) == 0) return "0";
    return abs(value) > 1 ? "of more than 308 digits" : "smaller than 1e-324";
  }
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

Rational evaluate(const NodePtr& node, const Lookup& lookup) {
  return Evaluator(lookup).value(node);
}

long evaluate_integer(const NodePtr& node, const Lookup& lookup) {
  return Evaluator(lookup).integer(node);
}

}  // namespace hamgen
