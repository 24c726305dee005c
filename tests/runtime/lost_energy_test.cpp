// An orbit far away whose energy was lost on the way has not escaped.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/integrator.hpp"

namespace hamgen::runtime {
namespace {

// The parameter is H after the first step; after the second it is 1 again, as at the start, and
// the third does not converge.
struct LostRun {
  double first = 0;
  int done = 0;
};

hamgen_run* create_lost(const double* parameters, const double*, double, double, const double*,
                        const double*) {
  return reinterpret_cast<hamgen_run*>(new LostRun{parameters[0]});
}

void destroy_lost(hamgen_run* run) { delete reinterpret_cast<LostRun*>(run); }

void advance_lost(hamgen_run* run, long long, int, hamgen_report* report) {
  LostRun& at = *reinterpret_cast<LostRun*>(run);
  *report = {};
  if (at.done == 2) {
    report->status = HAMGEN_NOT_CONVERGED;
    return;
  }
  ++at.done;
  report->steps_done = 1;
  report->energy_min = report->energy_max = report->energy_last = at.done == 1 ? at.first : 1;
}

void state_lost(const hamgen_run* run, double* z, double* lo) {
  z[0] = reinterpret_cast<const LostRun*>(run)->done == 0 ? 1 : 1e5;
  z[1] = 1;
  if (lo != nullptr) lo[0] = lo[1] = 0;
}

void carry_lost(const hamgen_run*, double* carry, double* lo) {
  carry[0] = carry[1] = lo[0] = lo[1] = 0;
}

double energy_lost(const double*, const double*, const double*, const double*, double* lo) {
  if (lo != nullptr) *lo = 0;
  return 1;
}

void gradient_lost(const double*, const double*, double* gradient) {
  gradient[0] = 1;
  gradient[1] = 2;  // with 1 q would be the time
}

const hamgen_plugin lost_energy = {.version = HAMGEN_PLUGIN_VERSION,
                                   .degrees_of_freedom = 1,
                                   .parameter_count = 1,
                                   .scalar_digits = 53,
                                   .description = "far away",
                                   .solver = "explicit",
                                   .create = create_lost,
                                   .destroy = destroy_lost,
                                   .advance = advance_lost,
                                   .get_state = state_lost,
                                   .get_carry = carry_lost,
                                   .energy = energy_lost,
                                   .gradient = gradient_lost};

// What is compared with the error is a tenth of |q H_q|/2: 5000.
TEST(Integrator, RemembersTheLargestErrorOfTheEnergy) {
  for (const double first : {1.0, 4000.0, -4000.0, 6000.0, -6000.0}) {
    Integrator run(std::make_shared<const Library>(lost_energy, nullptr),
                   {.parameters = {{first, 0}}, .h = {1, 0}, .state = {{1, 0}, {1, 0}}});
    EXPECT_EQ(run.advance(1, true).status, Status::done);
    EXPECT_EQ(run.advance(1, true).status, Status::done);
    EXPECT_EQ(run.advance(1, true).status,
              std::abs(first) > 5000 ? Status::not_converged : Status::escaped)
        << first;
  }
}

}  // namespace
}  // namespace hamgen::runtime
