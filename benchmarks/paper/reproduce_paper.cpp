// Measures every figure of the paper and writes the page, gnuplot's tables and the key numbers.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "benchmarks/paper/study.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/compiler.hpp"
#include "runtime/provenance.hpp"

namespace hamgen::paper {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string provenance(const Study& study) {
  const runtime::Provenance run = runtime::provenance_of(runtime::find_compiler());
  return fmt::format(
      "| | |\n| --- | --- |\n| machine | {} |\n| compiler | {} |\n| flags | {} |\n"
      "| hamgen | {} |\n| date | {}{} |\n\n"
      "*Solved* means to round-off, *kappa = 5* five sweeps of the paper's Algorithm 1, which run "
      "in\n"
      "double, as do figures 2 and 3 and h = 10. The rest runs in long double, in which all "
      "energies\n"
      "are evaluated. *Spread* is max H - min H over the steps of a run. *Order 4, 6, 8* are "
      "members\n"
      "of the family, alpha = 1/2 and beta = gamma = 0, raised by their generating function.\n",
      run.machine, run.compiler, run.flags, HAMGEN_VERSION, run.date,
      study.quick ? ", quick run: few steps, coarse planes" : "");
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  runtime::AtomicFile file(path);
  file.write(text);
  file.publish();
}

using Figure = Section (*)(const Study&);
constexpr std::pair<const char*, Figure> kFigures[] = {{"figure 2", figure_2},
                                                       {"figure 3", figure_3},
                                                       {"h = 10", large_steps},
                                                       {"time reversal", time_reversal},
                                                       {"figure 4", figure_4},
                                                       {"figure 5", figure_5},
                                                       {"figure 6", figure_6},
                                                       {"figures 7 and 8", figures_7_and_8},
                                                       {"all integrators", all_integrators}};

void run(bool quick, const std::filesystem::path& data, const std::filesystem::path& page) {
  const auto begin = std::chrono::steady_clock::now();
  std::fputs("compiling integrators\n", stderr);
  const Study study = make_study(quick, data);
  std::vector<Section> sections;
  for (const auto& [name, figure] : kFigures) {
    std::fputs(fmt::format("{:6.1f} s  {}\n", seconds_since(begin), name).c_str(), stderr);
    sections.push_back(figure(study));
  }
  write_file(page, page_text(sections, provenance(study)));
  write_file(data / "numbers.json", numbers_text(sections));
  std::fputs(fmt::format("{:6.1f} s  measured\n", seconds_since(begin)).c_str(), stderr);
}

}  // namespace
}  // namespace hamgen::paper

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  if (argc != (quick ? 4 : 3)) {
    std::fputs("usage: reproduce_paper [--quick] DATA_DIRECTORY PAGE\n", stderr);
    return 2;
  }
  try {
    hamgen::paper::run(quick, argv[argc - 2], argv[argc - 1]);
  } catch (const std::exception& error) {
    std::fputs(fmt::format("error: {}\n", error.what()).c_str(), stderr);
    return 1;
  }
  return 0;
}
