#include "generator/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/emitted_spaces.hpp"
#include "generator/equations/step_equations.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/formats/cpp_header.hpp"
#include "generator/formats/cpp_tangent.hpp"
#include "generator/formats/scalar.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/curvature.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/mechanics/modified_hamiltonian.hpp"
#include "generator/program/names.hpp"
#include "generator/program/program.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "generator/solvers/solve_plan.hpp"
#include "generator/verify/specialised.hpp"

namespace hamgen {

namespace {

// Is the name a word of the text?
bool mentions(const std::string& text, const std::string& name) {
  auto letter = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
  };
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    if ((at == 0 || !letter(at - 1)) && !letter(at + name.size())) return true;
  }
  return false;
}

// alpha, beta and gamma may stand for themselves: then they are run-time parameters of the
// integrator, and `--beta beta --set beta=0.1` needs no compilation for another value.
void add_scheme_parameters(Model& model, const Request& request) {
  const std::string texts = request.alpha + "," + request.beta + "," + request.gamma;
  std::set<std::string> known;
  for (const Variable& variable : model.coordinates) known.insert(variable.name);
  for (const Variable& variable : model.momenta) known.insert(variable.name);
  for (const Parameter& parameter : model.parameters) known.insert(parameter.name);
  for (const Size& size : model.sizes) known.insert(size.name);
  for (const Definition& definition : model.definitions) known.insert(definition.name);
  const std::pair<const char*, Rational> names[] = {
      {"alpha", Rational(1, 2)}, {"beta", Rational(0)}, {"gamma", Rational(0)}};
  for (const auto& [name, value] : names) {
    if (!mentions(texts, name) || known.contains(name)) continue;
    const Span nowhere{};
    model.parameters.push_back(
        {.name = name,
         .values = {std::make_shared<const Node>(Node{nowhere, NumberNode{value}})},
         .comment = "of the scheme"});
  }
  for (const std::string& name : request.scheme_parameters) {
    model.parameters.push_back(
        {.name = name,
         .values = {std::make_shared<const Node>(Node{Span{}, NumberNode{Rational(0)}})},
         .comment = "of the scheme"});
  }
}

// Burns the defaults of --fold in.
void fold_parameters(Model& model, const Request& request) {
  for (const std::string& name : request.fold) {
    const auto it = std::ranges::find(model.parameters, name, &Parameter::name);
    if (it == model.parameters.end()) {
      std::vector<std::string> names;
      for (const Parameter& parameter : model.parameters) names.push_back(parameter.name);
      const std::string near = nearest(name, names);
      throw UsageError(fmt::format("--fold {}: the model has no such parameter{}", name,
                                   near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    it->folded = true;
  }
}

// Defaults of parameters are literals of the emitted code.
void require_defaults_in_range(const Model& model, const ScalarType& scalar) {
  Model without_scenes = model;
  without_scenes.scenes.clear();
  const std::vector<Rational> defaults = scene_values(without_scenes, {}).parameters;
  std::vector<Diagnostic> mistakes;
  std::size_t i = 0;
  for (const Parameter& parameter : model.parameters) {
    for (const NodePtr& node : parameter.values) {
      const Rational& value = defaults.at(i++);
      if (is_in_range(value, scalar)) continue;
      mistakes.push_back({.span = node->span,
                          .message = fmt::format("the default of '{}' is {}", parameter.name,
                                                 out_of_range_message(value, scalar)),
                          .help = out_of_range_help(value, scalar)});
    }
  }
  if (!mistakes.empty()) throw ModelError(std::move(mistakes), model.source);
}

std::string stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  return name.empty() ? "model" : name;
}

bool shares_support(const Request& request) {
  if (request.support.empty() || request.support == "own") return false;
  if (request.support == "shared") return true;
  throw UsageError(fmt::format("--support {}: there are own and shared", request.support));
}

// The stages, in order: this is the only place that knows it.
struct Stages {
  Model model;  // as the request reads it
  FoldedModel folded;
  Specialised system;
  StepEquations equations;
  SolvePlan plan;
  Program program;
};

bool is_something_left_out(const Stages& stages) {
  return !stages.folded.folding.left_out.empty() || !stages.system.left_out.empty();
}

EmitOptions emit_options(const SourceText& source, const Stages& stages, const Request& request) {
  const Program& program = stages.program;
  const bool is_special = request.scene && is_something_left_out(stages);
  return {.file_name = stem(source.path),
          .command = request.command,
          .model_path = source.path,
          .model_digest = request.model_digest,
          .scalar = request.scalar,
          .spaces = emitted_spaces(program.plan.equations, request,
                                   is_special ? request.scene->values.name : ""),
          .tangent = request.tangent && !without_tangent(program),
          .shared_support = shares_support(request),
          .watched_step = request.step};
}

std::vector<Expression> modified_terms(const Mechanics& mechanics, const Scheme& scheme,
                                       int count) {
  if (!scheme.is_member() || mechanics.keeps_sums()) {
    throw UsageError(
        fmt::format("the modified Hamiltonian is derived for members of the family and sums "
                    "that are written out, not for {} of {}",
                    scheme.name, mechanics.name));
  }
  const Member& member = scheme.member();
  if (!scheme.symplectic) {
    throw UsageError(fmt::format("{} is not symplectic: it follows no modified Hamiltonian",
                                 scheme.description));
  }
  // H_0, then from the order of the scheme on; of a symmetric one every other.
  const int stride = scheme.symmetric ? 2 : 1;
  const int last = count == 1 ? 0 : scheme.order + stride * (count - 2);
  return modified_hamiltonian(mechanics, member.c, member.generating_order, last + 1);
}

// Ht, cut off after each of its terms, as functions of h and the state.
void watch_modified(Program& program, const std::vector<Expression>& terms) {
  const Expression h = step_size();
  std::vector<Expression> sums;
  Expression sum;
  Expression power(1);
  for (std::size_t j = 0; j < terms.size(); ++j) {
    sum += power * terms[j];
    power = power * h;
    if (j == 0 || terms[j].is_zero()) continue;
    sums.push_back(sum);
    program.modified_powers.push_back(static_cast<int>(j));
  }
  program.modified_energies = evaluate_together(sums);
}

// Sweeps leave the step unsolved, and what is not symplectic has no modified Hamiltonian.
void require_solved_step(const Request& request) {
  if (!request.solver.starts_with("sweeps")) return;
  throw UsageError(
      fmt::format("--solver {} leaves the step unsolved: it follows no modified "
                  "Hamiltonian\nhelp: drop --solver",
                  request.solver));
}

// Parameters that serve a scene only, or nothing: no emitted line names them.
void drop_unused_parameters(StepEquations& equations) {
  Mechanics& mechanics = equations.mechanics;
  if (mechanics.keeps_sums()) return;
  std::set<std::string> used;
  collect_symbols(mechanics.energy, used);
  for (const Expression& component : mechanics.gradient) collect_symbols(component, used);
  for (const auto& [place, value] : mechanics.hessian) collect_symbols(value, used);
  for (const NamedExpression& invariant : mechanics.invariants) {
    collect_symbols(invariant.value, used);
  }
  for (const auto& [place, value] : equations.stage_matrix) collect_symbols(value, used);
  std::erase_if(mechanics.parameters,
                [&](const Quantity& parameter) { return !used.contains(parameter.name); });
}

// Names of the model that the scheme's options use: they have to keep their meaning there.
std::set<std::string> named_by_scheme(const Model& model, const Request& request) {
  const std::string texts =
      request.alpha + "," + request.beta + "," + request.gamma + "," + request.gauge;
  std::set<std::string> names;
  for (const Parameter& parameter : model.parameters) {
    if (mentions(texts, parameter.name)) names.insert(parameter.name);
  }
  if (request.gauge != "locally-exact") return names;
  // It is exact with the parameters of its reference.
  const Values reference = read_reference(model, request.reference);
  const std::vector<std::string> elements = element_names(model.parameters);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool is_element = elements[i].find('[') != std::string::npos;
    if (is_element || reference.at(elements[i]) != request.scene->values.parameters[i])
      names.insert(elements[i]);
  }
  return names;
}

FoldedModel fold_for_scene(const Model& model, const Request& request) {
  if (!request.scene) return {model, {}};
  SceneFacts scene = *request.scene;
  scene.kept.merge(named_by_scheme(model, request));
  return fold(observed(model, scene.values), scene, request.fold);
}

// Loops know one set of parameters for all degrees of freedom.
bool may_keep_sums(const Request& request) {
  return request.gauge.empty() && !request.observe_curvature &&
         (request.alpha + request.beta + request.gamma).find(',') == std::string::npos;
}

Specialised make_system(const Model& model, const Request& request, bool keep_sums) {
  Mechanics mechanics = derive(model, keep_sums);
  if (request.observe_curvature) mechanics.invariants = energy_curvature(mechanics);
  Scheme scheme = choose_scheme(model, mechanics, request);
  return specialise(model, std::move(mechanics), std::move(scheme), request.scene);
}

Stages run_stages(const SourceText& source, const Request& request) {
  Model model = read_request(source, request);
  require_defaults_in_range(model, find_scalar(request.scalar));
  FoldedModel folded = fold_for_scene(model, request);
  Specialised system = make_system(folded.model, request, may_keep_sums(request));
  const HessianWish hessian = request.tangent ? HessianWish::exact : HessianWish::cheapest;
  StepEquations equations = discretise(system.mechanics, system.scheme, hessian);
  SolvePlan plan = plan_solve(equations, request.solver);
  if (request.scalar == "quad" && plan.arrays && uses_eigen(*plan.arrays)) {
    // Eigen does not know quad numbers: everything is written out instead.
    system = make_system(folded.model, request, false);
    equations = discretise(system.mechanics, system.scheme, hessian);
    plan = plan_solve(equations, request.solver);
  }
  drop_unused_parameters(plan.equations);
  equations.mechanics.parameters = plan.equations.mechanics.parameters;
  system.mechanics.parameters = plan.equations.mechanics.parameters;
  std::vector<std::string> left_out = folded.folding.left_out;
  left_out.insert(left_out.end(), system.left_out.begin(), system.left_out.end());
  plan.left_out.insert(plan.left_out.begin(), left_out.begin(), left_out.end());
  Program program = build_program(plan);
  if (request.tangent && !without_tangent(program)) program = with_tangent(std::move(program));
  if (request.watch_modified > 0) require_solved_step(request);
  if (request.watch_modified > 0) {
    watch_modified(program,
                   modified_terms(system.mechanics, system.scheme, request.watch_modified));
  }
  return {std::move(model),     std::move(folded), std::move(system),
          std::move(equations), std::move(plan),   std::move(program)};
}

Expression written_out(const Stages& stages) {
  const Specialised& system = stages.system;
  return system.mechanics.keeps_sums()
             ? restrict_to(written_out_hamiltonian(stages.folded.model), system.whole, system.kept)
             : system.mechanics.energy;
}

SizedSystem sized_system(const SourceText& source, Request request, const std::string& constant,
                         long size) {
  request.sizes[constant] = size;
  if (request.scene) {
    SceneValues values = scene_values(read_request(source, request), request.scene->asked);
    values.observe = request.scene->values.observe;
    values.formulas = request.scene->values.formulas;
    request.scene->values = std::move(values);
  }
  Stages stages = run_stages(source, request);
  Expression hamiltonian = written_out(stages);
  return {size, std::move(stages.system.mechanics), std::move(stages.equations.scheme),
          std::move(stages.program), std::move(hamiltonian)};
}

// Of a large system in loops: its largest size as small as loops are made of, and the next one.
// Empty where the model has no such sizes: a list of values fits one of them only.
std::optional<SmallerSystems> smaller_systems(const SourceText& source, const Request& request,
                                              const Stages& stages) {
  if (!stages.system.mechanics.keeps_sums() ||
      stages.system.mechanics.degrees_of_freedom <= kMostLookedAt)
    return {};
  const auto largest = std::ranges::max_element(stages.model.sizes, {}, &Size::value);
  constexpr long size = kMostWrittenOut + 1;
  if (largest == stages.model.sizes.end() || largest->value <= size + 1) return {};
  const auto made_by = [&](const Request& wish) {
    return SmallerSystems{largest->name, largest->value,
                          sized_system(source, wish, largest->name, size),
                          sized_system(source, wish, largest->name, size + 1)};
  };
  const auto routines = [](const Program& program) { return step_code(program).routines.size(); };
  try {
    SmallerSystems smaller = made_by(request);
    // Where Newton's matrix is too large the larger system is left without it.
    if (request.solver.empty() && routines(smaller.first.program) > routines(stages.program)) {
      Request without_matrix = request;
      without_matrix.solver = "fixed-point";
      smaller = made_by(without_matrix);
    }
    const bool in_loops =
        smaller.first.mechanics.keeps_sums() && smaller.second.mechanics.keeps_sums();
    return in_loops ? std::optional(std::move(smaller)) : std::nullopt;
  } catch (const std::exception&) {
    return {};
  }
}

Proof prove(const SourceText& source, const Request& request, const Stages& stages,
            const std::optional<SceneValues>& scene = {}) {
  Surroundings around = surroundings_of(stages.model);
  if (scene) around.centres.insert(around.centres.begin(), centre_of(stages.model, *scene));
  Proof proof = verify(stages.system.mechanics, stages.equations.scheme, stages.program,
                       written_out(stages), around, smaller_systems(source, request, stages));
  if (request.scene && is_something_left_out(stages))
    proof.push_back(
        prove_specialised(stages.model, stages.folded, stages.system, *request.scene, around));
  return proof;
}

// What the first lines of a header say of the step.
void add_proof(const SourceText& source, const Stages& stages, const Request& request,
               EmitOptions& options) {
  const Proof proof = prove(source, request, stages);
  require(proof, request.require);
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
    if (!(request.alpha + request.beta + request.gamma + request.gauge).empty() ||
        request.watch_modified > 0)
      throw;
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

}  // namespace

Model read_request(const SourceText& source, const Request& request) {
  Model model = read_model(source, request.sizes);
  add_scheme_parameters(model, request);
  fold_parameters(model, request);
  return model;
}

OutputFiles generate(const SourceText& source, const Request& request) {
  const Stages stages = run_stages(source, request);
  EmitOptions options = emit_options(source, stages, request);
  if (request.tangent && !options.tangent) {
    throw UsageError("--tangent: no linearised step: " + *without_tangent(stages.program));
  }
  add_proof(source, stages, request, options);
  const NamedFormat& format = find_format(request.format);
  return written(stages.model, request, [&] { return format.files(stages.program, options); });
}

std::string show_stage(const SourceText& source, const Request& request, const std::string& stage) {
  if (stage == "model") return to_text(read_request(source, request));
  if (stage == "mechanics") return to_text(derive(read_request(source, request)));
  const Stages stages = run_stages(source, request);
  if (stage == "equations") return to_text(stages.equations);
  if (stage == "plan") return to_text(stages.plan);
  if (stage == "program") return to_text(step_code(stages.program));
  if (stage == "origins") {
    return text_with_origins(step_code(stages.program), stages.system.mechanics.terms);
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
  const Mechanics mechanics = derive(model, false);
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
                  const std::optional<SceneValues>& scene) {
  return prove(source, request, run_stages(source, request), scene);
}

std::vector<Corner> corners_of_hamiltonian(const SourceText& source, const Request& request) {
  return corners_of_hamiltonian(derive(read_request(source, request)));
}

Scheme request_scheme(const SourceText& source, const Request& request) {
  const Model model = read_request(source, request);
  return choose_scheme(model, derive(model, may_keep_sums(request)), request);
}

StepCode make_step_code(const SourceText& source, const Request& request) {
  return step_code(run_stages(source, request).program);
}

PluginSource generate_plugin(const SourceText& source, const Request& request, HeaderProof proof) {
  Stages stages = run_stages(source, request);
  EmitOptions options = emit_options(source, stages, request);
  PluginSource plugin;
  // What is compiled does not depend on values that are given at run time.
  EmitOptions anonymous = options;
  anonymous.command.clear();
  plugin.text = plugin_text(stages, anonymous, request);
  if (proof == HeaderProof::included) add_proof(source, stages, request, options);
  plugin.header = {options.file_name + ".hpp", header_text(stages, options, request)};
  plugin.scheme_name = stages.equations.scheme.name;
  if (plugin.scheme_name.starts_with("member")) {
    plugin.scheme_name = stages.equations.scheme.description;
    if (request.order > 0) plugin.scheme_name += fmt::format(", order {}", request.order);
  }
  plugin.order = stages.equations.scheme.order;
  plugin.solver = stages.plan.solver;
  plugin.left_out = stages.plan.left_out;
  for (const Quantity& parameter : stages.system.mechanics.parameters) {
    plugin.parameter_names.push_back(parameter.name);
  }
  plugin.kept = stages.system.kept;
  const Unobserved& left = stages.system.left;
  plugin.unobserved = left.cyclic;
  for (const int i : left.dropped)
    plugin.unobserved.insert(plugin.unobserved.end(),
                             {i, stages.system.whole.degrees_of_freedom + i});
  plugin.whole_energy = left.dropped.empty();
  plugin.for_scene = request.scene.has_value();
  plugin.needs_energy_parameter = uses_energy_parameter(stages.equations);
  if (plugin.needs_energy_parameter) plugin.parameter_names.emplace_back("E0");
  for (const NamedExpression& invariant : stages.system.mechanics.invariants) {
    plugin.invariant_names.push_back(invariant.name);
  }
  for (const int power : stages.program.modified_powers)
    plugin.invariant_names.push_back(fmt::format("modified_energy_{}", power));
  plugin.without_tangent = without_tangent(stages.program).value_or("");
  plugin.singular_steps = singular_steps(stages.equations.scheme);
  plugin.needs_eigen = needs_eigen(stages.program);
  plugin.needs_quadmath = request.scalar == "quad";
  plugin.model = std::move(stages.model);
  return plugin;
}

}  // namespace hamgen
