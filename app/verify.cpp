// hamgen verify: what algebra proves of the step, one line a property.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/certificate_json.hpp"
#include "app/output/json_document.hpp"
#include "app/output/modified_output.hpp"
#include "app/output/output_name.hpp"
#include "app/output/patience.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/measure.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/verify/model_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/sha256.hpp"

namespace hamgen::app {
namespace {

struct VerifyOptions {
  MethodOptions method;
  std::string terms;  // K of the modified Hamiltonian; empty: nothing is asked for
  bool latex = false;
  SceneOptions scene;  // where the step is measured and the linear part is taken
  std::string required;
  bool measure = false;
  bool json = false;
  bool quiet = false;
  std::string emitted;      // a file; empty: the one that would be written
  std::string format;       // in this format
  std::string certificate;  // a file to write
};

nlohmann::ordered_json json_of(const LinearPoint& point) {
  const LinearStability& found = point.stability;
  const auto number = [](const std::optional<double>& x) {
    return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json(nullptr);
  };
  auto intervals = nlohmann::ordered_json::array();
  for (const auto& [from, to] : found.bounded_steps) {
    const bool ends = std::isfinite(to);
    intervals.push_back(
        {from, ends ? nlohmann::ordered_json(to) : nlohmann::ordered_json(nullptr)});
  }
  nlohmann::ordered_json resonant = nlohmann::ordered_json::object();
  for (const auto& [m, h] : found.resonant_h) resonant[std::to_string(m)] = h;
  return {{"property", "linear stability"},
          {"place", point.place},
          {"verdict", to_text(found.verdict)},
          {"h", found.h},
          {"frequencies", found.frequencies},
          {"free_motions", found.free_motions},
          {"growing", found.growing},
          {"jordan_block", found.resonant},
          {"growth_rate", found.growth_rate},
          {"margin", number(found.margin)},
          {"bounded_for_every_h", found.bounded_for_every_h},
          {"largest_h", number(found.largest_h)},
          {"bounded_steps", intervals},
          {"angles", found.angles},
          {"resonant_h", resonant},
          {"iteration_radius", number(found.iteration_radius)}};
}

// Of the scene's state, or of the first scene if none is named.  A reason where there is none.
std::vector<LinearPoint> linear_part(const Setting& setting, const SceneValues& scene,
                                     Proof& proof) {
  const auto open = [&proof](const std::string& why) {
    proof.push_back({"linear stability", Verdict::not_decided, why});
    return std::vector<LinearPoint>{};
  };
  if (setting.request.solver->kind == SolverWish::Kind::sweeps)
    return open("sweeps leave the step unsolved: the linear step is another");
  if (!scene.h) return open("there is no scene with a step size and no --h");
  std::vector<LinearPoint> points = linear_points(setting.source, setting.request, scene);
  if (points.empty()) return open("H'' is not defined at the initial state, or is too large");
  for (const LinearPoint& point : points) {
    for (Finding& finding : findings(point)) proof.push_back(std::move(finding));
  }
  return points;
}

// Below what is proved of the same name.
void add_beside(Proof& proof, const Finding& measured) {
  const std::string name = measured.property.substr(0, measured.property.find(' '));
  const auto last = std::find_if(proof.rbegin(), proof.rend(), [&name](const Finding& f) {
    return f.property.starts_with(name + " ");
  });
  proof.insert(last.base(), measured);  // at the end if nothing is said of it
}

// Without a scene by name only the terms.
ModifiedEnergy modified_energy(const Setting& setting, const VerifyOptions& options) {
  const int count = modified_term_count("--terms", options.terms);
  ModifiedEnergy modified;
  modified.terms = modified_hamiltonian(setting.source, setting.request, count);
  if (!options.scene.scene.empty())
    modified.orbit = watch_orbit(setting.source, setting.request,
                                 complete_scene(setting.model, setting.scene, ""), modified.terms,
                                 &interrupt_flag());
  return modified;
}

// The run that is looked at, of 1000 steps where nobody says how many.
Setting verify_setting(const VerifyOptions& options) {
  Setting setting = read_setting(options.method, options.scene);
  const SceneValues scene = scene_values(setting.model, setting.scene);
  if (!scene.steps) setting.scene.steps = "1000";
  take_gauge_at(scene, setting.model, setting.request);
  if (!options.scene.scene.empty())
    specialise(options.scene, scene, {}, Observing::as_the_scene, setting);
  setting.request.tangent = options.measure;  // then it is read back as well
  if (!options.format.empty())
    setting.request.format = std::string(find_format(options.format).name);
  return setting;
}

constexpr const char* kCommandLead = "//   command   ";
constexpr const char* kDigestLead = "//   sha256    ";

// The word behind `option` in the command that the header says it was made with.
std::string option_of_header(const std::string& text, const std::string& option) {
  const std::size_t begin = text.find(kCommandLead);
  if (begin == std::string::npos) return {};
  std::istringstream words(text.substr(begin, text.find('\n', begin) - begin));
  for (std::string word; words >> word;) {
    if (word != option) continue;
    std::string value;
    words >> value;
    return value.empty() ? "set" : value;
  }
  return {};
}

// The header that is named, and what it emits besides the step.
std::optional<EmittedHeader> read_header(const std::string& path, Request& request) {
  if (path.empty()) return {};
  EmittedHeader header{.path = path, .text = read_source(path).text};
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const char* name : kSupportFiles) {
    const std::filesystem::path beside = folder / name;
    if (std::filesystem::exists(beside)) header.beside[name] = read_source(beside.string()).text;
  }
  if (!option_of_header(header.text, "--tangent").empty()) request.tangent = true;
  if (!option_of_header(header.text, "--events").empty()) request.events = true;
  const std::string modified = option_of_header(header.text, "--watch-modified");
  if (!modified.empty()) request.watch_modified = modified_term_count("--watch-modified", modified);
  const std::string lanes = option_of_header(header.text, "--batch");
  if (!lanes.empty()) request.batch = static_cast<int>(integer_value("--batch", lanes, 1));
  const std::string math = option_of_header(header.text, "--math");
  if (!math.empty()) request.math = math;
  return header;
}

// What would be the options of a header that is another step.
void propose_command(const Proof& proof, const EmittedHeader& header) {
  const auto found = std::ranges::find(proof, kEmittedCode, &Finding::property);
  const std::size_t begin = header.text.find(kCommandLead);
  if (found == proof.end() || found->verdict != Verdict::refuted || begin == std::string::npos)
    return;
  const std::size_t at = begin + std::string(kCommandLead).size();
  print_error(fmt::format("help: {} says that it was made by: {}\n", header.path,
                          header.text.substr(at, header.text.find('\n', at) - at)));
}

// Only of what holds, and of a header that is there.
void write_certificate(const VerifyOptions& options, const Setting& setting,
                       const EmittedHeader& header, const Proof& proof) {
  for (const char* property : {"symplectic", kProgram, kEmittedCode, kModelRead}) {
    const auto found = std::ranges::find(proof, property, &Finding::property);
    if (found != proof.end() && hamgen::holds(found->verdict)) continue;
    throw ProofError(fmt::format("--certificate: '{}' is {}", property,
                                 found == proof.end() ? "not looked at" : to_text(found->verdict)));
  }
  // As the checker asks: the proof says nothing of what is remarked.
  const std::string digest = kDigestLead + runtime::sha256_hex(setting.source.text);
  if (header.text.find("\n" + digest + "\n") == std::string::npos)
    throw ProofError(fmt::format(
        "--certificate: {} has not the digest of {} in its first lines: it was made from another "
        "text\nhelp: make it anew, hamgen generate, and certify that",
        header.path, setting.source.path));
  const ProofCertificate certificate = certificate_of(setting.source, setting.request, proof);
  std::map<std::string, long> sizes;
  for (const Size& size : setting.model.sizes) sizes[size.name] = size.value;
  const std::string name = std::filesystem::path(header.path).filename().string();
  runtime::atomic_write(
      options.certificate,
      certificate_json(certificate, sizes, setting.source.text, name, header.text));
}

bool is_refuted(const Finding& finding) { return finding.verdict == Verdict::refuted; }

int verify(const VerifyOptions& options) {
  const Requirements required = Requirements::read(options.required);
  if (options.latex && options.terms.empty())
    throw UsageError("--latex prints the terms of the modified Hamiltonian: add --terms K");
  if (!options.certificate.empty() && options.emitted.empty())
    throw UsageError(
        "--certificate: it has the digest of a header\nhelp: write one with `hamgen generate -o "
        "DIRECTORY`, and add --emitted FILE");
  if (!options.format.empty() && !options.emitted.empty())
    throw UsageError(
        fmt::format("--format {}: of a text that would be written, and --emitted reads one that is "
                    "there\nhelp: leave out one of them",
                    options.format));
  require_apart("--certificate", options.certificate, options.method.model, "the model");
  require_apart("--certificate", options.certificate, options.emitted, "the header of --emitted");
  Setting setting = verify_setting(options);
  const std::optional<EmittedHeader> header = read_header(options.emitted, setting.request);
  const SceneValues scene = scene_values(setting.model, setting.scene);
  Proof proof;
  {
    const Patience patience(say_that_proofs_take_long);
    proof = verify_step(setting.source, setting.request, scene, header);
  }
  std::vector<InvariantDefect> defects;
  bool holds = true;
  if (options.measure) {
    const bool symmetric = std::ranges::any_of(proof, [](const Finding& f) {
      return f.property == "symmetric" && hamgen::holds(f.verdict);
    });
    Request alone = setting.request;  // a lane is the trajectory alone, bit for bit
    alone.batch = 0;
    alone.math = {};
    Measured measured = measure(setting.source, alone, setting.scene, symmetric, &interrupt_flag());
    holds = std::ranges::none_of(measured.proof, is_refuted);
    std::ranges::move(measured.proof, std::back_inserter(proof));
    for (const InvariantDefect& defect : measured.invariants) add_beside(proof, finding(defect));
    defects = std::move(measured.invariants);
  }
  const std::vector<LinearPoint> linear = linear_part(setting, scene, proof);
  const bool by_default = options.required.empty();
  auto rows = nlohmann::ordered_json::array();
  for (const Finding& finding : proof) {
    rows.push_back({{"property", finding.property},
                    {"verdict", to_text(finding.verdict)},
                    {"detail", finding.plain()}});
    for (const InvariantDefect& defect : defects) {
      if (finding.property == defect.name + " measured")
        rows.back().update(
            {{"initial", defect.initial}, {"defect", defect.largest}, {"steps", defect.steps}});
    }
    const bool of_text = finding.property == kEmittedCode || finding.property == kPlugin;
    const bool of_code = of_text || finding.property == kProgram ||
                         finding.property == kModelRead || finding.property == "specialised";
    if (of_code && is_refuted(finding)) holds = false;
    // What is emitted can be read.
    const bool unread = finding.detail.find("not understood") != std::string::npos;
    if (of_text && unread) holds = false;
    if (by_default && finding.property == "symplectic" && !hamgen::holds(finding.verdict))
      holds = false;
  }
  for (const LinearPoint& point : linear) rows.push_back(json_of(point));
  std::string text = to_text(proof);
  if (!options.terms.empty()) {
    const ModifiedEnergy modified = modified_energy(setting, options);
    if (interrupt_flag()) {
      print_error("hamgen: stopped; nothing is printed\n");
      return interrupted;
    }
    rows.push_back(modified_json(modified, options.latex));
    text += modified_text(modified, options.latex);
  }
  if (options.json) {
    print(json_document(rows));
  } else if (!options.quiet) {
    print(text);
  } else {
    Proof refuted;
    std::ranges::copy_if(proof, std::back_inserter(refuted), is_refuted);
    if (!refuted.empty()) print(to_text(refuted));
  }
  if (header) propose_command(proof, *header);
  require(proof, required);
  if (!options.certificate.empty()) write_certificate(options, setting, *header, proof);
  return holds ? done : proof_failed;
}

}  // namespace

Command add_verify(CLI::App& app) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* parser = app.add_subcommand(
      "verify", "proves what it can of the step by algebra: symplectic, symmetric, invariants");
  add_method_options(*parser, options->method);
  parser->add_option("--terms", options->terms, "")->type_name("K");
  parser->add_flag("--latex", options->latex,
                   "print K terms of the modified Hamiltonian, as LaTeX");
  add_scene_options(*parser, options->scene);
  add_observe_option(*parser, options->scene);
  parser->add_option("--h", options->scene.h, "")->type_name("H");
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser->add_option("--steps", options->scene.steps, "of the run that is looked at; the scene's")
      ->type_name("N");
  parser->add_option("--emitted", options->emitted, "")->type_name("FILE");
  parser->add_option("--format", options->format, "read this file, or a text of this format, back")
      ->type_name("NAME");
  parser
      ->add_option("--certificate", options->certificate,
                   "write a certificate (JSON) of the file that is read back")
      ->type_name("FILE");
  parser->add_flag("--measure", options->measure, "compile the step and measure it too");
  parser
      ->add_option("--require", options->required,
                   "else 5: symplectic (default),symmetric,order:P,conserves:NAME")
      ->type_name("LIST");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the findings as JSON; nothing but what is refuted");
  return {parser, [options] { return verify(*options); }};
}

}  // namespace hamgen::app
