// Names of macros, functions and types of other headers, as names of a user's quantities.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "generator/language/read_model.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

// Macros, functions, types and variables of the headers a program may include, and what a plugin
// calls its own.
const std::vector<std::string> taken = {"linux",
                                        "unix",
                                        "complex",
                                        "I",
                                        "errno",
                                        "stdin",
                                        "stdout",
                                        "stderr",
                                        "M_PI",
                                        "M_PIf",
                                        "NAN",
                                        "INFINITY",
                                        "HUGE_VAL",
                                        "NULL",
                                        "EOF",
                                        "BUFSIZ",
                                        "EDOM",
                                        "SIGINT",
                                        "RAND_MAX",
                                        "R_OK",
                                        "P_tmpdir",
                                        "O_RDONLY",
                                        "DBL_MAX",
                                        "math_errhandling",
                                        "st_atime",
                                        "si_value",
                                        "sa_handler",
                                        "no_argument",
                                        "assert",
                                        "major",
                                        "minor",
                                        "makedev",
                                        "isnan",
                                        "signbit",
                                        "gamma",
                                        "lgamma",
                                        "tgamma",
                                        "j0",
                                        "j1",
                                        "jn",
                                        "y0",
                                        "y1",
                                        "yn",
                                        "erf",
                                        "hypot",
                                        "signgam",
                                        "div",
                                        "index",
                                        "time",
                                        "signal",
                                        "select",
                                        "read",
                                        "write",
                                        "link",
                                        "stat",
                                        "clock",
                                        "remove",
                                        "system",
                                        "environ",
                                        "timezone",
                                        "daylight",
                                        "optarg",
                                        "cosf",
                                        "cosl",
                                        "exp10",
                                        "int8_t",
                                        "size_t",
                                        "tm",
                                        "timespec",
                                        "std",
                                        "Eigen",
                                        "plugin",
                                        "create",
                                        "destroy",
                                        "advance",
                                        "get_state",
                                        "energy_of",
                                        "high_part",
                                        "read_state",
                                        "hamgen_run",
                                        "hamgen_plugin",
                                        "hamgen_plugin_entry",
                                        "HAMGEN_PLUGIN_VERSION",
                                        "cosq",
                                        "sqrtq",
                                        "fabsq",
                                        "pow",
                                        "sqrt",
                                        "fabs",
                                        "sin",
                                        "cos",
                                        "exp",
                                        "log",
                                        "abs"};

const std::string headers = R"(
#include <alloca.h>
#include <complex.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <fenv.h>
#include <getopt.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <search.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <wchar.h>
#include <algorithm>
#include <cerrno>
#include <cfloat>
#include <climits>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>
)";

// A model in which every name of the list has every part in turn.
std::string model_of(const std::vector<std::string>& names, std::size_t first) {
  const auto name = [&](std::size_t k) { return names[(first + k) % names.size()]; };
  const auto text = [&](const std::string& lines) {
    return fmt::format(fmt::runtime(lines), fmt::arg("system", name(0)), fmt::arg("q", name(1)),
                       fmt::arg("p", name(2)), fmt::arg("a", name(3)), fmt::arg("let", name(4)),
                       fmt::arg("invariant", name(5)), fmt::arg("i", name(6)));
  };
  if (first % 2 == 0) {
    return text(
        "system {system}\ncoordinate {q}\nmomentum {p}\nparameter {a} = 2\n"
        "let {let} = cos({q})*{a}\nH = {p}^2*(1 + {q}^2) - {let} + abs({q})^3\n"
        "invariant {invariant} = {p}^2 - {let}\n");
  }
  return text(
      "system {system}\ncoordinate {q}[1..40] periodic\nmomentum {p}[1..40]\n"
      "parameter {a} = 2\nH = sum({i} = 1..40, {p}[{i}]^2/2 - {a}*cos({q}[{i}+1] - {q}[{i}]))\n"
      "invariant {invariant} = sum({i} = 1..40, {p}[{i}])\n");
}

// The names the language has no other meaning for.
std::vector<std::string> free_names() {
  std::vector<std::string> names;
  for (const std::string& name : taken) {
    try {
      static_cast<void>(read_model(make_source(
          "m.ham", "coordinate " + name + "\nmomentum p_\nH = p_^2 + " + name + "^2\n")));
      names.push_back(name);
    } catch (const ModelError&) {
    }
  }
  return names;
}

std::string all_headers(const Request& request) {
  const std::vector<std::string> names = free_names();
  std::string text;
  for (std::size_t first = 0; first < names.size(); ++first) {
    text += fmt::format("#line 1 \"{}.hpp\"\n", names[first]);
    text +=
        without_pragma(generate(make_source("m.ham", model_of(names, first)), request).at(0).text);
  }
  return text;
}

// But for functions of the language, its statements and the letters that it keeps.
TEST(TakenNames, AreFreeInTheLanguage) {
  const std::vector<std::string> names = free_names();
  EXPECT_GE(names.size(), taken.size() - 8);
  for (const char* name : {"linux", "gamma", "I", "j0", "plugin", "errno", "NAN", "major"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

TEST(TakenNames, BreakNoHeaderBeforeOrAfterOthersInAnyStandard) {
  const std::string text = all_headers({});
  for (const std::string& compiler : compilers()) {
    for (const std::string standard : {"-std=gnu++17", "-std=c++17", "-std=c++20"}) {
      EXPECT_EQ(messages(compiler, headers + text, {standard}), "") << compiler << standard;
      EXPECT_EQ(messages(compiler, text + headers, {standard}), "") << compiler << standard;
    }
  }
}

// What the test before would find.
TEST(TakenNames, BreakCodeThatDoesNotMindThem) {
  EXPECT_NE(messages("g++", headers + "struct State { double linux = 0; };\n", {"-std=gnu++17"}),
            "");
  EXPECT_NE(messages("g++", headers + "struct State { double EDOM = 0; };\n", {"-std=c++17"}), "");
  EXPECT_NE(messages("g++", "namespace gamma { struct State; }\n" + headers, {"-std=c++20"}), "");
  EXPECT_NE(messages("g++", headers + "namespace index { struct State; }\n", {"-std=c++17"}), "");
}

TEST(TakenNames, WorkInQuadPrecision) {
  EXPECT_EQ(messages("g++", headers + all_headers({.scalar = "quad"}), {"-std=gnu++17"}), "");
}

TEST(TakenNames, WorkInPlugins) {
  const std::vector<std::string> names = free_names();
  for (const std::string name : {"plugin", "create", "read_state", "hamgen_plugin_entry",
                                 "HAMGEN_PLUGIN_VERSION", "advance", "I", "linux", "gamma"}) {
    const auto first = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    ASSERT_LT(first, names.size()) << name;
    const std::string code = generate_plugin(make_source("m.ham", model_of(names, first)), {}).text;
    EXPECT_EQ(messages("g++", code, {"-std=gnu++17", "-Wall"}), "") << name;
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
