// Models by chance through every stage to the step: in quad the interpreted routines and a direct
// evaluation of the model's text agree to all but some digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "generator/choose_scheme.hpp"
#include "generator/interpreter/interpreter.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/program/build_program.hpp"
#include "generator/solvers/solve_plan.hpp"
#include "tests/random/direct_step.hpp"
#include "tests/random/random_model.hpp"

namespace hamgen::random {
namespace {

// Quad has 34 digits.  Formulas of some hundred operations, of which no argument and no result is
// larger than a hundred, lose three or four, and the quotients and roots that derivatives are
// rewritten to as many again: what is wrong is wrong by more than 1e-24.
constexpr double kRounding = 1e-24;

// |x - y| in parts of 1 + |y|.
double difference(Quad x, Quad y) {
  const auto size = [](Quad a) { return a < 0 ? -a : a; };
  return static_cast<double>(size(x - y) / (1 + size(y)));
}
double difference(const Vector& x, const Vector& y) {
  if (x.size() != y.size()) return 1;
  double worst = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double here = difference(x[k], y[k]);
    if (!(here <= worst)) worst = here;
  }
  return worst;
}

// How far the routines are from the model they were made of.
struct Differences {
  double energy = 0, gradient = 0, invariants = 0, step = 0;
  [[nodiscard]] double worst() const { return std::max({energy, gradient, invariants, step}); }
  [[nodiscard]] std::string text() const {
    return "energy " + std::to_string(energy) + ", gradient " + std::to_string(gradient) +
           ", invariants " + std::to_string(invariants) + ", step " + std::to_string(step);
  }
};

Vector state_of(const SceneValues& scene) {
  Vector z;
  for (const auto* values : {&scene.q, &scene.p}) {
    for (const Rational& value : *values) z.push_back(to_quad(value));
  }
  return z;
}

// `judge` is the model that the routines of `c` are held against.
Differences measure(const RandomCase& c, const std::string& judge) {
  const Model model = read_request(make_source("chance.ham", c.text), c.request);
  const Mechanics mechanics = derive(model, true);
  const StepEquations equations = discretise(mechanics, choose_scheme(model, mechanics, c.request));
  const Program code = build_program(plan_solve(equations, c.request.solver));

  const SceneValues scene = scene_values(model, {});
  const Model judging = read_request(make_source("judge.ham", judge), {});
  const DirectModel direct(judging, scene_values(judging, {}).parameters);
  std::vector<Quad> parameters;
  for (const auto& [name, unit, comment, value] : code.environment.parameters)
    parameters.push_back(direct.parameter(name));
  const Vector z = state_of(scene);
  const Quad h = to_quad(*scene.h);
  Interpreter<Quad> run(code, parameters, h, z);

  Differences found;
  const Jet energy = direct.hamiltonian(z);
  found.energy = difference(run.energy(z), energy.value);
  found.gradient = difference(run.values("gradient", z), energy.gradient);
  if (!judging.invariants.empty()) {
    Vector values;
    for (const Invariant& each : judging.invariants) {
      values.push_back(direct.value(each.value, z).value);
    }
    found.invariants = difference(run.values("invariants", z), values);
  }
  Vector end = direct_step(direct, equations.scheme, h, z);
  const bool converged = run.step().converged;
  for (std::size_t k = 0; k < end.size(); ++k) end[k] -= run.carry()[k];
  found.step = converged ? difference(run.state(), end) : 1;
  return found;
}

// Two thousand models, in parts that can run side by side: two by the tests, all by `ctest -C
// full`; from another seed on by HAMGEN_FIRST_SEED.
class RandomModelsOf : public testing::TestWithParam<int> {};
constexpr int kParts = 8;
constexpr int kModels = 2000 / kParts;
INSTANTIATE_TEST_SUITE_P(Part, RandomModelsOf, testing::Range(0, kParts));

TEST_P(RandomModelsOf, AreInterpretedAsTheyAreWritten) {
  const char* seed_of_all = std::getenv("HAMGEN_FIRST_SEED");
  const int first = (seed_of_all == nullptr ? 0 : std::atoi(seed_of_all)) + GetParam() * kModels;
  int wrong = 0;
  for (int seed = first; seed < first + kModels && wrong < 5; ++seed) {
    const RandomCase c = random_case(static_cast<std::uint64_t>(seed));
    try {
      const Differences found = measure(c, c.text);
      if (found.worst() <= kRounding) continue;
      ADD_FAILURE() << "seed " << seed << ": " << found.text() << "\n" << c.text;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "seed " << seed << ": " << error.what() << "\n" << c.text;
    }
    ++wrong;
  }
}

// Negative control: 1e-20 of one term more in H is seen in every quantity.
TEST(RandomModels, DoNotAgreeWithOthers) {
  for (int seed = 0; seed < 20; ++seed) {
    const RandomCase c = random_case(static_cast<std::uint64_t>(seed));
    const bool array = c.text.find("x[1..N]") != std::string::npos;
    std::string other = c.text;
    other.replace(other.find("H = "), 4, array ? "H = 1e-20*exp(x[1]) + " : "H = 1e-20*exp(q1) + ");
    const Differences found = measure(c, other);
    EXPECT_GT(found.energy, kRounding) << c.text;
    EXPECT_GT(found.gradient, kRounding) << c.text;
    // h times as large.
    EXPECT_GT(found.step, kRounding) << c.text;
  }
}

}  // namespace
}  // namespace hamgen::random
