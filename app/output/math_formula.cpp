#include "app/output/math_formula.hpp"

#include "app/output/plain_number.hpp"

namespace hamgen::app {
namespace {

MathFormula added(const MathFormula& left, MathFormula right) {
  MathFormula sum = left.kind == MathKind::sum
                        ? left
                        : MathFormula{.kind = MathKind::sum, .text = "", .parts = {left}};
  sum.parts.push_back(std::move(right));
  return sum;
}

}  // namespace

bool is_negation(const MathFormula& formula) { return formula.kind == MathKind::negation; }

std::span<const MathFormula> factors_of(const MathFormula& formula) {
  return formula.kind == MathKind::product ? std::span(formula.parts) : std::span(&formula, 1);
}

MathFormula product_of_all(std::vector<MathFormula> factors) {
  if (factors.empty()) return math_number("1");
  if (factors.size() == 1) return factors.front();
  return {.kind = MathKind::product, .text = "", .parts = std::move(factors)};
}

MathFormula math_number(const std::string& text) {
  if (text.starts_with('-')) return negated(math_number(text.substr(1)));
  return {.kind = MathKind::number, .text = text, .parts = {}};
}

MathFormula math_value(double value, int digits) {
  const DecimalParts parts = decimal_parts(value, digits);
  const MathFormula mantissa = math_number(parts.mantissa);
  if (!parts.exponent) return mantissa;
  const MathFormula power =
      power_of(math_number("10"), math_number(std::to_string(*parts.exponent)));
  return parts.mantissa == "1" ? power : product_of(mantissa, power);
}

MathFormula math_symbol(std::string_view name) {
  return {.kind = MathKind::symbol, .text = std::string(name), .parts = {}};
}

MathFormula with_subscript(std::string_view name, const MathFormula& subscript) {
  return {.kind = MathKind::symbol, .text = std::string(name), .parts = {subscript}};
}

MathFormula negated(const MathFormula& operand) {
  if (is_negation(operand)) return operand.parts[0];
  return {.kind = MathKind::negation, .text = "", .parts = {operand}};
}

MathFormula sum_of(const MathFormula& left, const MathFormula& right) { return added(left, right); }

MathFormula difference_of(const MathFormula& left, const MathFormula& right) {
  return added(left, negated(right));
}

MathFormula product_of(const MathFormula& left, const MathFormula& right) {
  if (is_negation(left)) return negated(product_of(left.parts[0], right));
  std::vector<MathFormula> factors(factors_of(left).begin(), factors_of(left).end());
  factors.push_back(right);
  return product_of_all(std::move(factors));
}

MathFormula quotient_of(const MathFormula& above, const MathFormula& below) {
  if (is_negation(above)) return negated(quotient_of(above.parts[0], below));
  if (above.kind == MathKind::quotient)
    return quotient_of(above.parts[0], product_of(above.parts[1], below));
  return {.kind = MathKind::quotient, .text = "", .parts = {above, below}};
}

MathFormula power_of(const MathFormula& base, const MathFormula& exponent) {
  return {.kind = MathKind::power, .text = "", .parts = {base, exponent}};
}

MathFormula call_of(const std::string& function, const std::vector<MathFormula>& arguments) {
  return {.kind = MathKind::call, .text = function, .parts = arguments};
}

MathFormula math_mark(const std::string& text) {
  return {.kind = MathKind::mark, .text = text, .parts = {}};
}

MathFormula applied(const MathFormula& function, const std::vector<MathFormula>& arguments) {
  MathFormula result{.kind = MathKind::application, .text = "", .parts = {function}};
  result.parts.insert(result.parts.end(), arguments.begin(), arguments.end());
  return result;
}

MathFormula in_brackets(const std::string& both, const std::vector<MathFormula>& list) {
  return {.kind = MathKind::brackets, .text = both, .parts = list};
}

MathFormula related(const std::string& signs, const std::vector<MathFormula>& parts) {
  if (signs.empty()) return parts.front();
  return {.kind = MathKind::relation, .text = signs, .parts = parts};
}

MathFormula sum_over(const std::string& index, const MathFormula& lower, const MathFormula& upper,
                     const MathFormula& body) {
  return {.kind = MathKind::big_sum, .text = index, .parts = {lower, upper, body}};
}

}  // namespace hamgen::app
