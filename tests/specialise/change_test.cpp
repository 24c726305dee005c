// Changes of variables: which are made, what they leave, and that those which must not be made are
// refuted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/specialised.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen {
namespace {

std::string changes_of(const std::string& model, const Changes& changes = {}) {
  const SourceText source = make_source("m.ham", model);
  const PluginSource plugin = generate_plugin(source, for_scene(source, changes));
  std::string text;
  for (const std::string& line : plugin.left_out) {
    if (line.find("symmetric") != std::string::npos || line.find("alone") != std::string::npos ||
        line.find("equal to") != std::string::npos || line.find("cyclic") != std::string::npos)
      text += line + "\n";
  }
  return text;
}

std::string two_bodies(const std::string& scene) {
  return "coordinate x, y, u, v\nmomentum px, py, pu, pv\nparameter m = 2\nparameter n = 3\n"
         "parameter k = 5\nlet r = sqrt((x - u)^2 + (y - v)^2)\n"
         "H = (px^2 + py^2)/(2*m) + (pu^2 + pv^2)/(2*n) - k/r\n"
         "scene s { h = 0.01; steps = 10; " +
         scene + " }\n";
}
const std::string kMirror = "x = 1; u = -1; py = 1/2; pv = -1/2; n = 2";

TEST(Symmetry, MirrorImagesAreOneBody) {
  EXPECT_EQ(changes_of(two_bodies(kMirror)),
            "parameter n: equal to m in scene s\n"
            "u = -x, v = -y, and so their momenta: H is symmetric, and the scene begins so\n");
}

TEST(Symmetry, IsNotSeenWhereThereIsNone) {
  // Other masses, another start, a mass or a variable that may get another value.
  EXPECT_EQ(changes_of(two_bodies("x = 1; u = -1; py = 1/2; pv = -1/2")), "");
  EXPECT_EQ(changes_of(two_bodies("x = 1; u = -1.001; py = 1/2; pv = -1/2; n = 2")), "");
  EXPECT_EQ(changes_of(two_bodies(kMirror + "; px = 1e-30")), "");
  // In 50 digits of a constant they agree, in 39 they do not.
  const std::string root = "py = 1/2; pv = -1/2; n = 2; x = sqrt(2); u = -sqrt(2)";
  EXPECT_NE(changes_of(two_bodies(root + "*sqrt(3)/sqrt(3)")), "");
  EXPECT_EQ(changes_of(two_bodies(root + "*(1 + 1e-39)")), "");
  EXPECT_EQ(changes_of(two_bodies(kMirror), {.kept = {"n"}}), "");
  EXPECT_EQ(changes_of(two_bodies(kMirror), {.kept = {"u"}}), "");
}

// x and u must not be exchanged where C tells them apart.
TEST(Symmetry, IsNotUsedWhereCBreaksIt) {
  const std::string kept = "parameter n: equal to m in scene s\nu = -x";
  EXPECT_TRUE(changes_of(two_bodies(kMirror), {.request = {.beta = "h/7"}}).starts_with(kept));
  EXPECT_TRUE(changes_of(two_bodies(kMirror), {.request = {.beta = "h/7, h/9, h/7, h/9"}})
                  .starts_with(kept));
  EXPECT_EQ(changes_of(two_bodies(kMirror), {.request = {.beta = "h/7, h/9, h/7, 0"}}), "");
  for (const char* scheme : {"stormer-verlet", "gauss-4", "yoshida-4", "rk4"})
    EXPECT_TRUE(changes_of(two_bodies(kMirror), {.request = {.scheme = scheme}}).starts_with(kept))
        << scheme;
  EXPECT_TRUE(changes_of(two_bodies(kMirror), {.request = {.order = 4}}).starts_with(kept));
}

std::string chain(const std::string& start) {
  return "coordinate q[1..5] with q[0] = 0, q[6] = 0\nmomentum p[1..5]\n"
         "H = sum(i = 1..5, p[i]^2/2) + sum(i = 0..5, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)\n"
         "scene s { q = [" +
         start + "]; h = 0.1; steps = 10 }\n";
}

TEST(Symmetry, OddOrEvenModesOfAChainRest) {
  EXPECT_EQ(changes_of(chain("1, 2, 3, 2, 1")),
            "q[5] = q[1], q[4] = q[2], and so their momenta: H is symmetric, and the scene begins "
            "so\n");
  EXPECT_EQ(changes_of(chain("1, 2, 0, -2, -1")),
            "q[5] = -q[1], q[4] = -q[2], q[3] = 0, and so their momenta: H is symmetric, and the "
            "scene begins so\n");
  EXPECT_EQ(changes_of(chain("1, 2, 3, 2, 1.5")), "");
}

// Of three bodies that start alike each is the other's image, in turn.
TEST(Symmetry, OfACycle) {
  EXPECT_EQ(changes_of("coordinate q[1..3] periodic\nmomentum p[1..3]\n"
                       "H = sum(i = 1..3, p[i]^2/2 + q[i]^4 + (q[i] - q[i+1])^4)\n"
                       "scene s { q = [1, 1, 1]; h = 0.1; steps = 10 }\n"),
            "q[2] = q[1], q[3] = q[1], and so their momenta: H is symmetric, and the scene begins "
            "so\n");
}

const std::string kApart = "x = 1; u = -1; py = 1/2; pv = -1/3; px = 1/7; observe ";

TEST(Translation, TheCentreOfMassIsLeftOutWhereNobodyAsks) {
  EXPECT_EQ(changes_of(two_bodies(kApart + "d = r")),
            "x: H and what is observed know x - u alone\n"
            "y: H and what is observed know y - v alone\n"
            "u, v: cyclic and not observed; pu_sum, pv_sum are parameters\n");
  EXPECT_EQ(changes_of(two_bodies(kApart + "px, d = r, energy")),
            changes_of(two_bodies(kApart + "d = r")));
}

TEST(Translation, NotWhereSomebodyDoes) {
  EXPECT_EQ(
      changes_of(two_bodies(kApart + "x, pv"),
                 {.request = {.beta = "h/7", .solver = "fixed-point"}}),
      "y: H and what is observed know y - v alone; not used: a step would have 382 operations, "
      "not 352\n");
  EXPECT_EQ(changes_of(two_bodies(kApart + "x, d = y + v")), "");
  EXPECT_EQ(changes_of(two_bodies("x = 1; u = -1; py = 1/2")), "");
}

// pbar of the total momentum is no constant under beta.
TEST(Translation, NotUnderBeta) {
  const std::string lines = changes_of(two_bodies(kApart + "d = r"), {.request = {.beta = "h/7"}});
  EXPECT_EQ(lines.find("cyclic"), std::string::npos) << lines;
}

// The values that the proof looks at, to be spoilt one by one.
struct Changed {
  Model model;
  SceneFacts scene;
  FoldedModel folded;
  Specialised system;

  Changed(const std::string& text, const GaugeBlock& beta)
      : model(read_model(make_source("m.ham", text))) {
    scene.values = scene_values(model, {});
    const std::vector<std::string> names = element_names(model.parameters);
    for (std::size_t i = 0; i < names.size(); ++i)
      scene.parameters.emplace(names[i], scene.values.parameters[i]);
    folded = fold(observed(model, scene.values), scene);
    Mechanics mechanics = derive(folded.model);
    const int n = mechanics.degrees_of_freedom;
    system = specialise(folded.model, std::move(mechanics),
                        family_member(n, {{Rational(1, 2)}}, beta, {{Rational(0)}}), scene);
  }
  explicit Changed(const std::string& text) : Changed(text, {{Expression(0)}}) {}

  // The same change made of another H, or with another C.
  void apply(const LinearChange& change) {
    system.changes = {change};
    system.whole = in_new_variables(change, system.given);
    system.whole_scheme =
        in_new_variables(change, system.given_scheme).value_or(system.given_scheme);
    system.mechanics = system.whole;
    system.scheme = system.whole_scheme;
    system.kept.clear();
    for (int i = 0; i < change.to; ++i) system.kept.push_back(i);
  }
  [[nodiscard]] Finding finding() const { return prove_specialised(model, folded, system, scene); }
};

TEST(ProveChange, OfASymmetryAndOfATranslation) {
  for (const std::string& text : {two_bodies(kMirror), two_bodies(kApart + "d = r"),
                                  chain("1, 2, 3, 2, 1"), chain("1, 2, 0, -2, -1")}) {
    const Changed changed(text);
    EXPECT_FALSE(changed.system.changes.empty());
    EXPECT_EQ(changed.finding().verdict, Verdict::proved) << changed.finding().detail;
  }
  const Changed with_beta(two_bodies(kMirror), {{Expression::symbol("h", kRankOfStep)}});
  EXPECT_EQ(with_beta.finding().verdict, Verdict::proved) << with_beta.finding().detail;
}

TEST(ProveChange, ASymmetryThatHLacksIsRefuted) {
  const LinearChange change = Changed(two_bodies(kMirror)).system.changes.front();
  std::string text = two_bodies(kMirror);
  text.replace(text.find("- k/r"), 5, "- k/r + x^4");
  Changed other(text);
  EXPECT_TRUE(other.system.changes.empty());
  other.apply(change);
  EXPECT_EQ(other.finding().verdict, Verdict::refuted);
  EXPECT_NE(other.finding().detail.find("dH/d"), std::string::npos) << other.finding().detail;
}

TEST(ProveChange, MassesThatDifferAreRefuted) {
  Changed changed(two_bodies(kMirror));
  changed.scene.values.parameters[1] = 3;
  EXPECT_EQ(changed.finding().verdict, Verdict::refuted);
  EXPECT_EQ(changed.finding().detail, "n and m are not equal in the scene");
}

TEST(ProveChange, AStartThatIsNotSymmetricIsRefuted) {
  Changed changed(two_bodies(kMirror));
  changed.scene.values.q[2] = Rational(-1001, 1000);
  EXPECT_EQ(changed.finding().verdict, Verdict::refuted);
  EXPECT_NE(changed.finding().detail.find("does not begin"), std::string::npos)
      << changed.finding().detail;
}

TEST(ProveChange, ACThatBreaksItIsRefuted) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  const LinearChange change = Changed(two_bodies(kMirror)).system.changes.front();
  Changed changed(two_bodies(kMirror), {{h, h, h, Expression(0)}});
  EXPECT_TRUE(changed.system.changes.empty());
  changed.apply(change);
  // C of the new variables, as if it did.
  changed.system.whole_scheme = family_member(2, {{Rational(1, 2)}}, {{h + h}}, {{Rational(0)}});
  changed.system.scheme = changed.system.whole_scheme;
  EXPECT_EQ(changed.finding().verdict, Verdict::refuted);
  EXPECT_NE(changed.finding().detail.find("C moves"), std::string::npos)
      << changed.finding().detail;
}

// Momenta that are scaled otherwise have another symplectic form.
TEST(ProveChange, VariablesThatAreNotCanonicalAreRefuted) {
  Changed changed(two_bodies(kMirror));
  LinearChange change = changed.system.changes.front();
  for (auto& [place, entry] : change.b) entry *= 2;
  changed.apply(change);
  EXPECT_EQ(changed.finding().verdict, Verdict::refuted);
  EXPECT_NE(changed.finding().detail.find("symplectic form"), std::string::npos);
}

// Coordinates that H knows not by their differences alone.
TEST(ProveChange, ATranslationThatHLacksIsRefuted) {
  const Changed good(two_bodies(kApart + "d = r"));
  std::string text = two_bodies(kApart + "d = r");
  text.replace(text.find("- k/r"), 5, "- k/r + x^2*u");
  Changed other(text);
  other.system.changes = good.system.changes;
  other.system.whole = in_new_variables(good.system.changes.front(), other.system.given);
  other.system.whole_scheme = good.system.whole_scheme;
  other.system.kept = good.system.kept;
  other.system.left = good.system.left;
  other.system.mechanics = restrict_to(other.system.whole, other.system.kept, other.system.left);
  other.system.scheme = good.system.scheme;
  EXPECT_EQ(other.finding().verdict, Verdict::refuted) << other.finding().detail;
}

}  // namespace
}  // namespace hamgen
