#include "app/output/gnuplot.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>

#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"
#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

struct ColourPair {
  int red, green, blue;   // on white
  std::string_view dark;  // on black
};

// Of curves as in plot.cpp, in the same order, then borders, grid, paper.
constexpr std::array<ColourPair, 11> kColourPairs = {{{0, 114, 178, "#5AB2EC"},
                                                      {213, 94, 0, "#F28A50"},
                                                      {0, 158, 115, "#40C79A"},
                                                      {204, 121, 167, "#E59CC7"},
                                                      {0, 0, 0, "#E6E4DF"},
                                                      {230, 159, 0, "#F0BC48"},
                                                      {86, 180, 233, "#ABDDFF"},
                                                      {127, 96, 0, "#C6A956"},
                                                      {85, 85, 85, "#A5A29A"},
                                                      {221, 221, 221, "#35373B"},
                                                      {255, 255, 255, "#17181A"}}};

// The script with another output.
std::string with_output(std::string script, const std::filesystem::path& output) {
  const std::size_t begin = script.find("set output ");
  if (begin == std::string::npos) internal_error("a script without an output");
  const std::size_t end = script.find('\n', begin);
  return script.replace(begin, end - begin, "set output " + gnuplot_path(output.string()));
}

// Under a temporary name until it is published.
class Aside {
 public:
  explicit Aside(const std::filesystem::path& picture)
      : picture_(picture), path_(runtime::temporary_name(picture)) {}
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  ~Aside() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void publish() const {
    std::error_code failed;
    std::filesystem::rename(path_, picture_, failed);
    if (failed) throw runtime::file_error("write", picture_, failed.value());
  }

 private:
  std::filesystem::path picture_;
  std::filesystem::path path_;
};

// Gnuplot does not mind a full disk.
bool is_whole(const std::filesystem::path& picture) {
  if (!std::filesystem::exists(picture)) return false;
  const std::string text = runtime::read_file(picture);
  if (text.starts_with("\x89PNG")) return text.ends_with("IEND\xAE\x42\x60\x82");
  return text.substr(0, text.find_last_not_of('\n') + 1).ends_with("</svg>");
}

// A rule for all ways in which gnuplot writes a colour.
std::string dark_rule(std::string_view light, std::string_view dark) {
  std::string rules;
  for (const char* property : {"stroke", "fill", "color"})
    rules += fmt::format("[{0}='{1}'] {{ {0}: {2} }}\n", property, light, dark);
  return rules;
}

}  // namespace

std::string output_line(const std::string& output) {
  return "set output " + gnuplot_path(std::filesystem::path(output).filename().string()) + "\n";
}

std::string script_head(const std::string& output, int width, int height) {
  const bool png = output.ends_with(".png");
  const int factor = png ? 2 : 1;  // for sharp screens and print
  return fmt::format(
      "# Drawn by: gnuplot THIS_FILE\n"
      "set terminal {} size {},{} enhanced font '{},{}' background rgb 'white'{}\n"
      "{}"
      "set border 3 lc rgb '#555555'\nset tics nomirror out scale 0.6\n"
      "set encoding utf8\nset grid lc rgb '#DDDDDD' lw 0.6 dt 1\nset samples 2\n",
      png ? "pngcairo" : "svg", factor * width, factor * height,
      png ? "Sans" : "Helvetica, Arial, sans-serif", png ? 11 : 15,
      png ? " fontscale 1.7 linewidth 2 pointscale 2" : " dynamic", output_line(output));
}

std::string with_dark_form(const std::string& svg) {
  const std::size_t root = svg.find("<svg");
  const std::size_t end = root == std::string::npos ? root : svg.find('>', root);
  if (end == std::string::npos) return svg;
  std::string style = "\n<style>@media (prefers-color-scheme: dark) {\n";
  for (const ColourPair& each : kColourPairs) {
    style +=
        dark_rule(fmt::format("rgb({:3}, {:3}, {:3})", each.red, each.green, each.blue), each.dark);
    style += dark_rule(fmt::format("rgb({},{},{})", each.red, each.green, each.blue), each.dark);
  }
  style += dark_rule("black", kColourPairs[4].dark) + dark_rule("#ffffff", kColourPairs[10].dark);
  return svg.substr(0, end + 1) + style + "}</style>" + svg.substr(end + 1);
}

std::string run_gnuplot(const std::string& script, const std::filesystem::path& picture,
                        StopFlag stop) {
  try {
    const runtime::TemporaryDirectory directory = runtime::private_directory();
    const Aside aside(picture);
    const std::filesystem::path file = directory.path() / "script.gp";
    runtime::atomic_write(file, with_output(script, aside.path()));
    runtime::ProcessRequest request;
    request.command = {"gnuplot", file.string()};
    request.stop = stop;
    const runtime::ProcessResult result = runtime::run_process(request);
    if (!result.succeeded())
      return fmt::format("gnuplot: {}\n{}", runtime::end_text(result, request),
                         runtime::tail_of(result.output));
    if (!is_whole(aside.path()))
      throw runtime::ToolError(
          {.message = fmt::format("cannot write '{}': gnuplot did not write all of it: is the disk "
                                  "full?",
                                  picture.string())});
    if (picture.extension() == ".svg") {
      runtime::atomic_write(picture, with_dark_form(runtime::read_file(aside.path())));
    } else {
      aside.publish();
    }
    return "";
  } catch (const runtime::ToolError& error) {
    const runtime::ToolFailure& failure = error.failure();
    if (failure.command.empty()) throw;  // of a file
    return "gnuplot could not be started: " + failure.message;
  }
}

}  // namespace hamgen::app
