// hamgen section.
#include "app/studies/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/output/section_output.hpp"
#include "app/studies/angles.hpp"
#include "generator/base/diagnostic.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/interpreted_orbit.hpp"

namespace hamgen::app_test {
namespace {

constexpr const char* kSectionModel =
    "system henon_heiles\ncoordinate x, y\nmomentum u, v\n"
    "H = (u^2 + v^2 + x^2 + y^2)/2 + x^2*y - y^3/3\n"
    "invariant surface = x\ninvariant axis_1 = y\ninvariant axis_2 = v\n"
    "scene start { y = 0.1; u = 0.4 }\n";

app::SectionRequest request_of(const InterpretedOrbit& orbit) {
  app::SectionRequest request;
  request.plugin = &orbit.plugin;
  request.library = orbit.library;
  request.start = orbit.start;
  request.energy = 1.0 / 8.0;
  request.first = 1;
  request.second = 3;
  request.momentum = 2;
  request.fixed = {0, 0.0};
  request.orbits = 4;
  request.points = 12;
  request.steps = 2000;
  return request;
}

TEST(Section, HasOrbitsOfOneEnergyThatCrossTheSurfaceUpwards) {
  const auto orbit = interpreted_orbit(kSectionModel, "gauss-4", "0.1");
  const app::SectionRequest request = request_of(*orbit);
  const app::Section section = app::section(request);
  ASSERT_EQ(section.orbits.size(), 4U);
  for (const app::SectionOrbit& each : section.orbits) {
    EXPECT_EQ(each.status, runtime::Status::done);
    EXPECT_EQ(each.points.size(), 12U);
    EXPECT_LT(each.largest_error, 1e-6);
    double time = 0.0;
    for (const app::SectionPoint& point : each.points) {
      // u^2/2 = E - H(0, y, 0, v) > 0.
      const double y = point.first;
      const double v = point.second;
      EXPECT_GT(1.0 / 8.0 - (v * v + y * y) / 2 + y * y * y / 3, -1e-6);
      EXPECT_GT(point.time, time);
      time = point.time;
    }
  }
}

TEST(Section, GivesTheLastMomentumTheEnergy) {
  const auto orbit = interpreted_orbit(kSectionModel, "gauss-4", "0.1");
  app::SectionRequest request = request_of(*orbit);
  std::vector<runtime::Wide> state(4);
  state[1] = {0.2, 0.0};
  state[3] = {-0.1, 0.0};
  for (const auto direction : {runtime::Direction::rising, runtime::Direction::falling}) {
    request.direction = direction;
    const auto found = app::with_energy(request, state);
    ASSERT_TRUE(found);
    EXPECT_NEAR(orbit->library->energy(request.start.parameters, *found).hi, 0.125, 1e-16);
    EXPECT_EQ((*found)[2].hi > 0, direction == runtime::Direction::rising);
  }
  state[3] = {0.6, 0.0};  // v^2/2 alone is more
  EXPECT_FALSE(app::with_energy(request, state));
  request.energy = -1;
  EXPECT_THROW((void)app::section(request), UsageError);
}

// Below the barrier orbits of a pendulum swing, within their angle; beyond it they turn round, and
// the angle has no end: no more than 1 from the scene's start is taken of it.
TEST(Section, StartsNearTheSceneWhereTheRegionHasNoEnd) {
  const auto orbit = interpreted_orbit(
      "system turning\ncoordinate x, y\nmomentum u, v\nH = (u^2 + v^2 + x^2)/2 - cos(y)\n"
      "invariant surface = x\ninvariant axis_1 = y\ninvariant axis_2 = v\n"
      "scene start { u = 0.4 }\n",
      "gauss-4", "0.1");
  app::SectionRequest request = request_of(*orbit);
  request.direction = runtime::Direction::both;
  request.orbits = 16;
  request.points = 1;
  for (const auto& [energy, farthest] : {std::pair(0.0, std::acos(-1.0) / 2), {1.5, 1.0}}) {
    request.energy = energy;
    double reached = 0;
    for (const app::SectionOrbit& each : app::section(request).orbits)
      reached = std::max(reached, std::abs(each.first));
    EXPECT_LE(reached, farthest + 1e-12) << energy;
    EXPECT_GT(reached, 0.8 * farthest) << energy;
  }
  // Of an angle a turn is taken.
  request.first_turns = true;
  double reached = 0;
  for (const app::SectionOrbit& each : app::section(request).orbits)
    reached = std::max(reached, std::abs(each.first));
  EXPECT_GT(reached, 2.5);
}

// A pendulum that turns round beside one that swings: each turn crosses the surface, and what the
// angles are is what is left of their turns.
TEST(Section, CountsTurnsOfAnAngleAsOne) {
  const auto orbit = interpreted_orbit(
      "system turning\ncoordinate x, y\nmomentum u, v\n"
      "H = (u^2 + v^2)/2 - cos(x) - cos(y) - cos(x - y)/8\n"
      "invariant surface = x\ninvariant axis_1 = y\ninvariant axis_2 = v\n"
      "scene start { u = 3; v = 2.5; y = 1 }\n",
      "gauss-4", "0.05");
  app::SectionRequest request = request_of(*orbit);
  request.orbits = 0;
  EXPECT_EQ(app::section(request).orbits[0].points.size(), 0U) << "it does not come back to 0";
  request.turns = true;
  for (const auto direction : {runtime::Direction::rising, runtime::Direction::falling}) {
    request.direction = direction;
    request.start.state[2] = {direction == runtime::Direction::rising ? 3.0 : -3.0, 0.0};
    request.first_turns = false;
    const app::SectionOrbit far = app::section(request).orbits[0];
    request.first_turns = true;
    const app::SectionOrbit near = app::section(request).orbits[0];
    ASSERT_EQ(far.points.size(), 12U);
    ASSERT_EQ(near.points.size(), 12U);
    const double pi = std::acos(-1.0);
    EXPECT_GT(std::abs(far.points[11].first), 6 * pi);
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_LE(std::abs(near.points[i].first), pi);
      EXPECT_NEAR(std::cos(near.points[i].first), std::cos(far.points[i].first), 1e-13);
      EXPECT_EQ(near.points[i].time, far.points[i].time);
    }
    request.direction = direction == runtime::Direction::rising ? runtime::Direction::falling
                                                                : runtime::Direction::rising;
    EXPECT_EQ(app::section(request).orbits[0].points.size(), 0U) << "it turns the other way";
  }
  // What rises with time does so along steps back, too, and starts are on that side.
  request.start.h = {-0.05, 0.0};
  request.direction = runtime::Direction::rising;
  request.start.state[2] = {3.0, 0.0};
  EXPECT_EQ(app::section(request).orbits[0].points.size(), 12U);
  request.energy = 5;
  request.orbits = 2;
  for (const app::SectionOrbit& each : app::section(request).orbits)
    EXPECT_EQ(each.points.size(), 12U);
}

// Lengths, and what H does not depend on, are none; nor is what only seems to turn.
TEST(Section, KnowsAnglesByTheEnergy) {
  const auto orbit = interpreted_orbit(
      "system five\ncoordinate x, y, z, w, s\nmomentum a, b, c, d, e\n"
      "H = (a^2 + b^2 + c^2 + d^2 + e^2)/2 + x^2/2 - cos(y) - cos(y - 2*w) + sin(s/2) + w^2/10^6\n"
      "scene start { x = 1; a = 1; b = 1 }\n",
      "gauss-4", "0.05");
  const std::vector<double> sizes(10, 1.0);
  EXPECT_EQ(app::angles(*orbit->library, orbit->start, sizes),
            std::vector<bool>({false, true, false, false, false}));
  EXPECT_EQ(app::within_a_turn(7.0), std::remainder(7.0, 2 * std::acos(-1.0)));
}

// The momentum's term is not p^2/2 and couples to the other one.
TEST(Section, FindsAMomentumThatIsCoupled) {
  const auto orbit = interpreted_orbit(
      "system coupled\ncoordinate x, y\nmomentum u, v\n"
      "H = u^2 - u*v/2 + v^2/2 - cos(x) - cos(y)\n"
      "invariant surface = x\ninvariant axis_1 = y\ninvariant axis_2 = v\nscene s { v = 0.5 }\n",
      "implicit-midpoint", "0.05");
  app::SectionRequest request = request_of(*orbit);
  request.energy = 0;
  request.direction = runtime::Direction::falling;
  std::vector<runtime::Wide> state = orbit->start.state;
  const auto found = app::with_energy(request, state);
  ASSERT_TRUE(found);
  EXPECT_NEAR(orbit->library->energy(request.start.parameters, *found).hi, 0.0, 1e-15);
  EXPECT_LT(2 * (*found)[2].hi - 0.25, 0.0);  // dx/dt
}

TEST(SectionCommand, WritesPointsPictureAndJson) {
  const Scratch scratch;
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  const Result result =
      hamgen({"section", model, "--energy", "1/12", "--orbits", "3", "--points", "5", "--plot",
              scratch.path("s.svg"), "-o", scratch.path("s.csv"), "--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["orbits"].size(), 3U);
  EXPECT_EQ(json["surface"], "q1 = 0, rising");
  EXPECT_EQ(json["axes"][1], "p2");
  int rows = 0;
  for (const std::string& line : lines(read(scratch.path("s.csv")))) {
    if (!line.empty() && line.front() != '#' && line.front() != 'o') ++rows;
  }
  EXPECT_EQ(rows, 15);
  EXPECT_TRUE(contains(read(scratch.path("s.svg")), "</svg>"));
}

TEST(SectionCommand, SaysWhatIsAnAngle) {
  const Scratch scratch;
  const Result result = hamgen({"section", HAMGEN_SOURCE_DIR "/hamiltonians/double_pendulum.ham",
                                "--orbits", "0", "--points", "3", "--steps", "20000", "--plot",
                                scratch.path("s.svg"), "-o", scratch.path("s.csv"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["surface"], "q1 = 0 (mod 2 pi), rising");
  EXPECT_EQ(json["angles"], nlohmann::json::array({"q2"}));
  EXPECT_TRUE(contains(read(scratch.path("s.csv")), "\n# angles    q2, from -pi to pi\n"));
  EXPECT_TRUE(contains(read(scratch.path("s.svg")), "(mod 2 pi)"));
}

// The time of a driven oscillator is an angle: what lies a period apart is its stroboscopic
// section.
TEST(SectionCommand, IsStroboscopicAtATime) {
  const Scratch scratch;
  const std::string model = scratch.write("driven.ham",
                                          "system driven\ncoordinate x\nmomentum p\ntime t\n"
                                          "H = p^2/2 - x^2/2 + x^4/4 - x*cos(t)/10\n"
                                          "scene s { x = 0.5; h = 0.05; steps = 1000 }\n");
  const Result result = hamgen({"section", model, "--surface", "t = 0", "--axes", "x,p", "--orbits",
                                "0", "--points", "4", "--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto points = nlohmann::json::parse(result.out)["orbits"][0]["points"];
  ASSERT_EQ(points.size(), 4U);
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_NEAR(points[k][0], 2 * std::acos(-1.0) * static_cast<double>(k + 1), 1e-12);
}

// No more points than were asked for, though the last step crosses twice.
TEST(SectionCommand, HasNoMorePointsThanWereAskedFor) {
  const Result result =
      hamgen({"section", HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham", "--points", "5",
              "--direction", "both", "--orbits", "0", "--surface", "q1^2+q2^2 = 0.01", "--axes",
              "q1*p2-q2*p1,p1", "--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["orbits"][0]["points"].size(), 5U);
}

// Where orbits end, those say where to begin that did not.
TEST(SectionCommand, SaysWhereOrbitsBeganThatStayed) {
  app::Section section;
  for (const auto& [first, second, status] : {std::tuple{-0.1, 0.2, runtime::Status::done},
                                              {0.3, -0.4, runtime::Status::done},
                                              {0.9, 0.9, runtime::Status::jumped}})
    section.orbits.push_back({.first = first, .second = second, .status = status, .points = {}});
  const app::SectionTitle title{.first = "x", .second = "px"};
  EXPECT_TRUE(contains(app::section_summary(section, title), "x=-0.1:0.3, px=-0.4:0.2"));
  section.orbits.erase(section.orbits.begin());
  EXPECT_TRUE(contains(app::section_summary(section, title), "help: a smaller --h\n"));

  // Where none stayed, nothing is known of the energy; one that was stopped needs no advice.
  section.orbits.erase(section.orbits.begin());
  EXPECT_FALSE(contains(app::section_summary(section, title), "kept to"));
  EXPECT_TRUE(contains(app::section_csv(section, title), "# ended     1 of the orbits: jumped\n"));
  section.orbits.front().status = runtime::Status::stopped;
  EXPECT_TRUE(contains(app::section_summary(section, title), "kept to"));
  EXPECT_FALSE(contains(app::section_summary(section, title), "help: "));
}

TEST(SectionCommand, RefusesWhatIsNoSection) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  for (const auto& [options, words] :
       {std::pair<std::vector<std::string>, std::string>{{"--axes", "q2"}, "two quantities"},
        {{"--axes", "q2,p3"}, "--surface or --axes: error: unknown name 'p3'"},
        {{"--surface", "q1,q2"}, "one equation is wanted"},
        {{"--surface", "q1 +"}, "expected"},
        {{"--direction", "up"}, "rising, falling or both"},
        {{"--axes", "q2,q2"}, "both are q2"},
        {{"--axes", "q1,p2"}, "q1 is 0 on the surface everywhere"},
        {{"--from", "q2=1"}, "a range of both axes"},
        {{"--from", "q2=1:0,p2=0:1"}, "the lower end comes first"},
        {{"--from", "q2=0:1,p2=0:1,p1=3:4"}, "none of the axes q2 and p2"},
        {{"--from", "q2=0:1,p2=0:1,q2=0:2"}, "q2 has two ranges"},
        {{"--surface", "q1 = q2"}, "orbits start where q1 has a value"},
        {{"--orbits", "0", "--from", "q2=0:1,p2=0:1"}, "the scene's own orbit"},
        {{"--orbits", "0", "--energy", "1/8"}, "the scene's own orbit"},
        {{"--energy", "much"}, "--energy"},
        {{"--plot", "a.pdf"}, "ends in .svg or .png"}}) {
    std::vector<std::string> words_of{"section", model};
    words_of.insert(words_of.end(), options.begin(), options.end());
    const Result result = hamgen(words_of);
    EXPECT_EQ(result.status, 2) << options[0];
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  }
}

}  // namespace
}  // namespace hamgen::app_test
