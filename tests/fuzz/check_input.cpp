#include "tests/fuzz/check_input.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"

namespace hamgen::fuzz {
namespace {

void require(bool holds, const std::string& what, const std::string& about) {
  if (!holds) throw std::logic_error(what + ":\n" + about);
}

const Model& optioned_model() {
  static const Model model = read_model(make_source("optioned.ham", R"(system optioned
size N = 3
coordinate q, x[1..N]
momentum p, y[1..N]
parameter w = 2
parameter m[1..N] = [1, 2, 3]
H = p^2/2 + w*q^2/2 + sum(i = 1..N, y[i]^2/(2*m[i]))
scene s { q = 1; x[i] = i; h = 0.1; steps = 10 }
)"));
  return model;
}

// The text of what was accepted, printed and read again.
void read_back(const Model& model) {
  const std::string printed = to_text(model);
  std::string again;
  try {
    again = to_text(read_model(make_source("printed.ham", printed)));
  } catch (const ModelError& error) {
    throw std::logic_error("the text of an accepted model is refused:\n" +
                           std::string(error.what()) + "\n" + printed);
  }
  require(again == printed, "a model reads back as another", printed + "\n" + again);
}

void read_back(const NodePtr& node, const std::vector<std::string>& names) {
  const std::string printed = to_text(node);
  require(to_text(read_expression("printed", printed, names)) == printed,
          "an expression reads back as another", printed);
}

// --h and --steps have their value alone, the others NAME=VALUE.
void read_run_option(const std::string& option, const std::string& text) {
  SceneRequest request;
  if (option == "--h") request.h = text;
  if (option == "--steps") request.steps = text;
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos) {
    const std::pair setting(text.substr(0, equals), text.substr(equals + 1));
    if (option == "--set") request.set = {setting};
    if (option == "--initial") request.initial = {setting};
    if (option == "--reference") request.reference = {setting};
  }
  static_cast<void>(scene_values(optioned_model(), request));
}

void read_option(const std::string& option, const std::string& text) {
  for (const char* name : {"--alpha", "--beta", "--gamma"}) {
    if (option != name) continue;
    const std::vector<std::string> names = {"h", "E0", "w", "m[1]", "m[2]", "m[3]"};
    read_back(read_expression(option, text, names), names);
    return;
  }
  read_run_option(option, text);
}

void read(std::string_view input) {
  if (input.starts_with("--")) {
    const std::size_t blank = std::min(input.find(' '), input.size());
    read_option(std::string(input.substr(0, blank)),
                std::string(input.substr(std::min(blank + 1, input.size()))));
  } else {
    read_back(read_model(make_source("fuzz.ham", std::string(input))));
  }
}

}  // namespace

Answer check_input(std::string_view input) {
  try {
    read(input);
    return Answer::accepted;
  } catch (const ModelError& error) {
    require(!error.diagnostics().empty(), "refused without a diagnostic", error.what());
    for (const Diagnostic& each : error.diagnostics()) {
      require(!each.message.empty(), "refused without a message", error.what());
      require(each.span.begin <= each.span.end, "a span that ends before it begins", error.what());
      require(each.span.begin <= input.size() + 3, "a place outside the text", error.what());
    }
  } catch (const UsageError& error) {
    require(!std::string_view(error.what()).empty(), "refused without a message", "");
  }
  return Answer::refused;
}

}  // namespace hamgen::fuzz
