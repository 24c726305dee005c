// hamgen chaos: values that are known.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/studies/frequencies.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

nlohmann::json chaos_of(const std::string& model, std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"chaos", HAMGEN_SOURCE_DIR "/hamiltonians/" + model, "--json", "--quiet"});
  const Result result = hamgen(options);
  EXPECT_EQ(result.status, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

// H = 1/8, x = 0, y = -1/4: the largest exponent is about 0.04 to 0.05, and the others are 0, 0 and
// its negative.
TEST(Chaos, OfHenonAndHeilesHasTheKnownExponents) {
  const auto json = chaos_of("henon_heiles.ham",
                             {"--scene", "regular", "--initial", "q2=-1/4,p1=sqrt(2/8-1/16-1/96)",
                              "--steps", "400000", "--h", "0.1", "--spectrum"});
  const auto& end = json["samples"].back();
  const double exponent = end["lyapunov"];
  EXPECT_GT(exponent, 0.035);
  EXPECT_LT(exponent, 0.055);
  const std::vector<double> spectrum = json["spectrum"];
  ASSERT_EQ(spectrum.size(), 4U);
  EXPECT_NEAR(spectrum[0], exponent, 2e-3);
  EXPECT_NEAR(spectrum[0] + spectrum[3], 0, 1e-3);
  EXPECT_NEAR(spectrum[1], 0, 1e-3);
  EXPECT_NEAR(spectrum[2], 0, 1e-3);
  EXPECT_NEAR(spectrum[0] + spectrum[1] + spectrum[2] + spectrum[3], 0, 1e-10);
  const double time = end["t"];
  EXPECT_NEAR(end["megno"].get<double>() / (0.5 * exponent * time), 1, 0.25);
  EXPECT_LT(end["sali"].get<double>(), 1e-12);
}

TEST(Chaos, IsAbsentFromARegularOrbit) {
  const auto json = chaos_of("henon_heiles.ham", {"--scene", "regular", "--steps", "100000"});
  const auto& end = json["samples"].back();
  const double time = end["t"];
  EXPECT_NEAR(end["megno"].get<double>(), 2, 0.1);
  EXPECT_LT(end["lyapunov"].get<double>(), 3 * std::log(time) / time);
  EXPECT_GT(end["sali"].get<double>(), 1e-3);
}

// Nothing depends on amplitudes: no shear.  The frequency is that of the midpoint step.
TEST(Chaos, AnIsochronousOrbitHasNone) {
  const auto json =
      chaos_of("harmonic.ham", {"--steps", "4096", "--h", "1/10", "--frequencies", "1"});
  const auto& end = json["samples"].back();
  EXPECT_NEAR(end["megno"].get<double>(), 0, 1e-10);
  EXPECT_NEAR(end["lyapunov"].get<double>(), 0, 1e-14);
  const double frequency = json["frequencies"].front()["harmonics"][0]["frequency"];
  EXPECT_NEAR(frequency, -20 * std::atan(0.05), 1e-11);
}

TEST(Chaos, OverAPlaneTellsRegularFromChaotic) {
  const Scratch scratch;
  const auto json = chaos_of("henon_heiles.ham",
                             {"--over", "q2=-0.2:0.2:3,p2=0:0.3:2", "--steps", "2000", "--h", "0.1",
                              "-o", scratch.path("map.csv"), "--plot", scratch.path("map.svg")});
  ASSERT_EQ(json["cells"].size(), 6U);
  EXPECT_EQ(json["axes"][0]["values"][1], 0.0);
  for (const auto& cell : json["cells"]) EXPECT_EQ(cell["status"], "done");
  EXPECT_NEAR(json["cells"][1]["megno"].get<double>(), 2, 0.5);
  EXPECT_TRUE(contains(read(scratch.path("map.csv")), "q2,p2,status,t,lyapunov,megno,fli,sali"));
  EXPECT_TRUE(contains(read(scratch.path("map.svg")), "</svg>"));
}

TEST(Chaos, RefusesWhatItCannotVary) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  for (const auto& [value, words] :
       {std::pair{"q3=0:1:5", "did you mean 'q1'"}, std::pair{"q2=0:1", "LOW:HIGH:COUNT"},
        std::pair{"q2=1:0:5", "LOW < HIGH"}, std::pair{"q2=0:1:1000000000", "at most 10000"}}) {
    const Result result = hamgen({"chaos", model, "--over", value});
    EXPECT_EQ(result.status, 2) << value;
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  }
}

// The energy is looked at after every step, and what is told of an orbit that ends is told of its
// last good state.
TEST(Chaos, LooksAtEveryStep) {
  const std::string models = HAMGEN_SOURCE_DIR "/hamiltonians/";
  const auto of = [](std::vector<std::string> words, int status) {
    const Result result = hamgen(std::move(words));
    EXPECT_EQ(result.status, status) << result.err;
    return result;
  };
  const std::vector<std::string> encounter = {
      models + "pythagorean.ham", "--h", "3e-4", "--time", "10", "--json"};
  std::vector<std::string> chaos = {"chaos", "--quiet"};
  chaos.insert(chaos.end(), encounter.begin(), encounter.end());
  std::vector<std::string> run = {"run"};
  run.insert(run.end(), encounter.begin(), encounter.end());
  const auto measured = nlohmann::json::parse(of(chaos, 1).out);
  const auto integrated = nlohmann::json::parse(of(run, 1).out);
  const double error = measured["max_energy_error"];
  EXPECT_NEAR(error, integrated["energy"]["max_error"].get<double>(), 0.05 * error);
  EXPECT_EQ(measured["status"], integrated["status"]);
  EXPECT_EQ(measured["steps"], integrated["steps_done"]);

  const Scratch scratch;
  const std::string logarithm = scratch.write("m.ham",
                                              "coordinate q\nmomentum p\nH = p^2/2 - log(1 - "
                                              "q)\nscene s { q = -3; p = 9; h = 0.07; steps = "
                                              "100 }\n");
  const auto left = nlohmann::json::parse(
      of({"chaos", logarithm, "--scheme", "stormer-verlet", "--json", "--quiet"}, 1).out);
  EXPECT_EQ(left["status"], "left the domain");
  EXPECT_EQ(left["steps"], 6);
  EXPECT_NEAR(left["samples"].back()["t"].get<double>(), 0.42, 1e-12);
  EXPECT_GT(left["max_energy_error"].get<double>(), 1e-6);
  EXPECT_TRUE(contains(of({"chaos", logarithm, "--steps", "0"}, 2).err, "there are none"));

  // An energy error beyond the scale that is no failure of the step itself.
  const std::vector<std::string> outwards = {models + "harmonic.ham", "--scheme", "explicit-euler",
                                             "--json", "--quiet"};
  chaos = {"chaos"};
  chaos.insert(chaos.end(), outwards.begin(), outwards.end());
  run = {"run"};
  run.insert(run.end(), outwards.begin(), outwards.end());
  const auto jumped = nlohmann::json::parse(of(chaos, 1).out);
  EXPECT_EQ(jumped["status"], "jumped");
  EXPECT_EQ(jumped["steps"], nlohmann::json::parse(of(run, 1).out)["steps_done"]);
}

TEST(Chaos, SaysThatSweepsAreNotTheMethod) {
  const Result result = hamgen({"chaos", HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham", "--solver",
                                "sweeps:2", "--steps", "10"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err + result.out, "implicit-midpoint, 2 fixed-point sweeps"))
      << result.err;
}

// So many steps that the frequency would be folded if every hundredth were a sample.
TEST(Chaos, FrequenciesOfALongOrbitAreThoseOfAShortOne) {
  const auto of = [](const char* steps) {
    const auto json = chaos_of("harmonic.ham", {"--steps", steps, "--frequencies", "1"});
    return json["frequencies"].front()["harmonics"][0]["frequency"].get<double>();
  };
  EXPECT_NEAR(of("10000"), of("200000"), 1e-9);

  // No sine: of a few samples it is another.  Source: the period of a pendulum, 4 K(sin(q/2))/w.
  const auto swing = chaos_of("pendulum.ham", {"--scene", "libration_16", "--h", "0.02", "--steps",
                                               "20000", "--frequencies", "1"});
  const double frequency = swing["frequencies"].front()["harmonics"][0]["frequency"].get<double>();
  const double period = 4 * std::comp_ellint_1(std::sin(0.8)) / std::sqrt(0.03);
  EXPECT_NEAR(std::abs(frequency), 2 * std::numbers::pi / period, 1e-6);
}

// A driven oscillator has those of q; t goes on.
TEST(Chaos, TimeHasNoFrequencies) {
  const auto json = chaos_of("driven_oscillator.ham", {"--steps", "2000", "--frequencies", "1"});
  ASSERT_EQ(json["frequencies"].size(), 1U);
  EXPECT_TRUE(json["frequencies"].contains("q"));
}

TEST(Chaos, AMapOfOneTimeIsThatWhateverTheStep) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham",
                                          "coordinate q\nmomentum p\nparameter w = 1\nparameter k "
                                          "= 1\nH = p^2/2 + k*w^2*q^2/2 + q^4/4\nscene s { q = 1; "
                                          "h = 0.1/w; steps = 100 }\n");
  const Result map =
      hamgen({"chaos", model, "--over", "w=1:4:4", "--time", "5", "--json", "--quiet"});
  ASSERT_EQ(map.status, 0) << map.err;
  const auto json = nlohmann::json::parse(map.out);
  ASSERT_EQ(json["cells"].size(), 4U);
  for (const auto& cell : json["cells"]) EXPECT_NEAR(cell["t"].get<double>(), 5, 0.1);
  const Result stress = hamgen({"stress", model, "--vary", "w=1:2:2,k=1:2:2", "--time", "5"});
  EXPECT_EQ(stress.status, 2);
  EXPECT_TRUE(contains(stress.err, "so many steps are of different lengths")) << stress.err;
  const Result equal = hamgen({"chaos", HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham", "--over",
                               "q=1:2:3", "--indicator", "fli", "--steps", "50", "--quiet"});
  EXPECT_TRUE(contains(equal.out, "between 0 and 0")) << equal.out;
}

TEST(Chaos, ItsTableHasWhatWasAskedFor) {
  const Result result = hamgen({"chaos", HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham",
                                "--spectrum", "--frequencies", "1", "--steps", "100", "-o", "-"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "\n# spectrum  "));
  EXPECT_TRUE(contains(result.out, "\n# frequency of q: -"));
}

// Of any study that varies something.
TEST(Varied, ANameIsSetOnce) {
  const Scratch scratch;
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"chaos", model, "--over", "q=0:1:3", "--initial", "q=2"},
           {"chaos", model, "--over", "eps=1:2:3", "--set", "eps=2"},
           {"stress", model, "--vary", "eps=1:2:3", "--set", "eps=2"},
           {"ensemble", model, "--over", "q=0:1:3", "--initial", "q=2", "-o",
            scratch.path("x.csv")}}) {
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << words[0];
    EXPECT_TRUE(contains(result.err, "is varied, and a name is set once")) << result.err;
  }
}

// What is asked for and cannot be given is not passed over.
TEST(Chaos, HasOptionsOfAnOrbitAndOptionsOfAMap) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  for (const auto& [options, words] :
       {std::pair<std::vector<std::string>, std::string>{{"--over", "q2=0:1:5", "--spectrum"},
                                                         "--spectrum: of one orbit"},
        {{"--over", "q2=0:1:5", "--frequencies", "2"}, "--frequencies: of one orbit"},
        {{"--indicator", "fli"}, "--indicator fli: of a map"},
        {{"--over", "q2=0:1:5", "--indicator", "flee"}, "there are megno"},
        {{"--frequencies", "21"}, "20 at most"},
        {{"--frequencies", "few"}, "--frequencies few"}}) {
    std::vector<std::string> words_of{"chaos", model};
    words_of.insert(words_of.end(), options.begin(), options.end());
    const Result result = hamgen(words_of);
    EXPECT_EQ(result.status, 2) << words;
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  }
}

using Complex = std::complex<double>;

TEST(Frequencies, OfAQuasiPeriodicSignalAreFound) {
  const std::vector<app::Harmonic> truth = {
      {.frequency = -0.7390851332, .amplitude = std::polar(2.0, 0.3)},
      {.frequency = 1.6180339887, .amplitude = std::polar(0.5, -1.0)},
      {.frequency = 0.3183098862, .amplitude = std::polar(0.02, 2.0)}};
  std::vector<Complex> signal;
  constexpr double dt = 0.37;
  for (int k = 0; k < 4096; ++k) {
    Complex sum = 0;
    for (const app::Harmonic& each : truth)
      sum += each.amplitude * std::polar(1.0, each.frequency * dt * k);
    signal.push_back(sum);
  }
  const auto found = app::leading_harmonics(signal, dt, 3);
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].frequency, truth[i].frequency, 1e-7) << i;
    EXPECT_NEAR(std::abs(found[i].amplitude - truth[i].amplitude), 0, 1e-4) << i;
  }
}

TEST(Frequencies, OfTwoStepsAreNone) {
  const std::string model = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/pendulum.ham";
  const std::vector<std::string> words = {"chaos", model, "--frequencies", "3", "--steps", "2"};
  EXPECT_NE(hamgen(words).out.find("so few steps have none"), std::string::npos);
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const auto found = nlohmann::json::parse(hamgen(as_json).out);
  EXPECT_TRUE(found["frequencies"]["q"]["change"].is_null());
}

TEST(Frequencies, OfNothingAreNone) {
  const std::vector<Complex> signal(256, Complex(0));
  EXPECT_TRUE(app::leading_harmonics(signal, 0.1, 3).empty());
}

}  // namespace
}  // namespace hamgen::app_test
