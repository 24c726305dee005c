// The compiler of a run, and the cache of what it compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

TEST(Run, RefusesCompilersThatChangeTheArithmetic) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const std::string flag : {"-ffast-math", "-Ofast", "-fassociative-math", "@flags"}) {
    const Result option = hamgen({"run", model, "--compiler", "g++ " + flag});
    EXPECT_EQ(option.status, 2) << option.err;
    EXPECT_TRUE(contains(option.err, "--compiler: ") && contains(option.err, "'" + flag + "'"))
        << option.err;
    for (const std::string command : {"run", "bench", "stress", "tune"}) {
      const Result variable = hamgen({command, model}, {"CXX=g++ " + flag});
      EXPECT_EQ(variable.status, 2) << command << variable.err;
      EXPECT_TRUE(contains(variable.err, "$CXX: ")) << variable.err;
    }
  }
}

TEST(Run, RefusesFlagsThatChangeTheArithmeticToo) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"run", model, "--flags=-O2 -ffast-math"});
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_TRUE(contains(result.err, "--flags: ") && contains(result.err, "'-ffast-math'"))
      << result.err;
  EXPECT_EQ(hamgen({"run", model, "--interpret", "--portable"}).status, 2);
}

// The same steps, however much the optimiser did.
TEST(Run, AsksTheCompilerForWhatTheNumberOfStepsRepays) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const auto state_with = [&](const std::string& optimisation, const std::string& cache,
                              const std::vector<std::string>& options) {
    std::vector<std::string> words = {"run", model, "--json"};
    words.insert(words.end(), options.begin(), options.end());
    const Result result = hamgen(words, {"HAMGEN_CACHE=" + scratch.path(cache), "CXX=g++"});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto found = nlohmann::json::parse(result.out);
    EXPECT_EQ(found["time"]["optimisation"], optimisation) << result.out;
    return found["state"];
  };
  const auto few = state_with("-O0", "one", {"--steps", "1000"});
  EXPECT_EQ(state_with("-O2", "one", {"--steps", "1000", "--flags=-O2"}), few);
  static_cast<void>(state_with("-O1", "one", {"--steps", "100000"}));
  static_cast<void>(state_with("-O3", "one", {"--steps", "4000000"}));
  EXPECT_EQ(state_with("-O3", "one", {"--steps", "1000"}), few);
  static_cast<void>(state_with("-O1", "two", {"--steps", "4000", "--scheme", "gauss-4"}));
  static_cast<void>(state_with("-O2", "two", {"--steps", "400000", "--scheme", "gauss-4"}));
}

// All steps of all orbits count.
TEST(Studies, AskTheCompilerForLittleWhereStepsAreFew) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string words = scratch.path("words");
  const std::string compiler =
      scratch.write("compiler", "#!/bin/sh\nfor word; do case $word in -O*) echo $word >>" + words +
                                    ";; esac; done\nexec g++ \"$@\"\n");
  std::filesystem::permissions(compiler, std::filesystem::perms::owner_all);
  const auto asked_by = [&](const std::vector<std::string>& command, const std::string& steps) {
    const std::string of =
        command[0] == "section" ? HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham" : model;
    std::vector<std::string> all = {command.front(), of, "--steps", steps};
    if (steps.empty()) all = {command.front(), scratch.path("own.ham")};
    all.insert(all.end(), command.begin() + 1, command.end());
    std::filesystem::remove(words);
    const Result result = hamgen(
        all, {"HAMGEN_CACHE=" + scratch.path("cache" + command[0] + steps), "CXX=" + compiler});
    EXPECT_EQ(result.status, 0) << command.front() << result.err;
    return read(words);
  };
  EXPECT_EQ(asked_by({"certify"}, "10"), "-O0\n");
  EXPECT_EQ(asked_by({"chaos"}, "100"), "-O0\n");
  EXPECT_EQ(asked_by({"section", "--orbits", "0"}, "1000"), "-O0\n");
  const std::string table = scratch.path("table.csv");
  EXPECT_EQ(asked_by({"ensemble", "-o", table, "--over", "q=0:1:10"}, "100"), "-O0\n");
  EXPECT_EQ(asked_by({"ensemble", "-o", table, "--over", "q=0:1:1000"}, "100"), "-O1\n");
  // Each may have a number of its own.
  std::string own(pendulum);
  own.replace(own.find("steps = 1000"), 12, "steps = 1000*eps");
  static_cast<void>(scratch.write("own.ham", own));
  EXPECT_EQ(asked_by({"ensemble", "-o", table, "--over", "eps=0.01:0.03:3"}, ""), "-O3\n");
  EXPECT_EQ(asked_by({"ensemble", "-o", table, "--over", "q=0:1:3"}, "10*2"), "-O0\n");
  EXPECT_EQ(asked_by({"ensemble", "-o", table, "--over", "eps=1:2:2"}, "100*eps"), "-O3\n");
  EXPECT_EQ(asked_by({"chaos", "--over", "eps=1:2:2"}, "100*eps"), "-O3\n");
  EXPECT_EQ(asked_by({"stress", "--vary", "h=0.1:1:4", "--reference-seconds", "0"}, "100"),
            "-O0\n");
}

// The level that a run asks a compiler for, which says it and compiles nothing.
std::string level_asked_for(const std::string& text, std::vector<std::string> options) {
  const Scratch scratch;
  options.insert(options.begin(), {"run", scratch.write("model.ham", text)});
  const std::string words = scratch.path("words");
  const std::string compiler = scratch.write(
      "compiler",
      "#!/bin/sh\nfor word; do case $word in --version) exec g++ --version;; -O*) echo "
      "$word >>" +
          words + ";; esac; done\nexit 1\n");
  std::filesystem::permissions(compiler, std::filesystem::perms::owner_all);
  const Result result =
      hamgen(options, {"HAMGEN_CACHE=" + scratch.path("cache"), "CXX=" + compiler});
  EXPECT_EQ(result.status, 4) << result.err;
  return read(words);
}

// Of a long text, which takes the optimiser long, more steps have to repay it.
TEST(Run, AsksTheCompilerForLittleWhereTheTextIsLong) {
  const std::string model =
      "system long\nsize N = 14\ncoordinate q[1..N]\nmomentum p[1..N]\n"
      "let A = sum(i = 1..N, p[i])\nlet B = sum(i = 1..N, q[i]^2)\n"
      "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/2) + A*B/N + sum(i = 1..N, q[i]*p[i])^2/50"
      " + sum(i = 1..N, i*q[i])*sum(i = 2..N-1, p[i]*q[i+1])/1000\n"
      "scene s { q[i] = sin(i)/3; p[i] = cos(2*i)/4; h = 0.02; steps = 3 }\n";
  EXPECT_EQ(level_asked_for(model, {"--steps", "3"}), "-O0\n");
  EXPECT_EQ(level_asked_for(model, {"--steps", "300"}), "-O0\n");
  EXPECT_EQ(level_asked_for(model, {"--steps", "20000"}), "-O1\n");
}

// Loops are compiled sooner than a text that is written out and as long.
TEST(Run, AsksTheCompilerForMoreWhereTheTextIsLoops) {
  const std::string model =
      "system ring\nsize N = 100\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)\n"
      "scene s { q[i] = sin(i)/3; h = 0.02; steps = 3 }\n";
  for (const auto& [steps, level] :
       std::map<std::string, std::string>{{"30", "-O0\n"}, {"5000", "-O1\n"}, {"200000", "-O3\n"}})
    EXPECT_EQ(level_asked_for(model, {"--order", "4", "--steps", steps}), level) << steps;
}

// The same steps, in an object of their own.
TEST(Run, CompilesForThisProcessorUnlessItIsPortable) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::vector<std::string> run = {"run", model, "--steps", "100", "--quiet", "-o", "-"};
  const std::vector<std::string> cache = {"HAMGEN_CACHE=" + scratch.path("cache")};
  const auto with = [&](const std::string& option) {
    std::vector<std::string> words = run;
    if (!option.empty()) words.push_back(option);
    const Result result = hamgen(words, cache);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out.substr(result.out.find("\nstep,"));
  };
  const std::string native = with("");
  EXPECT_EQ(with("--portable"), native);
  EXPECT_EQ(with(""), native);
  const auto objects =
      std::ranges::count_if(std::filesystem::directory_iterator(scratch.path("cache")),
                            [](const auto& entry) { return entry.path().extension() == ".so"; });
#if defined(__x86_64__)
  EXPECT_EQ(objects, 2);
#else
  EXPECT_EQ(objects, 1);
#endif
}

// Where g++ 12 sums two products side by side it leaves one of them unrounded, if the processor
// can.
TEST(Run, RoundsEveryProductWhateverTheProcessor) {
  const Scratch scratch;
  const std::string model = scratch.write(
      "chain.ham",
      "system chain\nsize N = 6\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
      "momentum p[1..N]\nH = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, 1.3*(q[i+1] - q[i])^2/2)\n"
      "scene wave {\n  q[i] = sin(i)\n  p[i] = cos(i)\n  h = 1\n  steps = 1000\n}\n");
  const auto states = [&](const std::string& option) {
    const Result result =
        hamgen({"run", model, "--quiet", "-o", "-", "--every", "100", "--flags=-O3", option});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out.substr(result.out.find("\nstep,"));
  };
  EXPECT_EQ(states("--portable"), states("--compiler=g++"));
}

#if defined(__x86_64__)
// Eigen is no text where the compiler has registers of 512 bits and no fused products.  A plugin
// with Eigen has neither, and runs where the one is missing, too.
TEST(Run, CompilesMatricesForProcessorsWithLongRegisters) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  const Scratch scratch;
  const std::string model = scratch.write(
      "chain.ham",
      "system chain\nsize N = 25\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, cosh(q[i+1] - q[i]))\n"
      "scene wave {\n  q[i] = sin(i)\n  h = 0.1\n  steps = 10\n}\n");
  // A weight of each coordinate: written out, with a matrix that Eigen eliminates.
  std::string weights = "--alpha=[1/2";
  for (int i = 1; i < 25; ++i) weights += ", 1/2";
  weights += "]";
  const std::string header = scratch.path("chain.hpp");
  ASSERT_EQ(hamgen({"generate", model, weights, "-o", header}).status, 0);
  ASSERT_TRUE(contains(read(header), "#include <Eigen/"));
  const auto states = [&](const std::string& option) {
    const Result result =
        hamgen({"run", model, weights, "--quiet", "-o", "-", "--every", "1", option});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out.substr(std::min(result.out.size(), result.out.find("\nstep,")));
  };
  const std::string interpreted = states("--interpret");
  EXPECT_GT(interpreted.size(), 1000u);
  EXPECT_EQ(interpreted, states("--flags=-march=skylake-avx512"));
}
#endif

TEST(Run, FindsACompilerOutThatChangesTheArithmeticByItself) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string script = scratch.write("compiler", "#!/bin/sh\nexec g++ \"$@\" -ffast-math\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const Result result = hamgen({"run", model, "--compiler", script});
  EXPECT_EQ(result.status, 4);
  EXPECT_TRUE(contains(result.err, "compile without -ffast-math")) << result.err;
}

TEST(Run, NamesAMissingCompilerAndUsesNoShell) {
  const Scratch scratch;
  // A model of its own, so that the cache cannot help.
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result missing = hamgen({"run", model, "--compiler", "no-such-compiler"});
  EXPECT_EQ(missing.status, 4);
  EXPECT_TRUE(contains(missing.err, "no-such-compiler")) << missing.err;
  const Result shell = hamgen({"run", model}, {"CXX=g++; touch " + scratch.path("touched")});
  EXPECT_EQ(shell.status, 4);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham"}));
}

TEST(Run, GoesOnWithoutAUsableCache) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string file = scratch.write("file", "");
  const Result result = hamgen({"run", model, "--steps", "1"}, {"HAMGEN_CACHE=" + file});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "warning")) << result.err;
}

// A disk of its own for the cache, in a namespace of its own where the system has such.
Result with_cache_of(const std::string& size, const std::string& directory,
                     const std::vector<std::string>& words) {
  runtime::ProcessRequest request;
  request.command = {"unshare",
                     "-Urm",
                     "sh",
                     "-c",
                     "mount -t tmpfs -o mode=700,size=\"$1\" tmpfs \"$2\" || exit 99; "
                     "export HAMGEN_CACHE=\"$2\"; shift 2; exec \"$@\"",
                     "sh",
                     size,
                     directory,
                     HAMGEN_EXECUTABLE};
  request.command.insert(request.command.end(), words.begin(), words.end());
  const runtime::ProcessResult result = runtime::run_process(request);
  return {.status = result.code, .out = "", .err = result.output};
}

Result run_with_cache_of(const std::string& size, const std::string& model,
                         const std::string& directory) {
  return with_cache_of(size, directory, {"run", model, "--steps", "10"});
}

TEST(Run, GoesOnWithAFullOrNearlyFullCacheDisk) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string directory = scratch.path("disk");
  std::filesystem::create_directory(directory);
  if (run_with_cache_of("64m", model, directory).status != 0)
    GTEST_SKIP() << "no disk can be mounted here";
  int warnings = 0;
  for (const std::string size :
       {"4k", "20k", "24k", "32k", "40k", "48k", "56k", "64k", "72k", "128k"}) {
    const Result result = run_with_cache_of(size, model, directory);
    EXPECT_EQ(result.status, 0) << size << '\n' << result.err;
    warnings += contains(result.err, "warning: ") ? 1 : 0;
  }
  EXPECT_GE(warnings, 4);
  // The reference of `bench` finds no room either.
  const Result bench = with_cache_of("4k", directory,
                                     {"bench", model, "--schemes", "stormer-verlet", "--rounds",
                                      "1", "--h", "0.1", "--steps", "10"});
  EXPECT_EQ(bench.status, 0) << bench.err;
  EXPECT_TRUE(contains(bench.err, "time for a state error")) << bench.err;
}

TEST(Cache, ListsAndClears) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::vector<std::string> own = {"HAMGEN_CACHE=" + scratch.path("cache")};
  ASSERT_EQ(hamgen({"run", model, "--steps", "1"}, own).status, 0);
  const Result listed = hamgen({"cache"}, own);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.out, "1 compiled integrator,")) << listed.out;
  EXPECT_TRUE(contains(listed.out, "  pendulum, implicit-midpoint  ")) << listed.out;
  EXPECT_EQ(hamgen({"cache", "prune"}, own).status, 0);
  EXPECT_EQ(hamgen({"cache", "clear"}, own).status, 0);
  EXPECT_TRUE(contains(hamgen({"cache", "list"}, own).out, "0 compiled integrators,"));
}

}  // namespace
}  // namespace hamgen::app_test
