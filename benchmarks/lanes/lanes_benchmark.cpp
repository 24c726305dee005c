// Nanoseconds per value of the elementary functions on lanes, in packs of 1, 4 and 8, beside the
// library's: the best of nine rounds, arguments and values in the first cache.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace hamgen::lanes_benchmark {
#include "tests/numerics_blocks/lanes.inc"

namespace {

constexpr int kCount = 512;

struct Row {
  const char* name;
  int function;  // in lanes.inc
  double low, high;
  double (*library)(double x, double y);
};
#define HAMGEN_OF_ONE(function) [](double x, double) { return std::function(x); }
#define HAMGEN_OF_TWO(function) [](double x, double y) { return std::function(x, y); }
const Row kRows[] = {
    {"acos", 1, -1, 1, HAMGEN_OF_ONE(acos)},   {"acosh", 2, 1, 4, HAMGEN_OF_ONE(acosh)},
    {"asin", 3, -1, 1, HAMGEN_OF_ONE(asin)},   {"asinh", 4, -3, 3, HAMGEN_OF_ONE(asinh)},
    {"atan", 5, -3, 3, HAMGEN_OF_ONE(atan)},   {"atan2", 6, -3, 3, HAMGEN_OF_TWO(atan2)},
    {"atanh", 7, -1, 1, HAMGEN_OF_ONE(atanh)}, {"cos", 8, -3, 3, HAMGEN_OF_ONE(cos)},
    {"cosh", 9, -3, 3, HAMGEN_OF_ONE(cosh)},   {"exp", 10, -3, 3, HAMGEN_OF_ONE(exp)},
    {"log", 11, 0.1, 10, HAMGEN_OF_ONE(log)},  {"pow", 12, 0.1, 5, HAMGEN_OF_TWO(pow)},
    {"sin", 13, -3, 3, HAMGEN_OF_ONE(sin)},    {"sinh", 14, -3, 3, HAMGEN_OF_ONE(sinh)},
    {"sqrt", 15, 0, 3, HAMGEN_OF_ONE(sqrt)},   {"tan", 16, -1.5, 1.5, HAMGEN_OF_ONE(tan)},
    {"tanh", 17, -3, 3, HAMGEN_OF_ONE(tanh)},
};
#undef HAMGEN_OF_ONE
#undef HAMGEN_OF_TWO

template <class Work>
double best_time(const Work& work) {
  double best = 1e9;
  for (int round = 0; round < 9; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 200; ++i) work();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count());
  }
  return best / 200 / kCount * 1e9;
}

void print(const Row& row) {
  std::vector<double> x(kCount);
  std::vector<double> y(kCount);
  std::vector<double> values(kCount);
  for (int i = 0; i < kCount; ++i) {
    const double part = i * 197 % kCount / double(kCount);
    x[static_cast<std::size_t>(i)] = row.low + (row.high - row.low) * part;
    y[static_cast<std::size_t>(i)] = 2.5 - 2 * part;
  }
  const double library = best_time([&] {
    for (std::size_t i = 0; i < kCount; ++i) values[i] = row.library(x[i], y[i]);
  });
  std::string line = fmt::format("{:<6} {:9.2f}", row.name, library);
  for (const int lanes : {1, 4, 8}) {
    const double time = best_time(
        [&] { evaluate(row.function, lanes, x.data(), y.data(), values.data(), kCount); });
    line += fmt::format(" {:9.2f}", time);
  }
  fmt::print("{}\n", line);
}

}  // namespace
}  // namespace hamgen::lanes_benchmark

int main() {
  fmt::print("ns per value\n{:<6} {:>9} {:>9} {:>9} {:>9}\n", "", "library", "1 lane", "4 lanes",
             "8 lanes");
  for (const auto& row : hamgen::lanes_benchmark::kRows) hamgen::lanes_benchmark::print(row);
}
