#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "app/output/math_formula.hpp"
#include "app/output/math_symbol.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

// How tightly a formula holds together; a ratio is a fraction with a slash.
enum class Tightness { relation, sum, sign, ratio, product, power, atom };

// A fraction has a bar where it stands by itself, and a slash inside a fraction, an exponent or a
// subscript.
enum class FractionForm { bar, slash };

std::string markup_of(const MathFormula& formula, FractionForm form);

bool is_one(const MathFormula& formula) {
  return formula.kind == MathKind::number && formula.text == "1";
}

// Of a product with fractions among its factors: one fraction.
std::optional<MathFormula> as_one_quotient(const MathFormula& product) {
  std::vector<MathFormula> above;
  std::vector<MathFormula> below;
  for (const MathFormula& factor : product.parts) {
    const bool is_quotient = factor.kind == MathKind::quotient;
    if (!is_quotient || !is_one(factor.parts[0]))
      std::ranges::copy(factors_of(is_quotient ? factor.parts[0] : factor),
                        std::back_inserter(above));
    if (is_quotient) std::ranges::copy(factors_of(factor.parts[1]), std::back_inserter(below));
  }
  if (below.empty()) return {};
  return MathFormula{.kind = MathKind::quotient,
                     .text = "",
                     .parts = {product_of_all(std::move(above)), product_of_all(std::move(below))}};
}

Tightness tightness_of(const MathFormula& formula, FractionForm form) {
  switch (formula.kind) {
    case MathKind::relation:
      return Tightness::relation;
    case MathKind::sum:
      return Tightness::sum;
    case MathKind::negation:
      return Tightness::sign;
    case MathKind::quotient:
      return form == FractionForm::bar ? Tightness::power : Tightness::ratio;
    case MathKind::product:
      return form == FractionForm::slash && as_one_quotient(formula) ? Tightness::ratio
                                                                     : Tightness::product;
    case MathKind::big_sum:
      return Tightness::product;
    case MathKind::power:
      return Tightness::power;
    case MathKind::number:
    case MathKind::symbol:
    case MathKind::mark:
    case MathKind::call:
    case MathKind::application:
    case MathKind::brackets:
      return Tightness::atom;
  }
  internal_error("unknown kind of formula");
}

// As high as what they hold, where that is higher than a line.
std::string fenced(std::string_view open, const std::string& markup, std::string_view close) {
  const bool is_high = markup.find("<mfrac") != std::string::npos ||
                       markup.find("<munderover") != std::string::npos ||
                       markup.find("<msqrt") != std::string::npos;
  const char* const stretch = is_high ? "" : " stretchy='false'";
  return fmt::format("<mrow><mo{0}>{1}</mo>{2}<mo{0}>{3}</mo></mrow>", stretch, open, markup,
                     close);
}

std::string parenthesised(const std::string& markup) { return fenced("(", markup, ")"); }

std::string at_least(Tightness level, const MathFormula& formula, FractionForm form) {
  const std::string markup = markup_of(formula, form);
  return tightness_of(formula, form) >= level ? markup : parenthesised(markup);
}

// A term behind others, or the first one.
std::string term_markup(const MathFormula& term, bool is_first, FractionForm form) {
  if (is_first) return at_least(Tightness::sign, term, form);
  if (is_negation(term))
    return "<mo form='infix'>−</mo>" + at_least(Tightness::ratio, term.parts[0], form);
  return "<mo form='infix'>+</mo>" + at_least(Tightness::ratio, term, form);
}

std::string sum_markup(const MathFormula& sum, FractionForm form) {
  std::string text;
  for (std::size_t i = 0; i < sum.parts.size(); ++i)
    text += term_markup(sum.parts[i], i == 0, form);
  return text;
}

// A digit must not follow a factor without a sign between them.
bool begins_with_number(const MathFormula& factor) {
  if (factor.kind == MathKind::power) return begins_with_number(factor.parts[0]);
  return factor.kind == MathKind::number;
}

std::string product_markup(const MathFormula& product, FractionForm form) {
  if (form == FractionForm::slash) {
    if (const auto quotient = as_one_quotient(product)) return markup_of(*quotient, form);
  }
  std::string text;
  for (std::size_t i = 0; i < product.parts.size(); ++i) {
    const MathFormula& factor = product.parts[i];
    const bool is_last = i + 1 == product.parts.size();
    if (i > 0)
      text +=
          begins_with_number(factor) ? "<mo>·</mo>" : "<mo>&#x2062;</mo><mspace width='0.14em'/>";
    // A big sum takes in all that follows it.
    text += at_least(
        factor.kind == MathKind::big_sum && is_last ? Tightness::product : Tightness::power, factor,
        form);
  }
  return text;
}

std::string quotient_markup(const MathFormula& quotient, FractionForm form) {
  const MathFormula& above = quotient.parts[0];
  const MathFormula& below = quotient.parts[1];
  if (form == FractionForm::bar)
    return fmt::format("<mfrac><mrow>{}</mrow><mrow>{}</mrow></mfrac>",
                       markup_of(above, FractionForm::slash),
                       markup_of(below, FractionForm::slash));
  return at_least(Tightness::product, above, form) + "<mo lspace='0' rspace='0'>/</mo>" +
         at_least(Tightness::power, below, form);
}

std::string list_markup(std::span<const MathFormula> formulas, FractionForm form) {
  std::string list;
  for (const MathFormula& each : formulas)
    list += (list.empty() ? "" : "<mo>,</mo>") + markup_of(each, form);
  return list;
}

// Functions that have a notation of their own keep it under a power.
std::optional<std::string> own_notation(const MathFormula& call, FractionForm form) {
  if (call.text == "sqrt")
    return "<msqrt><mrow>" + list_markup(call.parts, form) + "</mrow></msqrt>";
  if (call.text == "abs") return fenced("|", list_markup(call.parts, form), "|");
  if (call.text == "exp")
    return "<msup><mi>e</mi><mrow>" + list_markup(call.parts, FractionForm::slash) +
           "</mrow></msup>";
  if (call.text == "!") return list_markup(call.parts, form) + "<mo form='postfix'>!</mo>";
  return {};
}

std::string call_markup(const MathFormula& call, FractionForm form) {
  if (const auto notation = own_notation(call, form)) return *notation;
  return fmt::format("<mi>{}</mi><mo>&#x2061;</mo>{}", call.text,
                     parenthesised(list_markup(call.parts, form)));
}

SymbolMarkup symbol_parts(const MathFormula& symbol) {
  SymbolMarkup parts = symbol_markup(symbol.text);
  for (const MathFormula& subscript : symbol.parts)
    parts.subscript +=
        (parts.subscript.empty() ? "" : "<mo>,</mo>") + markup_of(subscript, FractionForm::slash);
  return parts;
}

std::string symbol_markup_of(const MathFormula& symbol) {
  const SymbolMarkup parts = symbol_parts(symbol);
  if (parts.subscript.empty()) return parts.letter;
  return fmt::format("<msub>{}<mrow>{}</mrow></msub>", parts.letter, parts.subscript);
}

// The power stands above a subscript, and after the name of a function.
std::string power_markup(const MathFormula& power, FractionForm form) {
  const MathFormula& base = power.parts[0];
  const std::string above = markup_of(power.parts[1], FractionForm::slash);
  if (base.kind == MathKind::symbol) {
    const SymbolMarkup parts = symbol_parts(base);
    if (!parts.subscript.empty())
      return fmt::format("<msubsup>{}<mrow>{}</mrow><mrow>{}</mrow></msubsup>", parts.letter,
                         parts.subscript, above);
  }
  const bool is_call = base.kind == MathKind::call;
  if (is_call && base.parts.size() == 1 && !own_notation(base, form))
    return fmt::format("<msup><mi>{}</mi><mrow>{}</mrow></msup><mo>&#x2061;</mo>{}", base.text,
                       above, parenthesised(markup_of(base.parts[0], form)));
  const std::string below = markup_of(base, form);
  const bool bare = !is_call && tightness_of(base, form) == Tightness::atom;
  return fmt::format("<msup><mrow>{}</mrow><mrow>{}</mrow></msup>",
                     bare ? below : parenthesised(below), above);
}

std::string big_sum_markup(const MathFormula& sum, FractionForm form) {
  return fmt::format(
      "<mrow><munderover><mo>∑</mo><mrow>{}<mo>=</mo>{}</mrow><mrow>{}</mrow></munderover>{}"
      "</mrow>",
      markup_of(math_symbol(sum.text), FractionForm::slash),
      markup_of(sum.parts[0], FractionForm::slash), markup_of(sum.parts[1], FractionForm::slash),
      at_least(Tightness::product, sum.parts[2], form));
}

// A letter is upright: the T of a transpose.
std::string mark_markup(const std::string& mark) {
  if (mark == "T") return "<mi mathvariant='normal'>T</mi>";
  if (mark == "…") return "<mo>…</mo>";
  if (mark.empty()) return "";
  // The letter before primes leans towards them.
  const std::string space = mark.starts_with("′") ? "<mspace width='0.15em'/>" : "";
  return space + "<mo lspace='0' rspace='0'>" + html_text(mark) + "</mo>";
}

// Each with the sign before it.
std::vector<std::string> relation_pieces(const MathFormula& relation, FractionForm form) {
  std::vector<std::string> pieces;
  for (std::size_t i = 0; i < relation.parts.size(); ++i) {
    const std::string sign = i == 0 ? "" : html_text(relation.text.substr(i - 1, 1));
    const std::string part = markup_of(relation.parts[i], form);
    if (sign == ",") {  // no line begins with it
      pieces.back() += "<mo>,</mo>" + part;
    } else {
      pieces.push_back((i == 0 ? "" : "<mo>" + sign + "</mo>") + part);
    }
  }
  return pieces;
}

std::string joined(const std::vector<std::string>& pieces) {
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

std::string markup_of(const MathFormula& formula, FractionForm form) {
  switch (formula.kind) {
    case MathKind::mark:
      return mark_markup(formula.text);
    case MathKind::application:
      return markup_of(formula.parts[0], form) + "<mo>&#x2061;</mo>" +
             parenthesised(list_markup(std::span(formula.parts).subspan(1), form));
    case MathKind::brackets:
      return fenced(formula.text.substr(0, 1), list_markup(formula.parts, form),
                    formula.text.substr(1));
    case MathKind::relation:
      return joined(relation_pieces(formula, form));
    case MathKind::number:
      return "<mn>" + formula.text + "</mn>";
    case MathKind::symbol:
      return symbol_markup_of(formula);
    case MathKind::negation:
      return "<mo form='prefix'>−</mo>" + at_least(Tightness::ratio, formula.parts[0], form);
    case MathKind::sum:
      return sum_markup(formula, form);
    case MathKind::product:
      return product_markup(formula, form);
    case MathKind::quotient:
      return quotient_markup(formula, form);
    case MathKind::power:
      return power_markup(formula, form);
    case MathKind::call:
      return call_markup(formula, form);
    case MathKind::big_sum:
      return big_sum_markup(formula, form);
  }
  internal_error("unknown kind of formula");
}

// -(a - b) is b - a, of a sum that is the whole formula or above its bar; -(a + b) without a bar
// is -a - b.
MathFormula without_leading_sign(const MathFormula& formula) {
  if (!is_negation(formula)) return formula;
  MathFormula operand = formula.parts[0];
  MathFormula& sum = operand.kind == MathKind::quotient ? operand.parts[0] : operand;
  const bool has_negative =
      sum.kind == MathKind::sum && std::ranges::any_of(sum.parts, is_negation);
  if (sum.kind != MathKind::sum || (!has_negative && &sum != &operand)) return formula;
  for (MathFormula& term : sum.parts) term = negated(term);
  std::ranges::stable_partition(sum.parts, [](const auto& term) { return !is_negation(term); });
  return operand;
}

}  // namespace

std::string math_markup(const MathFormula& formula) {
  return markup_of(without_leading_sign(formula), FractionForm::bar);
}

std::string line_markup(const MathFormula& formula) {
  return markup_of(without_leading_sign(formula), FractionForm::slash);
}

std::vector<std::string> line_pieces(const MathFormula& formula) {
  if (formula.kind == MathKind::relation) return relation_pieces(formula, FractionForm::slash);
  return {line_markup(formula)};
}

std::vector<std::string> math_pieces(const MathFormula& formula) {
  const MathFormula whole = without_leading_sign(formula);
  // A long sum above a number: the number goes in front, so that lines can end between its terms.
  constexpr std::size_t many = 4;
  const bool is_over_number =
      whole.kind == MathKind::quotient && whole.parts[0].kind == MathKind::sum &&
      whole.parts[0].parts.size() >= many && whole.parts[1].kind == MathKind::number;
  if (is_over_number) {
    std::vector<std::string> pieces = math_pieces(whole.parts[0]);
    const MathFormula factor = quotient_of(math_number("1"), whole.parts[1]);
    pieces.front() =
        markup_of(factor, FractionForm::bar) + "<mo stretchy='false'>(</mo>" + pieces.front();
    pieces.back() += "<mo stretchy='false'>)</mo>";
    return pieces;
  }
  if (whole.kind != MathKind::sum) return {markup_of(whole, FractionForm::bar)};
  std::vector<std::string> pieces;
  for (std::size_t i = 0; i < whole.parts.size(); ++i)
    pieces.push_back(term_markup(whole.parts[i], i == 0, FractionForm::bar));
  return pieces;
}

std::string accented_markup(const MathFormula& symbol, std::string_view accent) {
  const SymbolMarkup parts = symbol_parts(symbol);
  const std::string letter =
      fmt::format("<mover accent='true'>{}<mo>{}</mo></mover>", parts.letter, accent);
  if (parts.subscript.empty()) return letter;
  return fmt::format("<msub>{}<mrow>{}</mrow></msub>", letter, parts.subscript);
}

}  // namespace hamgen::app
