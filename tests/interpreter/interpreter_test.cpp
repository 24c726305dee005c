// The interpreter against the compiled text: the same operations in the same order, so that every
// bit of the state is the same.  What only the interpreter makes cheap enough, every method over
// every scene, is tests/contract.
#include "generator/interpreter/interpreter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "generator/base/source_text.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen {
namespace {

SourceText shipped(const std::string& name) {
  return read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + name + ".ham");
}

struct Start {
  std::vector<double> parameters, state;
  double h = 0;
};

// A scene with the parameters that the step uses.
Start start_of(const Model& model, const Scene& scene, const Program& code) {
  const SceneValues values = scene_values(model, {.scene = scene.name});
  Start start{.h = to_double(values.h.value_or(Rational(1, 100)))};
  for (const Rational& value : values.q) start.state.push_back(to_double(value));
  for (const Rational& value : values.p) start.state.push_back(to_double(value));
  const std::vector<std::string> names = element_names(model.parameters);
  for (const auto& [name, unit, comment, value] : code.environment.parameters) {
    const auto it = std::ranges::find(names, name);
    if (it == names.end()) throw std::runtime_error("no value for " + name);
    start.parameters.push_back(
        to_double(values.parameters.at(static_cast<std::size_t>(it - names.begin()))));
  }
  return start;
}

struct Case {
  std::string model;
  Request request;
  double h = 0;  // of the scene, if 0
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.model << " " << c.request.scheme.text() << c.request.solver.text();
}

class Compiled : public testing::TestWithParam<Case> {};

TEST_P(Compiled, HasTheBitsThatAreInterpreted) {
  const SourceText source = shipped(GetParam().model);
  const Program code = make_program(source, GetParam().request);
  const Model model = read_request(source, GetParam().request);
  Start start = start_of(model, model.scenes.front(), code);
  if (GetParam().h > 0) start.h = GetParam().h;
  Interpreter<double> interpreted(code, start.parameters, start.h, start.state);
  const PluginSource plugin = generate_plugin(source, GetParam().request);
  runtime::InitialValues initial{.h = {start.h, 0}};
  for (const double value : start.parameters) initial.parameters.push_back({value, 0});
  for (const double value : start.state) initial.state.push_back({value, 0});
  runtime::Integrator compiled(
      runtime::load_plugin({.text = plugin.text, .uses_eigen = plugin.needs_eigen},
                           runtime::find_compiler(), {}, runtime::open_cache())
          .library,
      initial);
  for (int step = 1; step <= 2000; ++step) {
    const runtime::Report report = compiled.advance(1, false);
    ASSERT_EQ(report.status, runtime::Status::done);
    const Interpreter<double>::Report other = interpreted.step();
    ASSERT_TRUE(other.converged);
    ASSERT_EQ(other.iterations, report.iterations) << "in step " << step;
    ASSERT_EQ(interpreted.state(), compiled.rounded_state()) << "after step " << step;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sample, Compiled,
    testing::Values(Case{"pendulum", {}}, Case{"double_pendulum", {}},
                    Case{"kepler", {.scheme = "yoshida-4"}},
                    Case{"henon_heiles", {.solver = "fixed-point"}},
                    Case{"kepler", {.scheme = "stormer-verlet"}},
                    Case{"toda", {.scheme = "mclachlan-4"}}, Case{"product", {.scheme = "rk4"}},
                    Case{"pendulum", {.scheme = "gauss-4"}},
                    Case{"product", {.scheme = "gauss-16"}, 0.48},
                    Case{"spring_pendulum", {.scheme = "gauss-6"}, 0.48},
                    Case{"kepler", {.scheme = "gauss-6", .solver = "newton"}}, Case{"fput", {}},
                    Case{"fput", {.order = 4}}, Case{"fput", {.order = 4}, 0.5},
                    Case{"fput", {.solver = "fixed-point"}}, Case{"fput", {.scheme = "gauss-4"}},
                    Case{"fput", {.scheme = "yoshida-4"}}, Case{"fput", {.solver = "sweeps:3"}},
                    Case{"outer_solar_system", {}}, Case{"morse", {.order = 4}}));

// A model without parameters, compiled and interpreted: the same bits and iterations for 100 steps.
void takes_the_same_steps(const std::string& text, const Request& request, double h,
                          const std::vector<double>& state) {
  const SourceText source = make_source("model.ham", text);
  Interpreter<double> interpreted(make_program(source, request), {}, h, state);
  runtime::InitialValues initial{.h = {h, 0}};
  for (const double value : state) initial.state.push_back({value, 0});
  const PluginSource plugin = generate_plugin(source, request);
  runtime::Integrator compiled(
      runtime::load_plugin({.text = plugin.text, .uses_eigen = plugin.needs_eigen},
                           runtime::find_compiler(), {}, runtime::open_cache())
          .library,
      initial);
  for (int step = 1; step <= 100; ++step) {
    const runtime::Report report = compiled.advance(1, false);
    ASSERT_EQ(report.status, runtime::Status::done);
    ASSERT_EQ(interpreted.step().iterations, report.iterations) << "in step " << step;
    ASSERT_EQ(interpreted.state(), compiled.rounded_state()) << "after step " << step;
  }
}

// Whole arrays are measured in parts, whose sums round otherwise than one long sum; a fixed point
// that contracts slowly then ends in another iteration.
TEST(FixedPoint, MeasuresArraysAsTheCompiledOneDoes) {
  std::vector<double> state(60);
  state[0] = 1;
  state[31] = 0.2;
  takes_the_same_steps(
      "size N = 30\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/3.4) + sum(i = 0..N, 0.3*(q[i+1] - q[i])^2/2)\n",
      {.solver = "fixed-point"}, 0.7, state);
}

// Two blocks one after the other, whose matrices have one name: of other sizes, in both orders, and
// one symmetric, one not.
TEST(Blocks, OfOtherMatricesHaveTheBitsThatAreInterpreted) {
  const auto rings = [](int first, int second) {
    return fmt::format(
        "system rings\nsize A = {}\nsize B = {}\n"
        "coordinate q[1..A] periodic\nmomentum p[1..A]\n"
        "coordinate r[1..B] periodic\nmomentum s[1..B]\n"
        "H = sum(i = 1..A, p[i]^2/2*(1 + q[i]^2) + (q[i+1] - q[i])^4/4)"
        " + sum(i = 1..B, s[i]^2/2*(1 + r[i]^2) + (r[i+1] - r[i])^4/4)\n",
        first, second);
  };
  const auto state = [](int size) {
    std::vector<double> values;
    for (int i = 0; i < 2 * size; ++i) values.push_back(i < size ? std::sin(1.0 + i) : 0.2);
    return values;
  };
  takes_the_same_steps(rings(4, 3), {}, 0.01, state(7));
  takes_the_same_steps(rings(2, 3), {}, 0.01, state(5));
  takes_the_same_steps(
      "system blocks\ncoordinate q[1..4]\nmomentum p[1..4]\n"
      "coordinate r[1..2]\nmomentum s[1..2]\n"
      "H = sum(i = 1..4, p[i]^2/2 + cos(q[i]) + q[i]^4)"
      " + sum(i = 1..4, j = i+1..4, q[i]^2*q[j]^2)"
      " + sum(i = 1..2, s[i]^2/2*(1 + r[i]^2)) + s[1]*s[2]*r[1]^3*4 + (r[1] - r[2])^4*s[1]"
      " + 3*r[1]*s[2]\n",
      {}, 0.005, state(6));
}

// Bands with corners, a block of both in turn and a full matrix, which tests/numerics compares with
// the step by hand.
TEST(Loops, OfRingsAndOfAllPairsHaveTheBitsThatAreInterpreted) {
  std::vector<double> state(52);
  for (std::size_t i = 0; i < state.size(); ++i)
    state[i] = static_cast<double>(i % 7) / 8 - static_cast<double>(i % 3) / 4;
  const std::string ring = "coordinate q[1..26] periodic\nmomentum p[1..26]\n";
  for (const std::string& text :
       {ring + "H = sum(i = 1..26, p[i]^2/2 + exp(q[i] - q[i+1]))\n",
        ring + "H = sum(i = 1..26, p[i]^2*(1 + q[i]^2/4)/2 + (1 - cos(q[i+1] - q[i])))\n",
        std::string("coordinate q[1..26]\nmomentum p[1..26]\n"
                    "H = sum(i = 1..26, p[i]^2/2 + q[i]^2/2)"
                    " + sum(i = 1..25, sum(j = i+1..26, cos(q[i] - q[j])/16))\n")}) {
    SCOPED_TRACE(text);
    takes_the_same_steps(text, {.alpha = "3/10", .beta = "1/8"}, 0.03125, state);
  }
}

// What all meet stands in a border: a symmetric band within one variable, and both arrays in turn
// within two.
TEST(Loops, OfAVariableThatAllMeetHaveTheBitsThatAreInterpreted) {
  std::vector<double> state(54);
  for (std::size_t i = 0; i < state.size(); ++i)
    state[i] = static_cast<double>(i % 7) / 8 - static_cast<double>(i % 3) / 4 + 1;
  for (const std::string& text :
       {"coordinate f, q[1..26] with q[0] = 0, q[27] = 0\nmomentum J, p[1..26]\n"
        "H = sum(i = 1..26, p[i]^2/2 + f*sin(q[i])) + J^2/2 + f^4"
        " + sum(i = 0..26, (q[i+1] - q[i])^4/4)\n",
        "coordinate q[1..26], f\nmomentum p[1..26], J\n"
        "H = sum(i = 1..26, p[i]^2*(1 + q[i]^2/4)/2) + J"
        " + sqrt(J^2 + 10)*sum(i = 1..26, cos(q[i] - f))/16\n"}) {
    SCOPED_TRACE(text);
    takes_the_same_steps(text, {.solver = "newton"}, 0.03125, state);
    takes_the_same_steps(text, {.alpha = "3/10", .beta = "1/8"}, 0.03125, state);
  }
}

// Symmetric bands, folded or not, of steps so long that Newton takes them, and of linear equations
// of a condition up to 1e12.
TEST(Loops, OfSymmetricBandsHaveTheBitsThatAreInterpreted) {
  std::vector<double> state(52);
  for (std::size_t i = 0; i < 26; ++i) state[i] = std::sin(0.24 * static_cast<double>(i));
  const std::string chain =
      "coordinate q[1..26] with q[0] = 0, q[27] = 0\nmomentum p[1..26]\n"
      "H = sum(i = 1..26, p[i]^2/2 - q[i]^2/2)"
      " + sum(i = 0..26, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)\n";
  const auto ring = [](const char* k) {
    return fmt::format(
        "coordinate q[1..26] periodic\nmomentum p[1..26]\n"
        "H = sum(i = 1..26, p[i]^2/2 + {}*(q[i+1] - q[i])^2/2)\n",
        k);
  };
  takes_the_same_steps(chain, {}, 0.5, state);
  takes_the_same_steps(ring("1.3"), {}, 0.5, state);
  takes_the_same_steps(ring("1e12"), {}, 0.5, state);
}

// Of a scene with steps of h: has a step taken Newton's iteration?
bool comes_to_newton(const char* name, const Request& request, double h) {
  const SourceText source = shipped(name);
  const Program code = make_program(source, request);
  const Model model = read_request(source, request);
  const Start start = start_of(model, model.scenes.front(), code);
  Interpreter<double> run(code, start.parameters, h, start.state);
  for (int step = 0; step < 500; ++step) EXPECT_TRUE(run.step().converged) << name;
  return run.remembered(0, "residual") != std::vector<double>{0};
}

// Where a prediction over a large step is worse than none.
TEST(FixedPoint, BeginsOnceMoreAtTheStateBeforeNewtonTakesOver) {
  EXPECT_FALSE(comes_to_newton("product", {.scheme = "gauss-16"}, 0.48));
  EXPECT_FALSE(comes_to_newton("toda", {.scheme = "gauss-16"}, 1.59));
  EXPECT_TRUE(comes_to_newton("spring_pendulum", {.scheme = "gauss-6"}, 0.48));
}

// Where coordinates and momenta wait for each other it begins with the prediction that the fixed
// point began with: by the steps that Newton alone takes, to the last bit.
TEST(FixedPoint, LeavesItsPredictionToNewton) {
  const SourceText source = make_source(
      "rotors.ham",
      "system rotors\nsize N = 26\ncoordinate q[1..N] periodic\nmomentum p[1..N] periodic\n"
      "H = sum(i = 1..N, p[i]^2*(2 + cos(q[i]))/6 - cos(q[i+1] - q[i]))\n");
  std::vector<double> start(52);
  for (std::size_t i = 0; i < 26; ++i) {
    start[i] = std::sin(static_cast<double>(i)) / 2;
    start[26 + i] = std::cos(static_cast<double>(i * i)) / 2;
  }
  const double h = 1;  // of which three increments show that they do not contract
  Interpreter<double> both(make_program(source, {}), {}, h, start);
  Interpreter<double> newton(make_program(source, {.solver = "newton"}), {}, h, start);
  long more = 0;
  for (int step = 0; step < 100; ++step) {
    const auto report = both.step();
    const auto alone = newton.step();
    ASSERT_TRUE(report.converged && alone.converged) << step;
    more += report.iterations - alone.iterations;
    ASSERT_EQ(both.state(), newton.state()) << step;
  }
  EXPECT_GT(more, 3);  // the fixed point was tried
}

// Variables that are called like the objects of the routines: z, k, par, carry.
TEST(Names, OfVariablesAreNotThoseOfObjects) {
  const auto last = [](const std::vector<std::string>& q) {
    std::string text;
    for (const char* kind : {"coordinate", "momentum"}) {
      text += kind;
      for (std::size_t i = 0; i < q.size(); ++i) {
        text += (i == 0 ? " " : ", ") + (*kind == 'm' ? "p" + std::to_string(i) : q[i]);
      }
      text += "\n";
    }
    text += fmt::format("H = (p0^2 + p1^2 + p2^2)/2 + {0}^4/4 + {1}^2/2 + {2}^2/3 + {0}*{1}*{2}\n",
                        q[0], q[1], q[2]);
    const Program code = make_program(make_source("m.ham", text), {});
    Interpreter<double> run(code, {}, 0.1, {1, 0.5, 0.25, 0, 0, 0});
    for (int step = 0; step < 20; ++step) EXPECT_TRUE(run.step().converged);
    return run.state();
  };
  const std::vector<double> wanted = last({"a", "b", "c"});
  EXPECT_EQ(last({"k", "par", "z"}), wanted);
  EXPECT_EQ(last({"carry", "dz", "start"}), wanted);
}

}  // namespace
}  // namespace hamgen
