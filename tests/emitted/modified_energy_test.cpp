// The emitted modified Hamiltonian, along the steps of the header it is emitted with.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

std::string header_of(const std::string& model, const Request& request) {
  return without_pragma(
      emit(read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + model), request)
          .at(0)
          .text);
}

// max |Ht(k) - Ht(0)| of H and of every truncation, along steps of 2000/h.
std::vector<double> variations(const std::string& h) {
  Request request;
  request.scalar = "quad";
  request.name_space = "m";
  request.watch_modified = 4;
  const std::string program = header_of("pendulum.ham", request) + R"(
#include <cstdio>
int main() {
  using namespace m;
  const Parameters par{.eps = Real(3) / 100};
  const Real h = )" + h + R"(;
  Propagator run(par, h, State{.q = Real(31) / 10, .p = 0});
  Real first[4], worst[4] = {}, now[4];
  for (long k = 0; k <= 20000; ++k) {
    if (k > 0 && !run.step().converged) return 1;
    const State z = run.state();
    now[0] = energy(par, z);
    Real rest[3];
    modified_energies(par, h, z, rest);
    for (int i = 0; i < 3; ++i) now[1 + i] = rest[i];
    if (modified_energy(par, h, z) != rest[2]) return 2;
    for (int i = 0; i < 4; ++i) {
      if (k == 0) first[i] = now[i];
      const Real change = now[i] > first[i] ? now[i] - first[i] : first[i] - now[i];
      if (change > worst[i]) worst[i] = change;
    }
  }
  for (const Real w : worst) std::printf("%.6e\n", static_cast<double>(w));
}
)";
  std::istringstream output(run_program(program));
  std::vector<double> values;
  for (double value = 0; output >> value;) values.push_back(value);
  return values;
}

// The values that `verify --terms` finds with expressions of 60 digits along 100000 steps; the
// orbit has been round before the 20000 steps here are over, so that the maxima are theirs to their
// digits: the remaining distance is that of sampling, 1 % at most.
TEST(ModifiedEnergy, OfTheEmittedHeaderIsConstantToTheNextOrder) {
  const std::vector<double> found = variations("Real(1) / 10");
  ASSERT_EQ(found.size(), 4u);
  const double expected[] = {1.499e-6, 1.740e-11, 1.068e-15, 2.565e-19};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(found[static_cast<std::size_t>(i)], expected[i], 0.01 * expected[i]) << i;
}

// h is an argument: half the step divides the variations by 4, 16, 64, 256, up to O(h^2).
TEST(ModifiedEnergy, TakesTheStepAtRunTime) {
  const std::vector<double> whole = variations("Real(1) / 5");
  const std::vector<double> half = variations("Real(1) / 10");
  ASSERT_EQ(whole.size(), half.size());
  for (std::size_t i = 0; i < half.size(); ++i) {
    const double order = std::log2(whole[i] / half[i]);
    EXPECT_NEAR(order, 2.0 * static_cast<double>(i + 1), 0.05) << i;
  }
}

TEST(ModifiedEnergy, CompilesWithoutWarningsInMembersWithParameters) {
  Request request;
  request.alpha = "1/2";
  request.beta = "-E0/12*h";
  request.gamma = "-h/12";
  request.watch_modified = 3;
  for (const char* scalar : {"double", "long-double"}) {
    request.scalar = scalar;
    for (const std::string& compiler : compilers())
      EXPECT_EQ(messages(compiler, header_of("henon_heiles.ham", request)), "") << compiler;
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
