#include "app/output/generate_command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "generator/base/source_text.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {

namespace {

class Words {
 public:
  // A model that came from standard input comes from there again.
  Words(const std::string& command, const std::string& model)
      : words_{"hamgen", command, model == kStandardInput ? "-" : model} {}

  // A value that begins with '-' would read as an option after a blank.
  void add(const std::string& option, const std::string& value) {
    if (value.empty()) return;
    if (value.front() == '-') {
      words_.push_back(option + "=" + value);
    } else {
      words_.push_back(option);
      words_.push_back(value);
    }
  }
  void add_flag(const std::string& option, bool is_set) {
    if (is_set) words_.push_back(option);
  }

  // The method, the sizes and the scene.
  void add_step(const Request& request) {
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
    add_flag("--plain-sums", request.plain_sums);
    for (const std::string& name : request.fold) add("--fold", name);
    for (const auto& [name, value] : request.sizes) add("--set", fmt::format("{}={}", name, value));
    if (!request.scene) return;
    const SceneFacts& scene = *request.scene;
    add("--scene", scene.values.name);
    for (const auto& [name, value] : scene.asked.set) add("--set", name + "=" + value);
    for (const auto& [name, value] : scene.asked.initial) add("--initial", name + "=" + value);
    add("--observe", scene.asked.observe.value_or(""));
    for (const std::string& name : scene.kept) add("--keep", name);
  }

  [[nodiscard]] std::string text() const { return runtime::command_text(words_); }

 private:
  std::vector<std::string> words_;
};

// A decimal where it is short, else a fraction: a step that divides the time exactly.
std::string step_text(const Rational& h) {
  const std::string decimal = fmt::format("{:.10g}", to_double(h));
  double read = 0.0;
  std::from_chars(decimal.data(), decimal.data() + decimal.size(), read);
  return read == to_double(h) ? decimal : h.get_str();
}

}  // namespace

std::string generate_command(const std::string& model, const Request& request) {
  Words words("generate", model);
  words.add_step(request);
  if (request.format->format != Asked<FormatWish>()->format)
    words.add("--format", request.format.text());  // the default
  words.add("--namespace", request.name_space);
  if (request.support->shared) words.add("--support", request.support.text());  // the default
  if (request.batch > 0) words.add("--batch", std::to_string(request.batch));
  words.add("--math", request.math.text());
  words.add("--require", request.require.text());
  words.add_flag("--tangent", request.tangent);
  words.add_flag("--events", request.events);
  if (request.watch_modified > 0)
    words.add("--watch-modified", std::to_string(request.watch_modified));
  return words.text();
}

std::string run_command(const std::string& model, const Request& request, const Rational& h,
                        long steps) {
  Words words("run", model);
  words.add_step(request);
  words.add("--h", step_text(h));
  words.add("--steps", std::to_string(steps));
  return words.text();
}

}  // namespace hamgen::app
