// Every shipped model, in several members and scalars, through two compilers' strictest warnings.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

struct Variant {
  std::string name;
  Request request;
};

std::vector<Variant> variants() {
  return {{"midpoint", {.scheme = "implicit-midpoint"}},
          {"euler_a", {.scheme = "symplectic-euler-a"}},
          {"euler_b", {.scheme = "symplectic-euler-b"}},
          {"general", {.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}},
          {"fixed_point", {.solver = "fixed-point"}},
          {"sweeps", {.solver = "sweeps:3"}}};
}

// The header of a shipped model, in the namespace MODEL_SCALAR::VARIANT.
std::string shipped_header(const std::filesystem::path& model, const Variant& variant,
                           const std::string& scalar) {
  Request request = variant.request;
  request.scalar = scalar;
  std::string suffix = scalar;
  std::erase(suffix, '-');
  request.name_space = "shipped_" + model.stem().string() + "_" + suffix + "::" + variant.name;
  return emit(read_source(model.string()), request).at(0).text;
}

// All of them as one translation unit, with a use of everything in it.
std::string unit(const std::vector<std::filesystem::path>& models, const std::string& scalar) {
  std::string text;
  for (const auto& model : models) {
    for (const Variant& variant : variants()) {
      text += "#line 1 \"" + model.stem().string() + "_" + variant.name + ".hpp\"\n";
      text += without_pragma(shipped_header(model, variant, scalar));
    }
  }
  return text;
}

std::vector<std::filesystem::path> models_for_every_scalar() {
  const std::set<std::string> names{
      "pendulum", "kepler", "double_pendulum", "fput", "driven_oscillator",
      "product",  "phi4",   "magnetic"};
  std::vector<std::filesystem::path> models;
  for (const auto& model : shipped_models()) {
    if (names.contains(model.stem().string())) models.push_back(model);
  }
  return models;
}

class EmittedHeader : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto found = compilers();
    if (std::ranges::find(found, std::string(GetParam())) == found.end()) {
      GTEST_SKIP() << "no " << GetParam() << " here";
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Compilers, EmittedHeader, ::testing::Values("g++", "clang++"),
                         [](const auto& instance) {
                           return std::string(instance.param) == "g++" ? "gcc" : "clang";
                         });

TEST_P(EmittedHeader, OfEveryShippedModelAndMemberCompilesWithoutAWarning) {
  ASSERT_GT(shipped_models().size(), 10u);
  EXPECT_EQ(messages(GetParam(), unit(shipped_models(), "double")), "");
}

TEST_P(EmittedHeader, InFloatCompilesWithoutAWarning) {
  EXPECT_EQ(messages(GetParam(), unit(models_for_every_scalar(), "float")), "");
}

TEST_P(EmittedHeader, InLongDoubleCompilesWithoutAWarning) {
  EXPECT_EQ(messages(GetParam(), unit(models_for_every_scalar(), "long-double")), "");
}

TEST_P(EmittedHeader, InQuadCompilesWithoutAWarning) {
  EXPECT_EQ(messages(GetParam(), unit(models_for_every_scalar(), "quad")), "");
}

// Sums that stay loops, by the matrix of their step: a ring, every pair, a torus, and a kinetic
// energy that couples the momenta.
std::vector<std::pair<std::string, std::string>> large_models() {
  return {{"ring",
           "size N = 64\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
           "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^2/2 + q[i]^4/4)\n"},
          {"pairs",
           "size N = 16\ncoordinate x[1..N]\ncoordinate y[1..N]\nmomentum px[1..N]\n"
           "momentum py[1..N]\nparameter eps = 1\n"
           "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2) + sum(i = 1..N-1, j = i+1..N,\n"
           "    eps/((x[i] - x[j])^2 + (y[i] - y[j])^2))\n"},
          {"torus",
           "size N = 256\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
           "H = sum(i = 1..N, p[i]^2/2 - cos(q[i+1] - q[i]) - cos(q[i+16] - q[i]))\n"},
          {"coupled",
           "size N = 40\ncoordinate q[1..N] periodic\nmomentum p[1..N] periodic\n"
           "H = sum(i = 1..N, (q[i]^2 + p[i]^2)^2/4 + q[i]*q[i+1] + p[i]*p[i+1])\n"}};
}

TEST_P(EmittedHeader, OfALargeSystemCompilesWithoutAWarning) {
  std::string text;
  for (const auto& [name, model] : large_models()) {
    for (Variant variant : variants()) {
      variant.request.name_space = name + "::" + variant.name;
      const SourceText source = make_source(name + ".ham", "system " + name + "\n" + model);
      text += "#line 1 \"" + name + "_" + variant.name + ".hpp\"\n";
      text += without_pragma(emit(source, variant.request).at(0).text);
    }
  }
  EXPECT_EQ(messages(GetParam(), text), "");
}

// Splittings, compositions, stages, what stands beside a step, and lanes.
TEST_P(EmittedHeader, OfOtherMethodsCompilesWithoutAWarning) {
  const std::vector<Variant> methods = {
      {"verlet", {.scheme = "stormer-verlet"}},
      {"composed", {.scheme = "yoshida-4"}},
      {"gauss", {.scheme = "gauss-8"}},
      {"stages", {.scheme = "gauss-4", .solver = "fixed-point"}},
      {"tangent", {.tangent = true}},
      {"series", {.watch_modified = 2}},
      {"lanes", {.batch = 4}},
      {"lane_verlet", {.scheme = "stormer-verlet", .batch = 4}},
      {"lane_gauss", {.scheme = "gauss-4", .batch = 8}},
      {"lane_fixed_point", {.solver = "fixed-point", .batch = 8}}};
  int headers = 0;
  for (const Variant& method : methods) {
    std::string text;
    for (const char* name : {"pendulum", "spring_pendulum", "kepler", "toda", "beads"}) {
      try {
        text += without_pragma(shipped_header(
            HAMGEN_SOURCE_DIR "/hamiltonians/" + std::string(name) + ".ham", method, "double"));
        ++headers;
      } catch (const UsageError& error) {
        EXPECT_EQ(method.name, "series") << name << ": " << error.what();
      }
    }
    EXPECT_EQ(messages(GetParam(), text), "") << method.name;
  }
  EXPECT_GE(headers, 47);
}

TEST_P(EmittedHeader, OfNothingToSolveCompilesWithoutAWarning) {
  std::string text;
  int number = 0;
  for (const char* h : {"3", "0", "a*p - 3*q"}) {
    const SourceText source = make_source(
        "s.ham",
        std::string("system s\ncoordinate q\nmomentum p\nparameter a = 1\nH = ") + h + "\n");
    std::vector<Variant> all = variants();
    all.push_back({"tangent", {.tangent = true}});
    all.push_back({"gauss", {.scheme = "gauss-4", .tangent = true}});
    all.push_back({"composed", {.scheme = "yoshida-4"}});
    for (Variant& variant : all) {
      variant.request.name_space = "n" + std::to_string(number++);
      text += "#line 1 \"" + std::string(h) + " " + variant.name + "\"\n" +
              without_pragma(emit(source, variant.request).at(0).text);
    }
  }
  EXPECT_EQ(messages(GetParam(), text), "");
}

TEST_P(EmittedHeader, IsCaughtWhenItIsWrong) {
  // Negative control: a conversion that loses digits.
  EXPECT_NE(messages(GetParam(), "inline float narrow(double x) { return x; }\n"), "");
  EXPECT_NE(messages(GetParam(), "inline int whole(double x) { return (int)x; }\n"), "");
  EXPECT_NE(messages(GetParam(), "inline unsigned size(int n) { return n; }\n"), "");
}

// With the optimiser on, compilers look further: uninitialised values, array bounds.
TEST(OptimisedHeader, CompilesWithoutAWarning) {
  std::string text;
  std::string uses;
  int number = 0;
  for (const auto& model : shipped_models()) {
    const std::string name = model.stem().string();
    if (name == "outer_solar_system" || name == "figure_eight") continue;  // Eigen: too slow
    for (const Variant& variant : variants()) {
      if (variant.name != "midpoint" && variant.name != "general") continue;
      const std::string code = shipped_header(model, variant, "double");
      if (code.find("Eigen") != std::string::npos) continue;
      text += without_pragma(code);
      const std::string space = "shipped_" + name + "_double";
      uses += "int use_" + std::to_string(number++) + "(" + space + "::State& z) {\n  " + space +
              "::" + variant.name + "::Propagator run(" + space + "::Parameters{}, 0.1, z);\n" +
              "  const long long n = run.advance(3).iterations;\n  z = run.state();\n  return (n > "
              "0) + (" +
              space + "::energy({}, z) > 0);\n}\n";
    }
  }
  ASSERT_GT(number, 20);
  std::vector<std::string> flags = strict_flags();
  flags.insert(flags.end(), {"-O2", "-Warray-bounds", "-Wmaybe-uninitialized"});
  EXPECT_EQ(messages("g++", text + uses, flags, "-S"), "");
}

TEST(EmittedHeaders, StandAloneWithTheHeadersTheyInclude) {
  for (const auto& model : shipped_models()) {
    EXPECT_EQ(messages("g++", without_pragma(shipped_header(model, variants()[0], "double"))), "")
        << model.stem();
  }
}

TEST(EmittedHeaders, IncludeNothingThatTheyDoNotUse) {
  for (const auto& model : shipped_models()) {
    for (const Variant& variant : variants()) {
      const SourceText source = read_source(model.string());
      const std::string text = shipped_header(model, variant, "double");
      SCOPED_TRACE(model.stem().string() + ", " + variant.name);
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("#include")) continue;
        const bool known = line == "#include <cmath>" || line.starts_with("#include <Eigen/");
        EXPECT_TRUE(known) << line;
      }
      const bool eigen = text.find("#include <Eigen/") != std::string::npos;
      EXPECT_EQ(eigen, generate_plugin(source, variant.request).needs_eigen);
      // Without Newton, or with few unknowns, there is no linear system for Eigen.
      if (variant.name != "midpoint" && variant.name != "general") {
        EXPECT_FALSE(eigen);
      }
      if (model.stem() != "outer_solar_system") {
        EXPECT_FALSE(eigen);
      }
      const bool cmath = text.find("#include <cmath>") != std::string::npos;
      EXPECT_EQ(cmath, text.find("std::") != std::string::npos);
      EXPECT_EQ(text.find("GiNaC"), std::string::npos);
      EXPECT_EQ(text.find("ginac"), std::string::npos);
    }
  }
}

// Some warnings of g++ come with what it makes of the code: of elements beyond the last, where it
// unrolls a loop that would not run.
TEST(EmittedHeaders, GiveNoWarningAtFullOptimisation) {
  const std::vector<Variant> methods = {{"midpoint", {.scheme = "implicit-midpoint"}},
                                        {"fixed_point", {.solver = "fixed-point"}},
                                        {"gauss", {.scheme = "gauss-4"}}};
  std::string text;
  std::string uses;
  for (const char* name : {"pendulum", "kepler", "double_pendulum"}) {
    const std::filesystem::path model =
        std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians" / (std::string(name) + ".ham");
    for (const Variant& method : methods) {
      text += without_pragma(shipped_header(model, method, "double"));
      uses += "bool use(shipped_" + std::string(name) + "_double::" + method.name +
              "::Propagator& run) { return run.advance(9).converged; }\n";
    }
  }
  std::vector<std::string> flags = strict_flags();
  flags.insert(flags.end(), {"-O3", "-Wno-missing-declarations"});
  EXPECT_EQ(messages("g++", text + uses, flags, "-S"), "");
}

// No line is longer than a hundred columns or ends in blanks, and an opening brace is indented by
// an even number of them.
TEST(EmittedHeaders, HaveTheFormatOfTheProject) {
  for (const auto& model : shipped_models()) {
    std::istringstream lines(shipped_header(model, variants()[3], "double"));
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("//")) continue;  // the user's own text
      EXPECT_LE(line.size(), 100u) << model.stem() << ": " << line;
      EXPECT_FALSE(line.ends_with(' ')) << model.stem() << ": '" << line << "'";
      const auto indent = line.find_first_not_of(' ');
      if (indent == std::string::npos || line.find('{') != indent) continue;
      EXPECT_EQ(indent % 2, 0u) << model.stem() << ": '" << line << "'";
    }
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
