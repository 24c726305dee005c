// What finds events in an emitted header, in the hands of a compiler.
#include <gtest/gtest.h>

#include <sstream>

#include "generator/base/diagnostic.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

constexpr const char* kWatchedKepler =
    "system kepler\ncoordinate x, y\nmomentum px, py\nparameter r0 = 1/2\n"
    "H = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2)\n"
    "event far = x falling\nevent near = x^2 + y^2 - r0^2\nevent never = 1 + x^2\n";

std::string watched_header(const std::string& model, Request request) {
  request.events = true;
  return without_pragma(emit(make_source("model.ham", model), request).at(0).text);
}

const std::vector<std::string>& watched_schemes() {
  static const std::vector<std::string> names = {"implicit-midpoint", "stormer-verlet", "rk4",
                                                 "yoshida-4", "gauss-6"};
  return names;
}

// From the perihelion at e = 0.6, where the eccentric anomaly E begins, x = cos(E) - e is 0 at the
// time E - e sin(E): for steps of 1/(N + 0.4) of it, N = 12 and 24, the errors of this time by the
// header and by its cubic alone.
std::string order_program() {
  std::string text;
  for (const std::string& scheme : watched_schemes())
    text += watched_header(kWatchedKepler, {.scheme = scheme});
  text += R"(
#include <cmath>
#include <cstdio>
using namespace kepler;
const Real quarter = std::acos(0.6) - 0.6 * 0.8;
template <class Crossing, class Watched, class Propagator, class Cubic>
int measure(int n, const Cubic& cubic) {
  const Real h = quarter / (n + Real(0.4));
  State z;
  z.x = 0.4;
  z.py = 2;
  Propagator alone({}, h, z);
  Watched watched(alone);
  Real time = 0;
  int fars = 0, nears = 0, others = 0;
  State before = z, after = z;
  const auto visit = [&](const Crossing& crossing) {
    const int event = static_cast<int>(crossing.event);
    if (event == 0) {
      ++fars;
      time = crossing.time;
    }
    nears += event == 1;
    others += event == 2;
    return false;
  };
  for (int i = 0; i < n + 4; ++i) {
    const State last = watched.propagator().state();
    if (!watched.step(visit).converged || !alone.step().converged) return 1;
    if (fars == 1 && after.x == z.x) {
      before = last;
      after = watched.propagator().state();
    }
  }
  // Found by looking, the steps are those of the Propagator.
  if (watched.propagator().state().x != alone.state().x) return 2;
  if (watched.propagator().state().py != alone.state().py) return 3;
  // x of the cubic between both states, alone.
  Real from[4], to[4];
  gradient({}, before, from);
  gradient({}, after, to);
  Real low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const Real s = (low + high) / 2;
    (cubic(s, h, before.x, from[2], after.x, to[2]) > 0 ? low : high) = s;
  }
  std::printf("%.17g %.17g %d %d %d\n", std::fabs(time - quarter), std::fabs((n + low) * h - quarter), fars,
              nears, others);
  return 0;
}
int main() {
  for (int n = 12; n <= 24; n += 12) {
)";
  for (const std::string& scheme : watched_schemes()) {
    std::string space = scheme;
    for (char& c : space) c = c == '-' ? '_' : c;
    text += "    if (const int status = measure<" + space + "::Crossing, " + space +
            "::WatchedPropagator, " + space + "::Propagator>(n, " + space +
            "::cubic_between)) return status;\n";
  }
  return text + "  }\n}\n";
}

struct TimeOfFar {
  double error = 0, of_cubic = 0;
  int far = 0, near = 0, never = 0;
};

// Orders of the schemes, 2, 2, 4, 4 and 6, of the crossing as of the steps: to 0.3 where the next
// term of the error still counts.  The negative control: on the cubic, whose error is of order h^4,
// that of gauss-6 is 4.
TEST(EmittedEvents, HaveTheOrderOfTheStepsAndLeaveThemAsTheyAre) {
  std::istringstream output(run_program(order_program()));
  std::vector<TimeOfFar> times;
  for (TimeOfFar t; output >> t.error >> t.of_cubic >> t.far >> t.near >> t.never;)
    times.push_back(t);
  const std::size_t count = watched_schemes().size();
  ASSERT_EQ(times.size(), 2 * count);
  const double orders[] = {2, 2, 4, 4, 6};
  const double refinement = std::log(24.4 / 12.4);
  for (std::size_t i = 0; i < count; ++i) {
    const TimeOfFar& coarse = times[i];
    const TimeOfFar& fine = times[count + i];
    EXPECT_NEAR(std::log(coarse.error / fine.error) / refinement, orders[i], 0.3)
        << watched_schemes()[i];
    for (const TimeOfFar& each : {coarse, fine}) {
      EXPECT_EQ(each.far, 1);
      EXPECT_EQ(each.near, 1);
      EXPECT_EQ(each.never, 0);
    }
  }
  const double of_cubic =
      std::log(times[count - 1].of_cubic / times[2 * count - 1].of_cubic) / refinement;
  EXPECT_NEAR(of_cubic, 4, 0.3);
  EXPECT_GT(times[2 * count - 1].of_cubic, 10 * times[2 * count - 1].error);
}

// q = cos(t): near its turn it passes 1 - 1/1000 twice within a step of 1/5, 0.0894 apart.
TEST(EmittedEvents, TwoInAStepAreFoundAndOneEndsTheRun) {
  const std::string program = watched_header(
                                  "system swing\ncoordinate q\nmomentum p\nH = p^2/2 + q^2/2\n"
                                  "event top = q - 999/1000\nevent down = q falling\n",
                                  {.scheme = "gauss-6"}) +
                              R"(
#include <cmath>
#include <cstdio>
int main() {
  using namespace swing;
  using namespace gauss_6;
  State start;
  start.q = 1;
  WatchedPropagator watched(Propagator({}, 0.2, start));
  int tops = 0, downs = 0;
  double worst = 0;
  const double pi = 3.14159265358979323846;
  const auto visit = [&](const Crossing& crossing) {
    double phase = std::acos(0.999);
    if (crossing.event == Event::top) {
      ++tops;
      if (tops % 2 == 0) phase = -phase;
    } else {
      ++downs;
      phase = pi / 2;
    }
    const double error = std::fabs(std::remainder(crossing.time - phase, 2 * pi));
    if (error > worst) worst = error;
    if (std::fabs(crossing.state.q - std::cos(crossing.time)) > 1e-5) return true;
    return downs == 100;
  };
  if (!watched.advance(1000000, visit).converged || !watched.ended()) return 1;
  const double time = watched.propagator().time();
  if (std::fabs(time - (99 * 2 * pi + pi / 2)) > 0.2) return 2;
  // Dense output of the last step: its ends, and what is between.
  State z, before = watched.propagator().state();
  if (!watched.at(0, z).converged || std::fabs(z.q - std::cos(time - 0.2)) > 1e-5) return 3;
  if (!watched.at(1, z).converged || std::fabs(z.q - before.q) > 1e-14) return 4;
  if (!watched.at(0.5, z).converged || std::fabs(z.q - std::cos(time - 0.1)) > 1e-5) return 5;
  watched.reset(start);
  if (watched.ended() || watched.propagator().time() != 0) return 6;
  tops = downs = 0;
  if (!watched.advance(10, visit).converged || tops != 1 || downs != 1) return 7;
  std::printf("%d %.3e", tops, worst);
}
)";
  const std::string output = run_program(program);
  std::istringstream words(output);
  int tops = 0;
  double worst = 1;
  words >> tops >> worst;
  EXPECT_EQ(tops, 1) << output;
  // The step is the Pade approximant of the rotation, whose phase is off by h^7 3!^2/(6! 7!) a
  // step: 4e-7 after 630 units of time.  Its radius is kept.
  EXPECT_LT(worst, 5e-7);
}

// What a header is made of: loops with and without a matrix, compositions, splittings, a scene
// whose steps are not looked at, one namespace, fixed blocks, other scalars.
constexpr const char* kWatchedChain =
    "size N = 40\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^2/2 + q[i]^4/4)\n"
    "event first = q[1] - q[2]\n";

TEST(EmittedEvents, InLoopsCompileWithoutAWarning) {
  const std::string header =
      watched_header(std::string("system chain\n") + kWatchedChain, {.scheme = "stormer-verlet"});
  EXPECT_EQ(messages("g++", header), "");
}

TEST(EmittedEvents, OfEveryKindCompileWithoutAWarning) {
  const std::string chain = kWatchedChain;
  const std::string driven =
      "system driven\ncoordinate default\nmomentum p\ntime t\nparameter a = 1\n"
      "H = p^2/2 + default^4/4 - a*default*cos(t)\nevent events = default rising\n"
      "event long = t - 1\nscene s { default = 1; h = 0.1; steps = 10 }\n";
  std::string text = watched_header("system a\n" + chain, {}) +
                     watched_header("system b\n" + chain, {.scheme = "yoshida-4"}) +
                     watched_header("system c\n" + chain, {.scheme = "stormer-verlet"}) +
                     watched_header("system d\n" + chain, {.scheme = "gauss-4"}) +
                     watched_header(driven, {}) + watched_header(driven, {.scheme = "saba-2"}) +
                     watched_header(driven, {.scalar = "float"}) +
                     watched_header(driven, {.scalar = "quad"}) +
                     watched_header(driven, {.scalar = "long-double", .name_space = "one"}) +
                     watched_header(kWatchedKepler, {.order = 4, .tangent = true});
  const auto use = [&](const std::string& space) {
    text += "template " + std::string("int use<") + space + "::WatchedPropagator, " + space +
            "::Crossing>(" + space + "::WatchedPropagator&);\n";
  };
  text += R"(
template <class Watched, class Crossing>
int use(Watched& watched) {
  int count = 0;
  (void)watched.advance(10, [&](const Crossing&) { return ++count > 3; });
  return count;
}
)";
  for (const char* space :
       {"a::implicit_midpoint", "b::yoshida_4", "c::stormer_verlet", "d::gauss_4",
        "driven::implicit_midpoint", "driven::float32::implicit_midpoint",
        "driven::quad::implicit_midpoint", "one"})
    use(space);
  EXPECT_EQ(messages("g++", text), "");
}

TEST(EmittedEvents, AreNotThereUnlessAskedFor) {
  const SourceText source = make_source("model.ham", kWatchedKepler);
  const std::string header = emit(source, {}).at(0).text;
  for (const char* name : {"events", "Crossing", "bracketed_root", "r0 = "})
    EXPECT_EQ(header.find(name), std::string::npos) << name;
  for (const char* format : {"c-header", "cpp-plugin"})
    EXPECT_THROW(static_cast<void>(emit(source, {.format = format, .events = true})), UsageError);
  EXPECT_THROW(static_cast<void>(generate(
                   read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/pendulum.ham"),
                   {.events = true})),
               UsageError);
}

}  // namespace
}  // namespace hamgen::emitted_test
