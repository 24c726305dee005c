// hamgen report: all there is to know of a model and a method, on one page.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include "app/bench_options.hpp"
#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/report_page.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/modified_energy.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct ReportOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string output, schemes;
  CompilerChoice compiler;
  std::string rounds = "5";
  bool quiet = false;
};

// A figure's three files; the picture's text for the page.
ReportPicture draw_figure(const Figure& figure, const std::filesystem::path& directory,
                          std::string& problem) {
  ReportPicture picture{.name = figure.name, .caption = figure.caption};
  const std::filesystem::path svg = directory / (figure.name + ".svg");
  const std::filesystem::path png = directory / (figure.name + ".png");
  const std::filesystem::path script = directory / (figure.name + ".gp");
  const std::string text = gnuplot_script(figure.plot, svg.string());
  runtime::atomic_write(script, text);
  problem = run_gnuplot(gnuplot_script(figure.plot, png.string()), png, &interrupt_flag());
  if (!problem.empty()) return picture;
  problem = run_gnuplot(text, svg, &interrupt_flag());
  if (problem.empty()) picture.svg = runtime::read_file(svg);
  return picture;
}

std::vector<ReportPicture> draw_all(const std::vector<Figure>& figures,
                                    const std::filesystem::path& directory) {
  std::vector<ReportPicture> pictures;
  std::string problem;
  for (const Figure& figure : figures) {
    std::string failed;
    pictures.push_back(draw_figure(figure, directory, failed));
    if (problem.empty()) problem = failed;
  }
  if (!problem.empty())
    print_error(fmt::format("hamgen: pictures are missing: {}\nhelp: the scripts *.gp are in {}\n",
                            problem, directory.string()));
  return pictures;
}

BenchMethod chosen_method(const ReportOptions& options, const SourceText& source,
                          const Request& request) {
  BenchMethod method =
      bench_method(options.method.scheme, source, request, options.compiler, &interrupt_flag());
  if (!method.refusal.empty())
    throw UsageError(fmt::format("{}: {}", options.method.model, method.refusal));
  return method;
}

// Of a member with few degrees of freedom; empty where there is none, or its terms are too long.
std::optional<ModifiedEnergy> modified_energy_of(const SourceText& source, const Request& request,
                                                 SceneValues scene) {
  constexpr long most_degrees_of_freedom = 4;
  constexpr long most_steps = 20'000;
  if (degrees_of_freedom(read_request(source, request)) > most_degrees_of_freedom) return {};
  scene.steps = std::min(*scene.steps, most_steps);
  for (const int count : {3, 2}) {
    try {
      ModifiedEnergy modified;
      modified.terms = modified_hamiltonian(source, request, count);
      modified.orbit = watch_orbit(source, request, scene, modified.terms, &interrupt_flag());
      return modified;
    } catch (const UsageError&) {
      continue;  // no member, or too long
    }
  }
  return {};
}

Proof linear_part(const SourceText& source, const Request& request, const SceneValues& scene) {
  Proof proof;
  for (const LinearPoint& point : linear_points(source, request, scene)) {
    for (Finding& finding : findings(point)) proof.push_back(std::move(finding));
  }
  return proof;
}

int report(const ReportOptions& options) {
  Setting setting = read_setting(options.method, options.scene);
  const SourceText& source = setting.source;
  const Model& model = setting.model;
  Request& request = setting.request;
  const SceneValues scene = complete_scene(model, setting.scene);
  take_gauge_at(scene, model, request);
  specialise(options.scene, scene, {}, Observing::everything, setting);
  record_origin(options.method, source, request);
  const BenchMethod method = chosen_method(options, source, request);
  // With all parameters by their names, folded ones too.
  const Mechanics mechanics = derive(read_model(source, request.sizes));

  const Bench bench = run_bench(read_bench({.model = options.method.model,
                                            .scene = options.scene,
                                            .schemes = options.schemes,
                                            .compiler = options.compiler,
                                            .rounds = options.rounds,
                                            .quiet = options.quiet,
                                            .length = "--steps 1000"}));
  if (interrupt_flag()) return interrupted;
  print_error(warning_text(bench));
  const ReferenceRequest reference{
      .sizes = request.sizes, .compiler = options.compiler, .stop = &interrupt_flag()};
  ReportFigures drawn = report_figures(method, scene, source, bench, reference);
  if (interrupt_flag()) return interrupted;

  const std::filesystem::path directory =
      options.output.empty() ? model.name + "-report" : options.output;
  const ReportContent content{.plugin = &method.plugin,
                              .mechanics = &mechanics,
                              .scene = &scene,
                              .bench = &bench,
                              .proof = verify_step(source, request),
                              .linear = linear_part(source, request, scene),
                              .modified = modified_energy_of(source, request, scene),
                              .orbit = drawn.orbit,
                              .pictures = draw_all(drawn.figures, directory),
                              .command = request.command};
  const std::filesystem::path page = directory / "report.html";
  runtime::atomic_write(page, report_page(content));
  runtime::atomic_write(directory / "bench.csv", csv_text(bench));
  print(page.string() + "\n");
  return done;
}

}  // namespace

Command add_report(CLI::App& app) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* parser = app.add_subcommand("report", "writes a page about a model and a method");
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->scene);
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser
      ->add_option("--steps", options->scene.steps, "time or number of steps; default: the scene's")
      ->type_name("N");
  parser
      ->add_option("-o,--output", options->output,
                   "report.html, pictures and scripts; default: MODEL-report")
      ->type_name("DIRECTORY");
  parser->add_option("--schemes", options->schemes, "methods compared, as for bench")
      ->type_name("A,B,...");
  parser->add_option("--rounds", options->rounds, "samples of each time; default 5")
      ->type_name("N");
  parser->add_flag("--quiet", options->quiet, "no progress");
  add_method_options(*parser, options->method);
  add_compiler_options(*parser, options->compiler);
  return {parser, [options] { return report(*options); }};
}

}  // namespace hamgen::app
