#include "app/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "app/output/generate_command.hpp"
#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "runtime/sha256.hpp"

namespace hamgen::app {
namespace {

void require_no_member_besides_scheme(const MethodOptions& options) {
  if (options.scheme.empty()) return;
  const Scheme* scheme = find_scheme(options.scheme);
  if (scheme != nullptr && std::holds_alternative<Composition>(scheme->method)) return;
  for (const auto& [name, value] :
       {std::pair{"--alpha", &options.alpha}, std::pair{"--beta", &options.beta},
        std::pair{"--gamma", &options.gamma}}) {
    if (value->empty()) continue;
    throw UsageError(
        fmt::format("--scheme {} and {} {} both choose the method\nhelp: leave one of them out",
                    options.scheme, name, *value));
  }
}

// A name given twice leaves open which value is meant.
void require_once(std::string_view option, const std::vector<Assignment>& assignments) {
  std::map<std::string, std::string> values;
  for (const auto& [written, value] : assignments) {
    std::string name = written;
    std::erase(name, ' ');
    const auto [first, is_new] = values.emplace(name, value);
    if (!is_new)
      throw UsageError(fmt::format("{0}: {1} is set twice, to {2} and to {3}", option, name,
                                   first->second, value));
  }
}

std::vector<Assignment> all_assignments(std::string_view option,
                                        const std::vector<std::string>& texts) {
  std::vector<Assignment> result;
  for (const std::string& text : texts) {
    for (Assignment& assignment : split_assignments(option, text))
      result.push_back(std::move(assignment));
  }
  require_once(option, result);
  return result;
}

}  // namespace

void add_method_options(CLI::App& command, MethodOptions& options) {
  command.add_option("MODEL", options.model, "a .ham file")->required();
  command.add_option("--scheme", options.scheme, "a method by its name, see `hamgen list schemes`")
      ->type_name("NAME");
  command.add_option("--alpha", options.alpha, "")->type_name("X");
  command.add_option("--beta", options.beta, "")->type_name("X");
  command
      .add_option("--gamma", options.gamma,
                  "member of the family: --beta=-1/400*h; default 1/2, 0, 0")
      ->type_name("X");
  command.add_option("--order", options.order, "order of a member by generating function, to 10")
      ->type_name("R");
  command
      .add_option("--gauge", options.gauge,
                  "locally-exact (the linear part without error), or C, 2n x 2n")
      ->type_name("NAME");
  add_repeated(command, "--reference", options.reference,
               "where: q=1,w=50; default: the scene's initial state")
      ->type_name("NAME=VALUE,...");
  add_repeated(command, "--fold", options.fold, "")->type_name("NAME,...");
  command
      .add_option("--solver", options.solver,
                  "burn parameters' values in; newton, fixed-point, sweeps:K")
      ->type_name("NAME");
  command.add_option("--scalar", options.scalar, "")->type_name("TYPE");
  command.add_flag("--plain-sums", options.plain_sums,
                   "float, double, long-double, quad; rounding not made up for");
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--scene", options.scene, "")->type_name("NAME");
  add_repeated(command, "--set", options.set,
               "of the model, default: its first; parameters or sizes of it")
      ->type_name("NAME=VALUE,...");
  add_repeated(command, "--initial", options.initial, "initial state, for example q=3.1,p=0")
      ->type_name("NAME=VALUE,...");
  command.add_flag("--whole", options.whole, "");
  add_repeated(command, "--keep", options.keep,
               "leave in all that the scene does not need, or these")
      ->type_name("NAME,...");
}

void add_observe_option(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--observe", options.observe,
                  "q, energy, r = sqrt(x^2 + y^2); default: the scene's")
      ->type_name("LIST");
}

void add_scene_choice(CLI::App& command, SceneOptions& options) {
  command.add_option("--scene", options.scene, "leave out what this scene does not need")
      ->type_name("NAME");
  add_repeated(command, "--set", options.set, "sizes of the model; with --scene parameters too")
      ->type_name("NAME=VALUE,...");
  add_repeated(command, "--initial", options.initial, "with --scene: another initial state")
      ->type_name("NAME=VALUE,...");
  add_observe_option(command, options);
  command.add_flag("--whole", options.whole, "");
  add_repeated(command, "--keep", options.keep, "with --scene: leave in all, or these")
      ->type_name("NAME,...");
}

void add_compiler_options(CLI::App& command, CompilerChoice& choice) {
  command.add_option("--compiler", choice.program, "")->type_name("C");
  command.add_option("--flags", choice.flags, "")->type_name("F");
  command.add_flag("--portable", choice.portable,
                   "default: $CXX, g++, clang++; not only for this processor");
}

void add_step_option(CLI::App& command, SceneOptions& options) {
  command.add_option("--h", options.h, "step size; default: the scene's")->type_name("H");
}

CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const std::string& help) {
  return command.add_option(name, values, help)->expected(1)->take_all()->allow_extra_args(false);
}

namespace {

std::vector<std::string_view> pieces_of_list(std::string_view option, std::string_view text) {
  const std::vector<std::string_view> pieces = outermost_pieces(text);
  if (pieces.size() > 1 && std::ranges::any_of(pieces, &std::string_view::empty))
    throw UsageError(
        fmt::format("{} {}: nothing stands beside a comma\nhelp: drop the comma", option, text));
  return pieces;
}

}  // namespace

Assignment split_assignment(std::string_view option, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view name = without_blanks(text.substr(0, equals));
  if (equals == std::string_view::npos || name.empty() ||
      without_blanks(text.substr(equals + 1)).empty())
    throw UsageError(
        fmt::format("{} {}: not an assignment\nhelp: write {} NAME=VALUE", option, text, option));
  return {std::string(name), std::string(without_blanks(text.substr(equals + 1)))};
}

std::vector<Assignment> split_assignments(std::string_view option, std::string_view text) {
  std::vector<std::vector<std::string>> groups;  // "NAME=VALUE", then what belongs to its list
  for (const std::string_view piece : pieces_of_list(option, text)) {
    if (piece.find('=') != std::string_view::npos || groups.empty()) groups.emplace_back();
    groups.back().emplace_back(piece);
  }
  std::vector<Assignment> assignments;
  for (const std::vector<std::string>& group : groups) {
    auto [name, value] = split_assignment(option, group.front());
    if (group.size() > 1)
      value = fmt::format("[{}, {}]", value, fmt::join(group.begin() + 1, group.end(), ","));
    assignments.emplace_back(std::move(name), std::move(value));
  }
  return assignments;
}

std::vector<std::string> listed(std::string_view option, const std::vector<std::string>& lists) {
  std::vector<std::string> pieces;
  for (const std::string& list : lists) {
    for (const std::string_view piece : pieces_of_list(option, list)) pieces.emplace_back(piece);
  }
  return pieces;
}

long integer_value(const std::string& what, const std::string& text, long least) {
  constexpr long largest = 1'000'000'000'000'000;
  std::optional<Rational> value;
  try {
    value = evaluate_constant(read_expression(what, text, {}), make_source(what, text), {});
  } catch (const ModelError&) {
    value.reset();
  }
  if (!value || value->get_den() != 1 || *value < least || *value > largest)
    throw UsageError(fmt::format("{}: not an integer between {} and 1e15", what,
                                 least == -largest ? "-1e15" : std::to_string(least)));
  return value->get_num().get_si();
}

Rational constant_option(const std::string& option, const std::string& text) {
  const std::string what = option + " " + text;
  return evaluate_constant(read_expression(what, text, {}), make_source(what, text), {});
}

int modified_term_count(const std::string& option, const std::string& text) {
  const long count = integer_value(option + " " + text, text, 1);
  if (count > 8) throw UsageError(fmt::format("{} {}: at most 8 terms", option, text));
  return static_cast<int>(count);
}

SizesAndRest split_sizes(const Model& model, const std::vector<std::string>& set) {
  SizesAndRest result;
  for (const Assignment& assignment : all_assignments("--set", set)) {
    const auto& [name, value] = assignment;
    const bool is_size = std::ranges::any_of(
        model.sizes, [&name = name](const Size& size) { return size.name == name; });
    if (is_size)
      result.sizes[name] =
          integer_value(fmt::format("--set {}={}", name, value), value, -1'000'000'000'000'000);
    else
      result.rest.push_back(assignment);
  }
  return result;
}

Request request_of(const MethodOptions& options) {
  require_no_member_besides_scheme(options);
  Request request;
  request.scheme = options.scheme;
  request.alpha = options.alpha;
  request.beta = options.beta;
  request.gamma = options.gamma;
  if (!options.order.empty()) {
    request.order = static_cast<int>(
        std::min(integer_value("--order " + options.order, options.order, 1), 99L));
  }
  request.gauge = options.gauge;
  request.reference = all_assignments("--reference", options.reference);
  request.solver = options.solver;
  request.scalar = options.scalar;
  request.fold = listed("--fold", options.fold);
  request.plain_sums = options.plain_sums;
  return request;
}

Setting read_setting(const MethodOptions& method, const SceneOptions& scene) {
  Setting setting;
  setting.source = read_source(method.model);
  setting.request = request_of(method);
  SizesAndRest set;
  if (!scene.set.empty()) set = split_sizes(read_model(setting.source), scene.set);
  setting.request.sizes = set.sizes;
  setting.model = read_request(setting.source, setting.request);
  setting.scene.scene = scene.scene;
  setting.scene.set = std::move(set.rest);
  setting.scene.initial = all_assignments("--initial", scene.initial);
  setting.scene.h = scene.h;
  setting.scene.steps = scene.steps;
  setting.scene.time = scene.time;
  setting.scene.observe = scene.observe;
  return setting;
}

namespace {

// A command that knows no run-time values sets sizes only.
std::map<std::string, long> sizes_of(const std::vector<std::string>& set,
                                     const SourceText& source) {
  const SizesAndRest split = split_sizes(read_model(source), set);
  if (!split.rest.empty())
    throw UsageError(
        fmt::format("--set {0}={1}: {0} is not a size of {2}\nhelp: `size` constants shape the "
                    "code and are set here; parameters get their values at run time, with "
                    "`hamgen run --set`, or with a scene, --scene NAME",
                    split.rest.front().first, split.rest.front().second, source.path));
  return split.sizes;
}

}  // namespace

Request request_of(const MethodOptions& options, const SceneOptions& scene,
                   const SourceText& source) {
  // A model without scenes has one without a name, where its initial state is given.
  const bool is_unnamed =
      scene.scene.empty() && !scene.initial.empty() && read_model(source).scenes.empty();
  if (!scene.scene.empty() || is_unnamed) {
    Setting setting = read_setting(options, scene);
    const SceneValues values = scene_values(setting.model, setting.scene);
    take_gauge_at(values, setting.model, setting.request);
    specialise(scene, values, {}, Observing::as_the_scene, setting);
    return setting.request;
  }
  if (!scene.initial.empty())
    throw UsageError("--initial changes a scene, but none is named\nhelp: add --scene NAME");
  if (!scene.keep.empty())
    throw UsageError(
        "--keep is about what a scene does not need, but none is named\nhelp: without --scene "
        "nothing is left out");
  if (scene.observe)
    throw UsageError(
        "--observe is about what is looked at in a scene, but none is named\nhelp: add --scene "
        "NAME");
  Request request = request_of(options);
  if (!scene.set.empty()) request.sizes = sizes_of(scene.set, source);
  if (request.gauge->locally_exact) {
    // Where a run without further options takes it.
    const Model model = read_request(source, request);
    if (!model.scenes.empty()) take_gauge_at(scene_values(model, {}), model, request);
  }
  return request;
}

void specialise(const SceneOptions& options, const SceneValues& values,
                const std::vector<std::string>& varied, Observing observing, Setting& setting) {
  const Model& model = setting.model;
  std::set<std::string> known;
  for (const auto& names : {element_names(model.coordinates), element_names(model.momenta),
                            element_names(model.parameters)}) {
    for (const std::string& name : names) {
      known.insert(name);
      known.insert(name.substr(0, name.find('[')));
    }
  }
  SceneFacts facts{.asked = setting.scene,
                   .values = values,
                   .kept = names_computed_from(model, setting.scene, varied)};
  if (observing == Observing::everything) {
    facts.values.observe.clear();
    facts.values.formulas.clear();
  }
  for (const std::string& name : listed("--keep", options.keep)) {
    if (!known.contains(name)) {
      const std::string near = nearest(name, {known.begin(), known.end()});
      throw UsageError(fmt::format("--keep {}: {} has no such variable or parameter{}", name,
                                   model.name,
                                   near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    facts.kept.insert(name);
  }
  if (!options.whole) {
    setting.request.scene = std::move(facts);
  } else if (!facts.values.formulas.empty() || !facts.values.watched.empty()) {
    // What a scene or a run defines to look at it is computed, and nothing left out for that.
    facts.kept = std::move(known);
    setting.request.scene = std::move(facts);
  }
}

void record_origin(const MethodOptions& options, const SourceText& source, Request& request) {
  request.command = generate_command(options.model, request);
  request.model_digest = runtime::sha256_hex(source.text);
}

}  // namespace hamgen::app
