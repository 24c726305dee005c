#include "app/output/generate_command.hpp"

#include <fmt/format.h>

#include <vector>

#include "generator/formats/all_formats.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {

std::string generate_command(const std::string& model, const Request& request) {
  std::vector<std::string> words = {"hamgen", "generate", model};
  // A value that begins with '-' would read as an option after a blank.
  const auto add = [&words](const std::string& option, const std::string& value) {
    if (value.empty()) return;
    if (value.front() == '-') {
      words.push_back(option + "=" + value);
    } else {
      words.push_back(option);
      words.push_back(value);
    }
  };
  add("--scheme", request.scheme.text());
  add("--alpha", request.alpha.text());
  add("--beta", request.beta.text());
  add("--gamma", request.gamma.text());
  if (request.order > 0) add("--order", std::to_string(request.order));
  add("--gauge", request.gauge.text());
  for (const auto& [name, value] : request.reference)
    add("--reference", fmt::format("{}={}", name, value));
  add("--solver", request.solver.text());
  add("--scalar", request.scalar.text());
  if (request.plain_sums) words.emplace_back("--plain-sums");
  for (const std::string& name : request.fold) add("--fold", name);
  for (const auto& [name, value] : request.sizes) add("--set", fmt::format("{}={}", name, value));
  if (request.scene) {
    const SceneFacts& scene = *request.scene;
    add("--scene", scene.values.name);
    for (const auto& [name, value] : scene.asked.set) add("--set", name + "=" + value);
    for (const auto& [name, value] : scene.asked.initial) add("--initial", name + "=" + value);
    add("--observe", scene.asked.observe.value_or(""));
    for (const std::string& name : scene.kept) add("--keep", name);
  }
  if (request.format->format != &all_formats().front())
    add("--format", request.format.text());  // the default
  add("--namespace", request.name_space);
  if (request.support->shared) add("--support", request.support.text());  // the default
  if (request.batch > 0) add("--batch", std::to_string(request.batch));
  add("--math", request.math.text());
  add("--require", request.require.text());
  if (request.tangent) words.emplace_back("--tangent");
  if (request.events) words.emplace_back("--events");
  if (request.watch_modified > 0) add("--watch-modified", std::to_string(request.watch_modified));
  return runtime::command_text(words);
}

}  // namespace hamgen::app
