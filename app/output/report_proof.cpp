// What the report says of proofs, of linear stability and of the modified Hamiltonian.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/output/math_markup.hpp"
#include "app/output/math_text.hpp"
#include "app/output/modified_output.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_parts.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

constexpr std::string_view kInvariant = " invariant";
constexpr std::size_t kLongestFormula = 600;   // characters, shown at once
constexpr std::size_t kLongestFolded = 4'000;  // behind a fold

// Of "L conserved by the step" the name is a formula.
std::string property_markup(const std::string& property) {
  const std::size_t end = property.find(' ');
  const std::string rest = end == std::string::npos ? "" : property.substr(end);
  if (rest != kInvariant && rest != kConserved) return html_text(property);
  return inline_formula(math_markup(math_variable(property.substr(0, end)))) + rest;
}

std::string findings_table(const Proof& proof) {
  std::string text = "<div class='wide'><table class='findings'>\n";
  for (const Finding& finding : proof)
    text += fmt::format("<tr><td>{}</td><td>{}</td><td class='detail'>{}</td></tr>\n",
                        property_markup(finding.property), verdict_markup(finding.verdict),
                        math_prose(finding.detail));
  return text + "</table></div>\n";
}

// "12 proved, 1 tested, 2 not decided".
std::string verdict_counts(const Proof& proof) {
  std::string text;
  for (const Verdict verdict : {Verdict::proved, Verdict::tested, Verdict::refuted,
                                Verdict::not_decided, Verdict::measured}) {
    const auto count = std::ranges::count(proof, verdict, &Finding::verdict);
    if (count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, verdict_markup(verdict));
  }
  return text;
}

std::string oscillations(const LinearStability& linear) {
  const std::vector<double>& w = linear.frequencies;
  if (w.empty()) return "the linear part of the motion has no oscillation";
  if (w.size() == 1)
    return "the linear part of the motion is an oscillation with " +
           named_value("omega", w.front(), 4);
  const std::string least = named_value("omega", w.front(), 4);
  const bool alike = least == named_value("omega", w.back(), 4);
  return fmt::format("the linear part of the motion is {} oscillations, {}{}", w.size(), least,
                     alike ? " of each" : " to " + html_number(w.back(), 4));
}

std::string bounded_phrase(const LinearStability& linear) {
  if (linear.frequencies.empty()) return "";
  const std::string verdict = verdict_markup(linear.verdict);
  const std::string h = named_value("h", linear.h, 4);
  if (linear.verdict == Verdict::refuted)
    return fmt::format(" At {} the step makes it grow without bound ({}).", h, verdict);
  if (!holds(linear.verdict))
    return fmt::format(" Whether the step keeps it bounded at {} is {}.", h, verdict);
  std::string where;
  if (linear.bounded_for_every_h) where = ", as at every " + inline_formula(math_symbol("h"));
  if (!linear.bounded_for_every_h && linear.largest_h)
    where = ", as up to " + named_value("h", *linear.largest_h, 4);
  return fmt::format(" At {} the step keeps it bounded{} ({}).", h, where, verdict);
}

// What the numbers mean, in sentences.
std::string linear_text(const LinearPoint& point) {
  const LinearStability& linear = point.stability;
  std::string text = fmt::format("<p>At the {} {}.", html_text(point.place), oscillations(linear));
  text += bounded_phrase(linear);
  if (linear.growing > 0)
    text += fmt::format(
        " {}, up to {}: that is the system's doing, not the step's.",
        linear.growing == 1 ? "One direction grows of its own accord"
                            : fmt::format("{} directions grow of their own accord", linear.growing),
        inline_formula(
            call_of("exp", {product_of(math_value(linear.growth_rate, 4), math_symbol("t"))})));
  if (linear.iteration_radius)
    text += fmt::format(" Fixed-point iteration would {}: its factor is {} an iteration.",
                        *linear.iteration_radius < 1.0 ? "converge" : "not converge",
                        html_number(*linear.iteration_radius, 2));
  return text + "</p>\n";
}

// H_4.
MathFormula term_symbol(std::size_t power) {
  return with_subscript("H", math_number(std::to_string(power)));
}

MathFormula power_of_h(std::size_t power) {
  return power_of(math_symbol("h"), math_number(std::to_string(power)));
}

std::string modified_symbol() { return accented_markup(math_symbol("H"), "˜"); }

std::string term_text(std::size_t power, const Expression& derived) {
  const Expression term = shown_term(derived);
  const std::size_t length = to_text(term).size();
  const std::string name = math_markup(term_symbol(power));
  if (length <= kLongestFormula) return formula_line(name, math_formula(term));
  if (length <= kLongestFolded)
    return folded(inline_formula(name) + ", written out", formula_line(name, math_formula(term)));
  return fmt::format(
      "<p class='note'>{} is long: <code>hamgen verify --terms</code> prints "
      "it.</p>\n",
      inline_formula(name));
}

std::string variation_text(const ModifiedEnergy& modified) {
  std::vector<double> variations;
  for (const std::size_t power : modified.powers())
    variations.push_back(modified.orbit->variations[power]);
  const bool falls =
      std::ranges::adjacent_find(variations, std::less_equal<>()) == variations.end();
  const char* const finding =
      variations.size() < 2 || variations.back() < 1e-30 ? ""
      : falls
          ? ": each further term takes the variation down"
          : ": further terms do not take the variation down, h is too large for the series here";
  std::string text = fmt::format(
      "<p>Along the orbit, {} steps of {} in quad precision{}:</p>\n<div "
      "class='wide'><table>\n<tr><th>terms to</th><th class='number'>largest "
      "<math><mrow><mo>|</mo>{}<mo>−</mo>{}<mo stretchy='false'>(</mo><mn>0</mn><mo "
      "stretchy='false'>)</mo>"
      "<mo>|</mo></mrow></math>"
      "</th></tr>\n",
      modified.orbit->steps, named_value("h", modified.orbit->h, 6), finding, modified_symbol(),
      modified_symbol());
  for (const std::size_t power : modified.powers())
    text += fmt::format("<tr><td>{}</td><td class='number'>{}</td></tr>\n",
                        inline_formula(power_of_h(power)),
                        html_number(modified.orbit->variations[power], 4));
  return text + "</table></div>\n";
}

}  // namespace

std::string proof_section(const ReportContent& content) {
  std::string text =
      fmt::format("<h2>What is proved</h2>\n<p>{}.</p>\n", verdict_counts(content.proof)) +
      folded("Every property, and how it was decided", findings_table(content.proof));
  if (content.linear.empty()) return text;
  text += "<h2>Linear stability</h2>\n";
  Proof lines;
  for (const LinearPoint& point : content.linear) {
    text += linear_text(point);
    for (Finding& line : findings(point)) lines.push_back(std::move(line));
  }
  return text + folded("The numbers behind this", findings_table(lines));
}

std::string modified_section(const ReportContent& content) {
  if (!content.modified) return "";
  const ModifiedEnergy& modified = *content.modified;
  std::string text = fmt::format(
      "<h2>The modified Hamiltonian</h2>\n<p>What the step conserves instead of {}, as "
      "a formal series in {}.</p>\n",
      inline_formula(math_symbol("H")), inline_formula(math_symbol("h")));
  MathFormula sum = math_symbol("H");
  std::string terms;
  for (const std::size_t power : modified.powers()) {
    if (power == 0) continue;
    sum = sum_of(sum, product_of(power_of_h(power), term_symbol(power)));
    terms += term_text(power, modified.terms[power]);
  }
  text += formula_line(modified_symbol(), sum_of(sum, math_symbol("…"))) + terms;
  return modified.orbit ? text + variation_text(modified) : text;
}

std::string verdict_markup(Verdict verdict) {
  constexpr std::array<std::string_view, 5> classes = {"proved", "tested", "refuted", "open",
                                                       "measured"};
  constexpr std::array<std::string_view, 5> signs = {"✓", "≈", "✗", "?", "·"};
  const auto i = static_cast<std::size_t>(verdict);
  return fmt::format("<span class='verdict {}'>{} {}</span>", classes.at(i), signs.at(i),
                     to_text(verdict));
}

}  // namespace hamgen::app
