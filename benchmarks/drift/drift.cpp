// drift [--steps N] [--starts N] [--seconds S] [--lanes W] [--scalar S] [WORD...]: a table of the
// rows whose problem or name has one of the words in it; W starts side by side, in lanes; in double
// or float.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "benchmarks/drift/rows.hpp"

namespace {

using namespace hamgen::drift;

struct Options {
  Length length;
  std::vector<std::string> flags = {"-march=native"};  // the same bits, in less time
  std::string scalar = "double";
  std::vector<std::string> words;
};

Options read_options(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const auto text = [&] { return i + 1 < count ? arguments[++i] : "0"; };
    const auto value = [&] { return std::atof(text()); };
    if (argument == "--steps") {
      options.length.steps = static_cast<long long>(value());
    } else if (argument == "--starts") {
      options.length.starts = static_cast<int>(value());
    } else if (argument == "--seconds") {
      options.length.seconds = value();
    } else if (argument == "--lanes") {
      options.length.lanes = static_cast<int>(value());
    } else if (argument == "--scalar") {
      options.scalar = text();
    } else {
      options.words.push_back(argument);
    }
  }
  return options;
}

bool is_wanted(const Row& row, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if ((row.problem + ": " + row.name).find(word) != std::string::npos) return true;
  }
  return words.empty();
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = read_options(count, arguments);
  int drifting = 0;
  int wanted = 0;
  int measured = 0;
  int failed = 0;
  fmt::print("{:30} {:34} {:>6} {:>10} {:>9} {:>7} {:>9} {:>9} {:>8} {:>8}  {}\n", "problem",
             "method", "starts", "mean", "std error", "errors", "units", "own rate", "chance",
             "ns/step", "verdict");
  for (Row& row : all_rows()) {
    if (!is_wanted(row, options.words)) continue;
    ++wanted;
    row.scalar = options.scalar;
    fmt::print("{:30} {:34} ", row.problem, row.name);
    std::fflush(stdout);
    try {
      const Result r = measure(row, options.length, {}, options.flags);
      ++measured;
      const bool drifts = r.drifts();
      if (drifts && !row.is_exempt) ++drifting;
      fmt::print("{:6} {:10.2e} {:9.1e} {:7.1f} {:9.1e} {:9.1e} {:8.1e} {:8.1f}  {}\n", r.starts,
                 r.mean, r.standard_error, r.mean / r.standard_error, r.units(), r.own_rate,
                 r.chance, r.nanoseconds,
                 row.is_exempt ? "exempt: not symplectic"
                 : drifts      ? "DRIFTS"
                               : "no drift");
    } catch (const std::exception& error) {
      if (!row.is_exempt) ++failed;
      const std::string what = error.what();
      fmt::print("  not measured: {}\n", what.substr(0, 300));
    }
    std::fflush(stdout);
  }
  if (wanted == 0) {
    fmt::print(stderr, "no row has one of these words in \"problem: method\"\n");
    return 2;
  }
  fmt::print("{} of {} rows drift{}\n", drifting, measured,
             failed == 0 ? "" : fmt::format(", {} not measured", failed));
  if (failed > 0) return 2;
  return drifting == 0 ? 0 : 1;
}
