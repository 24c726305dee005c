// hamgen plot: a picture of a trajectory file.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/terminal.hpp"
#include "app/output/trajectory_plot.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

struct PlotOptions {
  std::string file, output, columns;
  bool quiet = false;
};

int run_plot(const PlotOptions& options) {
  require_picture_name("-o", options.output);
  const NumberTable table = read_number_table(options.file);
  if (!table.is_whole && !options.quiet)
    print_error(fmt::format(
        "hamgen: warning: {} has no line '# status' at its end: it was cut off\n", options.file));
  const std::string title = std::filesystem::path(options.file).stem().string();
  const Plot plot = trajectory_plot(table, options.columns, title);
  const bool drawn =
      draw_picture({.picture = options.output,
                    .script = std::filesystem::path(options.output).replace_extension(".gp"),
                    .text = gnuplot_script(plot, options.output)},
                   options.quiet, &interrupt_flag());
  if (!drawn && interrupt_flag()) return interrupted;
  return drawn ? done : tool_failure;
}

}  // namespace

Command add_plot(CLI::App& app) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* parser = app.add_subcommand("plot", "draws a trajectory that `run -o` wrote");
  parser->add_option("FILE", options->file, "a trajectory, .csv")->required();
  parser
      ->add_option("-o,--output", options->output, "the picture, .svg or .png, and its script .gp")
      ->type_name("FILE")
      ->required();
  parser
      ->add_option("--columns", options->columns,
                   "q over time, q:p, x:y:z; default: orbit, momenta, energy error")
      ->type_name("LIST");
  parser->add_flag("--quiet", options->quiet, "say nothing but what is wrong");
  return {parser, [options] { return run_plot(*options); }};
}

}  // namespace hamgen::app
