#include "app/studies/modified_energy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/algebra/latex.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/verify/modified_energy.hpp"

namespace hamgen::app {
namespace {

// Ht is evaluated at about so many states of the orbit.
constexpr long samples = 400;

Rational exact(const runtime::Wide& value) {
  return Rational(from_double(value.hi) + from_double(value.lo));
}

struct WatchedOrbit {
  double h = 0.0;
  long steps = 0;
  std::vector<double> variations;  // by the power of h that Ht goes to
};

// The orbit in quad precision: what is left of the variation is that of the step, not of rounding.
WatchedOrbit watch_orbit(const SourceText& source, Request request, const SceneValues& scene,
                         const std::vector<Expression>& terms) {
  request.scalar = "quad";
  const Model model = read_request(source, request);
  const PluginSource plugin = generate_plugin(source, request);
  const runtime::LoadedPlugin loaded = load_integrator(plugin, "");
  runtime::Integrator integrator(loaded.library, initial_values(plugin, scene, *loaded.library));

  std::map<std::string, Rational> fixed = {{"h", *scene.h}};
  const std::vector<std::string> parameters = element_names(model.parameters);
  for (std::size_t i = 0; i < parameters.size(); ++i) fixed[parameters[i]] = scene.parameters[i];
  std::vector<std::string> names = element_names(model.coordinates);
  const std::vector<std::string> momenta = element_names(model.momenta);
  names.insert(names.end(), momenta.begin(), momenta.end());

  ModifiedEnergyWatch watch(terms, fixed);
  const auto add = [&] {
    std::map<std::string, Rational> state;
    const std::vector<runtime::Wide> z = integrator.state();
    for (std::size_t i = 0; i < names.size(); ++i) state[names[i]] = exact(z[i]);
    watch.add(state);
  };
  add();
  const long distance = std::max(1L, *scene.steps / samples);
  long done = 0;
  for (; done < *scene.steps; done += distance) {
    if (integrator.advance(distance, false).status != runtime::Status::done) break;
    add();
  }
  return {to_double(*scene.h), done, watch.variations()};
}

}  // namespace

int modified_term_count(const std::string& option, const std::string& text) {
  const long count = integer_value(option + " " + text, text, 1);
  if (count > 8) throw UsageError(fmt::format("{} {}: at most 8 terms", option, text));
  return static_cast<int>(count);
}

ModifiedReport modified_report(const SourceText& source, const Request& request,
                               const ModifiedOptions& options,
                               const std::optional<SceneValues>& scene) {
  const std::vector<Expression> terms =
      modified_hamiltonian(source, request, modified_term_count("--terms", options.terms));
  ModifiedReport report;
  report.text = "modified Hamiltonian, which the step conserves as a formal series:\n";
  report.json["property"] = "modified Hamiltonian";
  report.json["terms"] = nlohmann::ordered_json::array();
  for (std::size_t j = 0; j < terms.size(); ++j) {
    if (terms[j].is_zero() && j > 0) continue;
    const std::string formula = options.latex ? to_latex(terms[j]) : to_text(terms[j]);
    report.text += options.latex ? fmt::format("  h^{{{}}}: {}\n", j, formula)
                                 : fmt::format("  h^{}  {}\n", j, formula);
    report.json["terms"].push_back({{"power", j}, {"value", formula}});
  }
  if (!scene) return report;
  const WatchedOrbit orbit = watch_orbit(source, request, *scene, terms);
  report.text += fmt::format(
      "along scene {}, h = {}, {} steps in quad precision:\n"
      "  terms to  max |Ht - Ht(0)|\n",
      scene->name, orbit.h, orbit.steps);
  report.json["scene"] = scene->name;
  report.json["h"] = orbit.h;
  report.json["steps"] = orbit.steps;
  report.json["variation"] = nlohmann::ordered_json::array();
  for (std::size_t j = 0; j < terms.size(); ++j) {
    if (terms[j].is_zero() && j > 0) continue;
    report.text += fmt::format("  h^{:<7}  {:.3e}\n", j, orbit.variations[j]);
    report.json["variation"].push_back({{"power", j}, {"max", orbit.variations[j]}});
  }
  return report;
}

}  // namespace hamgen::app
