// hamgen verify: what algebra proves of the step, one line a property.
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/modified_energy.hpp"
#include "app/terminal.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

int verify(const MethodOptions& options, const ModifiedOptions& modified,
           const std::string& required, bool json) {
  const SourceText source = read_model_source(options);
  const Request request = request_with_sizes(options, source);
  const Proof proof = verify_step(source, request);
  bool holds = true;
  const bool by_default = required.empty();
  auto rows = nlohmann::ordered_json::array();
  for (const Finding& finding : proof) {
    rows.push_back({{"property", finding.property},
                    {"verdict", to_text(finding.verdict)},
                    {"detail", finding.detail}});
    const bool needed = finding.property == "emitted code" ||
                        (by_default && finding.property == "symplectic");
    if (needed && finding.verdict == Verdict::refuted) holds = false;
  }
  std::string text = to_text(proof);
  if (!modified.terms.empty()) {
    const ModifiedReport report = modified_report(source, request, modified);
    rows.push_back(report.json);
    text += report.text;
  }
  print(json ? rows.dump(2) + "\n" : text);
  require(proof, required);
  return holds ? done : proof_failed;
}

}  // namespace

Command add_verify(CLI::App& app) {
  const auto options = std::make_shared<MethodOptions>();
  const auto modified = std::make_shared<ModifiedOptions>();
  const auto required = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* parser = app.add_subcommand(
      "verify", "proves what it can of the step by algebra: symplectic, symmetric, invariants");
  add_method_options(*parser, *options);
  add_repeated(*parser, "--set", options->set, "another value for a size of the model")
      ->type_name("SIZE=N");
  parser->add_option("--terms", modified->terms, "print K terms of the modified Hamiltonian")
      ->type_name("K");
  parser->add_option("--scene", modified->scene, "measure it along this scene's orbit")
      ->type_name("NAME");
  parser->add_option("--h", modified->h, "with this step; default: the scene's")->type_name("H");
  parser->add_flag("--latex", modified->latex, "print it as LaTeX");
  parser->add_option("--require", *required,
                     "else 5: symplectic (default),symmetric,order:P,conserves:NAME")
      ->type_name("LIST");
  parser->add_flag("--json", *json, "the findings as JSON");
  return {parser, [options, modified, required, json] {
            return verify(*options, *modified, *required, *json);
          }};
}

}  // namespace hamgen::app
