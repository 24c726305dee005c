// The distance of steps from the exact map of their method.
#include "app/studies/certify.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/output/certify_output.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "tests/certify/taken_step.hpp"

namespace hamgen::certify_test {
namespace {

using app::Certificate;
using app::ExactSum;

// A unit is epsilon |z_i|: a handful of operations and the rounded coefficients of up to 31
// substeps, each worth half a unit of h |f| at most, where h |f| is a tenth of |z|.
constexpr double kRounding = 12.0;

TEST(Certify, EveryMethodOfTheListIsWithinRoundingOfItsMap) {
  for (const Scheme& scheme : all_schemes()) {
    for (const std::string h : {"1/10", "-1/10"}) {
      const Certificate found = Orbit(kHenonHeiles, {.scheme = scheme.name}, h).certify(3);
      EXPECT_EQ(found.certified, 3) << scheme.name << ": " << found.failure;
      EXPECT_LT(found.units, kRounding) << scheme.name << ", h = " << h;
      EXPECT_EQ(found.symplectic, scheme.symplectic) << scheme.name;
      EXPECT_TRUE(found.holds());
    }
  }
}

TEST(Certify, EveryScalarIsMeasuredByItsOwnRounding) {
  for (const std::string scalar : {"float", "double", "long-double", "quad"}) {
    for (const std::string scheme : {"implicit-midpoint", "gauss-4", "stormer-verlet"}) {
      const Certificate found =
          Orbit(kHenonHeiles, {.scheme = scheme, .scalar = scalar}).certify(20);
      EXPECT_EQ(found.certified, 20) << scalar << scheme << found.failure;
      EXPECT_LT(found.units, kRounding) << scalar << scheme;
      // Not because the unit is a coarser one.
      EXPECT_GT(found.units, 1e-3) << scalar << scheme;
    }
  }
}

TEST(Certify, MembersWithParametersFunctionsOfHAndE0) {
  const std::vector<Request> methods = {
      {.alpha = "3/10", .beta = "1/7", .gamma = "-1/9"},
      {.beta = "h/7, h/5", .gamma = "-sin(h)/5, 0"},
      {.beta = "E0*h"},
      {.beta = "beta*h"},
      {.gauge = "locally-exact"},
      {.scheme = "yoshida-4", .beta = "h/7"},
      {.alpha = "1/2", .beta = "[[h, h/3], [h/3, -h]]", .solver = "fixed-point"}};
  for (const Request& method : methods) {
    const Certificate found = Orbit(kHenonHeiles, method).certify(10);
    EXPECT_EQ(found.certified, 10) << found.method << found.failure;
    EXPECT_LT(found.units, kRounding) << found.method;
    EXPECT_TRUE(found.symplectic) << found.method;
  }
}

// A p[i] near 0 is measured by 2^-10 of the largest: the rounding of its force, of size 1, times h
// is a hundred of these units.
TEST(Certify, SystemsInLoops) {
  const std::string chain = R"(
size N = 30
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)
scene s { q[i] = sin(pi*i/(N+1)); p[i] = cos(i); h = 1/10; steps = 10 }
)";
  const Certificate found = Orbit(chain).certify(3);
  EXPECT_EQ(found.certified, 3) << found.failure;
  EXPECT_LT(found.units, 100.0);
}

// The certifier of a method, and a step of it as numbers.
struct Taken {
  explicit Taken(const std::string& scheme) : orbit(kHenonHeiles, {.scheme = scheme}) {
    app::StepNumbers numbers;
    numbers.values["h"] = app::in_scalar(orbit.start.h, 53);
    certifier = std::make_unique<app::StepCertifier>(orbit.plugin.model, orbit.scheme, numbers);
    runtime::Integrator integrator(orbit.library, orbit.start);
    (void)integrator.advance(5, false);
    before = exact(integrator);
    (void)integrator.advance(1, false);
    after = exact(integrator);
  }
  static std::vector<ExactSum> exact(const runtime::Integrator& integrator) {
    std::vector<ExactSum> result;
    const auto z = integrator.state();
    const auto carry = integrator.carry();
    for (std::size_t i = 0; i < z.size(); ++i)
      result.push_back({z[i].hi, z[i].lo, carry[i].hi, carry[i].lo});
    return result;
  }
  // As StepDistance defines it.
  [[nodiscard]] double unit(std::size_t i) const {
    double largest = 0.0;
    for (const ExactSum& value : after) largest = std::max(largest, std::fabs(value[0]));
    return 0x1p-52 * (std::max(std::fabs(before[i][0]), std::fabs(after[i][0])) + largest / 1024.0);
  }

  Orbit orbit;
  std::unique_ptr<app::StepCertifier> certifier;
  std::vector<ExactSum> before, after;
};

TEST(Certify, AStepThatIsOffByAThousandUnitsIsSaidToBe) {
  for (const std::string scheme : {"implicit-midpoint", "gauss-4", "stormer-verlet", "yoshida-4"}) {
    Taken taken(scheme);
    EXPECT_LT(taken.certifier->distance(taken.before, taken.after).units, kRounding);
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<ExactSum> moved = taken.after;
      moved[i][3] += 1000.0 * taken.unit(i);
      const app::StepDistance found = taken.certifier->distance(taken.before, moved);
      EXPECT_EQ(found.failure, "");
      EXPECT_NEAR(found.units, 1000.0, kRounding + 1.0) << scheme << i;
      EXPECT_EQ(found.component, i);
    }
  }
}

// Of two bodies of which the step has one the other is its mirror image, and not its copy.
TEST(Certify, AnotherEmbeddingOfTheStepIsSeen) {
  const SourceText source = read_source(HAMGEN_SOURCE_DIR "/hamiltonians/two_bodies.ham");
  const Model model = read_request(source, {});
  const SceneValues scene = scene_values(model, {.scene = "mirror", .steps = "5"});
  Request request;
  request.scene = SceneFacts{.asked = {.scene = "mirror"}, .values = scene, .kept = {}};
  PluginSource plugin = generate_plugin(source, request);
  ASSERT_EQ(plugin.state.step.size(), 4U);
  const Scheme scheme = request_scheme(source, {});
  const runtime::LoadedPlugin loaded = app::interpreted_integrator(source, request, plugin);
  const runtime::InitialValues start = app::initial_values(plugin, scene, *loaded.library);
  const auto certificate = [&] {
    return app::certify({.plugin = &plugin,
                         .library = loaded.library,
                         .scene = &scene,
                         .scheme = &scheme,
                         .start = &start,
                         .every = 1});
  };
  const Certificate good = certificate();
  EXPECT_EQ(good.certified, 5) << good.failure;
  EXPECT_LT(good.units, kRounding);
  for (auto& [place, factor] : plugin.state.model[2].of) factor = -factor;  // x2 = x1
  const Certificate bad = certificate();
  EXPECT_TRUE(bad.failed > 0 || bad.units > 1e6) << bad.units;
}

// Rounding is carried along: a step that forgot the carry is seen by its size, up to half a unit.
TEST(Certify, TheStepActsOnTheStateWithItsCarry) {
  Taken taken("stormer-verlet");
  const double with = taken.certifier->distance(taken.before, taken.after).units;
  std::vector<ExactSum> more = taken.before;
  more[0][2] += 100.0 * taken.unit(0);
  EXPECT_GT(taken.certifier->distance(more, taken.after).units, with + 80.0);
}

// The map of the method with the sign of a kick changed: h dV/dq is 1e-2 of the state.
TEST(Certify, AnotherMapIsFar) {
  std::vector<ExactSum> other;
  {
    Taken midpoint("implicit-midpoint");
    other = midpoint.after;
    std::vector<ExactSum> wrong = midpoint.after;
    for (std::size_t i = 2; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k)
        wrong[i][k] = 2.0 * midpoint.before[i][k] - midpoint.after[i][k];
    }
    const app::StepDistance found = midpoint.certifier->distance(midpoint.before, wrong);
    EXPECT_EQ(found.failure, "");
    EXPECT_GT(found.units, 1e10);
  }
  Taken verlet("stormer-verlet");
  EXPECT_GT(verlet.certifier->distance(verlet.before, other).units, 1e8);
}

// Sweeps stop early: of implicit midpoint's equations K of them leave an error of (h/2)^(K+2) or
// so.
TEST(Certify, AnIterationThatStopsEarlyIsSeen) {
  double before = HUGE_VAL;
  for (const std::string sweeps : {"1", "2", "4", "6"}) {
    const Orbit swept(kHenonHeiles, {.solver = "sweeps:" + sweeps});
    runtime::Integrator integrator(swept.library, swept.start);
    const std::vector<ExactSum> from = Taken::exact(integrator);
    (void)integrator.advance(1, false);
    Model model = swept.plugin.model;
    app::StepNumbers numbers;
    numbers.values["h"] = app::in_scalar(swept.start.h, 53);
    app::StepCertifier certifier(model, swept.scheme, numbers);
    const app::StepDistance found = certifier.distance(from, Taken::exact(integrator));
    ASSERT_EQ(found.failure, "");
    EXPECT_GT(found.units, 1e4) << sweeps;
    EXPECT_LT(found.units, before) << sweeps;
    before = found.units;
  }
}

// The model that is certified against is not the one that runs.
TEST(Certify, AnotherHamiltonianIsFar) {
  const auto pendulum = [](const std::string& factor) {
    return "coordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - " + factor +
           "eps*cos(q)\nscene s { q = 2; h = 1/10; steps = 10 }\n";
  };
  Orbit orbit(pendulum(""));
  EXPECT_LT(orbit.certify(10).units, kRounding);
  orbit.start.parameters[0].hi = 0.031;
  EXPECT_LT(orbit.certify(10).units, kRounding);
  const SourceText other = make_source("other.ham", "system run\n" + pendulum("1.0001*"));
  orbit.plugin.model = read_request(other, {});
  const Certificate found = orbit.certify(10);
  EXPECT_EQ(found.certified, 10);
  EXPECT_GT(found.units, 1e6);
}

TEST(Certify, TheSentenceClaimsWhatIsProved) {
  const std::string explicit_euler =
      app::certificate_sentence(Orbit(kHenonHeiles, {.scheme = "explicit-euler"}).certify(3));
  EXPECT_NE(explicit_euler.find("of the exact map of explicit-euler, which is not symplectic"),
            std::string::npos);
  EXPECT_EQ(explicit_euler.find("an exactly symplectic map"), std::string::npos);
  const std::string all = app::certificate_sentence(Orbit(kHenonHeiles).certify(4));
  EXPECT_EQ(all.find("each of 4 steps lies within "), 0u) << all;
  EXPECT_NE(all.find("units of rounding of an exactly symplectic map"), std::string::npos);
  const Certificate some = Orbit(kHenonHeiles).certify(100, 10);
  EXPECT_EQ(some.certified, 10);
  EXPECT_EQ(app::certificate_sentence(some).find("each of 10 steps looked at lies within "), 0u);
  EXPECT_EQ(app::certificate_sample(some), "steps 1, 11, 21, ... of 100");
  // Never fewer units than there are.
  const double said = std::stod(all.substr(std::string("each of 4 steps lies within ").size()));
  EXPECT_GE(said, Orbit(kHenonHeiles).certify(4).units);
}

TEST(Certify, WhatIsNotInDoublesIsRefusedWithTheReason) {
  const auto refusal = [](const Request& request) {
    try {
      const Orbit orbit(kHenonHeiles, request);
      app::require_certifiable(orbit.request, orbit.plugin.model, orbit.scheme);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({}), "");
  EXPECT_NE(refusal({.solver = "sweeps:3"}).find("leaves the step unsolved"), std::string::npos);
  EXPECT_NE(refusal({.order = 4}).find("a function K derived from H"), std::string::npos);
}

// From q = 1 towards 0: a step that goes beyond is not defined.
TEST(Certify, AStepOutsideTheDomainIsAnOutcomeWithItsPlace) {
  Orbit orbit(
      "coordinate q\nmomentum p\nH = p^2/2 + sqrt(q)\n"
      "scene s { q = 1; p = -1; h = 1/10; steps = 100 }\n",
      {.scheme = "stormer-verlet"});
  const Certificate found = orbit.certify(100);
  EXPECT_FALSE(found.holds());
  EXPECT_EQ(found.ended, "left the domain");
  EXPECT_EQ(found.steps, found.certified);
  EXPECT_GT(found.certified, 3);
  EXPECT_LT(found.certified, 20);
}

}  // namespace
}  // namespace hamgen::certify_test
