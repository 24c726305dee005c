// Nanoseconds per trajectory and step of batches of 1, 2, 4, 8 and 16 lanes, beside the header of
// one trajectory, all of a row in one program: the least of eleven rounds in turn.  Each has a
// translation unit of its own: what the compiler inlines depends on how much there is in one.
//
//   batch [FLAG...]     flags of the compiler, default: -march=native
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "benchmarks/emitted_program.hpp"
#include "generator/base/source_text.hpp"
#include "runtime/atomic_file.hpp"

namespace {

struct BatchRow {
  const char* model;  // in hamiltonians/
  double h;
  std::vector<std::pair<const char*, double>> start;  // of lane 0; other lanes start nearby
  const char* scheme;
  const char* solver = "";
};

const std::vector<std::pair<const char*, double>> kPendulum = {{"q", 3.1}};
const std::vector<std::pair<const char*, double>> kHenon = {{"q2", 0.1}, {"p1", 0.39581140290126}};
const std::vector<std::pair<const char*, double>> kKepler = {{"q1", 0.4}, {"p2", 2}};
const std::vector<std::pair<const char*, double>> kProduct = {{"q", 0.5}, {"p", 0.5}};
const std::vector<std::pair<const char*, double>> kDouble = {{"q1", 0.6}, {"q2", 0.8}};
const std::vector<std::pair<const char*, double>> kStiff = {
    {"x[0]", 1}, {"px[0]", 1}, {"y[0]", 0.02}, {"py[0]", 1}};
const std::vector<std::pair<const char*, double>> kPlucked = {{"q[15]", 1}};

const std::vector<BatchRow> kBatchRows = {
    {"pendulum", 0.1, kPendulum, "stormer-verlet"},
    {"henon_heiles", 0.05, kHenon, "stormer-verlet"},
    {"kepler", 0.01, kKepler, "stormer-verlet"},
    {"stiff_fpu", 0.001, kStiff, "stormer-verlet"},
    {"pendulum", 0.1, kPendulum, "implicit-midpoint"},
    {"henon_heiles", 0.05, kHenon, "implicit-midpoint"},
    {"kepler", 0.01, kKepler, "implicit-midpoint"},
    {"product", 0.005, kProduct, "implicit-midpoint"},
    {"double_pendulum", 0.02, kDouble, "implicit-midpoint"},
    {"stiff_fpu", 0.001, kStiff, "implicit-midpoint"},
    {"henon_heiles", 0.05, kHenon, "implicit-midpoint", "fixed-point"},
    {"henon_heiles", 0.1, kHenon, "gauss-6"},
    {"double_pendulum", 0.02, kDouble, "gauss-8"},
    {"fput", 0.1, kPlucked, "stormer-verlet"},
    {"fput", 0.1, kPlucked, "implicit-midpoint"},
    {"fput", 0.1, kPlucked, "gauss-6"},
};
constexpr int kWidths[] = {0, 1, 2, 4, 8, 16};  // 0: the header of one trajectory

const char* const kMeasure = R"(
#include <chrono>
#include <cstdio>
#include <memory>
inline void put(double& x, int, double value) { x = value; }
template <class Pack>
void put(Pack& x, int lane, double value) { x.set(lane, value); }
inline bool done(bool converged, int) { return converged; }
template <class Mask>
bool done(const Mask& converged, int lanes) {
  bool all_done = true;
  for (int i = 0; i < lanes; ++i) all_done = all_done && converged[i];
  return all_done;
}
static volatile double step_size = STEP_SIZE;
// A round: its time in nanoseconds per trajectory and step.
template <class Propagator, class Parameters, class State>
double measure(const State& z, int lanes) {
  constexpr long long steps = 20000;
  // Of a system in loops it may be larger than the stack.
  const auto made = std::make_unique<Propagator>(Parameters(), step_size, z);
  Propagator& propagator = *made;
  const auto begin = std::chrono::steady_clock::now();
  const auto report = propagator.advance(steps);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  if (!done(report.converged, lanes)) std::puts("a step failed");
  return time.count() / static_cast<double>(steps) / lanes * 1e9;
}
)";

// `double round_W()` of the header wW.hpp.
std::string unit_of(const BatchRow& row, int width) {
  const int lanes = width == 0 ? 1 : width;
  std::string text = fmt::format("#include \"w{}.hpp\"\n#define STEP_SIZE {}\n", width, row.h);
  text += kMeasure + fmt::format("double round_{0}() {{\n  w{0}::State z;\n", width);
  for (const auto& [name, value] : row.start) {
    text += fmt::format("  for (int i = 0; i < {}; ++i) put(z.{}, i, {} * (1 - 1e-3 * i));\n",
                        lanes, name, value);
  }
  return text +
         fmt::format("  return measure<w{0}::method::Propagator, w{0}::Parameters>(z, {1});\n}}\n",
                     width, lanes);
}

std::string program_text() {
  std::string declared = "#include <cstdio>\n";
  std::string rounds;
  std::string printed;
  for (const int width : kWidths) {
    declared += fmt::format("double round_{0}();\ndouble best{0} = 1e300;\n", width);
    rounds += fmt::format(
        "    if (const double time = round_{0}(); time < best{0}) best{0} = time;\n", width);
    printed += fmt::format("  std::printf(\" %8.2f\", best{});\n", width);
  }
  return fmt::format(
      "{}int main() {{\n  for (int round = 0; round < 11; ++round) {{\n{}  }}\n{}}}\n", declared,
      rounds, printed);
}

std::string name_of(const BatchRow& row) {
  const std::string solver = *row.solver == 0 ? "" : fmt::format(", {}", row.solver);
  return fmt::format("{}, {}{}, h = {}", row.model, row.scheme, solver, row.h);
}

std::string measured(const BatchRow& row, const std::vector<std::string>& flags) {
  const std::string path = fmt::format("{}/hamiltonians/{}.ham", HAMGEN_SOURCE_DIR, row.model);
  const std::string model = hamgen::runtime::read_file(path);
  std::vector<hamgen::ProgramFile> files = {{"main.cpp", program_text()}};
  for (const int width : kWidths) {
    hamgen::Request request;
    request.scheme = row.scheme;
    request.solver = row.solver;
    request.batch = width;
    files.push_back({fmt::format("w{}.hpp", width),
                     emitted_header(model, request, "", fmt::format("w{}::method", width))});
    files.push_back({fmt::format("w{}.cpp", width), unit_of(row, width)});
  }
  return output_of_sources(files, flags);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    std::vector<std::string> flags(arguments + 1, arguments + count);
    if (flags.empty()) flags = {"-march=native"};
    std::string widths;
    for (const int width : kWidths)
      widths += fmt::format(" {:>8}", width == 0 ? "one" : fmt::format("W = {}", width));
    fmt::print("{:<50}{}\n", "ns per trajectory and step", widths);
    for (const BatchRow& row : kBatchRows) {
      fmt::print("{:<50}{}\n", name_of(row), measured(row, flags));
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "batch: {}\n", error.what());
    return 1;
  }
}
