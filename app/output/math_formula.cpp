#include "app/output/math_formula.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "generator/base/quoted_text.hpp"

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

std::string parenthesised(const std::string& markup) {
  return "<mrow><mo>(</mo>" + markup + "<mo>)</mo></mrow>";
}

std::string at_least_as_tight(Tightness level, const MathFormula& formula) {
  return formula.tightness >= level ? formula.markup : parenthesised(formula.markup);
}

// What stands behind an operator: a sign would meet it.
std::string behind(Tightness level, const MathFormula& formula) {
  return formula.tightness == Tightness::sign ? parenthesised(formula.markup)
                                              : at_least_as_tight(level, formula);
}

// Functions that have a notation of their own keep it under a power.
std::optional<std::string> own_notation(const std::string& function, const std::string& argument) {
  if (function == "sqrt") return "<msqrt><mrow>" + argument + "</mrow></msqrt>";
  if (function == "abs") return "<mrow><mo>|</mo>" + argument + "<mo>|</mo></mrow>";
  if (function == "exp") return "<msup><mi>e</mi><mrow>" + argument + "</mrow></msup>";
  return {};
}

}  // namespace

MathFormula math_number(const std::string& text) {
  if (text.starts_with('-'))
    return {.markup = "<mo>−</mo><mn>" + text.substr(1) + "</mn>",
            .tightness = Tightness::sign,
            .is_number = true};
  return {.markup = "<mn>" + text + "</mn>", .is_number = true};
}

MathFormula math_symbol(std::string_view name) {
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  const std::string_view letters = name.substr(0, end);
  std::string shown(letters);
  for (const auto& [word, letter] : kGreek) {
    if (letters == word) shown = letter;
  }
  const std::string italic = fmt::format("<mi>{}</mi>", html_text(shown));
  if (end == name.size() || end == 0) return {.markup = italic};
  return {.markup = fmt::format("<msub>{}<mn>{}</mn></msub>", italic, name.substr(end))};
}

MathFormula with_subscript(std::string_view name, const MathFormula& subscript) {
  return {.markup = fmt::format("<msub><mrow>{}</mrow><mrow>{}</mrow></msub>",
                                math_symbol(name).markup, subscript.markup)};
}

MathFormula negated(const MathFormula& operand) {
  return {.markup = "<mo>−</mo>" + at_least_as_tight(Tightness::power, operand),
          .tightness = Tightness::sign};
}

MathFormula sum_of(const MathFormula& left, const MathFormula& right) {
  return {.markup = left.markup + "<mo>+</mo>" + behind(Tightness::product, right),
          .tightness = Tightness::sum};
}

MathFormula difference_of(const MathFormula& left, const MathFormula& right) {
  return {.markup = left.markup + "<mo>−</mo>" + behind(Tightness::product, right),
          .tightness = Tightness::sum};
}

MathFormula product_of(const MathFormula& left, const MathFormula& right) {
  const char* const times =
      right.is_number ? "<mo>·</mo>" : "<mo>&#x2062;</mo><mspace width='0.12em'/>";
  return {.markup =
              at_least_as_tight(Tightness::product, left) + times + behind(Tightness::power, right),
          .tightness = Tightness::product};
}

MathFormula quotient_of(const MathFormula& above, const MathFormula& below) {
  MathFormula result{.markup = fmt::format("<mfrac><mrow>{}</mrow><mrow>{}</mrow></mfrac>",
                                           above.markup, below.markup),
                     .tightness = Tightness::power};  // the bar holds it together
  if (above.is_number && below.is_number)
    result.in_line = fmt::format("<mrow>{}<mo>/</mo>{}</mrow>", above.markup, below.markup);
  return result;
}

MathFormula power_of(const MathFormula& base, const MathFormula& exponent) {
  MathFormula result{.tightness = Tightness::power};
  const std::string& above = exponent.in_line.empty() ? exponent.markup : exponent.in_line;
  if (!base.function.empty()) {
    result.markup = fmt::format("<msup><mi>{}</mi><mrow>{}</mrow></msup><mo>&#x2061;</mo>{}",
                                base.function, above, parenthesised(base.argument));
    return result;
  }
  const bool bare = base.tightness == Tightness::atom && !base.is_call;
  constexpr std::string_view subscripted = "<msub>";
  if (bare && base.markup.starts_with(subscripted)) {
    // The power stands above the subscript, not after it.
    const std::string inside =
        base.markup.substr(subscripted.size(), base.markup.size() - 2 * subscripted.size() - 1);
    result.markup = fmt::format("<msubsup>{}<mrow>{}</mrow></msubsup>", inside, above);
    return result;
  }
  result.markup = fmt::format("<msup><mrow>{}</mrow><mrow>{}</mrow></msup>",
                              bare ? base.markup : parenthesised(base.markup), above);
  return result;
}

MathFormula call_of(const std::string& function, const std::vector<MathFormula>& arguments) {
  std::string list;
  for (const MathFormula& argument : arguments)
    list += (list.empty() ? "" : "<mo>,</mo>") + argument.markup;
  if (const auto notation = own_notation(function, list))
    return {.markup = *notation, .is_call = true};
  MathFormula result{
      .markup = fmt::format("<mi>{}</mi><mo>&#x2061;</mo>{}", function, parenthesised(list)),
      .is_call = true};
  if (arguments.size() == 1) {
    result.function = function;
    result.argument = list;
  }
  return result;
}

MathFormula sum_over(const std::vector<MathRange>& ranges, const MathFormula& body) {
  std::string text;
  for (const MathRange& range : ranges)
    text +=
        fmt::format("<munderover><mo>∑</mo><mrow>{}<mo>=</mo>{}</mrow><mrow>{}</mrow></munderover>",
                    math_symbol(range.index).markup, range.lower.markup, range.upper.markup);
  return {.markup = "<mrow>" + text + at_least_as_tight(Tightness::product, body) + "</mrow>",
          .tightness = Tightness::product};
}

}  // namespace hamgen::app
