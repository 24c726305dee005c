// hamgen verify, on every model that comes with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using Json = nlohmann::json;

const std::filesystem::path verified_models = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians";

Json findings(const std::string& model, std::vector<std::string> options, int status = 0) {
  options.insert(options.begin(), {"verify", model, "--json"});
  const Result result = hamgen(options);
  EXPECT_EQ(result.status, status) << model << result.err;
  return Json::parse(result.out);
}

Json find(const Json& rows, const std::string& property) {
  const auto it =
      std::ranges::find_if(rows, [&](const Json& row) { return row.at("property") == property; });
  if (it == rows.end()) return {{"verdict", "missing"}};
  return *it;
}

// Not an invariant: the energy of the stiff springs is constant to O(1/w) only.
bool is_adiabatic(const std::string& model, const std::string& property) {
  return model == "stiff_fpu.ham" && property == "I invariant";
}

TEST(Verify, ProvesOfEveryShippedModelWhatHolds) {
  int seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(verified_models)) {
    const std::string model = entry.path().filename().string();
    const Json midpoint = findings(entry.path().string(), {});
    EXPECT_EQ(find(midpoint, "symplectic").at("verdict"), "proved") << model;
    EXPECT_EQ(find(midpoint, "symmetric").at("verdict"), "proved") << model;
    EXPECT_EQ(find(midpoint, "order 2").at("verdict"), "proved") << model;
    for (const Json& row : midpoint) {
      const std::string property = row.at("property");
      if (is_adiabatic(model, property)) {
        EXPECT_EQ(row.at("verdict"), "refuted") << model << ' ' << row;
        continue;
      }
      EXPECT_NE(row.at("verdict"), "refuted") << model << ' ' << row;
      if (property.ends_with(" invariant")) {
        EXPECT_EQ(row.at("verdict"), "proved") << model << ' ' << row;
      }
    }
    // Another member is symplectic too, and of order 1; what it does not conserve may be refuted.
    const Json third = findings(entry.path().string(), {"--alpha", "1/3"});
    EXPECT_EQ(find(third, "symplectic").at("verdict"), "proved") << model;
    EXPECT_EQ(find(third, "symmetric").at("verdict"), "refuted") << model;
    EXPECT_EQ(find(third, "order 1").at("verdict"), "proved") << model;
    for (const Json& proof : {midpoint, third}) {
      const std::string emitted = find(proof, "emitted code").at("verdict");
      EXPECT_TRUE(emitted == "proved" || emitted == "tested") << model << ' ' << emitted;
      EXPECT_TRUE(std::ranges::any_of(proof, [](const Json& row) {
        return row.at("property") == "linear stability" && row.contains("place");
      })) << model;
    }
    ++seen;
  }
  EXPECT_GE(seen, 20);
}

TEST(Verify, HasTheNumbersOfTheLinearPartInItsJson) {
  const std::string model = (verified_models / "harmonic.ham").string();
  const Json euler =
      find(findings(model, {"--scheme", "symplectic-euler-a", "--h", "1/2"}), "linear stability");
  EXPECT_EQ(euler.at("verdict"), "proved");
  EXPECT_EQ(euler.at("frequencies"), Json::array({1.0}));
  EXPECT_NEAR(euler.at("largest_h").get<double>(), 2.0, 1e-9);
  // cos theta = 1 - h^2 w^2/2.
  EXPECT_NEAR(euler.at("angles").at(0).get<double>(), std::acos(1.0 - 0.125), 1e-12);
  EXPECT_TRUE(euler.at("iteration_radius").is_null());
  const Json beyond =
      find(findings(model, {"--scheme", "symplectic-euler-a", "--h", "2.5"}), "linear stability");
  EXPECT_EQ(beyond.at("verdict"), "refuted");
  EXPECT_LT(beyond.at("margin").get<double>(), 0.0);
  // What is unbounded carries no bound.
  EXPECT_TRUE(beyond.at("largest_h").is_null());
  EXPECT_TRUE(beyond.at("bounded_steps").empty());
  EXPECT_EQ(euler.at("bounded_steps"), Json::array({Json::array({0.0, 2.0})}));
  const Json midpoint = find(findings(model, {"--h", "5"}), "linear stability");
  EXPECT_EQ(midpoint.at("verdict"), "proved");
  EXPECT_TRUE(midpoint.at("bounded_for_every_h"));
  EXPECT_NEAR(midpoint.at("iteration_radius").get<double>(), 2.5, 1e-12);
  const Json sweeps = find(findings(model, {"--solver", "sweeps:2"}, 5), "linear stability");
  EXPECT_EQ(sweeps.at("verdict"), "not decided");
}

// The midpoint rule conserves the quadratic angular momentum, up to rounding: 10000 steps of about
// 2e-16 each, all of one sign at worst.  It turns the ellipse: the Laplace vector moves.
TEST(Verify, MeasuresTheDefectOfEveryInvariantBesideItsProof) {
  const Json rows = findings((verified_models / "kepler.ham").string(), {"--measure"});
  const Json kept = find(rows, "L measured");
  EXPECT_EQ(kept.at("verdict"), "measured");
  EXPECT_EQ(kept.at("steps"), 10000);
  EXPECT_LT(kept.at("defect").get<double>(), 2e-12);
  const Json moved = find(rows, "A2 measured");
  EXPECT_GT(moved.at("defect").get<double>(), 1e-3);
  // The last row of a name.
  const auto place = [&rows](const std::string& property) {
    return std::ranges::find_if(rows,
                                [&](const Json& row) { return row.at("property") == property; }) -
           rows.begin();
  };
  EXPECT_EQ(place("L measured"), place("L conserved by the step") + 1);
  EXPECT_EQ(place("A2 measured"), place("A2 conserved by the step") + 1);
}

// With alpha = 1/2 -+ 1/6 for x and y the angular momentum is not conserved, and it shows.
TEST(Verify, MeasuresTheDefectOfAnInvariantThatIsRefuted) {
  const Json rows =
      findings((verified_models / "kepler.ham").string(), {"--alpha", "1/3,2/3", "--measure"});
  EXPECT_EQ(find(rows, "L conserved by the step").at("verdict"), "refuted");
  EXPECT_GT(find(rows, "L measured").at("defect").get<double>(), 1e-6);
}

// It says what it measures only of steps that were taken.
TEST(Verify, MeasuresNothingWhereNoStepIsTaken) {
  const Json rows = findings((verified_models / "pendulum.ham").string(),
                             {"--measure", "--solver", "fixed-point", "--h", "1000"});
  EXPECT_EQ(find(rows, "tangent map symplectic").at("verdict"), "not decided");
  EXPECT_EQ(find(rows, "tangent map of the step").at("verdict"), "missing");
  EXPECT_EQ(find(rows, "reversal").at("verdict"), "missing");
}

TEST(Verify, EndsWithFiveWhereAMeasurementRefutes) {
  const std::string pendulum = (verified_models / "pendulum.ham").string();
  // Not symplectic, which this list does not ask for; and yet it shows.
  const Json rows =
      findings(pendulum, {"--scheme", "rk4", "--require", "order:4", "--measure", "--h", "1/2"}, 5);
  EXPECT_EQ(find(rows, "tangent map symplectic").at("verdict"), "refuted");
  EXPECT_EQ(hamgen({"verify", pendulum, "--scheme", "rk4", "--require", "order:4"}).status, 0);
  EXPECT_EQ(hamgen({"verify", pendulum, "--scheme", "rk4"}).status, 5);
}

TEST(Verify, TakesTheOptionsOfARun) {
  const std::string pendulum = (verified_models / "pendulum.ham").string();
  // w^2 = eps cos(q): 2 there, by the run's own parameter and state.
  const Json rows = findings(pendulum, {"--set", "eps=2", "--initial", "q=0,p=0", "--h", "1/2"});
  EXPECT_NEAR(find(rows, "linear stability").at("frequencies").at(0).get<double>(), std::sqrt(2.0),
              1e-12);
  EXPECT_EQ(hamgen({"verify", pendulum, "--initial", "z=0"}).status, 2);
}

// A model without a scene is measured along 1000 steps from the state that is given.
TEST(Verify, NeedsNoSceneToMeasure) {
  const Scratch scratch;
  scratch.write("spring.ham",
                "coordinate q\nmomentum p\nH = p^2/2 + q^2/2\ninvariant E = (p^2 + q^2)/2\n");
  const std::string model = scratch.path("spring.ham");
  const Result without = hamgen({"verify", model, "--measure"});
  EXPECT_EQ(without.status, 2);
  EXPECT_TRUE(contains(without.err, "--initial q=0.1,p=0 --h 0.01\n")) << without.err;
  const Json rows = findings(model, {"--measure", "--initial", "q=0.1,p=0", "--h", "0.01"});
  EXPECT_EQ(find(rows, "E measured").at("steps"), 1000);
  EXPECT_EQ(find(rows, "tangent map symplectic").at("verdict"), "tested");
}

TEST(Verify, ReadsAHeaderThatIsThere) {
  const Scratch scratch;
  const std::string model = (verified_models / "pendulum.ham").string();
  ASSERT_EQ(hamgen({"generate", model, "-o", scratch.path("made")}).status, 0);
  const std::string path = scratch.path("made") + "/pendulum.hpp";
  const auto read_back = [&](int status, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--emitted", path});
    return find(findings(model, more, status), "emitted code");
  };
  EXPECT_EQ(read_back(0).at("verdict"), "proved");
  // Of another member it is another step.
  EXPECT_EQ(read_back(5, {"--alpha", "1/3"}).at("verdict"), "refuted");
  std::string text = read(path);
  const std::size_t at = text.find("q_bar += delta_q;");
  text.replace(at, 17, "q_bar -= delta_q;");
  static_cast<void>(scratch.write("made/pendulum.hpp", text));
  const Json found = read_back(5);
  EXPECT_EQ(found.at("verdict"), "refuted");
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
  EXPECT_TRUE(contains(found.at("detail"), path + ":" + std::to_string(line) + ": ")) << found;
  const Result compared = hamgen({"generate", model, "-o", scratch.path("made"), "--check"});
  EXPECT_EQ(compared.status, 1);
  EXPECT_TRUE(contains(compared.err, ":" + std::to_string(line) + ": the code is another"))
      << compared.err;
  EXPECT_EQ(hamgen({"verify", model, "--emitted", scratch.path("none.hpp")}).status, 2);
}

// In C, and what `run` compiles.
TEST(Verify, ReadsEveryFormatThatIsThere) {
  const Scratch scratch;
  const std::string model = (verified_models / "pendulum.ham").string();
  struct Written {
    std::string format, file, from, to;
  };
  for (const Written& written :
       {Written{"c-header", "pendulum.h", "self->z.q += dz.q", ""},
        Written{"cpp-plugin", "pendulum.plugin.cpp", "each(0, z.q,", "each(1, z.q,"}}) {
    const std::string made = scratch.path(written.format);
    const Result generated = hamgen({"generate", model, "--format", written.format, "--require",
                                     "emitted-code", "--plain-sums", "-o", made});
    ASSERT_EQ(generated.status, 0) << generated.err;
    const std::string path = made + "/" + written.file;
    std::string text = read(path);
    EXPECT_TRUE(contains(text, "symmetric, order 2, emitted code\n")) << written.format;
    EXPECT_EQ(
        find(findings(model, {"--plain-sums", "--emitted", path}), "emitted code").at("verdict"),
        "proved");
    EXPECT_EQ(find(findings(model, {"--plain-sums", "--format", written.format}), "emitted code")
                  .at("verdict"),
              "proved");
    const std::size_t at = text.find(written.from);
    ASSERT_NE(at, std::string::npos) << text;
    text.replace(at, written.from.size(), written.to);
    static_cast<void>(scratch.write(written.format + "/" + written.file, text));
    const Json rows = findings(model, {"--plain-sums", "--emitted", path}, 5);
    EXPECT_EQ(find(rows, "emitted code").at("verdict"), "refuted");
    EXPECT_EQ(find(rows, "plugin").at("verdict"), "proved");
    const Result compared = hamgen(
        {"generate", model, "--format", written.format, "--plain-sums", "-o", made, "--check"});
    EXPECT_EQ(compared.status, 1);
    EXPECT_TRUE(contains(compared.err, "the code is another")) << compared.err;
  }
  EXPECT_EQ(hamgen({"verify", model, "--format", "fortran"}).status, 2);
}

// What the header's first lines say of its lanes is taken from there.
TEST(Verify, ReadsTheHeaderOfABatch) {
  const Scratch scratch;
  const std::string model = (verified_models / "pendulum.ham").string();
  const std::string path = scratch.path("batch.hpp");
  ASSERT_EQ(hamgen({"generate", model, "--batch", "4", "-o", path}).status, 0);
  const Json rows = findings(model, {"--emitted", path});
  EXPECT_EQ(find(rows, "emitted code").at("verdict"), "proved");
  EXPECT_EQ(find(rows, "plugin").at("verdict"), "proved");
  std::string text = read(path);
  const std::size_t at = text.find("std::sin(", text.find("gradient("));
  const std::size_t sine = at != std::string::npos ? at : text.find("sin(", text.find("gradient("));
  ASSERT_NE(sine, std::string::npos) << text;
  text.replace(text.find("sin", sine), 3, "cos");
  static_cast<void>(scratch.write("batch.hpp", text));
  EXPECT_EQ(find(findings(model, {"--emitted", path}, 5), "emitted code").at("verdict"), "refuted");
}

// An index that falls, and one of every second element.
TEST(Verify, ReadsSubscriptsThatFall) {
  const Scratch scratch;
  const std::string model =
      scratch.write("mirror.ham",
                    "size N = 20\ncoordinate x[1..2*N]\nmomentum u[1..2*N]\n"
                    "H = sum(i = 1..2*N, u[i]^2/2 + x[i]^2/2) + sum(i = 1..N, x[2*i]*x[2*i-1]^2)"
                    " + sum(i = 1..N, x[i]*x[2*N+1-i])\n");
  for (const char* format : {"cpp-header", "cpp-plugin"}) {
    const Json rows = findings(model, {"--format", format});
    EXPECT_NE(find(rows, "emitted code").at("verdict"), "not decided") << rows.dump(1);
  }
}

TEST(Check, SaysWhereHHasACorner) {
  const Scratch scratch;
  scratch.write("ball.ham", "coordinate q\nmomentum p\nH = p^2/2 + (abs(q) - q)^2/8\n");
  const Result result = hamgen({"check", scratch.path("ball.ham")});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.err, "ball.ham:3:5: warning: H has a corner where q = 0, by abs(q)"))
      << result.err;
}

TEST(Verify, AndRunWatchTheSameModifiedHamiltonian) {
  const Scratch scratch;
  const Result result =
      hamgen({"run", (verified_models / "pendulum.ham").string(), "--watch-modified", "3",
              "--steps", "2000", "--json", "--quiet", "--header", scratch.path("k")});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json invariants = Json::parse(result.out).at("invariants");
  // In double the h^2 truncation still shows its h^4 error, at most 1.74e-11; that to h^4 is at
  // rounding, some units of 0.03.
  EXPECT_LT(std::abs(invariants.at("modified_energy_2").at("final_error").get<double>()), 1.8e-11);
  EXPECT_LT(std::abs(invariants.at("modified_energy_4").at("final_error").get<double>()), 1e-15);
  const std::string header = read(scratch.path("k") + "/pendulum.hpp");
  EXPECT_TRUE(contains(header, "--watch-modified 3"));
  EXPECT_TRUE(contains(header,
                       "inline Real modified_energy(const Parameters& par, Real h, "
                       "const State& z)"));
}

// What is remarked of a model is the same mathematics, and another file: a checker would refuse it.
TEST(Verify, CertifiesTheFileThatTheHeaderWasMadeFromAlone) {
  const Scratch scratch;
  const std::string text = "system m\ncoordinate q\nmomentum p\nH = p^2/2 + q^4\n";
  const std::string model = scratch.write("m.ham", text);
  const std::string header = scratch.path("m.hpp");
  const std::string certificate = scratch.path("c.json");
  ASSERT_EQ(hamgen({"generate", model, "-o", header, "--quiet"}).status, 0);
  const std::vector<std::string> words = {"verify",        model,       "--emitted", header,
                                          "--certificate", certificate, "--quiet"};
  EXPECT_EQ(hamgen(words).status, 0);
  EXPECT_TRUE(std::filesystem::remove(certificate));
  (void)scratch.write("m.ham", text + "# a remark\n");
  const Result refused = hamgen(words);
  EXPECT_EQ(refused.status, 5);
  EXPECT_NE(refused.err.find("has not the digest of"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(certificate));
}

}  // namespace
}  // namespace hamgen::app_test
