// What is found of a motion does not depend on the units in which its model is written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// The system of Henon and Heiles of this mass, length and frequency.
std::string henon_heiles(double mass, double length, double frequency) {
  return fmt::format(
      "coordinate x, y\nmomentum px, py\nparameter m = {:.17g}\nparameter L = {:.17g}\n"
      "parameter w = {:.17g}\n"
      "H = (px^2 + py^2)/(2*m) + m*w^2*((x^2 + y^2)/2 + (x^2*y - y^3/3)/L)\n"
      "scene s {{ y = L/10; px = m*w*L/2; h = 0.05/w; steps = 20000 }}\n",
      mass, length, frequency);
}

json found(const std::vector<std::string>& words) {
  const Result result = hamgen(words);
  EXPECT_EQ(result.status, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

struct Units {
  double mass, length, frequency;
};
const std::vector<Units> kUnits = {
    {1, 1, 1}, {1e-26, 1e-10, 1e13}, {1e24, 1e3, 1e-7}, {1, 0.01, 1}};

TEST(Units, OfASectionAreThoseOfTheModel) {
  const Scratch scratch;
  for (const auto& [mass, length, frequency] : kUnits) {
    const std::string model = scratch.write("m.ham", henon_heiles(mass, length, frequency));
    const json section =
        found({"section", model, "--orbits", "5", "--points", "3", "--json", "--quiet"});
    ASSERT_EQ(section["orbits"].size(), 5u);
    const double momentum = mass * frequency * length;
    std::set<double> starts;
    for (const json& orbit : section["orbits"]) {
      EXPECT_NEAR(orbit["energy_scale"].get<double>() / section["energy"].get<double>(), 1, 0.5);
      EXPECT_LE(orbit["max_energy_error"], 1e-3 * section["energy"].get<double>());
      starts.insert(orbit["start"][0].get<double>());
      // Within the well.
      EXPECT_LT(std::abs(orbit["start"][0].get<double>()), length);
      for (const json& point : orbit["points"]) {
        EXPECT_LT(std::abs(point[1].get<double>()), length);
        EXPECT_LT(std::abs(point[2].get<double>()), momentum);
      }
    }
    EXPECT_EQ(starts.size(), 5u) << "of mass " << mass;
  }
}

// A constant of H is nothing that moves.
TEST(Units, OfASectionHaveNoConstant) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "coordinate x, y\nmomentum u, v\n"
                    "H = (u^2 + v^2 + x^2 + y^2)/2 + x^2*y - y^3/3 + 1e6\n"
                    "scene s { y = -0.15; u = 0.4; h = 0.05; steps = 20000 }\n");
  const json section =
      found({"section", model, "--orbits", "5", "--points", "3", "--json", "--quiet"});
  for (const json& orbit : section["orbits"])
    EXPECT_LT(std::abs(orbit["start"][0].get<double>()), 1);
}

TEST(Units, OfExponentsAreThoseOfTime) {
  const Scratch scratch;
  double natural = 0;
  for (const auto& [mass, length, frequency] : kUnits) {
    const std::string model = scratch.write("m.ham", henon_heiles(mass, length, frequency));
    const json chaos = found({"chaos", model, "--spectrum", "--json", "--quiet"});
    std::vector<double> exponents;
    for (const json& each : chaos["spectrum"]) {
      ASSERT_TRUE(each.is_number()) << chaos["spectrum"];
      exponents.push_back(each.get<double>() / frequency);
    }
    ASSERT_EQ(exponents.size(), 4u);
    // The energy is 0.13, on an orbit of which the sizes of q and p change what is found by so
    // much.
    if (natural == 0) natural = exponents[0];
    EXPECT_NEAR(exponents[0], natural, 0.004);
    EXPECT_NEAR(exponents[0] + exponents[3], 0, 0.004);
    EXPECT_NEAR(exponents[1] + exponents[2], 0, 0.004);
  }
}

// Deviations along the orbit of this text.
json samples_of(const std::string& text) {
  const Scratch scratch;
  return found({"chaos", scratch.write("m.ham", text), "--json", "--quiet"})["samples"];
}

TEST(Units, OfDeviationsHaveNoConstant) {
  const std::string text =
      "coordinate x, y\nmomentum u, v\n"
      "H = (u^2 + v^2 + x^2 + y^2)/2 + x^2*y - y^3/3";
  const std::string scene = "\nscene s { y = -0.15; u = 0.4; h = 0.05; steps = 2000 }\n";
  const json alone = samples_of(text + scene).back();
  const json beside = samples_of(text + " + 1e6" + scene).back();
  EXPECT_NEAR(beside["fli"].get<double>(), alone["fli"].get<double>(), 1e-6);
  EXPECT_NEAR(beside["megno"].get<double>(), alone["megno"].get<double>(), 1e-6);
}

// A molecule with an angle that hardly changes its energy, in units of this length, mass and
// frequency.
std::string with_angle(double length, double mass, double frequency) {
  return fmt::format(
      "coordinate th, r\nmomentum L, p\nparameter a = {:.17g}\nparameter m = {:.17g}\n"
      "parameter w = {:.17g}\n"
      "H = p^2/(2*m) + L^2/(2*m*r^2) + m*w^2*(r - 2*a)^2*(1 + 0.3*cos(th))/2\n"
      "scene s {{ th = 1; r = 2.1*a; L = m*w*a^2; p = m*w*a/10; h = 0.05/w; steps = 200000 }}\n",
      length, mass, frequency);
}

// On a regular orbit MEGNO goes to 2 about as 1/t, whatever lengths of deviations mean, and SALI
// does not go to 0: with an angle of 1e-10 for a length it was 1e-8 here.
TEST(Units, OfAnAngleAreNoLength) {
  for (const std::string& text : {with_angle(1, 1, 1), with_angle(1e-10, 1e-26, 1e13)}) {
    const json samples = samples_of(text);
    const json& end = samples.back();
    const auto lacks = [](const json& sample) {
      return std::abs(sample["megno"].get<double>() - 2);
    };
    for (const json& sample : samples) {
      if (sample["t"].get<double>() > end["t"].get<double>() / 4) break;
      EXPECT_LT(lacks(end), 0.5 * lacks(sample)) << sample;
    }
    EXPECT_GT(end["sali"].get<double>(), 1e-3) << text;
  }
}

json linear_part(const std::string& model) {
  for (const json& each : found({"verify", model, "--json"})) {
    if (each["property"] == "linear stability") return each;
  }
  return {};
}

// An ion in a Penning trap: (wc +- sqrt(wc^2 - 2 wz^2))/2 and wz.
constexpr const char* kTrap =
    "coordinate x, y, z\nmomentum px, py, pz\nparameter m = 6.64e-26\nparameter wc = 4.58e6\n"
    "parameter wz = 1.2e6\n"
    "H = ((px - m*wc*y/2)^2 + (py + m*wc*x/2)^2 + pz^2)/(2*m) + m*wz^2/2*(z^2 - (x^2 + y^2)/2)\n"
    "scene s { x = 1e-5; z = 1e-5; h = 1e-8; steps = 200 }\n";
// Sun and Earth: the radial direction leaves by sqrt(2) times the frequency across it.
constexpr const char* kSunAndEarth =
    "coordinate x[1..2], y[1..2]\nmomentum px[1..2], py[1..2]\n"
    "parameter m[1..2] = [1.98892e30, 5.9722e24]\nparameter G = 6.6743e-11\n"
    "H = sum(i=1..2, (px[i]^2 + py[i]^2)/(2*m[i])) - G*m[1]*m[2]/sqrt((x[1]-x[2])^2 + "
    "(y[1]-y[2])^2)\n"
    "scene s { x = [0, 1.496e11]; py = [-5.9722e24*29780, 5.9722e24*29780]; h = 3600; steps = 30 "
    "}\n";

TEST(Units, OfALinearPartAreThoseOfTheModel) {
  const Scratch scratch;
  const json trap = linear_part(scratch.write("trap.ham", kTrap));
  ASSERT_EQ(trap["frequencies"].size(), 3u);
  const double root = std::sqrt(4.58e6 * 4.58e6 - 2 * 1.2e6 * 1.2e6);
  EXPECT_NEAR(trap["frequencies"][0].get<double>(), (4.58e6 - root) / 2, 1e-4);
  EXPECT_NEAR(trap["frequencies"][1].get<double>(), 1.2e6, 1e-4);
  EXPECT_NEAR(trap["frequencies"][2].get<double>(), (4.58e6 + root) / 2, 1e-4);
  const json two = linear_part(scratch.write("two.ham", kSunAndEarth));
  const double across = std::sqrt(6.6743e-11 * (1.98892e30 + 5.9722e24) / std::pow(1.496e11, 3));
  ASSERT_EQ(two["frequencies"].size(), 1u);
  EXPECT_NEAR(two["frequencies"][0].get<double>() / across, 1, 1e-6);
  EXPECT_NEAR(two["growth_rate"].get<double>() / across, std::sqrt(2.0), 1e-6);
}

// The step is then the flow.
TEST(Units, OfAnExactLinearPartAreThoseOfTheModel) {
  const Scratch scratch;
  const json run = found(
      {"run", scratch.write("trap.ham", kTrap), "--gauge", "locally-exact", "--json", "--quiet"});
  EXPECT_NEAR(run["state"]["q"][2].get<double>(), 1e-5 * std::cos(1.2e6 * 2e-6), 1e-18);
}

// Rounding is that of the numbers that the step computes with.
TEST(Units, OfMeasuredRoundingAreThoseOfTheScalar) {
  const std::string model = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/pendulum.ham";
  for (const char* scalar : {"float", "double", "quad"}) {
    const Result result = hamgen({"verify", model, "--scalar", scalar, "--measure"});
    EXPECT_EQ(result.status, 0) << scalar << result.out;
  }
}

// How late it is does not make an orbit far away: this spring ends where its length is 1.
TEST(Units, OfTimeDoNotCountAsFar) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "coordinate q\nmomentum p\ntime t\nH = p^2/2 - log(1 - q^2)/2 - t*q/100\n"
                    "scene s { q = 0.1; h = 0.05; steps = 40000 }\n");
  const Result result = hamgen({"run", model, "--quiet"});
  EXPECT_NE(result.err.find("left the domain"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("escape"), std::string::npos) << result.err;
}

// What moves by 1 at the start only is no time: this one is at infinity at t = 1.
TEST(Units, OfTimeAreNotThoseOfAVelocity) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "m.ham",
      "coordinate q\nmomentum p\nH = p*q^2\nscene s { q = 1; p = 1; h = 1e-5; steps = 130000 }\n");
  const Result result = hamgen({"run", model, "--quiet"});
  EXPECT_NE(result.err.find("escape"), std::string::npos) << result.err;
}

// Zero has no size, whatever its exponent is.
TEST(Units, OfZeroAreNone) {
  const Scratch scratch;
  for (const char* zero : {"0e1000000", "0e-99999999999", "0.000e99999999999999999999"}) {
    const std::string model = scratch.write(
        "m.ham", fmt::format("coordinate q\nmomentum p\nH = p^2/2 + q^2/2 + {}*q\n", zero));
    EXPECT_EQ(hamgen({"check", model}).status, 0) << zero;
  }
}

}  // namespace
}  // namespace hamgen::app_test
