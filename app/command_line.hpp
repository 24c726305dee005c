// What the subcommands share: their options, how a value is read, how help is laid out.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/setting.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

enum ExitStatus : int {
  done = 0,
  numerical_failure = 1,  // also: `generate --check` found a difference
  usage_error = 2,
  model_error = 3,
  tool_failure = 4,
  proof_failed = 5,
  ran_out_of_time = 6,  // `run --seconds`
  interrupted = 130,    // as shells report it
};

// A subcommand: how its arguments are read, and what it does once they are (its exit status).
struct Command {
  CLI::App* parser = nullptr;
  std::function<int()> run;
};

[[nodiscard]] Command add_new(CLI::App& app);
[[nodiscard]] Command add_check(CLI::App& app);
[[nodiscard]] Command add_show(CLI::App& app);
[[nodiscard]] Command add_generate(CLI::App& app);
[[nodiscard]] Command add_run(CLI::App& app);
[[nodiscard]] Command add_bench(CLI::App& app);
[[nodiscard]] Command add_report(CLI::App& app);
[[nodiscard]] Command add_stress(CLI::App& app);
[[nodiscard]] Command add_chaos(CLI::App& app);
[[nodiscard]] Command add_section(CLI::App& app);
class Crew;
[[nodiscard]] Command add_ensemble(CLI::App& app, Crew& crew);
[[nodiscard]] Command add_plot(CLI::App& app);
[[nodiscard]] Command add_plugin(CLI::App& app);
[[nodiscard]] Command add_verify(CLI::App& app);
[[nodiscard]] Command add_certify(CLI::App& app);
[[nodiscard]] Command add_tune(CLI::App& app);
[[nodiscard]] Command add_list(CLI::App& app);
[[nodiscard]] Command add_cache(CLI::App& app);
[[nodiscard]] Command add_completion(CLI::App& app);
[[nodiscard]] Command add_man(CLI::App& app);

// Which integrator is meant; the texts are kept as typed.
struct MethodOptions {
  std::string model;  // path of the .ham file
  std::string scheme, alpha, beta, gamma, gauge, order, solver, scalar;
  std::vector<std::string> reference;  // NAME=VALUE,... of the gauge
  std::vector<std::string> fold;       // NAME,...
  bool plain_sums = false;
};

// Adds MODEL and the method options, without --set, whose help differs between commands.
void add_method_options(CLI::App& command, MethodOptions& options);
// An option that may be given several times, one value at a time.
CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const std::string& help);

using Assignment = std::pair<std::string, std::string>;

// Which run is meant; the texts are kept as typed.
struct SceneOptions {
  std::string scene;
  std::vector<std::string> set, initial;  // NAME=VALUE,...
  std::optional<std::string> h, steps;    // in place of the scene's
  std::optional<std::string> time;        // in place of steps
  bool whole = false;                     // leave in what the scene does not need
  std::vector<std::string> keep;          // NAME,...
  std::optional<std::string> observe;     // in place of the scene's
};

// Adds --scene, --set, --initial, --whole and --keep.
void add_scene_options(CLI::App& command, SceneOptions& options);
void add_observe_option(CLI::App& command, SceneOptions& options);
// The same for a command that runs nothing, where --set without --scene is for sizes.
void add_scene_choice(CLI::App& command, SceneOptions& options);
// Adds --compiler, --flags and --portable.
void add_compiler_options(CLI::App& command, CompilerChoice& choice);
// Adds --h of one step size.
void add_step_option(CLI::App& command, SceneOptions& options);

// "eps=0.1" into its two sides, blanks at the ends dropped; throws UsageError naming the option.
[[nodiscard]] Assignment split_assignment(std::string_view option, std::string_view text);
// "q=1,p=[2,3],x=1,2": as above at every outermost comma; a piece without '=' belongs to the value
// before it, which becomes a list.
[[nodiscard]] std::vector<Assignment> split_assignments(std::string_view option,
                                                        std::string_view text);
// Of "a,b" and "c": a, b, c, at outermost commas.  Throws UsageError naming the option where
// nothing stands between two.
[[nodiscard]] std::vector<std::string> listed(std::string_view option,
                                              const std::vector<std::string>& lists);
// An integer such as "100" or "1e6" within [least, 1e15]; throws UsageError that begins with
// `what`, the option and its value as typed.
[[nodiscard]] long integer_value(const std::string& what, const std::string& text, long least);

// The number of a constant expression such as "2*pi"; throws ModelError that quotes the option.
[[nodiscard]] Rational constant_option(const std::string& option, const std::string& text);
// 1 to 8 terms of the modified Hamiltonian; throws UsageError naming the option.
[[nodiscard]] int modified_term_count(const std::string& option, const std::string& text);

// --set of sizes goes into the request, the rest is handed back in the order given.
struct SizesAndRest {
  std::map<std::string, long> sizes;
  std::vector<Assignment> rest;
};
[[nodiscard]] SizesAndRest split_sizes(const Model& model, const std::vector<std::string>& set);

// The request without sizes.  Throws UsageError where the options contradict each other.
[[nodiscard]] Request request_of(const MethodOptions& options);
// Everything a run is read from.  Throws UsageError and ModelError, not for what the scene lacks.
[[nodiscard]] Setting read_setting(const MethodOptions& method, const SceneOptions& scene);
// The request of a command that runs nothing.  With a scene by name it is for that scene; without
// it knows no run-time values, and --set is for sizes only.
[[nodiscard]] Request request_of(const MethodOptions& options, const SceneOptions& scene,
                                 const SourceText& source);
// Makes the request one for the setting's scene, unless --whole asks for more; `varied` are names
// that get other values too, and with them all that the scene computes from them.
enum class Observing { as_the_scene, everything };
void specialise(const SceneOptions& options, const SceneValues& values,
                const std::vector<std::string>& varied, Observing observing, Setting& setting);
// The `hamgen generate` command and the digest of the model's text: what an emitted header says of
// its origin.
void record_origin(const MethodOptions& options, const SourceText& source, Request& request);

// What headers made with --support shared have beside them.
inline constexpr const char* kSupportFiles[] = {"hamgen_support.hpp",
                                                "hamgen_support_float32.hpp",
                                                "hamgen_support_long_double.hpp",
                                                "hamgen_support_quad.hpp",
                                                "hamgen_support_events.hpp",
                                                "hamgen_support_float32_events.hpp",
                                                "hamgen_support_long_double_events.hpp",
                                                "hamgen_support_quad_events.hpp"};

// Help that fits one screen: one line an option.
void use_short_help(CLI::App& app);

}  // namespace hamgen::app
