#include "app/output/draw_picture.hpp"

#include <fmt/format.h>

#include "app/output/plot.hpp"
#include "app/output/terminal.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {

bool draw_picture(const PictureFiles& files, bool quiet, StopFlag stop) {
  runtime::atomic_write(files.script, files.text);
  if (!quiet) print_error(fmt::format("{}\n", files.script.string()));
  const std::string problem = run_gnuplot(files.text, files.picture, stop);
  if (!problem.empty()) {
    print_error(
        fmt::format("hamgen: no picture: {}\nhelp: with gnuplot installed, draw it with: "
                    "gnuplot {}\n",
                    problem, files.script.string()));
    return false;
  }
  if (!quiet) print_error(fmt::format("{}\n", files.picture.string()));
  return true;
}

}  // namespace hamgen::app
