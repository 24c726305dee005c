// Between walls a particle flies freely, and each time with the energy that it came with: what
// an iteration leaves of a step at a wall must not add up.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

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

// Of a method's header with one line instead of another.
double error_of(const Request& request, const std::string& line, const std::string& other) {
  std::string header = emitted_header(kWalls, request, "double", "walls");
  const std::size_t place = header.find(line);
  if (place == std::string::npos) throw std::runtime_error("not in the header: " + line);
  header.replace(place, line.size(), other);
  return std::stod(output_of_program({{"walls.hpp", header}}, kFlight, {"-O1"}));
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
  const std::string fewest = "amplifier < 4096 ? 32 : 1024;";
  EXPECT_LT(std::abs(error_of(request, fewest, fewest)), 1.1e-14);
  EXPECT_GT(std::abs(error_of(request, fewest, "32;")), 3e-14);
}

}  // namespace
}  // namespace hamgen::drift
