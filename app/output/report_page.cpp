#include "app/output/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/math_markup.hpp"
#include "app/output/report_style.hpp"
#include "app/output/wide_text.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

constexpr std::size_t kMostEquations = 8;
constexpr std::size_t kMostValues = 12;
constexpr std::size_t kLongestFormula = 400;

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[block >> (18 - 6 * k) & 63u];
  }
  return text;
}

std::string formula(const std::string& markup) {
  return "<div class='wide formula'><math displaystyle='true'><mrow>" + markup +
         "</mrow></math></div>\n";
}

std::string inline_formula(const std::string& markup) { return "<math>" + markup + "</math>"; }

// "q[3]" as a name with a subscript.
std::string element_markup(const std::string& name) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string::npos) return math_name(name);
  return fmt::format("<msub>{}<mn>{}</mn></msub>", math_name(name.substr(0, bracket)),
                     name.substr(bracket + 1, name.size() - bracket - 2));
}

// The derivative by time: a prime, above any subscript.
std::string primed(const std::string& name) {
  constexpr std::string_view subscripted = "<msub>";
  const std::string markup = element_markup(name);
  if (!markup.starts_with(subscripted)) return "<msup>" + markup + "<mo>′</mo></msup>";
  const std::size_t length = markup.size() - 2 * subscripted.size() - 1;
  return "<msubsup>" + markup.substr(subscripted.size(), length) + "<mo>′</mo></msubsup>";
}

// The comment above the model: what the system is, and its source.
std::string introduction(const Model& model) {
  std::string text;
  const std::string& source = model.source.text;
  for (std::size_t at = 0; at < source.size() && source[at] == '#';) {
    const std::size_t end = std::min(source.find('\n', at), source.size());
    std::string_view line = std::string_view(source).substr(at + 1, end - at - 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    text += html_text(line);
    at = end + 1;
  }
  return text.empty() ? "" : "<p class='lead'>" + text + "</p>\n";
}

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
    text += formula(
        fmt::format("{}<mo>=</mo>{}", primed(mechanics.variables[i].name), math_markup(right)));
  }
  if (2 * n > kMostEquations)
    text += fmt::format("<p class='note'>and {} more.</p>\n", 2 * n - kMostEquations);
  return text;
}

std::string number_cell(double value) { return runtime::number_text(value); }

std::string values_table(const ReportContent& content) {
  const Model& model = content.plugin->model;
  std::string rows;
  const auto row = [&rows](const std::string& name, const Rational& value, const std::string& unit,
                           const std::string& comment) {
    rows += fmt::format(
        "<tr><td class='name'>{}</td><td class='number'>{}</td><td>{}</td><td>{}</td></tr>\n",
        inline_formula(element_markup(name)), number_cell(to_double(value)), html_text(unit),
        html_text(comment));
  };
  std::size_t at = 0;
  std::size_t shown = 0;
  const auto rows_of = [&](const auto& declared, const std::vector<Rational>& values) {
    at = 0;
    for (const auto& each : declared) {
      const std::size_t count = each.range ? static_cast<std::size_t>(each.range->size()) : 1;
      for (std::size_t i = 0; i < count; ++i, ++at) {
        if (++shown > kMostValues) continue;
        const std::string name =
            each.range ? fmt::format("{}[{}]", each.name, each.range->first + static_cast<long>(i))
                       : each.name;
        row(name, values[at], each.unit, each.comment);
      }
    }
  };
  rows_of(model.parameters, content.scene->parameters);
  rows_of(model.coordinates, content.scene->q);
  rows_of(model.momenta, content.scene->p);
  std::string text =
      "<div class='wide'><table><tr><th></th><th class='number'>value</th><th>unit</th>"
      "<th></th></tr>\n" +
      rows + "</table></div>\n";
  if (shown > kMostValues)
    text += fmt::format("<p class='note'>and {} more.</p>\n", shown - kMostValues);
  return text;
}

std::string system_section(const ReportContent& content) {
  const Model& model = content.plugin->model;
  std::string text = "<h2>The system</h2>\n";
  text += formula("<mi>H</mi><mo>=</mo>" + math_markup(model.hamiltonian));
  for (const Definition& definition : model.definitions)
    text += formula("<mtext>with&#xa0;</mtext>" + math_name(definition.name) + "<mo>=</mo>" +
                    math_markup(definition.value));
  text += equations_of_motion(*content.mechanics);
  for (const Invariant& invariant : model.invariants)
    text += formula("<mtext>invariant&#xa0;</mtext>" + math_name(invariant.name) + "<mo>=</mo>" +
                    math_markup(invariant.value));
  const std::string scene =
      content.scene->name.empty() ? "Initial data" : "Scene " + html_text(content.scene->name);
  return text +
         fmt::format("<h2>{}</h2>\n<p>Step size {}, {} steps.</p>\n", scene,
                     number_cell(to_double(*content.scene->h)), *content.scene->steps) +
         values_table(content);
}

std::string findings_table(const Proof& proof) {
  std::string text = "<div class='wide'><table>\n";
  for (const Finding& finding : proof) {
    const bool proved = finding.verdict == Verdict::proved;
    const bool refuted = finding.verdict == Verdict::refuted;
    text += fmt::format("<tr><td>{}</td><td class='{}'>{}</td><td>{}</td></tr>\n",
                        html_text(finding.property),
                        proved    ? "proved"
                        : refuted ? "refuted"
                                  : "open",
                        to_text(finding.verdict), html_text(finding.detail));
  }
  return text + "</table></div>\n";
}

std::string proof_section(const ReportContent& content) {
  std::string text = "<h2>What is proved</h2>\n" + findings_table(content.proof);
  if (!content.linear.empty())
    text += "<h2>Linear stability</h2>\n" + findings_table(content.linear);
  return text;
}

// Ht term by term, and a table of how constant it is with more and more of them.
std::string modified_section(const ReportContent& content) {
  if (!content.modified) return "";
  const ModifiedEnergy& modified = *content.modified;
  const std::string tilde = "<mover><mi>H</mi><mo>~</mo></mover>";
  std::string text =
      "<h2>The modified Hamiltonian</h2>\n<p>What the step conserves instead of H, as a formal "
      "series in h.</p>\n";
  std::string sum;
  std::string terms;
  for (const std::size_t power : modified.powers()) {
    const std::size_t length = to_text(modified.terms[power]).size();
    const std::string name = fmt::format("<msub><mi>H</mi><mn>{}</mn></msub>", power);
    sum += power == 0 ? std::string("<mi>H</mi>")
                      : fmt::format("<mo>+</mo><msup><mi>h</mi><mn>{}</mn></msup>{}", power, name);
    if (power == 0) continue;
    terms += length > kLongestFormula
                 ? fmt::format(
                       "<p class='note'>{} has {} characters: hamgen verify --terms prints "
                       "it.</p>\n",
                       inline_formula(name), length)
                 : formula(name + "<mo>=</mo>" + math_markup(modified.terms[power]));
  }
  text += formula(tilde + "<mo>=</mo>" + sum + "<mo>+</mo><mo>…</mo>") + terms;
  if (!modified.orbit) return text;
  std::vector<double> variations;
  for (const std::size_t power : modified.powers())
    variations.push_back(modified.orbit->variations[power]);
  const bool falls =
      variations.size() > 1 &&
      std::ranges::adjacent_find(variations, std::less_equal<>()) == variations.end();
  const char* const finding =
      variations.size() < 2 || variations.back() < 1e-30 ? ""
      : falls
          ? ": each further term takes the variation down"
          : ": further terms do not take the variation down, h is too large for the series here";
  text += fmt::format(
      "<p>Along the orbit, {} steps of {} in quad precision{}:</p>\n<div "
      "class='wide'><table>\n<tr><th>terms to</th>"
      "<th class='number'>max |H̃ − H̃(0)|</th></tr>\n",
      modified.orbit->steps, number_cell(modified.orbit->h), finding);
  for (const std::size_t power : modified.powers())
    text += fmt::format("<tr><td>h<sup>{}</sup></td><td class='number'>{:.3e}</td></tr>\n", power,
                        modified.orbit->variations[power]);
  return text + "</table></div>\n";
}

std::string figures_section(const ReportContent& content) {
  std::string text = "<h2>What it does</h2>\n";
  const OrbitSummary& orbit = content.orbit;
  if (orbit.outcome != "done")
    text +=
        fmt::format("<p class='refuted'>The run ended early: {}.</p>\n", html_text(orbit.outcome));
  if (orbit.run.energy)
    text += fmt::format(
        "<p>{} steps: max |H − H(0)| = {:.3g}, spread {:.3g}, H(0) = {}.</p>\n",
        orbit.run.steps_done, orbit.run.energy->max_error(), orbit.run.energy->spread(),
        orbit.scalar_digits > 53 ? wide_text(orbit.run.energy->initial, orbit.scalar_digits)
                                 : fmt::format("{:.10g}", orbit.run.energy->initial.hi));
  text += "<div class='figures'>\n";
  for (const ReportPicture& picture : content.pictures) {
    const std::string image =
        picture.svg.empty() ? "<p class='note'>No picture: gnuplot is missing.</p>"
                            : fmt::format(
                                  "<p class='more'>Wider than this screen: scroll it sideways →</p>"
                                  "<div class='picture' tabindex='0'><img alt='{}' "
                                  "src='data:image/svg+xml;base64,{}'></div>",
                                  html_text(picture.caption), base64(picture.svg));
    text += fmt::format("<figure id='{}'>{}<figcaption>{}</figcaption></figure>\n", picture.name,
                        image, html_text(picture.caption));
  }
  return text + "</div>\n";
}

std::string error_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.2e}", *value) : "–";
}

std::string bench_section(const ReportContent& content) {
  const Bench& bench = *content.bench;
  const std::vector<std::size_t> front = pareto_front(bench.rows, bench.observed);
  std::string text = fmt::format(
      "<h2>Error against run time</h2>\n<p>Every method to t = {:.6g}, with the time its steps "
      "took: "
      "medians of samples taken in turn, ± the distance of their quartiles, to be compared within "
      "this page only. {}</p>\n"
      "<p class='more'>Errors are in the last columns: scroll sideways →</p>"
      "<div class='wide' tabindex='0'><table>\n<tr><th>method</th><th class='number'>h</th>"
      "<th class='number'>ns/step</th><th class='number'>µs/unit time</th>"
      "<th class='number'>±</th>"
      "<th class='number'>iterations</th><th class='number'>gradients</th><th "
      "class='number'>energy error</th>"
      "<th class='number'>state error</th></tr>\n",
      bench.time,
      bench.reference.state.empty()
          ? "There is no reference solution: " + html_text(bench.reference.failure) + "."
          : fmt::format(
                "The reference was extrapolated in quad precision; its own error is {:.0e}.",
                bench.reference.error));
  for (std::size_t i = 0; i < bench.rows.size(); ++i) {
    const BenchRow& row = bench.rows[i];
    const std::string begin =
        fmt::format("<tr{}><td class='name'>{}</td><td class='number'>{:.5g}</td>",
                    std::ranges::find(front, i) != front.end() ? " class='front'" : "",
                    html_text(bench.methods[row.method].spec), to_double(row.h));
    if (!row.ok()) {
      text += begin + "<td colspan='7'>" + html_text(row.outcome) + "</td></tr>\n";
      continue;
    }
    const BenchTime time = time_of(row);
    text += begin + fmt::format(
                        "<td class='number'>{:.0f}</td><td class='number'>{:.3g}</td>"
                        "<td class='number'>{:.0f} %</td>"
                        "<td class='number'>{:.2f}</td><td class='number'>{:.3g}</td>"
                        "<td class='number'>{}</td>"
                        "<td class='number'>{}</td></tr>\n",
                        time.nanoseconds_per_step, 1e6 * time.seconds_per_time, 100.0 * time.spread,
                        row.iterations_per_step, row.gradients_per_step,
                        error_text(row.energy_error), error_text(row.state_error));
  }
  return text + fmt::format(
                    "</table></div>\n<p class='note'>Bold: nothing else is both faster and "
                    "better in {} error.</p>\n",
                    to_text(bench.observed));
}

// What the times depend on, in one place.
std::string provenance_section(const runtime::Provenance& provenance) {
  std::string text = "<h2>Where it was measured</h2>\n<div class='wide'><table>\n";
  for (const auto& [name, value] :
       {std::pair{"machine", &provenance.machine}, std::pair{"compiler", &provenance.compiler},
        std::pair{"flags", &provenance.flags}, std::pair{"date", &provenance.date}})
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", name, html_text(*value));
  return text +
         fmt::format("<tr><td>hamgen</td><td>{}</td></tr>\n</table></div>\n", HAMGEN_VERSION);
}

// The comment at the top of the emitted header: scheme, solver, what was left out, cost.
std::string head_comment(const std::string& header) {
  std::string text;
  for (std::size_t at = 0; at < header.size() && header.compare(at, 2, "//") == 0;) {
    const std::size_t end = std::min(header.find('\n', at), header.size());
    text += header.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return text;
}

std::string code_section(const ReportContent& content) {
  const PluginSource& plugin = *content.plugin;
  std::string text =
      fmt::format("<h2>The emitted step</h2>\n<p>{}. Printed by <code>{}</code>.</p>\n",
                  html_text(plugin.solver), html_text(content.command));
  if (!plugin.left_out.empty()) {
    text += "<p>Left out, because this step does not need it:</p>\n<ul>\n";
    for (const std::string& item : plugin.left_out) text += "<li>" + html_text(item) + "</li>\n";
    text += "</ul>\n";
  }
  text += "<pre>" + html_text(head_comment(plugin.header.text)) + "</pre>\n";
  return text + "<details><summary>The whole header</summary><pre>" +
         html_text(plugin.header.text) + "</pre></details>\n";
}

}  // namespace

std::string report_page(const ReportContent& content) {
  const Model& model = content.plugin->model;
  return fmt::format(
             "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
             "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
             "<title>{0}: {1}</title>\n<style>{2}</style>\n</head>\n<body>\n<main>\n"
             "<h1>{0}</h1>\n<p class='lead'>{1}, made by hamgen {3} from <code>{4}</code></p>\n",
             html_text(model.name), html_text(content.plugin->scheme_name), kReportStyle,
             HAMGEN_VERSION, html_text(model.source.path)) +
         introduction(model) + system_section(content) + proof_section(content) +
         modified_section(content) + figures_section(content) + bench_section(content) +
         code_section(content) + provenance_section(content.bench->provenance) +
         "</main>\n</body>\n</html>\n";
}

}  // namespace hamgen::app
