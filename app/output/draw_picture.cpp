#include "app/output/draw_picture.hpp"

#include <fmt/format.h>

#include <vector>

#include "app/output/gnuplot.hpp"
#include "app/output/terminal.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

// A script draws into the folder in which it is run.
std::string drawing_command(const std::filesystem::path& script) {
  const std::vector<std::string> draw = {"gnuplot", script.filename().string()};
  const std::vector<std::string> go = {"cd", script.parent_path().string()};
  return (script.has_parent_path() ? runtime::command_text(go) + " && " : "") +
         runtime::command_text(draw);
}

}  // namespace

bool draw_picture(const PictureFiles& files, bool quiet, StopFlag stop) {
  runtime::atomic_write(files.script, files.text);
  if (!quiet) print_error(fmt::format("{}\n", files.script.string()));
  const std::string problem = run_gnuplot(files.text, files.picture, stop);
  if (!problem.empty() && is_stopped(stop)) {
    print_error(fmt::format("hamgen: stopped; the picture was not drawn\nhelp: draw it with: {}\n",
                            drawing_command(files.script)));
    return false;
  }
  if (!problem.empty()) {
    print_error(
        fmt::format("hamgen: no picture: {}\nhelp: with gnuplot installed, draw it with: {}\n",
                    problem, drawing_command(files.script)));
    return false;
  }
  if (!quiet) print_error(fmt::format("{}\n", files.picture.string()));
  return true;
}

}  // namespace hamgen::app
