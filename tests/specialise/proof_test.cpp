// What was left out is proved, and what must not be left out is refuted.
#include "generator/verify/proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/specialised.hpp"

namespace hamgen {
namespace {

// The values that the stage works on, to be spoilt one by one.
struct Made {
  Model model;
  SceneFacts scene;
  FoldedModel folded;
  Specialised system;

  Made(const std::string& text, const GaugeBlock& beta)
      : model(read_model(make_source("m.ham", text))) {
    scene.values = scene_values(model, {});
    folded = fold(observed(model, scene.values), scene);
    Mechanics mechanics = derive(folded.model);
    const int n = mechanics.degrees_of_freedom;
    system = specialise(folded.model, std::move(mechanics),
                        family_member(n, {{Rational(1, 2)}}, beta, {{Rational(0)}}), scene);
  }
  explicit Made(const std::string& text) : Made(text, {{Expression(0)}}) {}

  // As if another set of pairs were to be left out.
  void drop(const std::vector<int>& resting, const Unobserved& left = {}) {
    system.resting = resting;
    system.left = left;
    system.kept.clear();
    for (int i = 0; i < system.whole.degrees_of_freedom; ++i) {
      const auto is_in = [i](const std::vector<int>& list) {
        return std::ranges::find(list, i) != list.end();
      };
      if (!is_in(resting) && !is_in(left.dropped) && !is_in(left.cyclic)) system.kept.push_back(i);
    }
    system.mechanics = restrict_to(system.whole, system.kept, left);
    system.scheme = restrict_to(system.whole_scheme, system.kept);
  }

  [[nodiscard]] Finding finding() const { return prove_specialised(model, folded, system, scene); }
};

const std::string kPlane =
    "coordinate x, y, z\nmomentum px, py, pz\nparameter J2 = 0\nparameter mu = 3\n"
    "let r = sqrt(x^2 + y^2 + z^2)\n"
    "H = (px^2 + py^2 + pz^2)/2 - mu/r + J2*mu*(3*z^2/r^2 - 1)/(2*r^3)\n"
    "scene s { x = 1; py = 1; h = 0.01; steps = 10 }\n";
const std::string kPolar =
    "coordinate r, phi, u\nmomentum pr, pphi, pu\nparameter k = 2\n"
    "H = pr^2/2 + pphi^2/(2*r^2) - k/r + pu^2/2 + u^4/4\n"
    "scene s { r = 1; pphi = 1.1; u = 1; h = 0.01; steps = 10; observe r }\n";

TEST(ProveSpecialised, WhatIsLeftOutOfAScene) {
  const Made plane(kPlane);
  EXPECT_EQ(plane.system.resting, std::vector{2});
  EXPECT_EQ(plane.finding().verdict, Verdict::proved) << plane.finding().detail;
  const Made polar(kPolar);
  EXPECT_EQ(polar.system.left, (Unobserved{.dropped = {2}, .cyclic = {1}}));
  EXPECT_EQ(polar.finding().verdict, Verdict::proved) << polar.finding().detail;
}

TEST(ProveSpecialised, ADrivenCoordinateIsRefuted) {
  Made made(
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\n");
  EXPECT_TRUE(made.system.resting.empty());
  made.drop({1});
  EXPECT_EQ(made.finding().verdict, Verdict::refuted);
  EXPECT_NE(made.finding().detail.find("what moves py"), std::string::npos)
      << made.finding().detail;
}

TEST(ProveSpecialised, AVariableThatStartsElsewhereIsRefuted) {
  Made made(kPlane);
  made.scene.values.p[2] = Rational(1, 1000);
  EXPECT_EQ(made.finding().verdict, Verdict::refuted);
  EXPECT_EQ(made.finding().detail, "pz does not start at 0");
}

TEST(ProveSpecialised, AValueThatTheSceneDoesNotHaveIsRefuted) {
  Made made(kPlane);
  made.scene.values.parameters[0] = Rational(1, 10);
  EXPECT_EQ(made.finding().verdict, Verdict::refuted);
  EXPECT_EQ(made.finding().detail, "J2 is 0.1 in the scene, not 0");
}

// The value is said to be the scene's, and another one was put in.
TEST(ProveSpecialised, AnotherValueInHIsRefuted) {
  Made made(kPlane);
  SceneFacts other = made.scene;
  other.values.parameters[0] = 1;
  made.folded.model = fold(made.model, other).model;
  EXPECT_EQ(made.finding().verdict, Verdict::refuted) << made.finding().detail;
}

TEST(ProveSpecialised, ASubspaceThatCLeavesIsRefuted) {
  const std::string model =
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y^2\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\n";
  const Expression h = Expression::symbol("h", kRankOfStep);
  Made made(model, {{Expression(0), h, h, Expression(0)}, true});
  EXPECT_TRUE(made.system.resting.empty());
  made.drop({1});
  EXPECT_EQ(made.finding().verdict, Verdict::refuted);
  EXPECT_NE(made.finding().detail.find("C moves py by x"), std::string::npos)
      << made.finding().detail;
}

TEST(ProveSpecialised, ACyclicMomentumUnderBetaIsRefuted) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  Made made(kPolar, {{h}});
  EXPECT_EQ(made.system.left, (Unobserved{.dropped = {2}, .cyclic = {}}));
  made.drop({}, {.dropped = {2}, .cyclic = {1}});
  EXPECT_EQ(made.finding().verdict, Verdict::refuted);
  EXPECT_NE(made.finding().detail.find("C moves pphi by phi"), std::string::npos)
      << made.finding().detail;
}

TEST(ProveSpecialised, WhatIsObservedThroughOthersIsRefuted) {
  Made made(
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^4 + x^2*y^2\n"
      "scene s { x = 1; y = 1; h = 0.1; steps = 1; observe x }\n");
  EXPECT_EQ(made.system.left, Unobserved{});
  made.drop({}, {.dropped = {1}, .cyclic = {}});
  EXPECT_EQ(made.finding().verdict, Verdict::refuted) << made.finding().detail;
}

// p^2/2 + x y and (x - y)^2/2 leave y = 0 only together: the parts of a splitting are the
// functions of q and of p, and each of them is looked at through its own derivatives.
TEST(ProveSpecialised, APartOfASplittingIsLookedAtAlone) {
  const Made made(
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x*y + (x - y)^2/2\n"
      "scene s { x = 1; h = 0.1; steps = 1 }\n");
  EXPECT_EQ(made.system.resting, std::vector{1});  // together they are x^2/2 + y^2/2
  EXPECT_EQ(made.finding().verdict, Verdict::proved) << made.finding().detail;
}

}  // namespace
}  // namespace hamgen
