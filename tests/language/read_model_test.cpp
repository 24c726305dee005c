#include "generator/language/read_model.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "generator/language/scene.hpp"

namespace hamgen {
namespace {

Model read(const std::string& text) { return read_model(make_source("x.ham", text)); }

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(read(text));
    return "accepted";
  } catch (const ModelError& error) {
    return error.diagnostics().front().message;
  }
}

TEST(ReadModel, keeps_names_units_comments_and_texts) {
  const Model model = read(
      "system s\n"
      "coordinate q [rad]   # an angle\n"
      "momentum p\n"
      "parameter k = 1/4 [kg m^2]\n"
      "let r = (q   # half of it\n"
      "   + 1)\n"
      "H = p^2/2 +  k*r\n"
      "invariant A = r  # of no use\n");
  EXPECT_EQ(model.name, "s");
  EXPECT_EQ(model.coordinates.front().unit, "rad");
  EXPECT_EQ(model.coordinates.front().comment, "an angle");
  EXPECT_EQ(model.parameters.front().unit, "kg m^2");
  EXPECT_EQ(model.definitions.front().text, "(q + 1)");
  EXPECT_EQ(model.hamiltonian_text, "p^2/2 + k*r");
  EXPECT_EQ(model.invariants.front().comment, "of no use");
  EXPECT_TRUE(model.warnings.empty());
}

TEST(ReadModel, an_indexed_sum_stays_a_sum) {
  const Model model = read(
      "size N = 3\n"
      "coordinate q[0..N] periodic\n"
      "momentum p[0..N]\n"
      "H = sum(i = 0..N, p[i]^2 + q[i+1]*q[i])\n");
  EXPECT_EQ(to_text(model.hamiltonian), "sum(i = 0..N, p[i]^2 + q[i + 1]*q[i])");
  EXPECT_EQ(degrees_of_freedom(model), 4);
  EXPECT_EQ(element_names(model.momenta),
            (std::vector<std::string>{"p[0]", "p[1]", "p[2]", "p[3]"}));
}

TEST(ReadModel, time_is_the_last_degree_of_freedom) {
  const Model model = read("coordinate q\nmomentum p\ntime t [s]\nH = p^2/2 + q*cos(t)\n");
  EXPECT_EQ(element_names(model.coordinates), (std::vector<std::string>{"q", "t"}));
  EXPECT_EQ(element_names(model.momenta), (std::vector<std::string>{"p", "p_t"}));
  EXPECT_TRUE(model.coordinates.back().is_time);
  EXPECT_TRUE(model.momenta.back().is_time);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(ReadModel, sizes_can_be_given_from_outside) {
  const SourceText source =
      make_source("x.ham",
                  "size N = 3\nsize M = 2*N\ncoordinate q[1..M]\nmomentum p[1..M]\n"
                  "H = sum(i = 1..M, p[i]^2 + q[i]^2)\n");
  EXPECT_EQ(degrees_of_freedom(read_model(source, {{"N", 5}})), 10);
  EXPECT_THROW(static_cast<void>(read_model(source, {{"n", 5}})), UsageError);
}

TEST(ReadModel, a_file_without_a_system_line_is_named_after_itself) {
  const std::string text = "coordinate q\nmomentum p\nH = p^2 + q^2\n";
  EXPECT_EQ(read_model(make_source("models/two-wells.v2.ham", text)).name, "two_wells_v2");
  EXPECT_EQ(read_model(make_source("2.ham", text)).name, "model");
}

TEST(ReadModel, the_names_of_constants_elsewhere_are_ordinary_names) {
  EXPECT_EQ(refusal("coordinate I, Pi\nmomentum Euler, double\nH = Euler*I + double*Pi\n"),
            "accepted");
  EXPECT_EQ(refusal("coordinate sin\nmomentum p\nH = p\n"), "'sin' is reserved: a function");
}

TEST(ReadModel, a_subscript_that_only_some_pairs_reach_is_found) {
  const std::string head = "coordinate q[1..40]\nmomentum p[1..40]\nH = sum(i = 1..40, p[i]^2) + ";
  EXPECT_EQ(refusal(head + "sum(i = 1..40, j = i+1..40, q[i+1]*q[j])\n"), "accepted");
  EXPECT_EQ(refusal(head + "sum(i = 1..40, j = i+1..40, q[i+2]*q[j])\n"),
            "'q[41]' is outside q[1..40] for i = 39, j = 40");
  EXPECT_EQ(refusal(head + "sum(i = 1..40, q[i-1])\n"), "'q[0]' is outside q[1..40] for i = 1");
}

class ShippedModel : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedModel, is_read_without_a_warning_and_reads_back_as_printed) {
  const Model model = read_model(read_source(GetParam().string()));
  EXPECT_EQ(render(model.warnings, model.source), "");
  const std::string printed = to_text(model);
  EXPECT_EQ(to_text(read(printed)), printed);
  EXPECT_EQ(model.name, GetParam().stem());
  EXPECT_GE(model.scenes.size(), 2U);
  for (const Scene& scene : model.scenes) {
    const SceneValues values = scene_values(model, {.scene = scene.name});
    EXPECT_TRUE(values.h && values.steps) << scene.name;
  }
}

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    if (entry.path().extension() == ".ham") paths.push_back(entry.path());
  }
  return paths;
}

INSTANTIATE_TEST_SUITE_P(Hamiltonians, ShippedModel, testing::ValuesIn(shipped()),
                         [](const auto& each) { return each.param.stem().string(); });

// Exact squares double their digits with each line; the values stay below 1.
TEST(ReadModel, CountsTheDigitsOfExactConstants) {
  std::string text = "coordinate q\nmomentum p\nparameter b0 = 1/3\n";
  for (int i = 1; i <= 40; ++i) {
    const std::string last = "b" + std::to_string(i - 1);
    text += "parameter b" + std::to_string(i) + " = " + last + "*" + last + " + 1/7\n";
  }
  const auto said = [](const std::string& model) -> std::string {
    try {
      static_cast<void>(read_model(make_source("m.ham", model)));
    } catch (const ModelError& error) {
      const std::string message = error.what();
      return message.substr(0, message.find('\n'));
    }
    return "";
  };
  // b_i has 63^(2^(i-1)) in its denominator, 0.9*2^i digits, and about as many in its numerator.
  EXPECT_EQ(said(text + "H = p^2/2 + b40*q\n"),
            "m.ham:17:17: error: this constant has more than 20000 digits");
  EXPECT_EQ(said("coordinate q\nmomentum p\nH = p^2/2 + q*sum(i = 1..1000, 1/i)\n"), "");
  EXPECT_NE(said("coordinate q\nmomentum p\nparameter a = sum(i = 1..1000000, 1/i)\nH = p^2/2 + "
                 "a*q\n"),
            "");
}

}  // namespace
}  // namespace hamgen
