#include "app/output/math_markup.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <utility>

#include "generator/base/diagnostic.hpp"
#include "generator/language/model.hpp"

namespace hamgen::app {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 27> kGreek = {{
    {"alpha", "α"},   {"beta", "β"},   {"gamma", "γ"}, {"delta", "δ"}, {"eps", "ε"},
    {"epsilon", "ε"}, {"zeta", "ζ"},   {"eta", "η"},   {"theta", "θ"}, {"iota", "ι"},
    {"kappa", "κ"},   {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},    {"xi", "ξ"},
    {"pi", "π"},      {"rho", "ρ"},    {"sigma", "σ"}, {"tau", "τ"},   {"phi", "φ"},
    {"chi", "χ"},     {"psi", "ψ"},    {"omega", "ω"}, {"Gamma", "Γ"}, {"Delta", "Δ"},
    {"Omega", "Ω"},   {"Phi", "Φ"},
}};

// How tightly an expression holds together, as in the language's own notation.
enum class Tightness { sum, product, sign, power, atom };

Tightness tightness(const Node& node) {
  if (std::holds_alternative<NegateNode>(node.value)) return Tightness::sign;
  if (std::holds_alternative<SumNode>(node.value)) return Tightness::product;
  if (const auto* number = std::get_if<NumberNode>(&node.value))
    return number->value < 0 ? Tightness::sign : Tightness::atom;
  const auto* binary = std::get_if<BinaryNode>(&node.value);
  if (binary == nullptr) return Tightness::atom;
  switch (binary->operation) {
    case BinaryOperator::add:
    case BinaryOperator::subtract:
      return Tightness::sum;
    case BinaryOperator::multiply:
      return Tightness::product;
    case BinaryOperator::divide:
      return Tightness::power;  // a fraction's bar holds it together
    case BinaryOperator::power:
      return Tightness::power;
  }
  internal_error("unknown operator");
}

std::string parenthesised(const std::string& markup) {
  return "<mrow><mo>(</mo>" + markup + "<mo>)</mo></mrow>";
}

std::string at_least_as_tight(Tightness level, const NodePtr& node) {
  const std::string markup = math_markup(node);
  return tightness(*node) >= level ? markup : parenthesised(markup);
}

std::string markup_of(const NumberNode& number) {
  const std::string text = to_text(std::make_shared<const Node>(Node{.value = number}));
  return text.starts_with('-') ? "<mo>−</mo><mn>" + text.substr(1) + "</mn>"
                               : "<mn>" + text + "</mn>";
}

std::string markup_of(const NameNode& name) {
  const std::string letter = math_name(name.name);
  return name.subscript ? fmt::format("<msub><mrow>{}</mrow><mrow>{}</mrow></msub>", letter,
                                      math_markup(name.subscript))
                        : letter;
}

std::string markup_of(const NegateNode& negate) {
  return "<mo>−</mo>" + at_least_as_tight(Tightness::power, negate.operand);
}

bool is_plain_number(const NodePtr& node) {
  return std::holds_alternative<NumberNode>(node->value);
}

std::string fraction(const NodePtr& above, const NodePtr& below, bool inline_form) {
  if (inline_form)
    return fmt::format("<mrow>{}<mo>/</mo>{}</mrow>", math_markup(above), math_markup(below));
  return fmt::format("<mfrac><mrow>{}</mrow><mrow>{}</mrow></mfrac>", math_markup(above),
                     math_markup(below));
}

// Functions that have a notation of their own keep it under a power.
bool has_own_notation(const std::string& function) {
  return function == "sqrt" || function == "abs" || function == "exp";
}

std::string power(const BinaryNode& binary) {
  const auto* divided = std::get_if<BinaryNode>(&binary.right->value);
  const bool slash = divided != nullptr && divided->operation == BinaryOperator::divide &&
                     is_plain_number(divided->left) && is_plain_number(divided->right);
  const std::string exponent =
      slash ? fraction(divided->left, divided->right, true) : math_markup(binary.right);
  const auto* call = std::get_if<CallNode>(&binary.left->value);
  if (call != nullptr && !has_own_notation(call->function) && call->arguments.size() == 1)
    return fmt::format("<msup><mi>{}</mi><mrow>{}</mrow></msup><mo>&#x2061;</mo>{}", call->function,
                       exponent, parenthesised(math_markup(call->arguments.front())));
  const bool bare = tightness(*binary.left) == Tightness::atom && call == nullptr;
  const std::string base = math_markup(binary.left);
  constexpr std::string_view subscripted = "<msub>";
  if (bare && base.starts_with(subscripted)) {
    // The power stands above the subscript, not after it.
    const std::string inside =
        base.substr(subscripted.size(), base.size() - 2 * subscripted.size() - 1);
    return fmt::format("<msubsup>{}<mrow>{}</mrow></msubsup>", inside, exponent);
  }
  return fmt::format("<msup><mrow>{}</mrow><mrow>{}</mrow></msup>",
                     bare ? base : parenthesised(base), exponent);
}

std::string markup_of(const BinaryNode& binary) {
  const auto after = [&binary](Tightness level) {
    return tightness(*binary.right) == Tightness::sign ? parenthesised(math_markup(binary.right))
                                                       : at_least_as_tight(level, binary.right);
  };
  switch (binary.operation) {
    case BinaryOperator::add:
      return math_markup(binary.left) + "<mo>+</mo>" + after(Tightness::product);
    case BinaryOperator::subtract:
      return math_markup(binary.left) + "<mo>−</mo>" + after(Tightness::product);
    case BinaryOperator::multiply:
      return at_least_as_tight(Tightness::product, binary.left) +
             (is_plain_number(binary.right) ? "<mo>·</mo>"
                                            : "<mo>&#x2062;</mo><mspace width='0.12em'/>") +
             after(Tightness::power);
    case BinaryOperator::divide:
      return fraction(binary.left, binary.right, false);
    case BinaryOperator::power:
      return power(binary);
  }
  internal_error("unknown operator");
}

std::string markup_of(const CallNode& call) {
  std::string list;
  for (const NodePtr& argument : call.arguments)
    list += (list.empty() ? "" : "<mo>,</mo>") + math_markup(argument);
  if (call.function == "sqrt") return "<msqrt><mrow>" + list + "</mrow></msqrt>";
  if (call.function == "abs") return "<mrow><mo>|</mo>" + list + "<mo>|</mo></mrow>";
  if (call.function == "exp") return "<msup><mi>e</mi><mrow>" + list + "</mrow></msup>";
  return fmt::format("<mi>{}</mi><mo>&#x2061;</mo>{}", call.function, parenthesised(list));
}

std::string markup_of(const SumNode& sum) {
  std::string text;
  for (const SumRange& range : sum.ranges)
    text +=
        fmt::format("<munderover><mo>∑</mo><mrow>{}<mo>=</mo>{}</mrow><mrow>{}</mrow></munderover>",
                    math_name(range.index), math_markup(range.lower), math_markup(range.upper));
  return "<mrow>" + text + at_least_as_tight(Tightness::product, sum.body) + "</mrow>";
}

}  // namespace

std::string math_name(std::string_view name) {
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  const std::string_view letters = name.substr(0, end);
  std::string shown(letters);
  for (const auto& [word, letter] : kGreek) {
    if (letters == word) shown = letter;
  }
  const std::string italic = fmt::format("<mi>{}</mi>", html_text(shown));
  if (end == name.size() || end == 0) return italic;
  return fmt::format("<msub>{}<mn>{}</mn></msub>", italic, name.substr(end));
}

std::string math_markup(const NodePtr& node) {
  return std::visit([](const auto& each) { return markup_of(each); }, node->value);
}

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace hamgen::app
