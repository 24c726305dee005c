// What the report says of the system: formulas and values.
#include <fmt/format.h>

#include <algorithm>

#include "app/output/math_markup.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_parts.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

constexpr std::size_t kMostEquations = 8;
constexpr std::size_t kMostValues = 12;

std::string equations_of_motion(const Mechanics& mechanics) {
  if (mechanics.keeps_sums() || mechanics.degrees_of_freedom > 12) {
    return fmt::format(
        "<p class='note'>{} degrees of freedom: the equations of motion are not "
        "written out here.</p>\n",
        mechanics.degrees_of_freedom);
  }
  const auto n = static_cast<std::size_t>(mechanics.degrees_of_freedom);
  std::string text;
  for (std::size_t i = 0; i < std::min(2 * n, kMostEquations); ++i) {
    const Expression right = i < n ? mechanics.gradient[n + i] : -mechanics.gradient[i - n];
    text += formula_line(accented_markup(math_variable(mechanics.variables.name(i)), "˙"),
                         math_formula(right));
  }
  if (2 * n > kMostEquations)
    text += fmt::format("<p class='note'>and {} more.</p>\n", 2 * n - kMostEquations);
  return text;
}

struct ShownValue {
  MathFormula name;
  double value = 0.0;
  std::string unit, comment;
};

// Parameters, then the state: each element of an array.
std::vector<ShownValue> values_of(const ReportContent& content) {
  const Model& model = content.plugin->model;
  std::vector<ShownValue> all;
  const auto add = [&all](const auto& declared, const std::vector<Rational>& values) {
    std::size_t at = 0;
    for (const auto& each : declared) {
      const std::size_t count = each.range ? static_cast<std::size_t>(each.range->size()) : 1;
      for (std::size_t i = 0; i < count; ++i, ++at) {
        const std::string name =
            each.range ? fmt::format("{}[{}]", each.name, each.range->first + static_cast<long>(i))
                       : each.name;
        all.push_back({math_variable(name), to_double(values[at]), each.unit, each.comment});
      }
    }
  };
  add(model.parameters, content.scene->parameters);
  add(model.coordinates, content.scene->q);
  add(model.momenta, content.scene->p);
  return all;
}

std::string values_table(const std::vector<ShownValue>& values) {
  std::string rows;
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 8 * kMostValues); ++i) {
    const ShownValue& each = values[i];
    rows += fmt::format(
        "<tr><td class='name'>{}</td><td class='number'>{}</td><td>{}</td><td>{}</td></tr>\n",
        inline_formula(each.name), html_number(each.value, 12), html_text(each.unit),
        html_text(each.comment));
  }
  return "<div class='wide'><table><tr><th></th><th class='number'>value</th><th>unit</th>"
         "<th></th></tr>\n" +
         rows + "</table></div>\n";
}

std::string scene_text(const ReportContent& content) {
  const std::vector<ShownValue> values = values_of(content);
  std::string list;
  for (std::size_t i = 0; i < std::min(values.size(), kMostValues); ++i)
    list += (i == 0 ? "" : ", ") + inline_equation(values[i].name, math_value(values[i].value, 6));
  if (values.size() > kMostValues) list += fmt::format(" and {} more", values.size() - kMostValues);
  const std::string scene = content.scene->name.empty()
                                ? "Initial data"
                                : "Scene <em>" + html_text(content.scene->name) + "</em>";
  return fmt::format("<p>{}: {}{} steps of {}.</p>\n", scene, list.empty() ? "" : list + "; ",
                     *content.scene->steps, named_value("h", to_double(*content.scene->h), 6)) +
         folded("Values with their units", values_table(values));
}

}  // namespace

std::string system_section(const ReportContent& content) {
  const Model& model = content.plugin->model;
  std::string text = "<h2>The system</h2>\n";
  text += formula_line("<mi>H</mi>", math_formula(model.hamiltonian));
  for (const Definition& definition : model.definitions)
    text += formula_line("<mtext>with&#xa0;</mtext>" + math_markup(math_symbol(definition.name)),
                         math_formula(definition.value));
  text += equations_of_motion(*content.mechanics);
  for (const Invariant& invariant : model.invariants)
    text +=
        formula_line("<mtext>conserved&#xa0;</mtext>" + math_markup(math_symbol(invariant.name)),
                     math_formula(invariant.value));
  return text + scene_text(content);
}

}  // namespace hamgen::app
