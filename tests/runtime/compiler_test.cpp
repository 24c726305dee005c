#include "runtime/compiler.hpp"

#include <gtest/gtest.h>

#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::Environment;
using tests::script;
using tests::text_of;
using tests::write_text;

class CompilerTest : public testing::Test {
 protected:
  // What compile_sources throws with this script as the compiler.
  ToolFailure failure_with(const std::string& body, std::chrono::milliseconds limit) {
    const Compiler compiler = find_compiler(script(directory_.path() / "compiler", body));
    const fs::path build = directory_.path() / "build";
    fs::create_directory(build);
    write_sources(tests::oscillator(), build);
    try {
      (void)compile_sources(tests::oscillator(), compiler, {.time_limit = limit}, build);
    } catch (const ToolError& error) {
      return error.failure();
    }
    ADD_FAILURE() << "compiled";
    return {};
  }

  std::string message_for(const std::optional<std::string>& choice) {
    try {
      (void)find_compiler(choice);
    } catch (const ToolError& error) {
      return error.what();
    }
    return "found";
  }

  TemporaryDirectory directory_ = private_directory();
};

TEST_F(CompilerTest, IsTheExplicitChoiceThenTheVariableThenGcc) {
  const std::string mine = script(directory_.path() / "mine", "exit 0");
  const std::string other = script(directory_.path() / "other", "exit 0");
  {
    const Environment variable("CXX", other + "  -m64");
    EXPECT_EQ(find_compiler(mine).command, std::vector<std::string>{mine});
    EXPECT_EQ(find_compiler(mine).chosen_by, "--compiler");
    EXPECT_EQ(find_compiler().command, (std::vector<std::string>{other, "-m64"}));
    EXPECT_EQ(find_compiler().chosen_by, "$CXX");
  }
  script(directory_.path() / "clang++", "exit 0");
  const Environment path("PATH", directory_.path().string());
  for (const std::optional<std::string>& unset :
       {std::optional<std::string>(), std::optional<std::string>("  ")}) {
    const Environment variable("CXX", unset);
    EXPECT_EQ(find_compiler().command.front(), directory_.path() / "clang++");
  }
  script(directory_.path() / "g++", "exit 0");
  const Environment variable("CXX", std::nullopt);
  EXPECT_EQ(find_compiler().command.front(), directory_.path() / "g++");
}

TEST_F(CompilerTest, MayHaveASpaceInItsPath) {
  const std::string mine = script(directory_.path() / "my compiler", "exit 0");
  EXPECT_EQ(find_compiler(mine).command, std::vector<std::string>{mine});
}

TEST_F(CompilerTest, ThatIsMissingIsNamedAndNotReplaced) {
  EXPECT_EQ(message_for("no-such-compiler -O3"),
            "the C++ compiler 'no-such-compiler' named by --compiler was not found, or is not an "
            "executable file\n"
            "help: name one with --compiler or CXX, such as CXX=g++; on Debian: apt install g++");
  EXPECT_NE(message_for("").find("the C++ compiler '' named by --compiler"), std::string::npos);
  const Environment path("PATH", directory_.path().string());
  const Environment variable("CXX", std::nullopt);
  EXPECT_EQ(message_for({}),
            "no C++ compiler was found: neither g++ nor clang++ is in PATH\n"
            "help: on Debian: apt install g++; or name one with --compiler or CXX; `hamgen run "
            "--interpret` needs none");
}

TEST_F(CompilerTest, InTheVariableIsNeverSeenByAShell) {
  const fs::path victim = directory_.path() / "x";
  write_text(victim, "precious");
  const Environment variable("CXX", "g++; rm " + victim.string());
  EXPECT_NE(message_for({}).find("the C++ compiler 'g++;' named by $CXX was not found"),
            std::string::npos)
      << message_for({});
  EXPECT_EQ(text_of(victim), "precious");
}

TEST_F(CompilerTest, ChangesItsIdentityWhenTheFileChanges) {
  const fs::path mine = script(directory_.path() / "mine", "exit 0");
  const std::string wrapped = "env " + mine.string();
  const std::string before = find_compiler(mine).identity;
  const std::string before_wrapped = find_compiler(wrapped).identity;
  EXPECT_EQ(find_compiler(mine).identity, before);
  script(mine, "exit 00");
  EXPECT_NE(find_compiler(mine).identity, before);
  EXPECT_NE(find_compiler(wrapped).identity, before_wrapped);
}

TEST_F(CompilerTest, ThatHangsIsEndedAtTheTimeLimit) {
  const ToolFailure failure = failure_with("sleep 3600", std::chrono::seconds(1));
  EXPECT_TRUE(failure.message.starts_with(
      "the compiler did not make the integrator: not finished after 1 s\nhelp: `hamgen run "))
      << failure.message;
  EXPECT_FALSE(failure.exit_status.has_value());
}

TEST_F(CompilerTest, ThatCrashesIsSaidToHaveCrashed) {
  const ToolFailure failure =
      failure_with("echo internal compiler error >&2; kill -SEGV $$", std::chrono::seconds(60));
  EXPECT_EQ(failure.message,
            "the compiler did not make the integrator: killed by signal 11 (Segmentation fault)");
  EXPECT_EQ(failure.output_tail, "internal compiler error\n");
}

TEST_F(CompilerTest, ThatMakesNothingIsAFailureToo) {
  EXPECT_EQ(failure_with("exit 0", std::chrono::seconds(60)).message,
            "the compiler did not make the integrator: exit status 0, but no object file");
}

// As linkers do on a full disk.
TEST_F(CompilerTest, ThatMakesHalfAnObjectIsAFailureToo) {
  EXPECT_EQ(failure_with("printf '\\177ELF' > plugin.so", std::chrono::seconds(60)).message,
            "the compiler did not make the integrator: exit status 0, but of the object file: it "
            "is cut off");
}

TEST_F(CompilerTest, LeavesTheEndOfItsOutputInTheError) {
  const ToolFailure failure =
      failure_with("i=0; while [ $i -lt 100 ]; do i=$((i + 1)); echo line $i; done; exit 3",
                   std::chrono::seconds(60));
  EXPECT_EQ(failure.exit_status, 3);
  EXPECT_TRUE(failure.output_tail.starts_with("line 81\n")) << failure.output_tail;
  EXPECT_TRUE(failure.output_tail.ends_with("line 100\n"));
  EXPECT_TRUE(failure.command.ends_with(
      "/compiler -o plugin.so plugin.cpp -Wl,--version-script=exports.map " +
      command_text(compile_flags({}, {}, {})) + " -nodefaultlibs -lm -lgcc"))
      << failure.command;
}

TEST_F(CompilerTest, ShowsAMistakeWithTheNameOfTheSource) {
  PluginSource source{.text = "int f() { return missing; }\n", .name = "pendulum.plugin.cpp"};
  write_sources(source, directory_.path());
  try {
    (void)compile_sources(source, find_compiler(), {}, directory_.path());
    FAIL();
  } catch (const ToolError& error) {
    EXPECT_NE(error.failure().output_tail.find("pendulum.plugin.cpp:1:18: error:"),
              std::string::npos)
        << error.what();
    EXPECT_EQ(error.failure().exit_status, 1);
  }
}

TEST(CompileFlags, NeverIncludeFastMath) {
  for (const std::string flag : {"-ffast-math", "-Ofast", "@flags"}) {
    EXPECT_THROW((void)compile_flags({}, {}, {.extra_flags = {flag}}), ToolError) << flag;
  }
  const std::string flags = command_text(compile_flags({}, {}, {.extra_flags = {"-march=native"}}));
  EXPECT_EQ(flags.find("fast"), std::string::npos) << flags;
  EXPECT_NE(flags.find("-ffp-contract=off"), std::string::npos) << flags;
  EXPECT_TRUE(flags.ends_with(" -march=native")) << flags;
}

TEST(CompileFlags, LeaveTheOptimisationToWhoAsksForOne) {
  const auto flags = [](const std::vector<std::string>& arguments, const CompileOptions& options) {
    Compiler compiler{.command = {"/usr/bin/g++"}, .identity = "", .chosen_by = ""};
    compiler.command.insert(compiler.command.end(), arguments.begin(), arguments.end());
    return command_text(compile_flags({}, compiler, options));
  };
  EXPECT_NE(flags({"-g"}, {}).find(" -O3 "), std::string::npos);
  EXPECT_NE(flags({"-g"}, {.optimisation = "-O1"}).find(" -O1 "), std::string::npos);
  EXPECT_EQ(flags({"-g"}, {.optimisation = "-O1"}).find("-O3"), std::string::npos);
  for (const std::string own : {"-O", "-O0", "-O2", "-Os", "--optimize=2"})
    EXPECT_EQ(flags({own}, {}).find("-O"), std::string::npos) << own;
}

TEST(CompileFlags, NameEigenAndQuadmathWhenTheyAreUsed) {
  const std::vector<std::string> flags = compile_flags({.uses_eigen = true, .uses_quadmath = true},
                                                       {}, {.eigen_include = "/opt/eigen"});
  ASSERT_GE(flags.size(), 3u);
  EXPECT_EQ(std::vector<std::string>(flags.end() - 3, flags.end()),
            (std::vector<std::string>{"-isystem", "/opt/eigen", "-lquadmath"}));
}

TEST(WriteSources, AcceptsPlainNamesOnly) {
  const TemporaryDirectory directory = private_directory();
  for (const std::string name : {"../x.cpp", "", "-o", ".x", "plugin.h", "a/b.cpp", "plugin.so"}) {
    EXPECT_THROW(write_sources({.text = "", .name = name}, directory.path()), std::invalid_argument)
        << name;
  }
  EXPECT_EQ(tests::count_entries(directory.path()), 0u);
}

// No compiler of C++ starts in 32 MB.
TEST(CompileSources, LimitsTheMemoryOfTheCompiler) {
  const PluginSource source = tests::oscillator();
  const TemporaryDirectory directory = private_directory();
  write_sources(source, directory.path());
  EXPECT_NO_THROW((void)compile_sources(source, find_compiler(), {}, directory.path()));
  EXPECT_THROW(
      (void)compile_sources(source, find_compiler(), {.memory_limit = 32 << 20}, directory.path()),
      ToolError);
}

}  // namespace
}  // namespace hamgen::runtime
