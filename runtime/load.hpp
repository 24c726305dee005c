// A model's integrator in a program of one's own: hamgen::load("kepler.ham").
//
// The installed `hamgen` command derives and emits it, in a process of its own; it is compiled,
// kept in the cache, and loaded.  Nothing of the generator is linked.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/event_observer.hpp"
#include "runtime/library.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen {

struct SystemFacts;

// How a model is loaded.
struct LoadOptions {
  // As of `hamgen run`: {"--scheme", "gauss-4"}, {"--set", "N=100"} for a size.
  std::vector<std::string> method = {};
  std::string command = {};   // hamgen: a path or a name in PATH; empty: $HAMGEN, else "hamgen"
  std::string compiler = {};  // empty: $CXX, g++, clang++
  std::chrono::milliseconds time_limit = std::chrono::minutes(2);  // of the command
  const std::atomic<bool>* stop = nullptr;                         // gives up when set
};

// What the command said, as it would have on a terminal: the model's mistakes with their places.
class LoadError : public std::runtime_error {
 public:
  // Whose the mistake is.
  enum class Kind {
    usage,  // that of the options
    model   // that of the model
  };
  // With all that the command said.
  LoadError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  // Whose the mistake is.
  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

class System;

// The numbers a run starts from; names as in the model, "q", "m[2]".
class Start {
 public:
  // Sets a coordinate, a momentum, a parameter, or "h".  Throws std::out_of_range naming it.
  Start& set(std::string_view name, double value);
  // The same one's value, rounded to double.  Throws std::out_of_range.
  [[nodiscard]] double value(std::string_view name) const;

  // In the plugin's order, with the energy of the start where the method needs it.  Throws
  // std::invalid_argument if there is no step size, of a scene that has none.
  [[nodiscard]] runtime::InitialValues values() const;
  // How many the scene has, if it says.
  [[nodiscard]] std::optional<long long> steps() const { return steps_; }

 private:
  friend class System;
  explicit Start(const System& system);
  [[nodiscard]] runtime::Wide* place(std::string_view name);

  std::shared_ptr<const SystemFacts> facts_;
  runtime::InitialValues values_;
  std::optional<long long> steps_;
};

// What a run is asked for.
struct RunOptions {
  long long steps = 0;       // at most; none by default
  long long every = 0;       // records; 0: none
  bool watch_energy = true;  // H after each step
  bool end_at_jump = true;   // with the energy watched: where its error is ten times its scale
  std::function<void(const runtime::Record&)> on_record = {};  // called for each record
  std::vector<runtime::ObservedEvent> events = {};             // of the model or the program
  const std::atomic<bool>* stop = nullptr;                     // ends the run when set
};

// What a run ended with.
struct Trajectory {
  runtime::RunSummary summary;                  // what became of its steps
  std::vector<runtime::Wide> state;             // the last good one: q then p
  double time = 0.0;                            // of it
  std::optional<runtime::EventPoint> ended_by;  // an event: then state and time are its
};

// A loaded model.  Copies share it; all its members may be used by several threads at once, and
// each thread integrates orbits of its own.
class System {
 public:
  // The system's, as the model says it.
  [[nodiscard]] const std::string& name() const;
  // The method's: "gauss-8".
  [[nodiscard]] const std::string& scheme() const;
  // The method's: the error of a step is of size h^(order + 1).
  [[nodiscard]] int order() const;
  // Names, of the elements of arrays too: "q[1]".  In this order they are in a state.
  [[nodiscard]] const std::vector<std::string>& coordinates() const;
  // Names, in the order of the coordinates they belong to.
  [[nodiscard]] const std::vector<std::string>& momenta() const;
  // Names of what may be set at run time.
  [[nodiscard]] const std::vector<std::string>& parameters() const;
  // Names, of the model's `invariant` statements.
  [[nodiscard]] const std::vector<std::string>& invariants() const;
  // Names, of its `event` statements.
  [[nodiscard]] const std::vector<std::string>& events() const;
  // Names, the first of which is meant where none is given.
  [[nodiscard]] const std::vector<std::string>& scenes() const;
  // Of a scene; of the first, or of the defaults, without a name.  Throws std::out_of_range.
  [[nodiscard]] Start start(std::string_view scene = {}) const;
  // One of the model's events, for RunOptions::events: with the parameters of the start.  Throws
  // std::out_of_range.
  [[nodiscard]] runtime::ObservedEvent event(
      std::string_view name, const Start& start,
      std::function<bool(const runtime::EventPoint&)> on_event) const;
  // The value of an invariant at a state (2n values), in the model's units.  Throws
  // std::out_of_range, and std::invalid_argument for another number of values.
  [[nodiscard]] double invariant(std::string_view name, const Start& start,
                                 std::span<const runtime::Wide> state) const;

  // Integrates.  What goes wrong in a step is the summary's status, no exception; an exception of a
  // callback passes through.
  [[nodiscard]] Trajectory run(const Start& start, const RunOptions& options) const;

  // For what is not here: integrators of one's own.
  [[nodiscard]] const std::shared_ptr<const runtime::Library>& library() const;

 private:
  friend System load(const std::filesystem::path& model, const LoadOptions& options);
  friend class Start;
  explicit System(std::shared_ptr<const SystemFacts> facts) : facts_(std::move(facts)) {}

  std::shared_ptr<const SystemFacts> facts_;
};

// Throws LoadError with the command's diagnostics, and runtime::ToolError where the command or the
// compiler could not be run or failed.
[[nodiscard]] System load(const std::filesystem::path& model, const LoadOptions& options = {});

}  // namespace hamgen
