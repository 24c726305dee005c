// K of sums that are kept: what is written out, and no longer with more elements.
#include "generator/mechanics/kernel_series.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/mechanics/generating_series.hpp"
#include "generator/verify/emitted.hpp"
#include "tests/mechanics/formal_step.hpp"

namespace hamgen::mechanics_test {
namespace {

Model lattice(const std::string& text, int size) {
  return read_model(
      make_source("lattice.ham", fmt::format("system lattice\nsize N = {}\n{}", size, text)));
}

const std::string kEnds = "coordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n";
const std::string kRing = "coordinate q[1..N] periodic\nmomentum p[1..N]\n";
const std::string kQuadratic = "H = sum(i = 1..N, p[i]^2/2) + ";
const std::string kChainOfMasses =
    kEnds + "parameter m[1..N] = 2\nparameter k[0..N] = 3\n" +
    "H = sum(i = 1..N, p[i]^2/(2*m[i])) + sum(j = 0..N, k[j]*(q[j+1] - q[j])^3/3)\n";
const std::string kPendula = kRing + "parameter a = 1/2\n" + kQuadratic +
                             "sum(i = 1..N, (q[i+1] - q[i])^2/(2*a) + a*(1 - cos(q[i])))\n";
// Springs of two kinds, every other one.
const std::string kDimers =
    "coordinate q[1..2*N] with q[2*N+1] = 0\nmomentum p[1..2*N]\nH = sum(i = 1..2*N, p[i]^2/2)"
    " + sum(i = 1..N, (q[2*i] - q[2*i-1])^2) + sum(i = 1..N, (q[2*i+1] - q[2*i])^4)\n";
const std::string kCoupled =
    kRing + "H = sum(i = 1..N, (1 + q[i]^2)*p[i]^2/2 + i*q[i]*q[i+1] + p[i]*q[i+1]/5)\n";
// Two arrays, and neighbours but one.
const std::string kLadder =
    "coordinate x[1..N], y[0..N-1]\nmomentum px[1..N], py[0..N-1]\n"
    "H = (sum(i = 1..N, px[i]^2 + py[i-1]^2)/2 + sum(i = 1..N-2, (x[i+2] - x[i])^3)"
    " + sum(i = 1..N, (x[i] - y[N-i])^3) + x[1]^2*y[0])\n";

// t in every summand of a sum, and what it drives.
const std::string kDriven = kEnds + "time t\nparameter a = 1/2\n" + kQuadratic +
                            "sum(i = 0..N, (1 + a*cos(t))*(q[i+1] - q[i])^2/2) - t^2*q[2]"
                            " + sin(t)*sum(i = 1..N, i*q[i]^3 + t*p[i]/5)\n";

struct Asked {
  int order;
  Gauge gauge;
};

// Every product of it, whatever the form.
void expect_written_out(const std::string& text, int size, const Asked& asked) {
  const Model model = lattice(text, size);
  Mechanics loops = derive(model, true, 0);
  ASSERT_TRUE(loops.keeps_sums()) << text;
  const Mechanics written = derive(model, false);
  Mechanics alone = loops;
  alone.degrees_of_freedom = 1;
  const SparseMatrix one = scheme_of(alone, asked.gauge).member().c;
  const SparseMatrix all = scheme_of(written, asked.gauge).member().c;
  const auto gauge = gauge_series(all, asked.order);
  const auto terms = generating_series(written.energy, coordinate_chart(written, gauge), gauge,
                                       asked.order, SeriesForm::nested);
  Expression expected(0);
  for (std::size_t k = 0; k < terms.size(); ++k)
    expected +=
        Expression::power(Expression::symbol("h", kRankOfStep), Expression(static_cast<long>(k))) *
        terms[k];
  loops.kernels = generating_kernels(loops, one, asked.order);
  PolynomialRing ring(100000);
  EXPECT_TRUE(ring.expand(sum_of_kernels(loops) - expected).empty())
      << "order " << asked.order << ", alpha = " << asked.gauge.alpha << "\n"
      << text;
}

// A summand without a variable meets no other.
const std::string kWithConstants =
    kRing + kQuadratic + "sum(i = 1..N, q[i]^4/4 + 1 + (q[i+1] - q[i])^2/2)\n";

TEST(KernelSeries, IsTheSeriesWrittenOut) {
  for (const std::string& text :
       {kChainOfMasses, kPendula, kDimers, kCoupled, kLadder, kWithConstants}) {
    expect_written_out(text, 4, {4, {}});
    expect_written_out(text, 5, {3, {"3/10", "1/5", "-1/10"}});
    expect_written_out(text, 4, {4, {"1/2", "h/5", "2*h"}});
  }
  expect_written_out(kEnds + kQuadratic + "sum(i = 0..N, (q[i+1] - q[i])^3/3)\n", 6, {6, {}});
  expect_written_out(kDriven, 4, {4, {}});
  expect_written_out(kDriven, 5, {3, {"3/10", "1/5", "0"}});
}

// Down to where both ends meet.
TEST(KernelSeries, OfTheShortestIsTheSeriesWrittenOut) {
  for (int size = 2; size <= 7; ++size) {
    for (const std::string& text : {kChainOfMasses, kPendula})
      expect_written_out(text, size, {4, {}});
  }
}

TEST(KernelSeries, DoesNotGrowWithTheSize) {
  for (const std::string& text : {kChainOfMasses, kPendula, kDimers}) {
    const auto kernels = [&](int size) {
      const Mechanics mechanics = derive(lattice(text, size));
      return generating_kernels(mechanics, {}, 4);
    };
    const std::vector<Kernel> few = kernels(40);
    const std::vector<Kernel> many = kernels(20000);
    ASSERT_EQ(few.size(), many.size()) << text;
    EXPECT_LE(few.size(), 12U);
  }
}

// Where an instance meets all others, or others farther and farther away.
TEST(KernelSeries, RefusesWhatIsNoSumOverNeighbours) {
  const auto refusal = [](const std::string& potential) {
    const Mechanics mechanics =
        derive(lattice("coordinate q[1..N]\nmomentum p[1..N]\n" + kQuadratic + potential, 30));
    EXPECT_TRUE(mechanics.keeps_sums()) << potential;
    try {
      (void)generating_kernels(mechanics, {}, 4);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const auto& [potential, why] : std::map<std::string, std::string>{
           {"sum(i = 1..N, j = i+1..N, cos(q[i] - q[j]))\n", "a sum over several indices"},
           {"sum(i = 2..N, (q[i] - q[1])^2)\n", "q[1] in every summand of a sum"},
           {"sum(i = 1..N/2, q[i]^2*q[2*i])\n", "whose distance grows"}}) {
    const std::string text = refusal(potential);
    EXPECT_NE(text.find(why), std::string::npos) << potential << text;
    EXPECT_NE(text.find("couples all its 30 degrees of freedom"), std::string::npos) << text;
    EXPECT_NE(text.find("help: a composition"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace hamgen::mechanics_test
