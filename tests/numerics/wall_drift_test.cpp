// Between walls a particle flies freely, and each time with the energy that it came with: what
// an iteration leaves of a step at a wall must not add up.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/drift/rows.hpp"
#include "benchmarks/emitted_program.hpp"

namespace hamgen::drift {
namespace {

// Walls at 1 and -1.  Far from them the energy is that of the free flight, to the last place: the
// mean of its error, relative to the energy, over the last eighth of a million steps.
constexpr const char* kWalls =
    "system walls\ncoordinate q\nmomentum p\n"
    "H = p^2/2 + exp(40*(q - 1)) + exp(-40*(q + 1))\n";
constexpr const char* kFlight = R"(
#include <cmath>
#include <cstdio>

static long double energy(const walls::State& z, const walls::State& carry) {
  const long double q = (long double)(z.q) + carry.q, p = (long double)(z.p) + carry.p;
  return p * p / 2 + std::exp(40 * (q - 1)) + std::exp(-40 * (q + 1));
}

int main() {
  walls::State z;
  z.p = 0.8;
  const long double first = energy(z, walls::State());
  walls::Propagator run(walls::Parameters{}, 0.005, z);
  if (!run.advance(875000).converged) return 1;
  long double error = 0;
  long count = 0;
  for (int step = 0; step < 125000; ++step) {
    if (!run.step().converged) return 1;
    if (std::fabs(run.state().q) > 0.15) continue;
    error += energy(run.state(), run.carry()) / first - 1;
    ++count;
  }
  std::printf("%g", double(error / count));
}
)";

std::string with_line(std::string header, const std::string& line, const std::string& other) {
  const std::size_t place = header.find(line);
  if (place == std::string::npos) throw std::runtime_error("not in the header: " + line);
  return header.replace(place, line.size(), other);
}
// Of a method's header with one line instead of another.
double error_of(const Request& request, const std::string& line, const std::string& other) {
  const std::string header = emitted_header(kWalls, request, "double", "walls");
  const std::string changed = with_line(header, line, other);
  return std::stod(output_of_program({{"walls.hpp", changed}}, kFlight, {"-O1"}));
}

// A random walk of a million steps is some 1e-15: what is allowed are 1e-4 roundings a step.
TEST(WallDrift, IsNoneWhereTheBendIsLostAsWhatIsMeasured) {
  const std::string rule = "power(size) * 1048576 <= round_off * power(move);";
  EXPECT_LT(std::abs(error_of({}, rule, rule)), 1.1e-14);
  EXPECT_GT(std::abs(error_of({}, rule, "power(size) * 1024 <= round_off * power(move);")), 1e-13);
}

// Momenta are no unknowns of its stages: what the last round of a refinement leaves moves them 1/h
// times.
TEST(WallDrift, IsNoneOfGaussWhereRoundsGoOnToATinyPartOfAUnit) {
  const Request request{.scheme = "gauss-4", .solver = "fixed-point"};
  const std::string fewest = "TwoForms && amplifier > 4096 ? 1024 : 32;";
  EXPECT_LT(std::abs(error_of(request, fewest, fewest)), 1.1e-14);
  EXPECT_GT(std::abs(error_of(request, fewest, "32;")), 3e-14);
}

// N of them, the first of which are between walls of their own, that they do not meet at the same
// time, the others at springs; what couples them makes them one system, and no more.
std::string row_of(int size, int walled) {
  const std::string first = std::to_string(walled);
  const std::string springs =
      walled < size ? " + sum(i=" + std::to_string(walled + 1) + "..N, q[i]^2/200)" : "";
  return "system row\nsize N = " + std::to_string(size) +
         "\ncoordinate q[1..N]\nmomentum p[1..N]\n"
         "H = sum(i=1..N, p[i]^2/2) + sum(i=1..N-1, q[i]*q[i+1]/10^25)" +
         springs + " + sum(i=1.." + first + ", exp(40*(q[i] - 1)) + exp(-40*(q[i] + 1)))\n";
}
// The root of the mean square of the errors between walls.
constexpr const char* kFlights = R"(
#include <cmath>
#include <cstdio>

constexpr int size = sizeof(row::State) / sizeof(double) / 2;

static long double energy(long double q, long double p) {
  return p * p / 2 + std::exp(40 * (q - 1)) + std::exp(-40 * (q + 1));
}

int main() {
  row::State z;
  double* const first = reinterpret_cast<double*>(&z);
  long double energies[size], errors[walled] = {};
  int counts[walled] = {};
  for (int i = 0; i < size; ++i) {
    first[size + i] = (i < walled ? 1 : loud) * (0.5 + i * 0.39 / size);
    energies[i] = energy(0, first[size + i]);
  }
  row::Propagator run(row::Parameters{}, 0.005, z);
  if (!run.advance(400000).converged) return 1;
  const double* const now = reinterpret_cast<const double*>(&run.state());
  const double* const carry = reinterpret_cast<const double*>(&run.carry());
  for (int step = 0; step < 2000; ++step) {
    if (!run.step().converged) return 1;
    for (int i = 0; i < walled; ++i) {
      if (std::fabs(now[i]) > 0.15) continue;
      const long double q = (long double)(now[i]) + carry[i];
      const long double p = (long double)(now[size + i]) + carry[size + i];
      errors[i] += energy(q, p) / energies[i] - 1;
      ++counts[i];
    }
  }
  long double squares = 0;
  for (int i = 0; i < walled; ++i) squares += errors[i] / counts[i] * errors[i] / counts[i];
  std::printf("%g", double(std::sqrt(squares / walled)));
}
)";
double errors_of(int size, int walled, const Request& request,
                 const std::vector<std::pair<std::string, std::string>>& lines, double loud = 1) {
  std::string header = emitted_header(row_of(size, walled), request, "double", "row");
  for (const auto& [line, other] : lines) header = with_line(header, line, other);
  const std::string program = "\nconstexpr int walled = " + std::to_string(walled) +
                              ";\nconstexpr double loud = " + std::to_string(loud) + ";" + kFlights;
  return std::stod(output_of_program({{"row.hpp", header}}, program, {"-O1"}));
}

// The random walk is some 7e-16, and what is allowed, 1e-4 roundings a step, 4.4e-15.
TEST(WallDrift, IsNoneOfManyWhereAnIncrementLeavesEachLittle) {
  const Request newton{.solver = "newton"};
  EXPECT_LT(errors_of(12, 12, newton, {}), 4.4e-15);
  EXPECT_GT(errors_of(12, 12, newton,
                      {{"part * part * 16384 > round_off", "part * part * 16 > round_off"},
                       {"size * size * 16384 <= epsilon * length;",
                        "size * size * 16 <= epsilon * length;"},
                       {"size * size * 16384 <= epsilon * length * One",
                        "size * size * 16 <= epsilon * length * One"},
                       {"contraction * parts * 16384", "contraction * parts * 16"},
                       {"(size) * parts * 16384", "(size) * parts * 16"},
                       {"64 * epsilon * seen.shortest", "65536 * epsilon * seen.shortest"}}),
            1e-14);
}
// Most contract by a 1e7th, and two by a 300th for some steps; beside others that are louder the
// walk has a mean, which is within what is allowed.
TEST(WallDrift, IsNoneOfAFixedPointInLoopsThatLooksAtWhatFollows) {
  const Request fixed_point{.solver = "fixed-point"};
  EXPECT_LT(errors_of(30, 2, fixed_point, {}), 4.4e-15);
  EXPECT_LT(errors_of(30, 2, fixed_point, {}, 1e6), 8.9e-15);
  EXPECT_GT(errors_of(30, 2, fixed_point, {{"&& !waits && !doubted", "&& !waits"}}), 1e-13);
}

// A pendulum beside oscillators that do not move it: those are louder, and shrink to a 1e4th with
// each increment, the pendulum to a hundredth.
constexpr const char* kBesideOthers =
    "system beside\nsize N = 30\ncoordinate q[1..N]\nmomentum p[1..N]\n"
    "H = sum(i=1..N, p[i]^2/2) + sum(i=1..N-1, q[i]*q[i+1]/10^40)"
    " + sum(i=1..29, q[i]^2/200) + sum(i=30..30, 1 - cos(q[i]))\n";
// What steps leave of its energy, each beside one solved in quad, in roundings.
constexpr const char* kPendulumSteps = R"(
#include <cstdio>

#include <quadmath.h>

using Quad = __float128;

int main() {
  const double h = 0.2;
  double sum = 0;
  for (int start = 0; start < 12; ++start) {
    beside::State z;
    unsigned seed = start + 1;
    for (double& p : z.p) p = 100.0 * ((seed = seed * 1664525u + 1013904223u) >> 8) / (1 << 24);
    z.p[29] = 1 + start * 0.001;
    const double first = z.p[29] * z.p[29] / 2;
    beside::Propagator run(beside::Parameters{}, h, z);
    for (int step = 0; step < 10000; ++step) {
      const Quad q = Quad(run.state().q[29]) + run.carry().q[29];
      const Quad p = Quad(run.state().p[29]) + run.carry().p[29];
      if (!run.step().converged) return 1;
      Quad q_bar = q;
      Quad p_bar = p;
      for (int k = 0; k < 16; ++k) {
        p_bar = p - Quad(h) / 2 * sinq(q_bar);
        q_bar = q + Quad(h) / 2 * p_bar;
      }
      const Quad q_next = 2 * q_bar - q;
      const Quad p_next = 2 * p_bar - p;
      const Quad off_q = Quad(run.state().q[29]) + run.carry().q[29] - q_next;
      const Quad off_p = Quad(run.state().p[29]) + run.carry().p[29] - p_next;
      sum += double(off_q * sinq(q_next) + off_p * p_next) / (first * 0x1p-52);
    }
  }
  std::printf("%g", sum / (12 * 10000));
}
)";

// The walk leaves 1e-4 roundings a step in the mean of these.
TEST(WallDrift, IsNoneOfWhatShrinksLessThanOthersBesideIt) {
  const Request fixed_point{.solver = "fixed-point"};
  const std::string known = "grows || by_chance ? Real(0) : shrinks[j] * shrinks[j] * missing[j]";
  const auto mean = [&](const std::string& line) {
    std::string header = emitted_header(kBesideOthers, fixed_point, "double", "beside");
    header = with_line(std::move(header), known, line);
    return std::stod(output_of_program({{"beside.hpp", std::move(header)}}, kPendulumSteps,
                                       {"-O1", "-std=gnu++20", "-lquadmath"}));
  };
  EXPECT_LT(std::abs(mean(known)), 5e-4);
  EXPECT_LT(mean("Real(0)"), -1e-3);
}

}  // namespace
}  // namespace hamgen::drift
