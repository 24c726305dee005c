// The functions that are the same in every plugin, around a system of two pairs of numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "generator/numerics/shells/plugin_memory.hpp"
#include "runtime/plugin.h"

namespace hamgen::numerics_blocks_test::small_system {

using Real = long double;
struct Parameters {
  Real a = 0.1L, b = 3;
};
struct State {
  Real q[2] = {}, p = 0, s = 0;
};
struct StepReport {
  bool converged = true;
  int iterations = 2;
  Real increment = 0.5L;
};

bool keeps_time = false;  // is t the time of its propagator?
// Free motion: q += h p, t += h.  A step at q[0] >= 4 fails, and a negative `a` ends numbers.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}
  StepReport step() {
    if (z_.q[0] >= 4) return {false, 7, par_.a < 0 ? -std::log(0.0L) : 1};
    z_.q[0] += h_ * z_.p;
    z_.q[1] += h_ * z_.s;
    carry_.p += 0x1p-130L;
    ++steps_;
    return {};
  }
  StepReport advance(long long) { return {z_.p >= 0, 0, 0}; }
  void reset(const State& z) {
    z_ = z;
    carry_ = State();
    steps_ = 0;
  }
  const State& state() const { return z_; }
  const State& carry() const { return carry_; }
  const Parameters& parameters() const { return par_; }
  Real time() const { return keeps_time ? z_.q[1] : static_cast<Real>(steps_) * h_; }
  Real h() const { return h_; }

 private:
  Parameters par_;
  Real h_;
  State z_, carry_;
  long long steps_ = 0;
};

Real energy(const Parameters& par, const State& z) { return par.b * z.q[0]; }
bool tangent(const Parameters&, Real h, const State& z, const State& dz, Real (&m)[4][4]) {
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = i + h;
  return dz.q[0] == h * z.p;
}

}  // namespace hamgen::numerics_blocks_test::small_system

struct hamgen_run {
  hamgen::numerics_blocks_test::small_system::Propagator propagator;
  hamgen::numerics_blocks_test::small_system::Real start_time = 0;
};

namespace hamgen::numerics_blocks_test::small_system {
namespace {

template <class Record, class Each>
void for_parameters(Record& par, const Each& each) {
  each(0, par.a);
  each(1, par.b);
}
template <class Record, class Each>
void for_state(Record& z, const State& beside, const Each& each) {
  each(0, z.q[0], beside.q[0]);
  each(1, z.q[1], beside.q[1]);
  each(2, z.p, beside.p);
  each(3, z.s, beside.s);
}
template <class Each>
void for_invariants(const Parameters& par, const State& z, const Each& each) {
  each(0, z.p / 3);
  each(1, par.b);
}
template <class Each>
void for_gradient(const Parameters& par, const State&, const Each& each) {
  each(0, par.b);
}
const State& carry_of(const Propagator& run) { return run.carry(); }
bool never_fails = false;
constexpr int variables = 4;

#include "generator/numerics/shells/plugin_run.hpp"
#include "generator/numerics/shells/plugin_tangent.hpp"

struct Destroy {
  void operator()(hamgen_run* run) const { destroy(run); }
};
using OwnedRun = std::unique_ptr<hamgen_run, Destroy>;

constexpr double kParameters[] = {0.5, 3}, kLow[] = {0x1p-60, 0}, kStart[] = {1, 2, 3, 4};

OwnedRun begin(double h = 0.25) {
  return OwnedRun(create(kParameters, nullptr, h, 0, kStart, nullptr));
}
std::vector<double> state_of(const OwnedRun& run) {
  std::vector<double> state(4);
  get_state(run.get(), state.data(), nullptr);
  return state;
}

TEST(PluginRun, ANumberCrossesAsTwoDoubles) {
  const OwnedRun run(create(kParameters, kLow, 0.25, 0x1p-60, kStart, nullptr));
  double hi[2], lo[2];
  get_parameters(run.get(), hi, lo);
  EXPECT_EQ(hi[0], 0.5);
  EXPECT_EQ(lo[0], 0x1p-60);
  EXPECT_EQ(hi[1], 3);
  EXPECT_EQ(lo[1], 0);
  EXPECT_EQ(get_h(run.get(), lo), 0.25);
  EXPECT_EQ(lo[0], 0x1p-60);
  default_parameters(hi, lo);
  EXPECT_EQ(hi[0], 0.1);
  EXPECT_EQ(static_cast<Real>(hi[0]) + static_cast<Real>(lo[0]), 0.1L);
  default_parameters(hi, nullptr);
  EXPECT_EQ(hi[1], 3);
}

TEST(PluginRun, StepsAreCountedAndTheEnergyWatched) {
  const OwnedRun run = begin();
  hamgen_report report{};
  advance(run.get(), 2, 1, &report);
  EXPECT_EQ(report.status, HAMGEN_DONE);
  EXPECT_EQ(report.steps_done, 2);
  EXPECT_EQ(report.iterations, 4);
  EXPECT_EQ(report.last_iterations, 2);
  EXPECT_EQ(report.last_increment, 0.5);
  EXPECT_EQ(report.energy_min, 3 * 1.75);
  EXPECT_EQ(report.energy_max, 3 * 2.5);
  EXPECT_EQ(report.energy_last, 3 * 2.5);
  EXPECT_EQ(state_of(run), (std::vector<double>{2.5, 4, 3, 4}));
  std::vector<double> carry(4), carry_lo(4);
  get_carry(run.get(), carry.data(), carry_lo.data());
  EXPECT_EQ(carry, (std::vector<double>{0, 0, 0x1p-129, 0}));
  EXPECT_EQ(get_time(run.get(), nullptr), 0.5);
}

TEST(PluginRun, AFailureEndsItWithItsCause) {
  const OwnedRun run = begin();
  hamgen_report report{};
  advance(run.get(), 100, 0, &report);
  EXPECT_EQ(report.status, HAMGEN_NOT_CONVERGED);
  EXPECT_EQ(report.steps_done, 4);
  EXPECT_EQ(report.iterations, 8);
  EXPECT_EQ(report.last_iterations, 7);
  const double ending[] = {-1, 3};
  set_parameters(run.get(), ending, nullptr);
  advance(run.get(), 1, 0, &report);
  EXPECT_EQ(report.status, HAMGEN_NOT_FINITE);
  EXPECT_EQ(report.steps_done, 0);
}

TEST(PluginRun, AnEnergyThatIsNoNumberEndsItAndSoDoesAStateWhereNoStepFails) {
  const OwnedRun run = begin();
  hamgen_report report{};
  const double ending[] = {1, std::numeric_limits<double>::infinity()};
  set_parameters(run.get(), ending, nullptr);
  advance(run.get(), 3, 1, &report);
  EXPECT_EQ(report.status, HAMGEN_NOT_FINITE);
  EXPECT_EQ(report.steps_done, 1);
  const double backwards[] = {1, 2, -3, 4};
  set_state(run.get(), 0, 0, backwards, nullptr);
  advance(run.get(), 3, 0, &report);
  EXPECT_EQ(report.status, HAMGEN_DONE);
  never_fails = true;
  advance(run.get(), 3, 0, &report);
  never_fails = false;
  EXPECT_EQ(report.status, HAMGEN_NOT_FINITE);
}

TEST(PluginRun, ARunGoesOnWithAnotherStepOrOtherParameters) {
  const OwnedRun run = begin();
  hamgen_report report{};
  advance(run.get(), 2, 0, &report);
  set_h(run.get(), 0.125, 0);
  EXPECT_EQ(get_time(run.get(), nullptr), 0.5);
  advance(run.get(), 1, 0, &report);
  EXPECT_EQ(get_time(run.get(), nullptr), 0.625);
  EXPECT_EQ(state_of(run), (std::vector<double>{2.875, 4.5, 3, 4}));
  set_parameters(run.get(), kStart, nullptr);
  EXPECT_EQ(get_h(run.get(), nullptr), 0.125);
  double values[2];
  get_parameters(run.get(), values, nullptr);
  EXPECT_EQ(values[1], 2);
  set_state(run.get(), 7, 0.5, kStart, nullptr);
  EXPECT_EQ(get_time(run.get(), nullptr), 7.5);
  EXPECT_EQ(state_of(run), (std::vector<double>{1, 2, 3, 4}));
}

// A driven system's own t is the time of its propagator, whatever the run has been through; set at
// another time, that is what goes on.
TEST(PluginRun, ATimeOfTheStateIsNotCountedTwice) {
  keeps_time = true;
  const OwnedRun run = begin();
  hamgen_report report{};
  const double at_start = get_time(run.get(), nullptr);
  EXPECT_EQ(at_start, state_of(run)[1]);
  advance(run.get(), 2, 0, &report);
  const double reached = state_of(run)[1];
  EXPECT_GT(reached, at_start);
  set_h(run.get(), 0.125, 0);
  EXPECT_EQ(get_time(run.get(), nullptr), reached);
  set_parameters(run.get(), kStart, nullptr);
  EXPECT_EQ(get_time(run.get(), nullptr), reached);
  advance(run.get(), 1, 0, &report);
  EXPECT_EQ(get_time(run.get(), nullptr), state_of(run)[1]);
  set_state(run.get(), 7, 0.5, kStart, nullptr);
  EXPECT_EQ(get_time(run.get(), nullptr), 7.5);
  set_h(run.get(), 0.25, 0);
  EXPECT_EQ(get_time(run.get(), nullptr), 7.5);
  keeps_time = false;
}

TEST(PluginRun, ASavedRunIsRestoredByItsSizeAlone) {
  const OwnedRun run = begin();
  std::vector<char> bytes(static_cast<std::size_t>(save_run(run.get(), nullptr)));
  EXPECT_EQ(bytes.size(), sizeof(hamgen_run));
  save_run(run.get(), bytes.data());
  hamgen_report report{};
  advance(run.get(), 2, 0, &report);
  const auto size = static_cast<long long>(bytes.size());
  EXPECT_EQ(restore_run(run.get(), bytes.data(), size - 1), 0);
  EXPECT_EQ(restore_run(run.get(), bytes.data(), 0), 0);
  EXPECT_EQ(state_of(run)[0], 2.5);
  EXPECT_EQ(restore_run(run.get(), bytes.data(), size), 1);
  EXPECT_EQ(state_of(run)[0], 1);
}

TEST(PluginRun, ValuesOfAStateStandAtTheirPlaces) {
  double values[2] = {}, lo[2] = {}, slope[1] = {};
  EXPECT_EQ(energy_of(kParameters, nullptr, kStart, nullptr, lo), 3);
  EXPECT_EQ(lo[0], 0);
  const double third[] = {0, 0, 1, 0};
  invariants_of(kParameters, nullptr, third, nullptr, values, lo);
  EXPECT_EQ(values[0], 1.0 / 3);
  EXPECT_NE(lo[0], 0);
  EXPECT_EQ(values[1], 3);
  gradient_of(kParameters, kStart, slope);
  EXPECT_EQ(slope[0], 3);
}

TEST(PluginRun, TheTangentIsOfTheStepThatIsTaken) {
  double end[4] = {}, matrix[16] = {};
  EXPECT_EQ(tangent_of(kParameters, 0.25, kStart, end, matrix), 1);
  EXPECT_EQ(end[0], 1.75);
  EXPECT_EQ(end[3], 4);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(matrix[i], i + 0.25);
  const double failing[] = {4, 0, 0, 0};
  EXPECT_EQ(tangent_of(kParameters, 0.25, failing, end, matrix), 0);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test::small_system
