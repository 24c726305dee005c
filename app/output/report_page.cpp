#include "app/output/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "app/output/math_font.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_parts.hpp"
#include "app/output/report_style.hpp"
#include "app/output/wide_text.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

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

std::string image_source(const std::string& svg) {
  return "data:image/svg+xml;base64," + base64(svg);
}

std::string figure_markup(const ReportPicture& picture) {
  std::string image = "<p class='note'>No picture: gnuplot is missing.</p>";
  if (!picture.svg.empty()) {
    const std::string narrow = picture.narrow_svg.empty()
                                   ? ""
                                   : fmt::format("<source media='(max-width: 44rem)' srcset='{}'>",
                                                 image_source(picture.narrow_svg));
    image = fmt::format("<picture>{}<img alt='{}' src='{}'></picture>", narrow,
                        html_text(picture.caption), image_source(picture.svg));
  }
  return fmt::format("<figure id='{}'{}>{}<figcaption>{}</figcaption></figure>\n", picture.name,
                     picture.large ? " class='large'" : "", image, html_text(picture.caption));
}

std::string bench_section(const ReportContent& content) {
  const Bench& bench = *content.bench;
  std::string text = "<h2>Error against run time</h2>\n";
  if (!content.pictures.empty()) text += figure_markup(content.pictures.front());
  text += fmt::format(
      "<p>Every method to {}, with the processor time its steps took: medians of samples taken "
      "in turn, to be compared within this page only. {}</p>\n",
      named_value("t", bench.time, 6),
      bench.reference.state.empty()
          ? "There is no reference solution: " + html_text(bench.reference.failure) + "."
          : fmt::format("The reference was extrapolated in quad precision; its own error is {}.",
                        html_number(bench.reference.error, 1)));
  text += ladder_table(content);
  return text + folded("All " + counted(bench.rows.size(), "measurement", "measurements"),
                       bench_table(bench));
}

MathFormula size_of(const MathFormula& formula) { return call_of("abs", {formula}); }

// The energies whose largest is the scale: |H|, |p H_p|/2, |H - p H_p/2|, |q H_q|/2.
std::string scale_text() {
  const MathFormula h = math_symbol("H");
  const MathFormula two = math_number("2");
  const auto work = [&](const char* name) {
    const MathFormula variable = math_symbol(name);
    return product_of(variable, with_subscript("H", variable));
  };
  return fmt::format("{}, {}, {} and {}", inline_formula(size_of(h)),
                     inline_formula(quotient_of(size_of(work("p")), two)),
                     inline_formula(size_of(difference_of(h, quotient_of(work("p"), two)))),
                     inline_formula(quotient_of(size_of(work("q")), two)));
}

std::string energy_sentence(const OrbitSummary& orbit) {
  if (!orbit.run.energy) return "";
  const runtime::EnergyStatistics& energy = *orbit.run.energy;
  const double scale = orbit.run.energy_terms;
  const MathFormula h = math_symbol("H");
  const MathFormula start = call_of("H", {math_number("0")});
  const std::string relative =
      scale > 0.0 ? fmt::format(", {} of the energy's scale {}",
                                html_number(energy.max_error() / scale, 3), html_number(scale, 3))
                  : "";
  const MathFormula initial = orbit.scalar_digits > 53
                                  ? math_number(wide_text(energy.initial, orbit.scalar_digits))
                                  : math_value(energy.initial.hi, 10);
  return fmt::format(
      "<p>{} steps: {} reaches {}{}; its spread is {}, {}. The scale is the largest of {} at the "
      "start: of a mechanical system its kinetic and its potential energy and half its "
      "virial.</p>\n",
      orbit.run.steps_done, inline_formula(size_of(difference_of(h, start))),
      html_number(energy.max_error(), 3), relative, html_number(energy.spread(), 3),
      inline_equation(start, initial), scale_text());
}

std::string figures_section(const ReportContent& content) {
  std::string text = "<h2>What it does</h2>\n";
  if (content.orbit.outcome != "done")
    text += fmt::format("<p class='refuted'>The run ended early: {}.</p>\n",
                        html_text(content.orbit.outcome));
  text += energy_sentence(content.orbit) + "<div class='figures'>\n";
  for (std::size_t i = 1; i < content.pictures.size(); ++i)
    text += figure_markup(content.pictures[i]);
  return text + "</div>\n";
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

// "simplified Newton of size 2" begins a sentence.
std::string capitalised(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(text.front()));
  return text;
}

std::string code_section(const ReportContent& content) {
  std::string left_out;
  for (const std::string& item : content.plugin->left_out)
    left_out += "<li>" + html_text(greek_text(item)) + "</li>\n";
  if (!left_out.empty()) left_out = folded("What it does without", "<ul>\n" + left_out + "</ul>\n");
  return fmt::format("<h2>The emitted step</h2>\n<p>{}. Printed by {}</p>\n",
                     html_text(capitalised(content.plugin->solver)),
                     command_markup(content.command)) +
         left_out +
         folded("Its first lines", "<pre>" + html_text(head_comment(content.header)) + "</pre>\n") +
         folded("The whole header", "<pre>" + html_text(content.header) + "</pre>\n");
}

// What the times depend on, in one place.
std::string provenance_section(const runtime::Provenance& provenance) {
  std::string text = "<footer>\n<h2>Where it was measured</h2>\n<dl>\n";
  for (const auto& [name, value] :
       {std::pair{"machine", &provenance.machine}, std::pair{"compiler", &provenance.compiler},
        std::pair{"flags", &provenance.flags}, std::pair{"date", &provenance.date}})
    text += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html_text(*value));
  return text +
         fmt::format("<div><dt>hamgen</dt><dd>{}</dd></div>\n</dl>\n</footer>\n", HAMGEN_VERSION);
}

}  // namespace

std::string formula_line(const std::string& left, const MathFormula& right) {
  std::string text = "<div class='formula'>";
  bool is_first = true;
  for (const std::string& piece : math_pieces(right)) {
    text += fmt::format("{}<math displaystyle='true'><mrow>{}{}</mrow></math>",
                        is_first ? "" : "<wbr>",  // the sign has its own room

                        is_first ? left + "<mo>=</mo>" : "", piece);
    is_first = false;
  }
  return text + "</div>\n";
}

std::string inline_formula(const std::string& markup) { return "<math>" + markup + "</math>"; }

std::string inline_formula(const MathFormula& formula) {
  return inline_formula("<mrow>" + line_markup(formula) + "</mrow>");
}

std::string inline_equation(const MathFormula& left, const MathFormula& right) {
  return inline_formula(
      fmt::format("<mrow>{}<mo>=</mo>{}</mrow>", line_markup(left), line_markup(right)));
}

std::string named_value(std::string_view name, double value, int digits) {
  return inline_equation(math_symbol(name), math_value(value, digits));
}

std::string command_markup(const std::string& command) {
  std::string words;
  for (std::size_t at = 0; at <= command.size();) {
    const std::size_t end = std::min(command.find(' ', at), command.size());
    words += fmt::format("{}<span>{}</span>", at == 0 ? "" : " ",
                         html_text(command.substr(at, end - at)));
    at = end + 1;
  }
  return "<code class='command'>" + words + "</code>";
}

std::string folded(const std::string& summary, const std::string& inside) {
  return "<details><summary>" + summary + "</summary>\n" + inside + "</details>\n";
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string report_page(const ReportContent& content) {
  const Model& model = content.plugin->model;
  return fmt::format(
             "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
             "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
             "<title>{0}: {1}</title>\n<style>{2}{3}</style>\n</head>\n<body>\n<main>\n"
             "<header><h1>{0}</h1>\n<p class='origin'><code>{4}</code>, hamgen {5}</p>\n",
             html_text(model.name), html_text(content.plugin->scheme_name), math_font_style(),
             kReportStyle, html_text(content.file), HAMGEN_VERSION) +
         introduction(model) + "</header>\n" + report_answers(content) + bench_section(content) +
         system_section(content) + figures_section(content) + proof_section(content) +
         modified_section(content) + code_section(content) +
         provenance_section(content.bench->provenance) + "</main>\n</body>\n</html>\n";
}

}  // namespace hamgen::app
