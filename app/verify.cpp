// hamgen verify: what algebra proves of the step, one line a property.
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/terminal.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

int verify(const MethodOptions& options, bool json) {
  const SourceText source = read_model_source(options);
  const Proof proof = verify_step(source, request_with_sizes(options, source));
  bool holds = true;
  auto rows = nlohmann::ordered_json::array();
  for (const Finding& finding : proof) {
    rows.push_back({{"property", finding.property},
                    {"verdict", to_text(finding.verdict)},
                    {"detail", finding.detail}});
    const bool required = finding.property == "symplectic" || finding.property == "emitted code";
    if (required && finding.verdict == Verdict::refuted) holds = false;
  }
  print(json ? rows.dump(2) + "\n" : to_text(proof));
  return holds ? done : proof_failed;
}

}  // namespace

Command add_verify(CLI::App& app) {
  const auto options = std::make_shared<MethodOptions>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* parser = app.add_subcommand(
      "verify", "proves what it can of the step by algebra: symplectic, symmetric, invariants");
  add_method_options(*parser, *options);
  add_repeated(*parser, "--set", options->set, "another value for a size of the model")
      ->type_name("SIZE=N");
  parser->add_flag("--json", *json, "the findings as JSON");
  return {parser, [options, json] { return verify(*options, *json); }};
}

}  // namespace hamgen::app
