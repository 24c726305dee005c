#include "runtime/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

#include "runtime/atomic_file.hpp"
#include "runtime/facts.hpp"
#include "runtime/load_plugin.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen {
namespace {

// Exit statuses of the command.
constexpr int kUsageStatus = 2;
constexpr int kModelStatus = 3;

std::string command_of(const LoadOptions& options) {
  if (!options.command.empty()) return options.command;
  const char* chosen = std::getenv("HAMGEN");
  return chosen != nullptr && *chosen != '\0' ? chosen : "hamgen";
}

runtime::ProcessResult run(const runtime::ProcessRequest& request) {
  try {
    return runtime::run_process(request);
  } catch (const runtime::ToolError& error) {
    runtime::ToolFailure failure = error.failure();
    failure.message +=
        "; the installed command is looked for in LoadOptions::command, $HAMGEN, PATH";
    throw runtime::ToolError(std::move(failure));
  }
}

// Lets the command write into the directory.
void emit(const std::filesystem::path& model, const LoadOptions& options,
          const std::filesystem::path& directory) {
  runtime::ProcessRequest request;
  request.command = {command_of(options), "plugin", model.string(), "-o",
                     directory.string(),  "--quiet"};
  request.command.insert(request.command.end(), options.method.begin(), options.method.end());
  request.time_limit = options.time_limit;
  request.stop = options.stop;
  const runtime::ProcessResult result = run(request);
  if (result.succeeded()) return;
  if (result.end == runtime::ProcessEnd::exited && result.code == kUsageStatus)
    throw LoadError(LoadError::Kind::usage, result.output);
  if (result.end == runtime::ProcessEnd::exited && result.code == kModelStatus)
    throw LoadError(LoadError::Kind::model, result.output);
  throw runtime::ToolError(
      {.message = fmt::format("hamgen made no integrator: {}", runtime::end_text(result, request)),
       .command = runtime::command_text(request.command),
       .exit_status =
           result.end == runtime::ProcessEnd::exited ? std::optional(result.code) : std::nullopt,
       .output_tail = runtime::tail_of(result.output)});
}

std::size_t index_of(const std::vector<std::string>& names, std::string_view name,
                     std::string_view what) {
  const auto it = std::ranges::find(names, name);
  if (it == names.end())
    throw std::out_of_range(
        fmt::format("there is no {} '{}'; there are: {}", what, name, fmt::join(names, ", ")));
  return static_cast<std::size_t>(it - names.begin());
}

runtime::EventLocator::Quantity quantity_of(const std::shared_ptr<const SystemFacts>& facts,
                                            std::size_t place,
                                            std::vector<runtime::Wide> parameters) {
  return [facts, place, parameters = std::move(parameters)](std::span<const runtime::Wide> state) {
    return facts->library->invariants(parameters, state)[place].hi;
  };
}

}  // namespace

System load(const std::filesystem::path& model, const LoadOptions& options) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  emit(model, options, directory.path());
  SystemFacts facts = read_facts(runtime::read_file(directory.path() / "facts.txt"));
  runtime::PluginSource source;
  source.text = runtime::read_file(directory.path() / "plugin.cpp");
  source.uses_eigen = facts.uses_eigen;
  source.uses_quadmath = facts.uses_quadmath;
  source.model = facts.name;
  source.scheme = facts.scheme;
  runtime::CompileOptions compile;
  compile.stop = options.stop;
  const auto choice = options.compiler.empty() ? std::nullopt : std::optional(options.compiler);
  facts.library =
      runtime::load_plugin(source, runtime::find_compiler(choice), compile, runtime::open_cache())
          .library;
  return System(std::make_shared<const SystemFacts>(std::move(facts)));
}

const std::string& System::name() const { return facts_->name; }
const std::string& System::scheme() const { return facts_->scheme; }
int System::order() const { return facts_->order; }
const std::vector<std::string>& System::coordinates() const { return facts_->coordinates; }
const std::vector<std::string>& System::momenta() const { return facts_->momenta; }
const std::vector<std::string>& System::parameters() const { return facts_->parameters; }
const std::vector<std::string>& System::invariants() const { return facts_->invariants; }
const std::vector<std::string>& System::events() const { return facts_->event_names; }
const std::vector<std::string>& System::scenes() const { return facts_->scene_names; }
const std::shared_ptr<const runtime::Library>& System::library() const { return facts_->library; }

Start System::start(std::string_view scene) const {
  Start result(*this);
  const std::size_t i = scene.empty() ? 0 : index_of(facts_->scene_names, scene, "scene");
  const SceneStart& values = facts_->scenes[i];
  result.values_ = {.parameters = values.parameters,
                    .h = values.h.value_or(runtime::Wide{}),
                    .state = values.state,
                    .defined_everywhere = facts_->defined_everywhere};
  result.steps_ = values.steps;
  return result;
}

runtime::ObservedEvent System::event(
    std::string_view name, const Start& start,
    std::function<bool(const runtime::EventPoint&)> on_event) const {
  const EventFacts& event = facts_->events[index_of(facts_->event_names, name, "event")];
  return {.quantity = quantity_of(facts_, event.place, start.values().parameters),
          .direction = event.direction,
          .on_event = std::move(on_event)};
}

double System::invariant(std::string_view name, const Start& start,
                         std::span<const runtime::Wide> state) const {
  const std::size_t place = index_of(facts_->invariants, name, "invariant");
  return facts_->library->invariants(start.values().parameters, state)[place].hi;
}

Trajectory System::run(const Start& start, const RunOptions& options) const {
  const runtime::InitialValues values = start.values();
  runtime::Integrator integrator(facts_->library, values);
  runtime::EventObserver observer(facts_->library, values, options.events);
  runtime::IntegrateOptions integrate;
  integrate.steps = options.steps;
  integrate.every = options.every;
  integrate.watch_energy = options.watch_energy;
  integrate.end_at_jump = options.end_at_jump && options.watch_energy;
  integrate.on_record = options.on_record;
  integrate.stop = options.stop;
  if (!options.events.empty())
    integrate.on_look = [&observer](const auto& now) { return observer.look(now); };
  Trajectory result{.summary = runtime::integrate(integrator, integrate),
                    .state = integrator.state(),
                    .time = 0.0,
                    .ended_by = observer.end()};
  const auto steps = static_cast<double>(result.summary.steps_done);
  result.time = std::fma(steps, values.h.hi, steps * values.h.lo);
  if (!result.ended_by) return result;
  result.state = result.ended_by->state;
  result.time = result.ended_by->time;
  return result;
}

Start::Start(const System& system) : facts_(system.facts_) {}

runtime::Wide* Start::place(std::string_view name) {
  if (name == "h") return &values_.h;
  const std::size_t n = facts_->coordinates.size();
  const auto in = [&](const std::vector<std::string>& names, std::vector<runtime::Wide>& values,
                      std::size_t first) -> runtime::Wide* {
    const auto it = std::ranges::find(names, name);
    if (it == names.end()) return nullptr;
    return &values[first + static_cast<std::size_t>(it - names.begin())];
  };
  if (auto* value = in(facts_->coordinates, values_.state, 0)) return value;
  if (auto* value = in(facts_->momenta, values_.state, n)) return value;
  if (auto* value = in(facts_->parameters, values_.parameters, 0)) return value;
  throw std::out_of_range(
      fmt::format("{} has no coordinate, momentum or parameter '{}'", facts_->name, name));
}

Start& Start::set(std::string_view name, double value) {
  *place(name) = {.hi = value, .lo = 0.0};
  return *this;
}

double Start::value(std::string_view name) const { return Start(*this).place(name)->hi; }

runtime::InitialValues Start::values() const {
  if (values_.h.hi == 0.0)
    throw std::invalid_argument(
        fmt::format("{}: no step size; set one: start.set(\"h\", 0.01)", facts_->name));
  runtime::InitialValues values = values_;
  if (!facts_->needs_initial_energy) return values;
  values.parameters.push_back({});  // H does not depend on E0
  values.parameters.back() = facts_->library->energy(values.parameters, values.state);
  return values;
}

}  // namespace hamgen
