#include "app/output/modified_output.hpp"

#include <fmt/format.h>

#include "generator/algebra/latex.hpp"
#include "generator/algebra/polynomial.hpp"

namespace hamgen::app {
namespace {

std::string formula_of(const Expression& term, bool latex) {
  const Expression shown = shown_term(term);
  return latex ? to_latex(shown) : to_text(shown);
}

}  // namespace

Expression shown_term(const Expression& term) {
  constexpr std::size_t most_terms = 200;
  constexpr double longer = 1.5;
  try {
    PolynomialRing ring(most_terms);
    const Polynomial polynomial = ring.expand(term);
    const Expression flat = ring.horner(polynomial, [](const Expression&) { return false; });
    const auto length = [](const Expression& e) { return static_cast<double>(to_text(e).size()); };
    return length(flat) <= longer * length(term) ? flat : term;
  } catch (const TooManyTerms&) {
    return term;
  }
}

std::string modified_text(const ModifiedEnergy& modified, bool latex) {
  std::string text = "modified Hamiltonian, which the step conserves as a formal series:\n";
  for (const std::size_t j : modified.powers()) {
    const std::string formula = formula_of(modified.terms[j], latex);
    text += latex ? fmt::format("  h^{{{}}}: {}\n", j, formula)
                  : fmt::format("  h^{}  {}\n", j, formula);
  }
  if (!modified.orbit) return text;
  const WatchedOrbit& orbit = *modified.orbit;
  text += fmt::format(
      "along scene {}, h = {}, {} steps in quad precision:\n"
      "  terms to  max |Ht - Ht(0)|\n",
      orbit.scene, orbit.h, orbit.steps);
  for (const std::size_t j : modified.powers())
    text += fmt::format("  h^{:<7}  {:.3e}\n", j, orbit.variations[j]);
  return text;
}

nlohmann::ordered_json modified_json(const ModifiedEnergy& modified, bool latex) {
  nlohmann::ordered_json json = {{"property", "modified Hamiltonian"},
                                 {"terms", nlohmann::ordered_json::array()}};
  for (const std::size_t j : modified.powers())
    json["terms"].push_back({{"power", j}, {"value", formula_of(modified.terms[j], latex)}});
  if (!modified.orbit) return json;
  const WatchedOrbit& orbit = *modified.orbit;
  json["scene"] = orbit.scene;
  json["h"] = orbit.h;
  json["steps"] = orbit.steps;
  json["variation"] = nlohmann::ordered_json::array();
  for (const std::size_t j : modified.powers())
    json["variation"].push_back({{"power", j}, {"max", orbit.variations[j]}});
  return json;
}

}  // namespace hamgen::app
