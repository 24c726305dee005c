#include "runtime/arithmetic.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "runtime/load_plugin.hpp"
#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::oscillator;
using tests::script;

std::string reason(const std::vector<std::string>& flags) {
  return refused_flag(flags).value_or("accepted");
}

TEST(RefusedFlags, AreThoseThatChangeWhatTheArithmeticMeans) {
  for (const std::string flag :
       {"-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math",
        "-freciprocal-math", "-ffinite-math-only", "-fno-signed-zeros", "-fno-honor-nans",
        "-ffp-model=fast", "-fsingle-precision-constant", "-mfpmath=387", "-mfpmath=sse+387",
        "-mno-sse2", "-mpc64", "-mdaz-ftz", "-fdenormal-fp-math=preserve-sign,preserve-sign",
        "-fdenormal-fp-math-f32=positive-zero", "-menable-unsafe-fp-math"}) {
    const std::string said = reason({"-m64", flag, "-O3"});
    EXPECT_NE(said.find("'" + flag + "'"), std::string::npos) << said;
    EXPECT_NE(said.find("\nhelp: leave it out"), std::string::npos) << said;
  }
}

TEST(RefusedFlags, AreNoneOfThoseThatDoNot) {
  for (const std::string flag :
       {"-O3", "-O2", "-march=native", "-m64", "-fno-trapping-math", "-fno-math-errno",
        "-frounding-math", "-fno-rounding-math", "-ffp-contract=fast", "-fcx-limited-range",
        "-fno-fast-math", "-mfpmath=sse", "-fexcess-precision=fast", "-mrecip", "-ffp-model=strict",
        "-fdenormal-fp-math=ieee"})
    EXPECT_EQ(reason({flag}), "accepted") << flag;
}

TEST(RefusedFlags, MayNotHideInAFile) {
  const std::string said = reason({"@flags.txt"});
  EXPECT_NE(said.find("'@flags.txt'"), std::string::npos) << said;
  EXPECT_NE(said.find("write out the flags"), std::string::npos) << said;
}

class FastCompiler : public testing::Test {
 protected:
  // What loading the oscillator says with this compiler.
  std::string failure(const Compiler& compiler) {
    const Cache none{.directory = {}, .problem = "no cache"};
    try {
      (void)load_plugin(oscillator(), compiler, {}, none);
    } catch (const ToolError& error) {
      return error.what();
    }
    return "loaded";
  }
  // A compiler that adds flags nobody sees.
  std::string failure_behind_script(const std::string& program, const std::string& flags) {
    return failure(find_compiler(
        script(directory_.path() / "compiler", "exec " + program + " \"$@\" " + flags)));
  }
  TemporaryDirectory directory_ = private_directory();
};

TEST_F(FastCompiler, IsRefusedByItsArguments) {
  const std::string said = failure(find_compiler("g++ -ffast-math"));
  EXPECT_NE(said.find("'-ffast-math' is refused"), std::string::npos) << said;
  EXPECT_EQ(failure(find_compiler("g++ -fno-trapping-math")), "loaded");
}

TEST_F(FastCompiler, BehindAScriptIsFoundOutAndTheProcessKeepsItsArithmetic) {
  EXPECT_EQ(failure_behind_script("g++", "-O2"), "loaded");
  for (const std::string flags : {"-ffast-math", "-Ofast", "-funsafe-math-optimizations"}) {
    const std::string said = failure_behind_script("g++", flags);
    EXPECT_NE(said.find("makes subnormal numbers zero"), std::string::npos) << flags << said;
    EXPECT_TRUE(environment_is_ieee()) << flags;
  }
}

TEST_F(FastCompiler, WhoseObjectsLeaveTheEnvironmentAloneIsFoundOutToo) {
  const std::string entry = "return &plugin;";
  for (const std::string program : {"g++", "clang++"}) {
    try {
      (void)find_compiler(program);
    } catch (const ToolError&) {
      continue;  // not there
    }
    PluginSource source = oscillator();
    source.text.replace(source.text.find(entry), entry.size(),
                        "return hamgen_arithmetic_is_ieee() ? &plugin : nullptr;");
    const auto said = [&](const std::string& flags) -> std::string {
      try {
        (void)load_plugin(source,
                          find_compiler(script(directory_.path() / "compiler",
                                               "exec " + program + " \"$@\" " + flags)),
                          {}, {.directory = {}, .problem = "no cache"});
      } catch (const ToolError& error) {
        return error.what();
      }
      return "loaded";
    };
    EXPECT_EQ(said("-fno-trapping-math"), "loaded") << program;
    for (const std::string flags :
         {"-fassociative-math -fno-signed-zeros -fno-trapping-math", "-ffinite-math-only"})
      EXPECT_NE(said(flags).find("compiled with flags that change"), std::string::npos)
          << program << flags << said(flags);
    if (program == "g++") continue;  // g++ has macros for these: see header_test
    for (const std::string flags : {"-freciprocal-math", "-fno-signed-zeros", "-fno-honor-nans"})
      EXPECT_NE(said(flags).find("compiled with flags that change"), std::string::npos)
          << flags << said(flags);
  }
}

TEST(Environment, OfAThreadThatDoesNotRoundToNearestRefusesPlugins) {
  const KeptEnvironment kept;
  ASSERT_TRUE(environment_is_ieee());
  const TemporaryDirectory build = private_directory();
  write_sources(oscillator(), build.path());
  const fs::path object = compile_sources(oscillator(), find_compiler(), {}, build.path());
  EXPECT_NO_THROW(Library{object});
  std::fesetround(FE_UPWARD);
  EXPECT_FALSE(environment_is_ieee());
  EXPECT_THROW(Library{object}, ToolError);
}

TEST(Environment, IsWhatItWasAfterItWasKept) {
  {
    const KeptEnvironment kept;
    std::fesetround(FE_UPWARD);
  }
  EXPECT_EQ(std::fegetround(), FE_TONEAREST);
}

}  // namespace
}  // namespace hamgen::runtime
