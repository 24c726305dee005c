// Steps that become slower are noticed by the instructions they take, on any machine.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string_view>

#include "runtime/process.hpp"
#include "runtime/tool_error.hpp"
#include "tests/instructions/count_table.hpp"
#include "tests/instructions/counted_steps.hpp"

namespace hamgen::instructions {
namespace {

const std::string kCounts = HAMGEN_SOURCE_DIR "/tests/instructions/counts.txt";
const std::string kHowToWrite =
    "HAMGEN_COUNT_INSTRUCTIONS=write build/release/tests/instructions_test";

bool writes() {
  const char* asked = std::getenv("HAMGEN_COUNT_INSTRUCTIONS");
  return asked != nullptr && std::string_view(asked) == "write";
}

// "g++ 12.2.0"; empty if there is no such compiler.
std::string with_version(const std::string& compiler) {
  try {
    const std::string ask = compiler == "g++" ? "-dumpfullversion" : "-dumpversion";
    const runtime::ProcessResult result = runtime::run_process({.command = {compiler, ask}});
    return compiler + " " + result.output.substr(0, result.output.find('\n'));
  } catch (const runtime::ToolError&) {
    return "";
  }
}

std::string lines(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + '\n';
  return all;
}

// One program holds all of them, and one that takes a few instructions more than its row.
void expect_counts(const std::string& compiler) {
#ifndef __x86_64__
  GTEST_SKIP() << "instructions are counted of x86-64 alone";
#endif
  const std::string version = with_version(compiler);
  if (version.empty()) GTEST_SKIP() << "no " << compiler << " here";
  CountTable table = read_table(kCounts);
  if (!table.contains(version) && !writes()) {
    GTEST_SKIP() << "tests/instructions/counts.txt has no rows of " << version
                 << "; this adds them: " << kHowToWrite;
  }
  std::vector<EmittedStep> steps;
  for (const CountedStep& step : main_steps()) steps.push_back(emitted_step(step));
  CountedStep first = main_steps().front();
  const std::string name = first.name;
  first.name = "slower " + name;
  constexpr int kMore = 24;
  steps.push_back(slower(emitted_step(first), kMore));

  Counts counted = count_instructions(steps, compiler);
  const double slower_count = counted.extract(first.name).mapped();
  if (writes()) {
    table[version] = counted;
    write_table(kCounts, table);
  }
  EXPECT_EQ(lines(differences(counted, table.at(version))), "")
      << version << ".  Is that meant?  Then this writes the new counts: " << kHowToWrite;

  // Compiled beside other code, a step may need half an instruction less.
  EXPECT_GE(slower_count, counted.at(name) + kMore - 1);
  Counts with_slower = counted;
  with_slower[name] = slower_count;
  const std::vector<std::string> noticed = differences(with_slower, table.at(version));
  ASSERT_EQ(noticed.size(), 1u) << lines(noticed);
  EXPECT_TRUE(noticed[0].starts_with(name + ": ")) << noticed[0];
}

TEST(Instructions, OfMainStepsByGccAreThoseOfTheFile) { expect_counts("g++"); }

TEST(Instructions, OfMainStepsByClangAreThoseOfTheFile) { expect_counts("clang++"); }

TEST(Instructions, DifferFromThreePartsInAHundredOn) {
  const Counts rows = {{"a", 1000}, {"b", 200}};
  EXPECT_EQ(differences({{"a", 1029}, {"b", 200}}, rows), std::vector<std::string>{});
  EXPECT_EQ(differences({{"a", 1031}, {"b", 200}}, rows),
            std::vector<std::string>{"a: 1031 instructions a step instead of 1000, +3.1 %"});
  EXPECT_EQ(differences({{"a", 960}, {"b", 200}}, rows),
            std::vector<std::string>{"a: 960 instructions a step instead of 1000, -4.0 %"});
  EXPECT_EQ(differences({{"a", 1000}, {"c", 3}}, rows),
            (std::vector<std::string>{"b: is not counted", "c: has no row"}));
}

}  // namespace
}  // namespace hamgen::instructions
