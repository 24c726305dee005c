// rounding [--steps N] [--starts N] [WORD...]: how the rounding error of an energy grows over very
// long runs.  The energy is the modified Hamiltonian, which the exact steps keep: along an orbit of
// them a phase shift does not change it, and what changes is rounding.  Evaluated in quad, from
// state and carry.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "benchmarks/emitted_program.hpp"

namespace {

using namespace hamgen;

struct Row {
  std::string problem, name, model;
  Request request;    // of the method that runs
  Request energy;     // of the member whose modified Hamiltonian is kept
  std::string moved;  // what makes of the state of the one that of the other
  double h = 0.05;
  long long steps = 100'000'000;
  std::string start;  // fills z from uniform() in (-1, 1)
};

// The headers are known as rounded (double), exact (the same method in quad) and modified (quad).
constexpr const char* kProgram = R"(
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

using Quad = __float128;
constexpr int size = sizeof(rounded::State) / sizeof(double);
static_assert(sizeof(exact::State) == size * sizeof(Quad));
static_assert(sizeof(modified::State) == size * sizeof(Quad));

static std::uint64_t seed = 0;
static double uniform() {{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (seed >> 11) * 0x1p-52 - 1;
}}

static Quad kept(double step, const Quad (&values)[size]) {{
  const modified::Parameters par;
  const Quad h = step;
  modified::State z;
  std::memcpy(static_cast<void*>(&z), values, sizeof values);
  {moved}
  return modified::modified_energy(par, h, z);
}}

static Quad kept(double h, const rounded::State& state, const rounded::State& carry) {{
  double hi[size], lo[size];
  std::memcpy(hi, &state, sizeof hi);
  std::memcpy(lo, &carry, sizeof lo);
  Quad z[size];
  for (int i = 0; i < size; ++i) z[i] = Quad(hi[i]) + lo[i];
  return kept(h, z);
}}

// What is cut off of the modified Hamiltonian: its largest change along steps in quad.
static double cut_off(double h, const double (&start)[size]) {{
  exact::State state;
  Quad z[size];
  for (int i = 0; i < size; ++i) z[i] = start[i];
  std::memcpy(static_cast<void*>(&state), z, sizeof z);
  exact::Propagator run(exact::Parameters(), h, state);
  const Quad before = kept(h, z);
  Quad largest = 0;
  for (int i = 0; i < 3000; ++i) {{
    if (!run.step().converged) return NAN;
    std::memcpy(z, &run.state(), sizeof z);
    Quad change = (kept(h, z) - before) / before;
    if (change < 0) change = -change;
    if (change > largest) largest = change;
  }}
  return double(largest);
}}

int main() {{
  const double h = {h};
  for (int s = 0; s < {starts}; ++s) {{
    seed = 7919u * s + 13;
    for (int i = 0; i < 10; ++i) uniform();
    double z[size];
    {start}
    rounded::State state;
    std::memcpy(static_cast<void*>(&state), z, sizeof z);
    if (s == 0) std::printf("%.17g\n", cut_off(h, z));
    rounded::Propagator run(rounded::Parameters(), h, state);
    const Quad before = kept(h, run.state(), rounded::State());
    long long done = 0;
    for (long long steps = {steps} / 10000; steps <= {steps}; steps *= 10) {{
      if (!run.advance(steps - done).converged) return 1;
      done = steps;
      {carry}
      std::printf("%lld %.17g\n", steps, double((kept(h, run.state(), carry) - before) / before));
    }}
  }}
}}
)";

constexpr const char* kPendulum =
    "system pendulum\ncoordinate q\nmomentum p\nH = p^2/2 + 1 - cos(q)\n";
constexpr const char* kKepler =
    "system kepler\ncoordinate q1, q2\nmomentum p1, p2\nH = (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + "
    "q2^2)\n";
// Oscillations up to 1.5 wide.
constexpr const char* kSwing = "z[0] = 1 + 0.5 * uniform(); z[1] = 0.1 * uniform();";
// Eccentricity 0.6, from the pericentre in any direction.
constexpr const char* kOrbit = R"(const double c = std::cos(3 * uniform());
    const double d = std::sqrt(1 - c * c);
    z[0] = 0.4 * c; z[1] = 0.4 * d; z[2] = -2 * d; z[3] = 2 * c;)";

std::vector<Row> all_rows() {
  const Request midpoint{.scheme = "implicit-midpoint", .watch_modified = 8};
  Request order_8{.order = 8, .watch_modified = 8};
  Request verlet{.scheme = "stormer-verlet"};
  // A step of it is one of this, between half a kick and the half kick back.
  const Request euler{.scheme = "symplectic-euler-b", .watch_modified = 8};
  const std::string half_kick = "z.p -= h / 2 * sinq(z.q);";
  std::vector<Row> rows = {
      {"pendulum", "implicit-midpoint", kPendulum, midpoint, midpoint, "", 0.05, 100'000'000,
       kSwing},
      {"pendulum", "order 8", kPendulum, order_8, order_8, "", 0.05, 100'000'000, kSwing},
      {"pendulum", "stormer-verlet", kPendulum, verlet, euler, half_kick, 0.01, 100'000'000,
       kSwing},
      {"kepler",
       "implicit-midpoint",
       kKepler,
       {.scheme = "implicit-midpoint"},
       {.scheme = "implicit-midpoint", .watch_modified = 6},
       "",
       0.005,
       10'000'000,
       kOrbit},
  };
  const std::size_t count = rows.size();
  for (std::size_t i = 0; i < count; ++i) {
    rows.push_back(rows[i]);
    rows.back().name += ", plain sums";
    rows.back().request.plain_sums = true;
  }
  return rows;
}

struct Growth {
  double cut_off = 0.0;
  std::map<long long, std::vector<double>> errors;  // after so many steps, one of each start
};

Growth measure(const Row& row, long long steps, int starts) {
  Request request = row.request;
  request.watch_modified = 0;
  const bool plain = request.plain_sums;
  std::istringstream output(output_of_program(
      {{"rounded.hpp", emitted_header(row.model, request, "double", "rounded")},
       {"exact.hpp", emitted_header(row.model, request, "quad", "exact")},
       {"modified.hpp", emitted_header(row.model, row.energy, "quad", "modified")}},
      fmt::format(fmt::runtime(kProgram), fmt::arg("moved", row.moved), fmt::arg("h", row.h),
                  fmt::arg("start", row.start), fmt::arg("starts", starts),
                  fmt::arg("steps", steps),
                  fmt::arg("carry", plain ? "const rounded::State carry;"
                                          : "const rounded::State& carry = run.carry();"))));
  Growth growth;
  output >> growth.cut_off;
  long long done = 0;
  double error = 0.0;
  while (output >> done >> error) growth.errors[done].push_back(error);
  return growth;
}

struct Moments {
  double mean = 0.0, rms = 0.0, standard_error = 0.0;
};

Moments moments(const std::vector<double>& errors) {
  const auto count = static_cast<double>(errors.size());
  Moments m;
  for (const double e : errors) m.mean += e / count;
  double variance = 0.0;
  for (const double e : errors) {
    m.rms += e * e / count;
    variance += (e - m.mean) * (e - m.mean) / (count - 1);
  }
  m.rms = std::sqrt(m.rms);
  m.standard_error = std::sqrt(variance / count);
  return m;
}

void print(const Growth& growth) {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  double first = 0.0;
  long long first_steps = 0;
  for (const auto& [steps, errors] : growth.errors) {
    const Moments m = moments(errors);
    if (first_steps == 0) {
      first = m.rms;
      first_steps = steps;
    }
    const bool last = steps == growth.errors.rbegin()->first;
    const double power = std::log(m.rms / first) /
                         std::log(static_cast<double>(steps) / static_cast<double>(first_steps));
    fmt::print("  {:10.0e} {:10.2f} {:10.2f} +- {:8.2f}{}\n", static_cast<double>(steps),
               m.rms / unit, m.mean / unit, m.standard_error / unit,
               last ? fmt::format("   grows as steps^{:.2f}", power) : "");
  }
}

}  // namespace

int main(int count, char** arguments) {
  long long most = 0;
  int starts = 16;
  std::vector<std::string> words;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool has_value = i + 1 < count;
    if (argument == "--steps" && has_value) {
      most = static_cast<long long>(std::atof(arguments[++i]));
    } else if (argument == "--starts" && has_value) {
      starts = std::atoi(arguments[++i]);
    } else {
      words.push_back(argument);
    }
  }
  if (starts < 2) starts = 2;
  fmt::print("rounding of the modified energy, relative, in units of 2^-52, over {} starts\n\n",
             starts);
  for (const Row& row : all_rows()) {
    const std::string title = row.problem + ": " + row.name;
    bool wanted = words.empty();
    for (const std::string& word : words) wanted = wanted || title.find(word) != std::string::npos;
    if (!wanted) continue;
    try {
      const Growth growth = measure(row, most > 0 ? most : row.steps, starts);
      fmt::print("{}, h = {}; cut off: {:.1e}\n  {:>10} {:>10} {:>10}\n", title, row.h,
                 growth.cut_off / std::numeric_limits<double>::epsilon(), "steps", "rms", "mean");
      print(growth);
    } catch (const std::exception& error) {
      fmt::print("{}: not measured: {}\n", title, std::string(error.what()).substr(0, 400));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
  return 0;
}
