// hamgen check --json: what editors read.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

nlohmann::json checked(const Result& result) {
  EXPECT_EQ(result.err, "");
  return nlohmann::json::parse(result.out);
}

TEST(CheckAsJson, SaysOfEveryMistakeWhereItIs) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham",
                                          "system m\n"
                                          "coordinate q  # \xc3\xa9\n"
                                          "momentum p\n"
                                          "parameter \"a\" = 1\n"
                                          "H = p^2/2 - coss(q) + r\n");
  const Result result = hamgen({"check", "--json", model});
  EXPECT_EQ(result.status, 3);
  const Result text = hamgen({"check", model});
  EXPECT_EQ(text.status, 3);
  const nlohmann::json document = checked(result);
  EXPECT_EQ(document["fine"], false);
  EXPECT_EQ(document["model"], model);
  ASSERT_GE(document["diagnostics"].size(), 1u);
  // The same as the text says, in its order.
  std::size_t from = 0;
  for (const nlohmann::json& each : document["diagnostics"]) {
    EXPECT_EQ(each["file"], model);
    const std::string line = model + ":" + std::to_string(each["line"].get<int>()) + ":" +
                             std::to_string(each["column"].get<int>()) +
                             ": error: " + each["message"].get<std::string>() + "\n";
    const std::size_t at = text.err.find(line, from);
    ASSERT_NE(at, std::string::npos) << line << text.err;
    from = at + line.size();
    if (each["help"] != "") {
      EXPECT_TRUE(contains(text.err.substr(from), "help: " + each["help"].get<std::string>()));
    }
  }
  EXPECT_EQ(text.err.find(": error: ", from), std::string::npos) << "one is missing";
}

TEST(CheckAsJson, GivesTheEndOfAWord) {
  const Result result =
      hamgen({"check", "--json", HAMGEN_SOURCE_DIR "/tests/diagnostics/misspelt_name.ham"});
  EXPECT_EQ(result.status, 3);
  const nlohmann::json each = checked(result)["diagnostics"].at(0);
  EXPECT_EQ(each["severity"], "error");
  EXPECT_EQ(each["line"], 9);
  EXPECT_EQ(each["column"], 36);
  EXPECT_EQ(each["end_line"], 9);
  EXPECT_EQ(each["end_column"], 40);
  EXPECT_EQ(each["message"], "unknown name 'thta'");
  EXPECT_EQ(each["help"], "did you mean 'theta', the coordinate declared on line 3?");
}

TEST(CheckAsJson, WarnsOfAModelThatIsFine) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "m.ham", "system m\ncoordinate q\nmomentum p\nH = p^2/2 + abs(q)\nscene s { q = 1 }\n");
  const Result result = hamgen({"check", "--json", model});
  EXPECT_EQ(result.status, 0);
  const nlohmann::json document = checked(result);
  EXPECT_EQ(document["fine"], true);
  EXPECT_EQ(document["degrees_of_freedom"], 1);
  EXPECT_EQ(document["scenes"], 1);
  ASSERT_EQ(document["diagnostics"].size(), 1u);
  EXPECT_EQ(document["diagnostics"][0]["severity"], "warning");
  EXPECT_EQ(document["diagnostics"][0]["line"], 4);
}

// Of every scene, not only of the one that a run would take.
TEST(CheckAsJson, WarnsOfASceneThatCannotBegin) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "system m\ncoordinate x\nmomentum p\nH = p^2/2 + 1/x\n"
                    "scene here { x = 1 }\nscene there { p = 1; h = 0.1; steps = 10 }\n");
  const Result result = hamgen({"check", "--json", model});
  EXPECT_EQ(result.status, 0);
  const nlohmann::json document = checked(result);
  ASSERT_EQ(document["diagnostics"].size(), 1u);
  const nlohmann::json& said = document["diagnostics"][0];
  EXPECT_EQ(said["severity"], "warning");
  EXPECT_EQ(said["message"],
            "H is not defined at the initial state of scene 'there': H is infinite");
  EXPECT_EQ(said["line"], 4);
}

// What is no step, whatever the size is.
TEST(CheckAsJson, WarnsOfAStartOfALargeSystem) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "m.ham",
      "system m\nsize N = 3000\ncoordinate q[1..N]\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + 1/q[i]) + sum(i = 1..N-1, (q[i+1] - q[i])^4)\n"
      "scene there { h = 0.1; steps = 10 }\nscene here { q[i] = i; h = 0.1; steps = 10 }\n");
  const Result result = hamgen({"check", "--json", model});
  EXPECT_EQ(result.status, 0);
  const nlohmann::json document = checked(result);
  ASSERT_EQ(document["diagnostics"].size(), 1u);
  EXPECT_TRUE(contains(document["diagnostics"][0]["message"].get<std::string>(), "'there'"));
}

TEST(CheckAsJson, NamesTheOptionThatIsMeant) {
  const Result result = hamgen(
      {"check", "--json", HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham", "--beta", "0.1*nothing"});
  EXPECT_EQ(result.status, 3);
  const nlohmann::json each = checked(result)["diagnostics"].at(0);
  EXPECT_EQ(each["file"], "--beta");
  EXPECT_EQ(each["line"], 1);
  EXPECT_EQ(each["column"], 5);
}

// Bytes that are no text stay a document.
TEST(CheckAsJson, IsADocumentWhateverTheBytes) {
  const Scratch scratch;
  const std::string model = scratch.write("m\"\n.ham", "system \xff\x01 \"\\\n");
  const Result result = hamgen({"check", "--json", model});
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(checked(result)["fine"], false);
  EXPECT_EQ(hamgen({"check", "--json", scratch.path("none.ham")}).status, 2);
}

// A mistake in an option's text has its place there; one that has no place says so.
TEST(CheckAsJson, SaysWhatIsWrongWithOptions) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham";
  const auto said = [&model](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"check", "--json", model};
    words.insert(words.end(), options.begin(), options.end());
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << result.out;
    EXPECT_EQ(result.err, "");
    return checked(result)["diagnostics"].at(0);
  };
  const nlohmann::json name = said({"--scene", "paper", "--set", "esp=1"});
  EXPECT_EQ(name["file"], "--set");
  EXPECT_EQ(name["message"], "unknown name 'esp'");
  EXPECT_EQ(name["column"], 1);
  EXPECT_EQ(name["end_column"], 4);
  const nlohmann::json text = said({"--scene", "paper", "--set", "eps=1+"});
  EXPECT_EQ(text["column"], 6);
  const nlohmann::json scene = said({"--scene", "papre"});
  EXPECT_EQ(scene["file"], "");
  EXPECT_TRUE(contains(scene["message"].get<std::string>(), "did you mean 'paper'?"));
  const nlohmann::json size = said({"--set", "eps=1"});
  EXPECT_TRUE(contains(size["help"].get<std::string>(), "--scene NAME"));
}

TEST(ShowAsJson, SaysWhatTheModelDeclares) {
  const Result result =
      hamgen({"show", HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham", "--json", "--stage", "plan"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json document = nlohmann::json::parse(result.out);
  EXPECT_EQ(document["stage"], "plan");
  EXPECT_TRUE(contains(document["text"].get<std::string>(), "solver: Newton"));
  const nlohmann::json& model = document["model"];
  EXPECT_EQ(model["system"], "pendulum");
  EXPECT_EQ(model["coordinates"].at(0)["unit"], "rad");
  EXPECT_EQ(model["parameters"].at(0)["name"], "eps");
  EXPECT_EQ(model["parameters"].at(0)["values"].at(0), "0.03");
  EXPECT_EQ(model["scenes"].at(0)["name"], "paper");
  EXPECT_EQ(model["scenes"].at(0)["h"], "0.1");
}

}  // namespace
}  // namespace hamgen::app_test
