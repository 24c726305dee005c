#include "app/output/chaos_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/json_document.hpp"
#include "app/output/kept_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

using ChaosJson = nlohmann::ordered_json;

std::string head_of(const ChaosTitle& title) {
  return fmt::format("{}{}\n  scheme     {}, h = {:.10g}\n", title.model,
                     title.scene.empty() ? "" : ", scene " + title.scene, title.scheme, title.h);
}

ChaosJson json_of(const ChaosSample& sample) {
  return {{"t", sample.time},  {"lyapunov", sample.lyapunov}, {"megno", sample.megno},
          {"fli", sample.fli}, {"sali", sample.sali},         {"gali", sample.gali}};
}

// Is the unit of time about that of the motion?  Steps are some hundredths of it; else ln t is the
// logarithm of a number that has nothing to do with the orbit.
bool has_unit_of_motion(const ChaosTitle& title) {
  const double h = std::abs(title.h);
  return 1e-4 < h && h < 10.0;
}

// Numbers of one size are the easier to compare without exponents.
std::string frequency_text(double frequency, double largest) {
  const bool plain = 1e-3 < largest && largest < 1e6;
  return plain ? fmt::format("{:+.12f}", frequency) : fmt::format("{:+.12e}", frequency);
}

}  // namespace

std::string chaos_text(const Chaos& chaos, const ChaosTitle& title) {
  std::string text = head_of(title);
  if (chaos.samples.empty())
    return text + fmt::format("  ended      {} at the first step\n", to_text(chaos.status));
  const ChaosSample& end = chaos.samples.back();
  text += fmt::format("  time       {:.6g}, {} steps, energy kept to {}\n", end.time, chaos.steps,
                      kept_text(chaos.largest_energy_error, chaos.energy_scale));
  if (chaos.status != runtime::Status::done)
    text += fmt::format("  ended      {} before all steps were done\n", to_text(chaos.status));
  const double logarithm = std::log(std::abs(end.time));
  const bool knows_regular = has_unit_of_motion(title) && logarithm > 1.0;
  text += fmt::format("  lyapunov   {:.5g}", end.lyapunov);
  if (knows_regular)
    text +=
        fmt::format(" (on a regular orbit about ln(t)/t = {:.1e})", logarithm / std::abs(end.time));
  text += fmt::format(
      "\n  MEGNO      {:.5g} (regular 2, isochronous 0, chaotic lyapunov t/2 = {:.3g})\n",
      end.megno, 0.5 * end.lyapunov * std::abs(end.time));
  text += fmt::format("  FLI        {:.5g}", end.fli);
  if (knows_regular) text += fmt::format(" (on a regular orbit about ln t = {:.3g})", logarithm);
  text += fmt::format("\n  SALI       {:.3g} (chaotic: to 0 as exp(-(l1 - l2) t))\n", end.sali);
  text += fmt::format("  GALI_{}     {:.3g}\n", chaos.deviations, end.gali);
  if (!chaos.spectrum.empty()) {
    text += "  spectrum  ";
    for (const double exponent : chaos.spectrum) text += fmt::format(" {:.5g}", exponent);
    text += "\n";
  }
  return text;
}

std::string frequencies_text(const std::vector<DegreeFrequencies>& degrees,
                             const ChaosTitle& title) {
  std::string text;
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    const DegreeFrequencies& degree = degrees[i];
    text += fmt::format("  frequencies of {}", title.coordinates[i]);
    if (degree.change)
      text += fmt::format(" (change from the first part of the time to the last {:.1e})\n",
                          *degree.change);
    else
      text += ": so few steps have none\n";
    double largest = 0.0;
    for (const Harmonic& harmonic : degrees[i].harmonics)
      largest = std::max(largest, std::abs(harmonic.frequency));
    for (const Harmonic& harmonic : degrees[i].harmonics)
      text += fmt::format("    {}  amplitude {:.4e}\n", frequency_text(harmonic.frequency, largest),
                          std::abs(harmonic.amplitude));
  }
  return text;
}

std::string chaos_csv(const Chaos& chaos, const std::vector<DegreeFrequencies>& degrees,
                      const ChaosTitle& title) {
  using runtime::number_text;
  std::string text =
      fmt::format("# made by   hamgen " HAMGEN_VERSION "\n# model     {}\n# scheme    {}, h = {}\n",
                  title.model, title.scheme, number_text(title.h));
  if (!chaos.spectrum.empty()) {
    text += "# spectrum ";
    for (const double exponent : chaos.spectrum) text += " " + number_text(exponent);
    text += "\n";
  }
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    for (const Harmonic& each : degrees[i].harmonics)
      text += fmt::format("# frequency of {}: {}, amplitude {}\n", title.coordinates[i],
                          number_text(each.frequency), number_text(std::abs(each.amplitude)));
  }
  text += fmt::format("t,lyapunov,megno,fli,sali,gali_{}\n", chaos.deviations);
  for (const ChaosSample& s : chaos.samples)
    text += fmt::format("{},{},{},{},{},{}\n", number_text(s.time), number_text(s.lyapunov),
                        number_text(s.megno), number_text(s.fli), number_text(s.sali),
                        number_text(s.gali));
  return text;
}

std::string chaos_json(const Chaos& chaos, const std::vector<DegreeFrequencies>& degrees,
                       const ChaosTitle& title) {
  ChaosJson samples = ChaosJson::array();
  for (const ChaosSample& sample : chaos.samples) samples.push_back(json_of(sample));
  ChaosJson frequencies = ChaosJson::object();
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    ChaosJson harmonics = ChaosJson::array();
    for (const Harmonic& each : degrees[i].harmonics)
      harmonics.push_back({{"frequency", each.frequency},
                           {"amplitude", std::abs(each.amplitude)},
                           {"phase", std::arg(each.amplitude)}});
    const ChaosJson change = degrees[i].change ? ChaosJson(*degrees[i].change) : ChaosJson();
    frequencies[title.coordinates[i]] = {{"harmonics", harmonics}, {"change", change}};
  }
  return json_document({{"model", title.model},
                        {"scene", title.scene},
                        {"scheme", title.scheme},
                        {"h", title.h},
                        {"status", to_text(chaos.status)},
                        {"steps", chaos.steps},
                        {"max_energy_error", chaos.largest_energy_error},
                        {"energy_scale", chaos.energy_scale},
                        {"deviations", chaos.deviations},
                        {"spectrum", chaos.spectrum},
                        {"frequencies", frequencies},
                        {"samples", samples}});
}

Plot chaos_plot(const Chaos& chaos, const ChaosTitle& title) {
  PlotSeries exponent{.label = "", .points = {}, .style = PlotStyle::lines};
  PlotSeries megno{.label = "", .points = {}, .style = PlotStyle::lines};
  for (const ChaosSample& s : chaos.samples) {
    exponent.points.push_back({std::abs(s.time), s.lyapunov});
    megno.points.push_back({std::abs(s.time), s.megno});
  }
  return {.panels = {{.title = title.model + ": largest Lyapunov exponent",
                      .x_label = "t",
                      .y_label = "ln(|w(t)|/|w(0)|)/t",
                      .logarithmic_x = true,
                      .logarithmic_y = true,
                      .series = {exponent}},
                     {.title = "MEGNO",
                      .x_label = "t",
                      .y_label = "mean of Y",
                      .logarithmic_x = true,
                      .series = {megno}}}};
}

const std::vector<Indicator>& all_indicators() {
  static const std::vector<Indicator> list = {
      {"megno", "MEGNO", [](const ChaosSample& s) { return s.megno; }},
      {"lyapunov", "largest Lyapunov exponent", [](const ChaosSample& s) { return s.lyapunov; }},
      {"fli", "FLI", [](const ChaosSample& s) { return s.fli; }},
      {"sali", "log10 SALI",
       [](const ChaosSample& s) { return std::log10(std::max(s.sali, 1e-16)); }},
  };
  return list;
}

}  // namespace hamgen::app
