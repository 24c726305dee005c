// hamgen report: all there is to know of a model and a method, on one page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/bench_options.hpp"
#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/bench_output.hpp"
#include "app/output/gnuplot.hpp"
#include "app/output/output_name.hpp"
#include "app/output/report_page.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/modified_energy.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::app {
namespace {

constexpr const char* kDefaultTarget = "1e-8";
// The page says which method is the quickest for each of these.
constexpr const char* kLadder = "1e-2,1e-4,1e-6,1e-8,1e-10,1e-12";

struct ReportOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string output, schemes;
  CompilerChoice compiler;
  std::string target = kDefaultTarget;
  std::string rounds = "5";
  bool json = false;
  bool quiet = false;
};

std::string drawn_text(const std::string& script, const std::filesystem::path& svg,
                       std::string& problem) {
  const std::string failed = run_gnuplot(script, svg, &interrupt_flag());
  if (failed.empty()) return runtime::read_file(svg);
  if (problem.empty()) problem = failed;
  return "";
}

// With its panels one below the other, for a narrow screen.
Plot narrow_form(Plot plot) {
  plot.stacked = true;
  plot.width = 440;
  plot.height = plot.panels.size() > 1 ? 370 : 560;
  return plot;
}

// A figure's three files; the pictures' text for the page.
ReportPicture draw_figure(const Figure& figure, const std::filesystem::path& directory,
                          std::string& problem) {
  ReportPicture picture{.name = figure.name, .caption = figure.caption, .large = figure.large};
  const std::filesystem::path svg = directory / (figure.name + ".svg");
  const std::filesystem::path png = directory / (figure.name + ".png");
  const std::string text = gnuplot_script(figure.plot, svg.string());
  runtime::atomic_write(directory / (figure.name + ".gp"), text);
  const std::string failed =
      run_gnuplot(gnuplot_script(figure.plot, png.string()), png, &interrupt_flag());
  if (problem.empty()) problem = failed;
  if (!failed.empty()) return picture;
  picture.svg = drawn_text(text, svg, problem);
  if (!figure.large) return picture;
  const runtime::TemporaryDirectory aside = runtime::private_directory();
  const std::filesystem::path narrow = aside.path() / svg.filename();
  picture.narrow_svg =
      drawn_text(gnuplot_script(narrow_form(figure.plot), narrow.string()), narrow, problem);
  return picture;
}

std::vector<ReportPicture> draw_all(const std::vector<Figure>& figures,
                                    const std::filesystem::path& directory) {
  std::vector<ReportPicture> pictures;
  std::string problem;
  for (const Figure& figure : figures) {
    if (interrupt_flag()) return pictures;
    pictures.push_back(draw_figure(figure, directory, problem));
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

// The page's step over the bench's time, measured as the bench measures.
BenchRow subject_row(const BenchMethod& method, const SceneValues& scene, const Bench& bench,
                     long rounds) {
  const double h = to_double(*scene.h);
  BenchRow row{.h = *scene.h, .steps = std::max(1L, std::lround(std::fabs(bench.time / h)))};
  measure_errors(method, scene, bench.reference, row);
  for (long round = 0; row.ok() && round < rounds && !interrupt_flag(); ++round)
    measure_time(method, scene, row);
  return row;
}

int stopped() {
  print_error("hamgen: stopped; no page was written\n");
  return interrupted;
}

// On the page the model has no folder: it is for others too.
std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

int report(const ReportOptions& options) {
  require_directory("-o", options.output);
  Setting setting = read_setting(options.method, options.scene);
  const SourceText& source = setting.source;
  const Model& model = setting.model;
  Request& request = setting.request;
  const SceneValues scene = complete_scene(model, setting.scene);
  take_gauge_at(scene, model, request);
  specialise(options.scene, scene, {}, Observing::everything, setting);
  SourceText shown = source;
  shown.path = file_name(source.path);
  MethodOptions named = options.method;
  named.model = shown.path;
  record_origin(named, source, request);
  const BenchMethod method = chosen_method(options, shown, request);
  // With all parameters by their names, folded ones too.
  const Mechanics mechanics = derive(read_model(source, request.sizes));

  const BenchRequest asked = read_bench({.model = options.method.model,
                                         .scene = options.scene,
                                         .schemes = options.schemes,
                                         .target = options.target + "," + kLadder,
                                         .compiler = options.compiler,
                                         .rounds = options.rounds,
                                         .quiet = options.quiet,
                                         .length = "--steps 1000"});
  const Bench bench = run_bench(asked);
  if (interrupt_flag()) return stopped();
  print_error(warning_text(bench));
  const ReferenceRequest reference{
      .sizes = request.sizes, .compiler = options.compiler, .stop = &interrupt_flag()};
  const ReportSubject subject{
      .method = &method, .scene = &scene, .row = subject_row(method, scene, bench, asked.rounds)};
  ReportFigures drawn = report_figures(subject, source, bench, reference);
  if (interrupt_flag()) return stopped();

  const std::filesystem::path directory =
      options.output.empty() ? model.name + "-report" : options.output;
  make_directories_above({directory.string()}, options.quiet);
  const ReportContent content{
      .plugin = &method.plugin,
      .mechanics = &mechanics,
      .scene = &scene,
      .bench = &bench,
      .row = subject.row,
      .proof = verify_step(source, request),
      .linear = linear_points(source, request, scene),
      .modified = modified_energy_of(source, request, scene),
      .orbit = drawn.orbit,
      .pictures = draw_all(drawn.figures, directory),
      .header = generate_plugin(shown, request, HeaderText::without_proof).header.text,
      .file = shown.path,
      .command = request.command,
      .path = options.method.model};
  if (interrupt_flag()) return stopped();
  const std::filesystem::path page = directory / "report.html";
  runtime::atomic_write(page, report_page(content));
  runtime::atomic_write(directory / "bench.csv", csv_text(bench));
  print(options.json ? report_json(content, directory.string()) : page.string() + "\n");
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
  parser
      ->add_option("--target", options->target,
                   "the error for which the page says what to take; default 1e-8")
      ->type_name("E");
  parser->add_option("--rounds", options->rounds, "samples of each time; default 5")
      ->type_name("N");
  parser->add_flag("--json", options->json, "what the page says, as JSON on standard output");
  parser->add_flag("--quiet", options->quiet, "no progress");
  add_method_options(*parser, options->method);
  add_compiler_options(*parser, options->compiler);
  return {parser, [options] { return report(*options); }};
}

}  // namespace hamgen::app
