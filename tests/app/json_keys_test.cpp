// The keys of JSON documents are those that docs/command.md lists.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

// The words of a line that stand between grave accents.
std::vector<std::string> quoted(const std::string& text) {
  std::vector<std::string> words;
  const std::regex word("`([^`]*)`");
  for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it)
    words.push_back((*it)[1]);
  return words;
}

std::vector<std::string> cells_of_row(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(cell);
  return cells;
}

std::set<std::string> keys_of(const nlohmann::json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

// The rows of the table below a heading.
std::vector<std::vector<std::string>> rows_below(const std::string& heading) {
  const std::string page = read(HAMGEN_SOURCE_DIR "/docs/command.md");
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : lines(page.substr(page.find(heading)))) {
    if (line.starts_with("| `")) rows.push_back(cells_of_row(line));
    if (!line.starts_with("|") && !rows.empty()) break;
  }
  return rows;
}

// Short, and with something in every list.
const std::map<std::string, std::string> short_calls = {
    {"check", ""},
    {"bench", "--h 0.1 --schemes gauss-4 --steps 100 --target 1e-3 --rounds 1"},
    {"report", "--steps 100 --schemes gauss-4 --rounds 1 -o page"},
    {"tune", "--steps 100 --samples 50"},
    {"stress", "--steps 10 --vary h=1:2:2 --reference-seconds 0"},
    {"section", "--orbits 1 --points 1"},
    {"chaos", "--steps 20"},
    {"ensemble", "--over q2=0:0.1:2 --steps 5 -o rows.csv"}};

TEST(JsonKeys, AreThoseOfThePage) {
  const Scratch scratch;
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  std::map<std::string, nlohmann::json> documents;
  std::set<std::string> commands;
  for (const std::vector<std::string>& row : rows_below("## JSON")) {
    const std::vector<std::string> what = quoted(row[0]);
    const std::string command = what[0].substr(0, what[0].find(' '));
    if (!documents.contains(what[0])) {
      const Result result =
          shell("hamgen " + command + " " + model + " " + short_calls.at(command) +
                    what[0].substr(command.size()) + " --json --quiet",
                scratch.path("."));
      ASSERT_LE(result.status, 1) << what[0] << result.err;
      documents[what[0]] = nlohmann::json::parse(result.out);
    }
    nlohmann::json document = documents[what[0]];
    if (what.size() > 1) document = document.at(what[1]).at(0);
    const std::vector<std::string> keys = quoted(row[1]);
    EXPECT_EQ(keys_of(document), std::set<std::string>(keys.begin(), keys.end())) << row[0];
    commands.insert(command);
  }
  EXPECT_EQ(commands.size(), short_calls.size());
}

TEST(JsonKeys, OfARunAndItsCertificateAreThoseOfThePage) {
  const std::string model = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
  for (const auto& [heading, words] :
       {std::pair<std::string, std::vector<std::string>>{
            "* **`--json`** prints one object",
            {"run", model, "--steps", "200", "--until", "q1", "--certify"}},
        {"status 130. `--json`:", {"certify", model, "--steps", "10"}}}) {
    std::set<std::string> shown;
    for (const std::vector<std::string>& row : rows_below(heading)) {
      for (const std::string& key : quoted(row[0])) shown.insert(key);
    }
    std::vector<std::string> call = words;
    call.insert(call.end(), {"--json", "--quiet"});
    const Result result = hamgen(call);
    ASSERT_EQ(result.status, 0) << result.err;
    for (const std::string& key : keys_of(nlohmann::json::parse(result.out)))
      EXPECT_TRUE(shown.contains(key)) << words[0] << ": " << key;
  }
}

}  // namespace
}  // namespace hamgen::app_test
