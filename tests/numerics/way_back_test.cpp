// A symmetric step is its own way back, h against -h, in exact arithmetic.  Stormer-Verlet is one
// in rounded numbers, too, to the last place of the carry: what its substeps look at is a function
// of the sum of state and carry alone (program/splitting_routine.cpp, Note [the way back]).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/drift/rows.hpp"
#include "benchmarks/emitted_program.hpp"

namespace hamgen::drift {
namespace {

// Steps there and back, and how far from where it began it ends, in units of 2^-53.
constexpr const char* kThereAndBack = R"(
#include <cmath>
#include <cstdio>
#include <cstring>

using Quad = __float128;
constexpr int size = sizeof(there::State) / sizeof(double);

static void read(const there::Propagator& run, Quad (&z)[size]) {
  double hi[size], lo[size];
  std::memcpy(hi, &run.state(), sizeof hi);
  std::memcpy(lo, &run.carry(), sizeof lo);
  for (int i = 0; i < size; ++i) z[i] = Quad(hi[i]) + lo[i];
}

int main() {
  const double h = 0.7;
  double values[size];
  for (int i = 0; i < size; ++i) values[i] = std::sin(1.0 + i * i);
  there::State state;
  std::memcpy(static_cast<void*>(&state), values, sizeof state);
  there::Propagator run(there::Parameters{}, h, state);
  if (!run.advance(1).converged) return 1;  // for a carry to begin with
  Quad first[size], last[size];
  read(run, first);
  if (!run.advance(1000).converged) return 1;
  run.h_ = -h;
  run.k_ = there::prepare(run.par_, run.h_);
  if (!run.advance(1000).converged) return 1;
  read(run, last);
  Quad worst = 0;
  for (int i = 0; i < size; ++i) {
    const Quad gap = last[i] - first[i];
    if (gap > worst) worst = gap;
    if (-gap > worst) worst = -gap;
  }
  std::printf("%g", double(worst) * 0x1p53);
}
)";

// Of a header from which this line, wherever it stands, is left out.
double gap_of(const std::string& model, const std::string& scheme, const std::string& line = "") {
  std::string header = emitted_header(model, {.scheme = scheme}, "double", "there");
  const std::string hidden = " private:\n";
  header.replace(header.find(hidden, header.find("class Propagator {")), hidden.size(),
                 " public:\n");
  if (!line.empty()) header.erase(header.find(line), line.size());
  return std::stod(output_of_program({{"there.hpp", header}}, kThereAndBack, {"-O1"}));
}

TEST(WayBack, OfStormerVerletEndsWhereItBegan) {
  for (const std::string& model : {oscillator(), chain(6), chain(25)}) {
    EXPECT_LE(gap_of(model, "stormer-verlet"), 1e-12) << model;
  }
}

// In loops it begins with momenta without their carry.
TEST(WayBack, OfPositionVerletEndsWhereItBeganIfWrittenOut) {
  EXPECT_LE(gap_of(chain(6), "position-verlet"), 1e-12);
}

// A sum without what it lost is no function of state and carry together.
TEST(WayBack, NeedsWhatASumHasLost) {
  EXPECT_GE(gap_of(chain(25), "stormer-verlet", "p_j += lost_z_p_j;"), 1);
}

}  // namespace
}  // namespace hamgen::drift
