// Every scheme as it is emitted: its order as observed, forth and back, and failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "tests/schemes/emitted_program.hpp"

namespace hamgen::schemes_test {
namespace {

std::string space(const std::string& name) {
  std::string text = "scheme_" + name;
  std::ranges::replace(text, '-', '_');
  return text;
}

// A step as a user asks for it, and what is claimed of it.
struct Offer {
  std::string name;
  Request request;
  int order = 1;
  bool symmetric = false;
};

struct Observed {
  double coarse = 0, fine = 0;  // errors with h and h/2
  double back = 0;              // distance from the start after steps forth and back
};

// Steps to time 1: as many as quad's round-off allows, for then the leading error is alone.
int steps_for(int order) { return order >= 12 ? 6 : order >= 9 ? 12 : order >= 6 ? 24 : 64; }

// Errors in quad at time 1 against gauss-16 with a small step, from (q, p) = (0.8, 0.3).
std::map<std::string, Observed> observe(const std::string& model,
                                        const std::vector<Offer>& offers) {
  std::string text = header(model, {.scheme = "gauss-16", .scalar = "quad"}, "reference");
  std::string calls;
  for (const Offer& offer : offers) {
    Request request = offer.request;
    request.scalar = "quad";
    const std::string name_space = space(offer.name);
    text += header(model, request, name_space);
    calls += "  observe<" + name_space + "::Propagator, " + name_space + "::State, " + name_space +
             "::Parameters>(\"" + offer.name + "\", " + std::to_string(steps_for(offer.order)) +
             ");\n";
  }
  text += R"(
#include <cmath>
#include <cstdio>
using Quad = __float128;
Quad size(Quad x) { return x < 0 ? -x : x; }
reference::State exact;
template <class Propagator, class State, class Parameters>
State after(Quad h, int steps, const State& z) {
  Propagator run(Parameters{}, h, z);
  if (!run.advance(steps).converged) std::puts("not converged");
  return run.state();
}
template <class Propagator, class State, class Parameters>
void observe(const char* name, int steps) {
  State start;
  start.q = Quad(8) / 10;
  start.p = Quad(3) / 10;
  double error[2];
  State z;
  for (int k = 0; k < 2; ++k) {
    const int count = steps << k;
    z = after<Propagator, State, Parameters>(Quad(1) / count, count, start);
    error[k] = static_cast<double>(size(z.q - exact.q) + size(z.p - exact.p));
  }
  const State back = after<Propagator, State, Parameters>(Quad(-1) / (2 * steps), 2 * steps, z);
  std::printf("%s %.17g %.17g %.17g\n", name, error[0], error[1],
              static_cast<double>(size(back.q - start.q) + size(back.p - start.p)));
}
int main() {
  reference::State start;
  start.q = Quad(8) / 10;
  start.p = Quad(3) / 10;
  exact = after<reference::Propagator, reference::State, reference::Parameters>(Quad(1) / 40, 40, start);
)" + calls +
          "}\n";
  std::istringstream lines(output_of(text));
  std::map<std::string, Observed> result;
  for (std::string name; lines >> name;) {
    Observed seen;
    if (!(lines >> seen.coarse >> seen.fine >> seen.back)) {
      ADD_FAILURE() << "after " << name;
      break;
    }
    result[name] = seen;
  }
  return result;
}

void check(const std::string& model, const std::vector<Offer>& offers) {
  const auto seen = observe(model, offers);
  ASSERT_EQ(seen.size(), offers.size());
  for (const Offer& offer : offers) {
    const Observed& o = seen.at(offer.name);
    EXPECT_NEAR(std::log2(o.coarse / o.fine), offer.order, 0.2) << offer.name << " " << o.coarse;
    // Quad rounds to 1e-34, and a few hundred substeps add up; a step that is not symmetric misses
    // by its own error.
    if (offer.symmetric) {
      EXPECT_LT(o.back, 1e-30) << offer.name;
    } else {
      EXPECT_GT(o.back, 1e-20) << offer.name;
    }
  }
}

std::vector<Offer> the_list(bool splittings) {
  std::vector<Offer> offers;
  for (const Scheme& scheme : all_schemes()) {
    if (std::holds_alternative<Splitting>(scheme.method) != splittings) continue;
    offers.push_back({scheme.name, {.scheme = scheme.name}, scheme.order, scheme.symmetric});
  }
  return offers;
}

TEST(Emitted, SplittingsHaveTheirOrderAndReturnIfSymmetric) { check(kPendulum, the_list(true)); }

TEST(Emitted, SchemesForAnyHamiltonianHaveTheirOrderAndReturnIfSymmetric) {
  check(kMixed, the_list(false));
}

// Members of their own order, and of those that the generating function gives them.
TEST(Emitted, MembersHaveTheOrderAskedForAndReturnIfSymmetric) {
  const std::vector<Offer> own = {
      {"general", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10"}, 1, false},
      {"alpha", {.alpha = "2/5"}, 1, false},
      {"odd", {.beta = "h/7", .gamma = "-h/9"}, 2, true},
      {"odd-alpha", {.alpha = "1/2 + h/5", .beta = "h/7"}, 2, true}};
  check(kMixed, own);
  std::vector<Offer> raised;
  for (int order = 2; order <= 10; order += 2) {
    raised.push_back({"midpoint-" + std::to_string(order), {.order = order}, order, true});
    raised.push_back({"odd-" + std::to_string(order),
                      {.beta = "h/7", .gamma = "-h/9", .order = order},
                      order,
                      true});
  }
  for (int order = 2; order <= 6; ++order) {
    raised.push_back({"general-" + std::to_string(order),
                      {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10", .order = order},
                      order,
                      false});
  }
  check(kPendulum, raised);
}

// H = p^2/2 + sqrt(q) drives q below 0, where H is not real: each scheme fails, and the state
// stays.
TEST(Emitted, FailureLeavesTheStateAsItWasBeforeTheStep) {
  const std::string model = "system fall\ncoordinate q\nmomentum p\nH = p^2/2 + sqrt(q)\n";
  std::string text;
  std::string calls;
  int number = 0;
  auto add = [&](Request request) {
    const std::string name = "fall_" + std::to_string(number++);
    text += header(model, request, name);
    calls += "  falls<" + name + "::Propagator, " + name + "::State>(\"" + request.scheme.text() +
             " " + request.solver.text() + "\", [](" + name + "::State& z) { return " + name +
             "::step({}, 0.1, z).converged; });\n";
  };
  for (const char* name : {"stormer-verlet", "ruth-3", "saba-2", "yoshida-4", "yoshida-6-verlet",
                           "gauss-4", "gauss-6", "rk4"}) {
    add({.scheme = name});
  }
  add({.scheme = "gauss-4", .solver = "newton"});
  add({.scheme = "gauss-4", .solver = "fixed-point"});
  add({.scheme = "suzuki-4", .solver = "fixed-point"});
  text += R"(
#include <cstdio>
#include <cstring>
template <class Propagator, class State, class Step>
void falls(const char* name, Step step) {
  State z;
  z.q = 1.0;
  z.p = -0.5;
  Propagator run({}, 0.1, z);
  bool failed = false;
  for (int i = 0; i < 100 && !failed; ++i) {
    const State before = run.state();
    failed = !run.step().converged;
    const State now = run.state();
    if (failed && std::memcmp(&before, &now, sizeof now) != 0) std::printf("%s changed\n", name);
    if (!(now.q - now.q == 0 && now.p - now.p == 0)) std::printf("%s not finite\n", name);
  }
  if (!failed) std::printf("%s did not fail\n", name);
  bool single = false;
  for (int i = 0; i < 100 && !single; ++i) {
    const State before = z;
    single = !step(z);
    if (single && std::memcmp(&before, &z, sizeof z) != 0) std::printf("%s: step changed\n", name);
  }
  if (!single) std::printf("%s: step did not fail\n", name);
}
int main() {
)" + calls +
          "}\n";
  EXPECT_EQ(output_of(text), "");
}

// omega h = 50: the fixed point diverges, Newton takes over, and the energy of the stiff spring
// stays.
TEST(Emitted, GaussSolvesStiffProblemsByNewton) {
  const std::string model =
      "system stiff\ncoordinate q\nmomentum p\nH = p^2/2 + 125000*q^2 + q^4/4\n";
  std::string text = "#include <cstdio>\n";
  std::string calls;
  for (const std::string name : {"gauss-2", "gauss-4", "gauss-8"}) {
    text += header(model, {.scheme = name}, space(name));
    calls += "  {\n    using namespace " + space(name) + ";\n" + R"(    State z;
    z.q = 1.0;
    const double start = energy({}, z);
    Propagator run({}, 0.1, z);
    const StepReport report = run.advance(1000);
    const double error = energy({}, run.state()) / start - 1;
    if (!report.converged) std::puts("not converged");
    if (!(error < 1e-3 && error > -1e-3)) std::printf("energy error %g\n", error);
    if (report.iterations > 12000) std::printf("%lld iterations\n", report.iterations);
  }
)";
  }
  EXPECT_EQ(output_of(text + "int main() {\n" + calls + "}\n"), "");
}

// A figure of the paper, and the same scheme with the coefficients of Laskar and Robutel.
TEST(Emitted, Saba2AsPrintedAndAsPublishedHaveTheirEnergySpread) {
  const std::string model = "system pendulum\ncoordinate q\nmomentum p\nH = p^2/2 - 0.03*cos(q)\n";
  std::string text = "#include <cstdio>\n";
  std::string calls;
  for (const std::string name : {"saba-2-printed", "saba-2"}) {
    text += header(model, {.scheme = name}, space(name));
    calls += "  {\n    using namespace " + space(name) + ";\n" + R"(    State z;
    z.q = 3.1;
    Propagator run({}, 0.1, z);
    double low = 1, high = -1;
    for (int i = 0; i < 20000; ++i) {
      if (!run.step().converged) std::puts("failed");
      const double now = energy({}, run.state());
      if (now < low) low = now;
      if (now > high) high = now;
    }
    std::printf("%.6g ", high - low);
  }
)";
  }
  std::istringstream output(output_of(text + "int main() {\n" + calls + "}\n"));
  double printed = 0;
  double published = 0;
  output >> printed >> published;
  EXPECT_NEAR(printed, 5.6e-7, 0.05 * 5.6e-7);
  EXPECT_NEAR(published, 1.0e-7, 0.05 * 1.0e-7);
}

// Thirty pendulums that do not know of each other, in loops, and one of them written out.
TEST(Emitted, LoopsTakeTheStepsThatWrittenOutCodeTakes) {
  const std::string many =
      "system many\nsize n = 30\ncoordinate q[1..n]\nmomentum p[1..n]\n"
      "H = sum(i = 1..n, p[i]^2/2 - cos(q[i]))\n";
  std::string text = "#include <cstdio>\n";
  std::string calls;
  int number = 0;
  auto add = [&](Request request) {
    const std::string one = "one_" + std::to_string(number);
    const std::string all = "all_" + std::to_string(number++);
    text += header(kPendulum, request, one) + header(many, request, all);
    calls +=
        "  {\n    " + one + "::State a;\n    a.q = 0.8;\n    a.p = 0.3;\n    " + all +
        "::State b;\n    for (int i = 0; i < 30; ++i) b.q[i] = 0.8, b.p[i] = 0.3;\n    " + one +
        "::Propagator first({}, 0.1, a);\n    " + all + "::Propagator second({}, 0.1, b);\n" +
        R"(    if (!first.advance(100).converged || !second.advance(100).converged) std::puts("failed");
    for (int i = 0; i < 30; ++i) {
      const double dq = first.state().q - second.state().q[i];
      const double dp = first.state().p - second.state().p[i];
      if (!(dq * dq + dp * dp < 1e-26)) std::printf("scheme )" +
        std::to_string(number - 1) +
        R"(: %g %g\n", dq, dp);
    }
  }
)";
  };
  for (const char* name : {"stormer-verlet", "ruth-3", "saba-2", "yoshida-4", "gauss-4", "rk4"}) {
    add({.scheme = name});
  }
  add({.scheme = "gauss-4", .solver = "newton"});
  EXPECT_EQ(output_of(text + "int main() {\n" + calls + "}\n"), "");
}

// What the routines of loops call their own arrays, too.
TEST(Emitted, TheHessianOfLoopsIsTheSameWhateverACoordinateIsCalled) {
  std::string text = "#include <cstdio>\n";
  std::string calls =
      "  double q[30], p[30] = {}, u[60], first[60], y[60];\n"
      "  for (int i = 0; i < 30; ++i) q[i] = 0.1 * (i % 7);\n"
      "  for (int i = 0; i < 60; ++i) u[i] = i % 5;\n";
  for (const std::string x : {"q", "y", "u"}) {
    text += header("system many\nsize n = 30\ncoordinate " + x + "[1..n] with " + x + "[0] = 0, " +
                       x + "[n+1] = 0\nmomentum p[1..n]\nH = sum(i = 1..n, p[i]^2/2)" +
                       " + sum(i = 0..n, cosh(" + x + "[i+1] - " + x + "[i]))\n",
                   {.tangent = true}, "of_" + x);
    calls += "  of_" + x + "::curvature({}, q, p, u, " + (x == "q" ? "first" : "y") + ");\n";
    if (x == "q") continue;
    calls +=
        "  for (int i = 0; i < 60; ++i)\n    if (y[i] != first[i]) std::puts(\"" + x + "\");\n";
  }
  EXPECT_EQ(output_of(text + "int main() {\n" + calls + "}\n"), "");
}

class Strictly : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scalars, Strictly,
                         ::testing::Values("float", "double", "long-double", "quad"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(Strictly, EmittedSchemesCompileWithoutAWarning) {
  const std::string loops =
      "system chain\nsize n = 40\ncoordinate q[1..n]\nmomentum p[1..n]\n"
      "H = sum(i = 1..n, p[i]^2/2) + sum(i = 1..n-1, (q[i+1] - q[i])^4/4) + q[1]^2 + q[n]^2\n";
  std::string text;
  int number = 0;
  auto add = [&](const std::string& model, Request request) {
    request.scalar = GetParam();
    text += header(model, request, "strict_" + std::to_string(number++));
  };
  const auto driven = [](const std::string& more) {
    return "system driven\nsize N = 40\ncoordinate q[1..N], n\nmomentum p[1..N], k\ntime Matrix\n"
           "H = sum(i = 1..N, p[i]^2/2 - cos(Matrix)*q[i]" +
           more + ") + k^2/2 + sum(i = 1..N-1, sin(Matrix)*(q[i+1] - q[i])^4/4) + n^4/4\n";
  };
  add(driven(" + n*q[i]^2"), {.solver = "newton", .tangent = true});
  add(driven(" + n*q[i]^2"), {.scheme = "gauss-4"});
  add(driven(""), {.order = 4});
  add(driven(" + p[i]^2*exp(-Matrix)"), {.alpha = "0"});  // whose matrix has nothing of it
  for (const std::string& model : {kPendulum, kMixed, loops}) {
    for (const char* name : {"yoshida-4", "gauss-2", "gauss-6", "rk4"})
      add(model, {.scheme = name});
    add(model, {.scheme = "gauss-4", .solver = "fixed-point"});
    for (const char* name : {"implicit-midpoint", "yoshida-4", "gauss-4", "rk4"}) {
      add(model, {.scheme = name, .tangent = true});
    }
    for (const char* solver : {"fixed-point", "sweeps:2"}) {
      add(model, {.solver = solver, .tangent = true});
    }
    add(model, {.alpha = "1/3", .beta = "h/5", .gamma = "-h/7", .tangent = true});
    add(model, {.alpha = "0", .tangent = true});
    if (model != kMixed) add(model, {.scheme = "saba-2", .tangent = true});
    if (model != loops) add(model, {.scheme = "gauss-4", .solver = "newton"});
    if (model == kMixed) continue;
    for (const char* name : {"stormer-verlet", "ruth-3", "saba-3"}) add(model, {.scheme = name});
  }
  for (const char* compiler : {"g++", "clang++"}) EXPECT_EQ(warnings_of(compiler, text), "");
}

std::string refusal(const std::string& model, const Request& request) {
  try {
    (void)generate(make_source("model.ham", model), request);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Requests, ForAHamiltonianThatIsNotSeparableNameAnAlternative) {
  EXPECT_EQ(refusal(kMixed, {.scheme = "yoshida-6-verlet"}),
            "--scheme yoshida-6-verlet needs a separable H = T(p) + V(q), and the H of mixed mixes "
            "coordinates and momenta\nhelp: --scheme yoshida-6 or gauss-6 takes any H");
  EXPECT_NE(refusal(kMixed, {.scheme = "ruth-3"}).find("--scheme gauss-4 takes any H"),
            std::string::npos);
  EXPECT_NE(refusal("system s\ncoordinate q\nmomentum p\nH = sqrt(1 + p^2) + q^2\n",
                    {.scheme = "blanes-moan-rkn-6"})
                .find("quadratic in p"),
            std::string::npos);
}

TEST(Requests, ComposeSymmetricMembersOnly) {
  EXPECT_NE(refusal(kPendulum, {.scheme = "yoshida-4", .alpha = "1/3"}).find("symmetric"),
            std::string::npos);
  EXPECT_EQ(refusal(kPendulum, {.scheme = "yoshida-4", .beta = "h/7", .gamma = "-h/9"}), "");
}

TEST(Requests, ForASolverOfAnExplicitSchemeAreRefused) {
  EXPECT_NE(refusal(kPendulum, {.scheme = "rk4", .solver = "newton"}).find("explicit"),
            std::string::npos);
  EXPECT_NE(refusal(kPendulum, {.scheme = "gauss-4", .solver = "sweeps:3"}).find("fixed-point"),
            std::string::npos);
}

}  // namespace
}  // namespace hamgen::schemes_test
