#include "app/studies/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/studies/load_integrator.hpp"
#include "runtime/csv_writer.hpp"
#include "runtime/sha256.hpp"

namespace hamgen::app {

std::vector<std::string> manifest_lines(const Setting& setting, const SceneValues& scene,
                                        const PluginSource& plugin,
                                        const CompilerChoice& compiler) {
  std::vector<std::string> lines = {
      "made by   hamgen " HAMGEN_VERSION,
      fmt::format("model     {}   sha256 {}", setting.model.name,
                  runtime::sha256_hex(setting.source.text)),
      "scheme    " + plugin.scheme_name, "solver    " + plugin.solver,
      // Of the emitted text, the compiler and its flags.
      "code      sha256 " + digest_of_code(plugin, compiler),
      fmt::format("h         {}", runtime::number_text(to_double(*scene.h))),
      fmt::format("steps     {}", *scene.steps)};
  if (!scene.name.empty()) lines.push_back("scene     " + scene.name);
  for (const auto& [name, value] : setting.scene.set)
    lines.push_back(fmt::format("set       {}={}", name, value));
  for (const auto& [name, value] : setting.scene.initial)
    lines.push_back(fmt::format("initial   {}={}", name, value));
  if (setting.scene.observe) lines.push_back("observe   " + *setting.scene.observe);
  return lines;
}

std::string difference_of(const std::vector<std::string>& there,
                          const std::vector<std::string>& here) {
  std::string text;
  const auto add = [&text](const char* where, const std::vector<std::string>& lines,
                           const std::vector<std::string>& others) {
    for (const std::string& line : lines) {
      if (std::ranges::find(others, line) == others.end())
        text += fmt::format("  {:<6} {}\n", where, line);
    }
  };
  add("there", there, here);
  add("here", here, there);
  return text;
}

}  // namespace hamgen::app
