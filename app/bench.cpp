// hamgen bench: error against run time, method by method and step by step.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/bench_options.hpp"
#include "app/interrupt.hpp"
#include "app/output/bench_output.hpp"
#include "app/output/bench_picture.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/output_name.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct BenchCommand {
  BenchOptions bench;
  std::string output, csv, plot;
  bool all = false;
  bool json = false;
};

void write_files(const BenchCommand& options, const Bench& bench) {
  make_directories_above({options.output, options.csv, options.plot}, options.bench.quiet);
  namespace fs = std::filesystem;
  const auto write = [&options](const fs::path& path, const std::string& text) {
    runtime::atomic_write(path, text);
    if (!options.bench.quiet) print_error(fmt::format("{}\n", path.string()));
  };
  const auto draw = [&](const fs::path& picture) {
    draw_picture({.picture = picture,
                  .script = fs::path(picture).replace_extension(".gp"),
                  .text = gnuplot_script(bench_picture(bench), picture.string())},
                 options.bench.quiet, &interrupt_flag());
  };
  if (!options.csv.empty()) write(options.csv, csv_text(bench));
  if (!options.plot.empty()) draw(options.plot);
  const OutputKind kind = output_kind(options.output);
  if (kind == OutputKind::csv) write(options.output, csv_text(bench));
  if (kind == OutputKind::json) write(options.output, json_text(bench));
  if (kind != OutputKind::directory) return;
  const fs::path directory = options.output;
  write(directory / "bench.csv", csv_text(bench));
  write(directory / "bench.json", json_text(bench));
  draw(directory / "bench.svg");
}

int bench(const BenchCommand& options) {
  if (!options.plot.empty() && !options.plot.ends_with(".svg") && !options.plot.ends_with(".png"))
    throw UsageError(fmt::format("--plot {}: the name ends in .svg or .png", options.plot));
  const OutputKind kind = output_kind(options.output);
  require_one_document(options.json, kind);
  require_writable({options.output, options.csv, options.plot});
  const Bench result = run_bench(read_bench(options.bench));
  if (result.is_stopped && result.rows.empty()) {
    print_error("hamgen: stopped; nothing was measured yet\n");
    return interrupted;
  }
  print_error(warning_text(result));
  print(options.json ? json_text(result)
        : kind == OutputKind::standard
            ? csv_text(result)
            : table_text(result, options.all || !options.bench.h.empty()));
  write_files(options, result);
  if (result.is_stopped) {
    print_error("hamgen: stopped; these rows were measured\n");
    return interrupted;
  }
  // Only errors that were asked for are missed.
  if (options.bench.target.empty()) return done;
  const bool all_reached =
      std::ranges::all_of(result.answers, [](const auto& each) { return each.row.has_value(); });
  return all_reached ? done : numerical_failure;
}

}  // namespace

Command add_bench(CLI::App& app) {
  const auto options = std::make_shared<BenchCommand>();
  CLI::App* parser =
      app.add_subcommand("bench", "measures error against run time, method by method");
  parser->add_option("MODEL", options->bench.model, "a .ham file")->required();
  add_scene_options(*parser, options->bench.scene);
  parser
      ->add_option("--schemes", options->bench.schemes,
                   "names, with options: gauss-4,alpha=1/2:beta=-h/9")
      ->type_name("A,B,...");
  parser->add_flag("--plain-sums", options->bench.plain_sums,
                   "of all methods: rounding is not made up for");
  parser
      ->add_option("--h", options->bench.h,
                   "step sizes; default: for each method those that matter")
      ->type_name("H1,H2,...");
  parser->add_option("--time", options->bench.time, "")->type_name("T");
  parser
      ->add_option("--steps", options->bench.steps,
                   "of each run, N of the scene's steps; default: 2000 of them")
      ->type_name("N");
  parser
      ->add_option("--target", options->bench.target,
                   "errors to reach; default 1e-4,1e-6,1e-8,1e-10")
      ->type_name("E1,E2,...");
  parser->add_option("--observe", options->bench.observe, "the error that counts: state or energy")
      ->type_name("WHAT");
  parser->add_option("--rounds", options->bench.rounds, "samples of each time; default 9")
      ->type_name("N");
  parser
      ->add_option("-o,--output", options->output,
                   "bench.csv, .json, .gp and .svg there; or FILE.csv, FILE.json")
      ->type_name("DIRECTORY");
  parser->add_option("--csv", options->csv, "the table as CSV")->type_name("FILE");
  parser->add_option("--plot", options->plot, "a picture, .svg or .png, and its script .gp")
      ->type_name("FILE");
  parser->add_flag("--all", options->all, "");
  parser->add_flag("--json", options->json, "print all rows; the table as JSON");
  parser->add_flag("--quiet", options->bench.quiet, "no progress, no names of files");
  add_compiler_options(*parser, options->bench.compiler);
  return {parser, [options] { return bench(*options); }};
}

}  // namespace hamgen::app
