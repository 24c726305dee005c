// A drift in loops has the velocities of the momenta that have one, and no others.
#include <gtest/gtest.h>

#include <string>

#include "tests/schemes/emitted_program.hpp"

namespace hamgen::schemes_test {
namespace {

// Masses 1 + i, of all bodies or of all but the last, which then rests: a step of a kick, a drift
// and a kick.
TEST(Emitted, ALoopKnowsWhichMomentaHaveAVelocityAndTheirNumbers) {
  std::string text = "#include <cmath>\n#include <cstdio>\n";
  std::string calls;
  for (const std::string last : {"n", "n-1"}) {
    const std::string name = last == "n" ? "of_all" : "but_one";
    text += header(
        "system many\nsize n = 30\ncoordinate q[1..n]\nmomentum p[1..n]\n"
        "H = sum(i = 1.." +
            last + ", p[i]^2/(2 + 2*i)) - sum(i = 1..n, cos(q[i]))\n",
        {.scheme = "stormer-verlet"}, name);
    calls += "  {\n    using namespace " + name +
             ";\n    const int moving = " + (last == "n" ? "30" : "29") + ";\n" + R"(    State z;
    for (int i = 0; i < 30; ++i) z.q[i] = 0.8, z.p[i] = 0.3;
    Propagator run({}, 0.1, z);
    if (!run.step().converged) std::puts("failed");
    for (int i = 0; i < 30; ++i) {
      const double p = 0.3 - 0.05 * std::sin(0.8);
      const double q = 0.8 + (i < moving ? 0.1 * p / (2 + i) : 0);
      const double dq = run.state().q[i] - q, dp = run.state().p[i] - (p - 0.05 * std::sin(q));
      if (!(dq * dq + dp * dp < 1e-30)) std::printf("%d of %d: %g %g\n", i, moving, dq, dp);
    }
  }
)";
  }
  EXPECT_EQ(output_of(text + "int main() {\n" + calls + "}\n"), "");
}

}  // namespace
}  // namespace hamgen::schemes_test
