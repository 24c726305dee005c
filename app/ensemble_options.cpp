#include "app/ensemble_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/axis_option.hpp"
#include "app/studies/threads.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"

namespace hamgen::app {
namespace {

// NAME=uniform(A,B) or NAME=normal(MEAN,DEVIATION)
EnsembleDraw read_draw(const std::string& text, const std::set<std::string>& names) {
  const auto wrong = [&text] {
    return UsageError(fmt::format(
        "--random {}: uniform(A,B) with A < B, or normal(MEAN,DEVIATION) with DEVIATION > 0 is "
        "wanted\nhelp: for example --random 'q2=uniform(-0.1,0.1)'",
        text));
  };
  const auto [name, law] = split_assignment("--random", text);
  require_varied("--random", text, name, names);
  const std::size_t open = law.find('(');
  if (open == std::string::npos || !law.ends_with(')')) throw wrong();
  const std::string kind(without_blanks(law.substr(0, open)));
  const std::string inside = law.substr(open + 1, law.size() - open - 2);
  const std::vector<std::string_view> ends = outermost_pieces(inside);
  if (ends.size() != 2 || (kind != "uniform" && kind != "normal")) throw wrong();
  const auto number = [&text](std::string_view piece) {
    return to_double(constant_option("--random " + text, std::string(piece)));
  };
  const EnsembleDraw draw{
      .name = name,
      .distribution = kind == "uniform" ? Distribution::uniform : Distribution::normal,
      .a = number(ends[0]),
      .b = number(ends[1])};
  if (kind == "uniform" ? !(draw.a < draw.b) : !(draw.b > 0.0)) throw wrong();
  return draw;
}

void require_known(const EnsemblePlan& plan, const std::vector<std::string>& folded,
                   const std::set<std::string>& names) {
  for (const std::string& name : plan.table.names)
    require_varied("--from", plan.table.path + ", column " + name, name, names);
  std::vector<std::string> all = plan.names();
  require_not_folded(folded, all);
  std::ranges::sort(all);
  if (const auto twice = std::ranges::adjacent_find(all); twice != all.end())
    throw UsageError(fmt::format("{} is given its values twice", *twice));
}

std::vector<std::string> all_observables(const Model& model) {
  std::vector<std::string> names;
  for (const Variable& each : model.coordinates) names.push_back(each.name);
  for (const Variable& each : model.momenta) names.push_back(each.name);
  names.emplace_back("energy");
  for (const Invariant& each : model.invariants) names.push_back(each.name);
  return names;
}

}  // namespace

EnsemblePlan read_plan(const EnsembleOptions& options, const Model& model) {
  const std::set<std::string> names = varied_names(model);
  constexpr long most = 1'000'000'000'000'000;
  EnsemblePlan plan;
  if (!options.from.empty()) plan.table = read_ensemble_table(options.from);
  for (const std::string& text : options.over) {
    for (const std::string_view piece : outermost_pieces(text)) {
      const AxisOption axis = read_axis_option(std::string(piece), names, 2, most);
      plan.axes.push_back(
          {.name = axis.name, .low = axis.low, .high = axis.high, .count = axis.count});
    }
  }
  for (const std::string& text : options.random) {
    for (const std::string_view piece : outermost_pieces(text))
      plan.draws.push_back(read_draw(std::string(piece), names));
  }
  if (plan.names().empty())
    throw UsageError(
        "an ensemble differs in something: --over, --random or --from\nhelp: for example --over "
        "q1=-1:1:100, or --random 'q1=normal(0,0.1)' --draws 1000");
  if (plan.draws.empty() && !(options.draws.empty() && options.seed.empty()))
    throw UsageError("--draws and --seed are for --random\nhelp: leave them out");
  if (!options.draws.empty())
    plan.draws_each = integer_value("--draws " + options.draws, options.draws, 1);
  if (!options.seed.empty())
    plan.seed =
        static_cast<std::uint64_t>(integer_value("--seed " + options.seed, options.seed, 0));
  require_known(plan, listed("--fold", options.method.fold), names);
  if (plan.size() > static_cast<double>(kMostTrajectories))
    throw UsageError(fmt::format(
        "these are {:.4g} trajectories, of which 100 bytes each would make {:.4g} TB; {:.0e} are "
        "the most\nhelp: fewer values of --over, --draws or --from, or several ensembles",
        plan.size(), plan.size() * 1e-10, static_cast<double>(kMostTrajectories)));
  return plan;
}

ObservedAndStatistics read_statistics(const std::string& statistics, const Model& model,
                                      SceneRequest scene) {
  const SceneValues before = scene_values(model, scene);
  std::vector<std::string> list = before.observe;
  for (std::string& name : list) {
    for (const ObservedFormula& formula : before.formulas) {
      if (formula.name == name) name += " = " + formula.text;
    }
  }
  ObservedAndStatistics result;
  if (statistics.empty()) {
    result.observe = scene.observe.value_or("");
    return result;
  }
  if (list.empty()) list = all_observables(model);
  std::vector<std::string> names;
  for (const std::string_view piece : outermost_pieces(statistics)) {
    const std::string name(without_blanks(piece.substr(0, piece.find('='))));
    if (name.empty())
      throw UsageError(fmt::format(
          "--statistics {}: names of observables are wanted\nhelp: for example --statistics "
          "'energy, r = sqrt(x^2 + y^2)'",
          statistics));
    names.push_back(name);
    const bool is_there = std::ranges::any_of(list, [&name](const std::string& each) {
      return each == name || each.starts_with(name + "[") || each.starts_with(name + " =") ||
             name.starts_with(each + "[");
    });
    if (piece.find('=') != std::string_view::npos || !is_there) list.emplace_back(piece);
  }
  result.observe = fmt::format("{}", fmt::join(list, ", "));
  scene.observe = result.observe;
  std::vector<std::string> observed;
  try {
    observed = scene_values(model, scene).observe;
  } catch (const UsageError& error) {
    std::string text = error.what();
    if (text.starts_with("--observe")) text.replace(0, text.find(' '), "--statistics:");
    throw UsageError(text);
  }
  for (const std::string& name : names) {
    for (const std::string& each : observed) {
      if (each == name || each.starts_with(name + "[")) result.statistics.push_back(each);
    }
  }
  return result;
}

int read_threads(const EnsembleOptions& options) {
  if (options.threads.empty()) return all_threads();
  const long threads = integer_value("--threads " + options.threads, options.threads, 1);
  if (threads > 1 && !has_threads())
    throw UsageError(
        fmt::format("--threads {}: this hamgen was built without oneTBB, and has one thread\n"
                    "help: build it where the package libtbb-dev is installed",
                    threads));
  return static_cast<int>(std::min(threads, 1024L));
}

void add_ensemble_options(CLI::App& parser, EnsembleOptions& options) {
  add_scene_options(parser, options.scene);
  add_repeated(parser, "--over", options.over, "evenly spaced values of a variable or parameter")
      ->type_name("NAME=LOW:HIGH:COUNT,...");
  add_repeated(parser, "--random", options.random, "uniform(a,b) or normal(mean,deviation)")
      ->type_name("NAME=LAW,...");
  parser.add_option("--draws", options.draws, "")->type_name("N");
  parser.add_option("--seed", options.seed, "")->type_name("S");
  parser.add_option("--from", options.from, "random values for each point; a CSV file of starts")
      ->type_name("FILE");
  parser
      .add_option("--observe", options.scene.observe,
                  "at the end: q, energy, r = sqrt(x^2 + y^2); or the scene's")
      ->type_name("LIST");
  parser.add_option("--statistics", options.statistics, "")->type_name("LIST");
  parser.add_option("--every", options.every, "least, largest, mean; over every K steps")
      ->type_name("K");
  parser.add_option("--h", options.scene.h, "")->type_name("H");
  parser.add_option("--steps", options.scene.steps, "")->type_name("N");
  parser
      .add_option("--time", options.scene.time,
                  "size, and number or time of steps; default: the scene's")
      ->type_name("T");
  parser.add_option("-o,--output", options.output, "")->type_name("FILE");
  parser.add_flag("--resume", options.resume,
                  "results, needed: .csv, .h5; go on with what is missing");
  parser.add_option("--threads", options.threads, "")->type_name("N");
  parser.add_flag("--json", options.json, "");
  parser.add_flag("--quiet", options.quiet,
                  "default: all; the summary as JSON; no summary, no progress");
  add_method_options(parser, options.method);
  add_compiler_options(parser, options.compiler);
}

}  // namespace hamgen::app
