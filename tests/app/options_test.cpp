// One vocabulary: an option means the same wherever it is, and no message proposes what fails.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "app/dispatch.hpp"
#include "app/studies/crew.hpp"
#include "runtime/cache.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

const std::vector<std::string> all_commands = {
    "new",    "check",   "show",    "generate", "run",  "bench",    "report", "stress", "tune",
    "verify", "certify", "section", "chaos",    "plot", "ensemble", "list",   "cache"};

// In this process: thousands of calls cost nothing.
Result said_by(const std::vector<std::string>& words) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  app::SingleCrew alone;
  Result result;
  result.status = app::dispatch(words, alone);
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

// The options of a command's help, each with what stands for its value.
std::map<std::string, std::string> options_of(const std::string& command) {
  std::map<std::string, std::string> options;
  const std::regex option(R"((--[a-z][a-z-]*)( [A-Z][^ ,]*(,[A-Z][^ ,]*|,\.\.\.)*)?(,|  |\n))");
  for (const std::string& line : lines(said_by({command, "--help"}).out)) {
    const std::string left = line.substr(0, line.find("  ", 3)) + "\n";
    if (!line.starts_with("  -")) continue;
    for (std::sregex_iterator it(left.begin(), left.end(), option), end; it != end; ++it)
      options[(*it)[1]] = (*it)[2].length() == 0 ? "" : (*it)[2].str().substr(1);
  }
  return options;
}

std::map<std::string, std::map<std::string, std::string>> all_options() {
  std::map<std::string, std::map<std::string, std::string>> all;
  for (const std::string& command : all_commands) all[command] = options_of(command);
  return all;
}

struct Word {
  std::string option, value;
  std::set<std::string> commands;
};

const std::set<std::string> runs = {"run", "report", "stress", "section", "chaos", "ensemble"};

std::set<std::string> with(std::set<std::string> commands, const std::set<std::string>& more) {
  commands.insert(more.begin(), more.end());
  return commands;
}

const std::set<std::string> integrate = with(runs, {"bench", "tune", "verify", "certify"});
const std::set<std::string> derive = {"check", "show", "generate"};

// What the page of the command says, word by word.
const std::vector<Word> vocabulary = {
    {"--scene", "NAME", with(integrate, derive)},
    {"--set", "NAME=VALUE,...", with(integrate, derive)},
    {"--initial", "NAME=VALUE,...", with(integrate, derive)},
    {"--whole", "", with(integrate, derive)},
    {"--keep", "NAME,...", with(integrate, derive)},
    {"--time", "T", integrate},
    {"--steps", "N", integrate},
    {"--scheme", "NAME", with(with(runs, derive), {"verify", "certify"})},
    {"--schemes", "A,B,...", {"bench", "report"}},
    {"--every", "K", {"run", "certify", "ensemble"}},
};

TEST(Options, MeanTheSameInEveryCommand) {
  const auto all = all_options();
  for (const Word& word : vocabulary) {
    for (const std::string& command : all_commands) {
      const auto found = all.at(command).find(word.option);
      EXPECT_EQ(found != all.at(command).end(), word.commands.contains(command))
          << command << ' ' << word.option;
      if (found != all.at(command).end()) {
        EXPECT_EQ(found->second, word.value) << command << ' ' << word.option;
      }
    }
  }
  for (const std::string& command : integrate) {
    const std::string value = command == "bench" ? "H1,H2,..." : "H";
    EXPECT_EQ(all.at(command).at("--h"), value) << command;
    EXPECT_TRUE(all.at(command).contains("--quiet")) << command;
    if (command != "report") {
      EXPECT_TRUE(all.at(command).contains("--json")) << command;
    }
  }
  for (const std::string command : {"check", "show", "generate", "list", "cache"})
    EXPECT_TRUE(all.at(command).contains("--json")) << command;
}

// "did you mean" is accepted there, and "is an option of" tells the truth.
TEST(Options, AreProposedOnlyWhereTheyAreTaken) {
  const auto all = all_options();
  std::set<std::string> words = {"--scen",   "--target", "--stag",
                                 "--shceme", "--intial", "--verbose"};
  for (const Word& word : vocabulary) words.insert(word.option);
  const std::regex meant("did you mean '([^']*)'");
  const std::regex others("is an option of ([^;]*);");
  std::size_t proposals = 0;
  for (const std::string& command : all_commands) {
    for (const std::string& word : words) {
      if (all.at(command).contains(word)) continue;
      std::vector<std::string> call = {command, "a", word + "=1"};
      if (command == "plot") call.insert(call.end(), {"-o", "a.svg"});
      const Result result = said_by(call);
      EXPECT_EQ(result.status, 2) << command << ' ' << word;
      EXPECT_TRUE(contains(result.err, "unexpected '" + word)) << result.err;
      EXPECT_TRUE(contains(result.err, "help: ")) << result.err;
      std::smatch match;
      if (std::regex_search(result.err, match, meant)) {
        EXPECT_TRUE(all.at(command).contains(match[1])) << command << '\n' << result.err;
        ++proposals;
      }
      if (std::regex_search(result.err, match, others)) {
        const std::string first = match[1].str().substr(0, match[1].str().find_first_of(", "));
        EXPECT_TRUE(all.at(first).contains(word)) << command << '\n' << result.err;
        ++proposals;
      }
    }
  }
  EXPECT_GE(proposals, 50u);
}

// The words "--x" between the quotes of a line of C++.
std::vector<std::string> options_in_literals(const std::string& line) {
  std::vector<std::string> options;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; };
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!inside && line.compare(i, 2, "//") == 0) break;
    if (line[i] == '\\') {
      ++i;
    } else if (line[i] == '"') {
      inside = !inside;
    } else if (inside && line.compare(i, 2, "--") == 0) {
      std::size_t end = i;
      while (end < line.size() && is_letter(line[end])) ++end;
      if (end > i + 2 && line[i + 2] != '-') options.push_back(line.substr(i, end - i));
      i = end - 1;
    }
  }
  return options;
}

// Every option that a message names is one of some command's.
TEST(Options, OfMessagesExist) {
  std::set<std::string> known = {"--help", "--version", "--output"};
  for (const auto& [command, options] : all_options())
    for (const auto& [option, value] : options) known.insert(option);
  known.insert("--version-script");  // of the linker
  for (const char* folder : {"/app", "/generator"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(HAMGEN_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() != ".cpp") continue;
      for (const std::string& line : lines(read(entry.path().string()))) {
        if (line.find("#include") != std::string::npos) continue;
        for (const std::string& option : options_in_literals(line))
          EXPECT_TRUE(known.contains(option)) << entry.path() << ": " << line;
      }
    }
  }
}

TEST(Options, TakeListsByCommas) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "m.ham",
      "system m\ncoordinate x, y\nmomentum u, v\nparameter a = 1\nparameter b[1..2] = 1\n"
      "H = (u^2 + v^2)/2 + a*(b[1]*x^2 + b[2]*y^2)/2\nscene s { x = 1; h = 0.1; steps = 10 }\n");
  const auto last = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"run", model, "--interpret", "--json", "--whole"};
    words.insert(words.end(), options.begin(), options.end());
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t begin = result.out.find("\"state\"");
    EXPECT_NE(begin, std::string::npos) << result.out;
    return result.out.substr(begin, result.out.find('}', begin) - begin);
  };
  const std::string apart = last({"--set", "a=2", "--set", "b=[3,4]", "--initial", "y=1"});
  EXPECT_EQ(apart, last({"--set", "a=2,b=[3,4]", "--initial", "y=1"}));
  EXPECT_EQ(apart, last({"--set", "b=3,4,a=2", "--initial", "x=1,y=1"}));
  EXPECT_NE(apart, last({"--set", "a=2,b=[3,5]", "--initial", "y=1"}));
  const Result twice = hamgen({"run", model, "--set", "a=1,a=2"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_TRUE(contains(twice.err, "a is set twice")) << twice.err;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--set", "a=1,"},
                                                {"--initial", "x=1,,y=2"},
                                                {"--fold", ",a"},
                                                {"--keep", "x,"},
                                                {"--until", "x < 0,"}}) {
    const Result empty = hamgen({"run", model, words[0], words[1]});
    EXPECT_EQ(empty.status, 2);
    EXPECT_TRUE(contains(empty.err, words[0] + " " + words[1] + ": nothing stands beside a comma"))
        << empty.err;
  }
}

// A time is as many whole steps as it has room for, in every command.
TEST(Options, OfLengthAgree) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", model, "--interpret"},
        std::vector<std::string>{"verify", model, "--scene", "swing"},
        std::vector<std::string>{"tune", model},
        std::vector<std::string>{"stress", model, "--vary", "eps=1:2:2,scale=1:2:2"},
        std::vector<std::string>{"section", model}, std::vector<std::string>{"chaos", model},
        std::vector<std::string>{"bench", model}}) {
    std::vector<std::string> both = words;
    both.insert(both.end(), {"--time", "1", "--steps", "10"});
    const Result result = hamgen(both);
    EXPECT_EQ(result.status, 2) << words[0] << result.err;
    EXPECT_TRUE(contains(result.err, "both say how long")) << words[0] << result.err;
  }
  const Result time = hamgen({"stress", model, "--time", "1"});
  EXPECT_EQ(time.status, 2);
  EXPECT_TRUE(contains(time.err, "h is an axis")) << time.err;
}

// What is no length at all is said, not run.
TEST(Options, OfLengthHaveRoomForAStep) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  for (const char* command : {"run", "chaos", "certify", "section"}) {
    const Result result = hamgen({command, model, "--h", "0.1", "--time", "0.01"});
    EXPECT_EQ(result.status, 2) << command << result.err;
    EXPECT_TRUE(contains(result.err, "--time 0.01: less than a step of h = 0.1")) << result.err;
  }
}

// Where a directory is meant, the name of a file is a slip; a directory above a name that is not
// there is made, and said.
TEST(Options, OfOutputTellFilesFromDirectories) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"generate", "galaxy.txt"},
                                                {"report", "page.html"},
                                                {"bench", "table.txt"},
                                                {"stress", "map.dat"},
                                                {"plugin", "plugin.cpp"}}) {
    const Result result = hamgen({words[0], model, "-o", words[1]}, {}, scratch.path("."));
    EXPECT_EQ(result.status, 2) << words[0] << result.err;
    EXPECT_TRUE(contains(result.err, "help: for a directory of that name: -o " + words[1] + "/"))
        << result.err;
  }
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"m.ham"}));
  const Result run = hamgen({"run", model, "--interpret", "--steps", "1", "-o", "a/b/x.csv"}, {},
                            scratch.path("."));
  EXPECT_TRUE(run.err.starts_with("a/ (a new directory)\n")) << run.err;
  EXPECT_TRUE(std::filesystem::exists(scratch.path("a/b/x.csv"))) << run.err;
  const Result emitted = hamgen({"generate", model, "-o", "d.d/"}, {}, scratch.path("."));
  EXPECT_EQ(emitted.err, "d.d/m.hpp\n");
}

// The command that a run of a model without scenes says it can be emitted with.
TEST(Options, OfAnEmittedHeaderAreAcceptedWithoutAScene) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", two_oscillators);
  const Result run =
      hamgen({"run", model, "--initial", "x=1", "--h", "0.1", "--steps", "1", "--interpret"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::size_t begin = run.err.find("hamgen generate ");
  ASSERT_NE(begin, std::string::npos) << run.err;
  const Result emitted = shell(run.err.substr(begin, run.err.find('\n', begin) - begin));
  EXPECT_EQ(emitted.status, 0) << emitted.err;
  EXPECT_TRUE(contains(emitted.out, "y, py: they start at 0")) << emitted.out.substr(0, 2000);
}

// Every command that reads a model reads it from standard input, once.
TEST(Options, ADashIsStandardInput) {
  const Scratch scratch;
  scratch.write("m.ham", pendulum);
  for (const char* command : {"check -", "show -", "generate -", "run - --interpret", "verify -",
                              "chaos - --steps 9", "list schemes --for -"}) {
    const Result result = shell(std::string("hamgen ") + command + " < m.ham", scratch.path("."));
    EXPECT_EQ(result.status, 0) << command << '\n' << result.err;
  }
}

// What is in the cache is other people's text: shown, and nothing else.
TEST(CacheList, SaysWhatEachEntryIs) {
  const Scratch scratch;
  std::filesystem::permissions(scratch.path("."), std::filesystem::perms::owner_all);
  const std::vector<std::string> environment = {"HAMGEN_CACHE=" + scratch.path("cache")};
  const runtime::Cache cache = runtime::open_cache(scratch.path("cache"));
  ASSERT_TRUE(cache.usable()) << cache.problem;
  const std::string known(64, 'a');
  const std::string old(64, 'b');
  scratch.write("cache/" + known + ".so", "object");
  scratch.write("cache/" + old + ".so", "object");
  runtime::publish_record(cache, known,
                          {.model = "mine\x1b[2J", .scheme = std::string(200, 's'), .made = {}});
  const Result list = hamgen({"cache"}, environment);
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_TRUE(contains(list.out, "aaaaaaaaaaaa  mine<U+001B>[2J, sss")) << list.out;
  EXPECT_TRUE(contains(list.out, "bbbbbbbbbbbb  no record of what it is")) << list.out;
  for (const std::string& line : lines(list.out)) {
    if (line.starts_with("a") || line.starts_with("b")) {
      EXPECT_LE(line.size(), 100u) << line;
    }
  }
  const Result json = hamgen({"cache", "--json"}, environment);
  EXPECT_TRUE(contains(json.out, "\"model\": \"mine\\u001b[2J\"")) << json.out;
  EXPECT_TRUE(contains(json.out, "\"model\": null")) << json.out;
  EXPECT_EQ(hamgen({"cache", "clear", "--json"}, environment).status, 2);
  EXPECT_EQ(hamgen({"cache", "clear"}, environment).out, "removed 2 files, 0.0 kB\n");
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("cache")));
}

// What is wrong in an option is no mistake of the model, whichever command has it.
TEST(Options, ThatAreWrongAreWrongUsage) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run", model, "--h", "foo"},
                                             {"run", model, "--alpha", "foo"},
                                             {"check", model, "--beta", "1 +"},
                                             {"bench", model, "--time", "foo"},
                                             {"bench", model, "--target", "1e-"}}) {
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << words[2] << ": " << result.err;
    EXPECT_TRUE(result.err.starts_with("hamgen: " + words[2])) << result.err;
  }
  EXPECT_EQ(hamgen({"check", scratch.write("wrong.ham", "system")}).status, 3);
}

TEST(Options, NameAHeaderByItsLanguage) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const auto text = [&](const std::string& format) {
    const Result result = hamgen({"generate", model, "--format", format});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  EXPECT_EQ(text("c"), text("c-header"));
  EXPECT_EQ(text("cpp"), text("cpp-header"));
  EXPECT_EQ(hamgen({"verify", model, "--format", "c"}).status, 0);
  EXPECT_EQ(hamgen({"generate", model, "--format", "header"}).status, 2);
}

}  // namespace
}  // namespace hamgen::app_test
