#include "generator/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/choose_sums.hpp"
#include "generator/emitted_spaces.hpp"
#include "generator/emitted_text.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/formats/cpp_header.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/modified_terms.hpp"
#include "generator/program/code_cost.hpp"
#include "generator/program/names.hpp"
#include "generator/program/without_tangent.hpp"
#include "generator/read_request.hpp"
#include "generator/stages.hpp"
#include "generator/verify/model_text.hpp"

namespace hamgen {

namespace {

std::string stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  return name.empty() ? "model" : name;
}

int lanes_of(const Request& request, const Program& program) {
  if (request.batch == 0) {
    const bool in_lanes = program.stages && program.stages->packs() > 0;
    if (!request.math.empty() && !in_lanes)
      throw UsageError(
          "--math: is of the elementary functions of a batch, and of stages that are computed at "
          "once\nhelp: add --batch 8, or take --scheme gauss-4");
    return 0;
  }
  constexpr int most = 256;  // beyond, compilers take minutes
  if (!std::has_single_bit(static_cast<unsigned>(request.batch)) || request.batch > most)
    throw UsageError(fmt::format(
        "--batch {}: not 1, 2, 4, ..., {}\nhelp: as many numbers as a register has are fastest: 8 "
        "with AVX-512, 4 with AVX2, 2 elsewhere; twice that may be, too",
        request.batch, most));
  if (request.events)
    throw UsageError(
        "--events with --batch: lanes cross at times of their own, which a batch does not look "
        "for\n"
        "help: drop one of the two");
  return request.batch;
}

EmitOptions emit_options(const SourceText& source, const Stages& stages, const Request& request) {
  const bool is_special = request.scene && is_something_left_out(stages);
  return {.file_name = stem(source.path),
          .command = request.command,
          .model_path = source.path,
          .model_digest = request.model_digest,
          .scalar = request.scalar.text(),
          .spaces = emitted_spaces(stages.equations, request,
                                   is_special ? request.scene->values.name : ""),
          .tangent = request.tangent && !without_tangent(stages.plan),
          .shared_support = request.support->shared,
          .watched_step = request.step,
          .lanes = lanes_of(request, stages.program),
          .library_functions = request.math->of_library};
}

// Throws UsageError if there is no tangent map and the request wants one.
EmitOptions options_with_tangent(const SourceText& source, const Stages& stages,
                                 const Request& request) {
  EmitOptions options = emit_options(source, stages, request);
  if (request.tangent && !options.tangent)
    throw UsageError("--tangent: no linearised step: " + *without_tangent(stages.plan));
  return options;
}

// The first of the files, and what it includes of the others.
ReadBack read_files(const OutputFiles& files, const Stages& stages, const Request& request) {
  EmittedFile file{.text = files.front().text,
                   .scalar = request.scalar.text(),
                   .beside = {},
                   .watched_step = request.step,
                   .lanes = request.batch};
  for (const OutputFile& other : files) file.beside[other.path] = other.text;
  return read_back(file, stages.program);
}

// What the first lines of a header say of the step; `files` are what is emitted, but for them.
void add_proof(const SourceText& source, const Stages& stages, const Request& request,
               const OutputFiles& files, EmitOptions& options) {
  Proof proof = prove(source, request, stages);
  add_emitted_code(read_files(files, stages, request), "", proof);
  require(proof, *request.require);
  require_emitted(proof);
  options.proved = properties_with(proof, Verdict::proved);
  options.tested = properties_with(proof, Verdict::tested);
  options.refuted = properties_with(proof, Verdict::refuted);
}

// What `write` emits.  A constant the scalar has no number for comes out of H, combined from its
// numbers, unless the request has numbers of its own.
template <typename Write>
auto written(const Model& model, const Request& request, Write write) {
  try {
    return write();
  } catch (const OutOfRange& error) {
    if (request.names_member() || request.watch_modified > 0) throw;
    Diagnostic diagnostic = error.diagnostic();
    diagnostic.span = model.hamiltonian->span;
    throw ModelError({std::move(diagnostic)}, model.source);
  }
}

std::string header_text(const Stages& stages, const EmitOptions& options, const Request& request) {
  return written(stages.model, request, [&] { return cpp_header(stages.program, options); });
}

std::string plugin_text(const Stages& stages, const EmitOptions& options, const Request& request) {
  return written(stages.model, request, [&] { return cpp_plugin(stages.program, options); });
}

OutputFiles files_of(const Stages& stages, const EmitOptions& options, const Request& request) {
  const NamedFormat& format = *request.format->format;
  return written(stages.model, request, [&] { return format.files(stages.program, options); });
}

// A file that is there, or else the one that is emitted.
ReadBack read_file(const std::optional<EmittedHeader>& there, const SourceText& source,
                   const Stages& stages, const Request& request) {
  if (!there)
    return read_files(files_of(stages, emit_options(source, stages, request), request), stages,
                      request);
  const EmittedFile file{.text = there->text,
                         .scalar = request.scalar.text(),
                         .beside = there->beside,
                         .watched_step = request.step,
                         .lanes = request.batch};
  return read_back(file, stages.program);
}

}  // namespace

OutputFiles generate(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  EmitOptions options = options_with_tangent(source, stages, request);
  add_proof(source, stages, request, files_of(stages, options, request), options);
  return files_of(stages, options, request);
}

OutputFiles emit(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  return files_of(stages, options_with_tangent(source, stages, request), request);
}

std::string show_stage(const SourceText& source, const Request& request, const std::string& stage) {
  if (stage == "model")
    return to_text(fold_for_scene(read_request(source, request), request).model);
  if (stage == "mechanics" && !request.scene) return to_text(derive(read_request(source, request)));
  const Stages stages = run_stages(source, request);
  if (stage == "mechanics") return to_text(stages.system.mechanics);
  if (stage == "equations") return to_text(stages.equations);
  if (stage == "plan") return to_text(stages.plan);
  if (stage == "program") return to_text(stages.program);
  if (stage == "origins") {
    return text_with_origins(stages.program, stages.system.mechanics.terms);
  }
  throw UsageError(fmt::format(
      "unknown stage '{}'; there are model, mechanics, equations, plan, program, origins", stage));
}

void check_step(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  static_cast<void>(header_text(stages, emit_options(source, stages, request), request));
}

std::vector<Expression> modified_hamiltonian(const SourceText& source, const Request& request,
                                             int count) {
  require_solved_step(request);
  const Model model = read_request(source, request);
  const Mechanics mechanics = derive(model, false);
  return modified_terms(mechanics, choose_scheme(model, mechanics, request), count);
}

std::vector<LinearPoint> linear_points(const SourceText& source, const Request& request,
                                       const SceneValues& scene) {
  const Model model = read_request(source, request);
  constexpr long most = 600;  // the symmetric eigenvalue problem takes the third power
  if (hamgen::degrees_of_freedom(model) > most) return {};
  constexpr long most_collective = 100;  // a function of sums has a full second derivative
  if (hamgen::degrees_of_freedom(model) > most_collective && !derive(model).sums.empty()) return {};
  std::optional<Mechanics> written_out;
  try {
    written_out = derive(model, false);
  } catch (const ModelError&) {  // which it is for its length alone: the model was derived in loops
    return {};
  }
  const Mechanics& mechanics = *written_out;
  std::map<std::string, Rational> point;
  const auto add = [&point](const std::vector<std::string>& names,
                            const std::vector<Rational>& values) {
    for (std::size_t i = 0; i < names.size(); ++i) point[names[i]] = values[i];
  };
  add(element_names(model.coordinates), scene.q);
  add(element_names(model.momenta), scene.p);
  add(element_names(model.parameters), scene.parameters);
  return linear_points(mechanics, choose_scheme(model, mechanics, request), point, scene.h.value());
}

Proof verify_step(const SourceText& source, const Request& request,
                  const std::optional<SceneValues>& scene,
                  const std::optional<EmittedHeader>& header) {
  const Stages stages = run_stages(source, request);
  Proof proof = prove(source, request, stages, scene);
  const ReadBack read = read_file(header, source, stages, request);
  add_emitted_code(read, header ? header->path : "", proof);
  if (header || read.kind != TextKind::plugin) {
    Request run = request;
    run.format = "cpp-plugin";
    run.support = "";
    run.events = false;  // a plugin has none, and no lanes
    run.batch = 0;
    run.math = {};
    const std::optional<Stages> of_run =
        request.events || request.batch > 0 ? std::optional(run_stages(source, run)) : std::nullopt;
    add_plugin(read_file({}, source, of_run ? *of_run : stages, run), proof);
  }
  return proof;
}

ReadBack read_emitted(const SourceText& source, const Request& request,
                      const std::optional<EmittedHeader>& header) {
  return read_file(header, source, run_stages(source, request), request);
}

ProofCertificate certificate_of(const SourceText& source, const Request& request,
                                const Proof& proof) {
  const Stages stages = run_stages(source, request);
  if (stages.plan.sweeps)
    throw UsageError("--certificate: sweeps leave the step unsolved\nhelp: drop --solver sweeps");
  if (is_something_left_out(stages)) {
    throw UsageError("--certificate: the scene leaves a part of the system out\nhelp: add --whole");
  }
  const auto is_proved = [&](const std::string& property) {
    const auto found = std::ranges::find(proof, property, &Finding::property);
    return found != proof.end() && found->verdict == Verdict::proved;
  };
  Mechanics mechanics = stages.system.mechanics;
  Scheme scheme = stages.equations.scheme;
  if (mechanics.keeps_sums()) {
    require_certified_size(mechanics);
    mechanics = derive(stages.folded.model, false);
    scheme = choose_scheme(stages.model, mechanics, request);
  }
  std::vector<NamedExpression> invariants;
  for (const NamedExpression& invariant : mechanics.invariants) {
    if (is_proved(invariant.name + " invariant")) invariants.push_back(invariant);
  }
  return make_certificate(mechanics, scheme, is_proved("symmetric"), invariants);
}

std::vector<Corner> corners_of_hamiltonian(const SourceText& source, const Request& request) {
  return corners_of_hamiltonian(derive(read_request(source, request)));
}

std::string point_beyond_text(const SourceText& source, const Request& request) {
  const Model model = read_request(source, request);
  return point_beyond_text(model, derive(model, may_keep_sums(request)));
}

Scheme request_scheme(const SourceText& source, const Request& request) {
  const Model model = read_request(source, request);
  require_few_coupled(model, request);
  Scheme scheme = choose_scheme(model, derive_for(request, model, may_keep_sums(request)), request);
  const auto n = static_cast<int>(degrees_of_freedom(model));
  if (auto* member = std::get_if<Member>(&scheme.method)) {
    *member = of_all(*member, n);
  } else if (auto* composition = std::get_if<Composition>(&scheme.method)) {
    composition->base = of_all(composition->base, n);
  }
  return scheme;
}

Program make_program(const SourceText& source, const Request& request) {
  return run_stages(source, request).program;
}

PluginSource generate_plugin(const SourceText& source, const Request& request, HeaderText header) {
  if (request.events) {  // found by who runs it
    Request plain = request;
    plain.events = false;
    return generate_plugin(source, plain, header);
  }
  Stages stages = run_stages(source, request);
  EmitOptions options = emit_options(source, stages, request);
  PluginSource plugin;
  // What is compiled does not depend on values that are given at run time.
  EmitOptions anonymous = options;
  anonymous.command.clear();
  plugin.text = plugin_text(stages, anonymous, request);
  if (header == HeaderText::with_proof) {
    const OutputFiles files = {{options.file_name + ".hpp", header_text(stages, options, request)}};
    add_proof(source, stages, request, files, options);
  }
  if (header != HeaderText::none)
    plugin.header = {options.file_name + ".hpp", header_text(stages, options, request)};
  plugin.scheme_name = stages.equations.scheme.name;
  if (plugin.scheme_name.starts_with("member")) {
    plugin.scheme_name = stages.equations.scheme.description;
    if (request.order > 0) plugin.scheme_name += fmt::format(", order {}", request.order);
  }
  plugin.order = stages.equations.scheme.order;
  plugin.solver = stages.program.facts.solver;
  plugin.is_swept = stages.plan.sweeps.has_value();
  plugin.left_out = stages.plan.left_out;
  plugin.left_out_for_scene = stages.folded.folding.left_out.size() + stages.system.left_out.size();
  for (const Quantity& parameter : stages.system.mechanics.parameters) {
    plugin.parameter_names.push_back(parameter.name);
  }
  plugin.state = state_map(stages.system);
  plugin.same = stages.folded.folding.same;
  for (const LinearChange& change : stages.system.changes)
    plugin.same.insert(plugin.same.end(), change.united.begin(), change.united.end());
  plugin.whole_energy = stages.system.left.dropped.empty();
  plugin.for_scene = request.scene.has_value();
  plugin.needs_energy_parameter = uses_energy_parameter(stages.equations);
  if (plugin.needs_energy_parameter) plugin.parameter_names.emplace_back("E0");
  for (const NamedExpression& invariant : stages.system.mechanics.invariants) {
    plugin.invariant_names.push_back(invariant.name);
  }
  for (const int power : stages.program.facts.modified_powers)
    plugin.invariant_names.push_back(fmt::format("modified_energy_{}", power));
  plugin.without_tangent = without_tangent(stages.plan).value_or("");
  plugin.singular_steps = singular_steps(stages.equations.scheme);
  plugin.operations_per_step = operations_per_step(stages.program);
  plugin.has_stages = std::holds_alternative<RungeKutta>(stages.equations.scheme.method);
  plugin.in_loops = stages.program.environment.arrays;
  plugin.needs_eigen = stages.program.facts.needs_eigen;
  plugin.needs_quadmath = request.scalar->type->digits == 113;
  plugin.model = std::move(stages.model);
  return plugin;
}

}  // namespace hamgen
