// Emitted headers under flags that change what arithmetic means: an error, or the same steps.
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/source_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

namespace fs = std::filesystem;

// The refusals of an emitted file, one with the storage of doubles.
const std::string kParts = "what rounding loses is kept here: compile without -ffast-math, -Ofast";
const std::string kRegisters = "numbers must not be kept in wider registers";

std::string pendulum_header(const std::string& scalar = "double") {
  const fs::path model = fs::path(HAMGEN_SOURCE_DIR) / "hamiltonians/pendulum.ham";
  return without_pragma(
      emit(read_source(model.string()), {.scalar = scalar, .name_space = "emitted"}).at(0).text);
}

std::string said(const std::string& compiler, const std::string& flag,
                 const std::string& scalar = "double") {
  return messages(compiler, pendulum_header(scalar), {"-std=c++17", flag});
}

TEST(Arithmetic, OfAnotherKindIsAnErrorInGcc) {
  const auto expect_refused = [](const std::string& flag, const std::string& scalar) {
    EXPECT_NE(said("g++", flag, scalar).find(kParts), std::string::npos) << scalar << flag;
  };
  for (const char* flag : {"-ffast-math", "-Ofast", "-funsafe-math-optimizations",
                           "-freciprocal-math", "-ffinite-math-only", "-fno-signed-zeros"})
    expect_refused(flag, "double");
  for (const char* scalar : {"float", "long-double", "quad"}) expect_refused("-ffast-math", scalar);
  EXPECT_EQ(said("g++", "-fno-trapping-math"), "");
  EXPECT_EQ(said("g++", "-O3"), "");
}

TEST(Arithmetic, InWiderRegistersIsAnErrorWhereThatMatters) {
#ifdef __x86_64__
  EXPECT_NE(said("g++", "-mfpmath=387").find(kRegisters), std::string::npos);
  EXPECT_EQ(said("g++", "-mfpmath=387", "long-double"), "");
#else
  GTEST_SKIP() << "only x86 has them";
#endif
}

TEST(Arithmetic, OfAnotherKindIsAnErrorInClangWhereItSaysSo) {
  if (std::ranges::count(compilers(), "clang++") == 0) GTEST_SKIP() << "no clang++";
  for (const std::string flag : {"-ffast-math", "-Ofast", "-ffinite-math-only", "-ffp-model=fast"})
    EXPECT_NE(said("clang++", flag).find(kParts), std::string::npos) << flag;
}

// A program that prints many steps of the pendulum, and what (a + b) - a is outside the header.
std::string program(const std::string& header) {
  return "#include <cstdio>\n" + header + R"(
double outside(double a, double b) { return a + b - a; }
int main() {
  emitted::Propagator propagator({}, 0.1, {3.1, 0.0});
  propagator.advance(20000);
  const volatile double one = 1.0, tiny = 1e-18;
  std::printf("%a %a %d\n", propagator.state().q, propagator.state().p, outside(one, tiny) == tiny);
}
)";
}

std::string printed(const std::string& text, const std::vector<std::string>& flags) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  std::vector<std::string> command = {"clang++", "-std=c++17", "-O3", "-o",
                                      (directory.path() / "program").string()};
  command.insert(command.end(), flags.begin(), flags.end());
  const fs::path source = directory.path() / "program.cpp";
  runtime::atomic_write(source, text);
  command.push_back(source.string());
  const runtime::ProcessResult compiled = runtime::run_process({.command = command});
  EXPECT_TRUE(compiled.succeeded()) << compiled.output;
  return runtime::run_process({.command = {(directory.path() / "program").string()}}).output;
}

TEST(Arithmetic, ThatReordersSumsIsKeptOutOfTheHeaderByClang) {
  if (std::ranges::count(compilers(), "clang++") == 0) GTEST_SKIP() << "no clang++";
  const std::string plain = printed(program(pendulum_header()), {});
  const std::vector<std::string> reordering = {"-fassociative-math", "-fno-signed-zeros"};
  // The steps are the same to the last bit, and after the header the flags hold again.
  const std::string digits = plain.substr(0, plain.rfind(' '));
  EXPECT_EQ(plain, digits + " 0\n");
  EXPECT_EQ(printed(program(pendulum_header()), reordering), digits + " 1\n");
  // Without the header's lines for clang they are not.
  std::string unprotected = pendulum_header();
  for (const std::string line :
       {"#pragma float_control(push)\n", "#pragma clang fp reassociate(off)\n",
        "#pragma float_control(pop)\n"}) {
    ASSERT_EQ(count(unprotected, line), 1) << line;
    unprotected.erase(unprotected.find(line), line.size());
  }
  EXPECT_NE(printed(program(unprotected), reordering), digits + " 1\n");
}

}  // namespace
}  // namespace hamgen::emitted_test
