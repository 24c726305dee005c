// Large systems in loops: their headers are as long as those of small ones, and as well proved.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

const std::string kChain =
    "system chain\nsize N = 40\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^3/12)\n"
    "scene s {\n  q[i] = sin(pi*i/(N+1))\n  h = 0.1\n  steps = 10\n}\n";
const std::string kBodies =
    "system bodies\nsize N = 15\ncoordinate x[1..N], y[1..N], z[1..N]\n"
    "momentum px[1..N], py[1..N], pz[1..N]\nparameter m[1..N] = 1/N\n"
    "H = (sum(i = 1..N, (px[i]^2 + py[i]^2 + pz[i]^2)/(2*m[i]))\n"
    "     - sum(i = 1..N, j = i+1..N, m[i]*m[j]/N/sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2\n"
    "                                                  + (z[i] - z[j])^2 + 1/100)))\n"
    "scene s {\n  x[i] = sin(i)\n  y[i] = cos(i)\n  h = 0.01\n  steps = 10\n}\n";
const std::string kRotators =
    "system rotators\nsize N = 40\ncoordinate q[1..N]\nmomentum p[1..N]\n"
    "let C = sum(i = 1..N, cos(q[i]))\nlet S = sum(i = 1..N, sin(q[i]))\n"
    "H = sum(i = 1..N, p[i]^2/2) - (C^2 + S^2)/(2*N)\n"
    "scene s {\n  q[i] = i/N\n  h = 0.1\n  steps = 10\n}\n";

// The header is proved to be the step, and has no more statements than that of a tenth of the
// elements.
void expect_proved(const std::string& model, const std::string& size, const std::string& scheme) {
  const Scratch scratch;
  const std::string path = scratch.write("model.ham", model);
  const auto generated = [&](const std::string& elements) {
    return hamgen(
        {"generate", path, "--set", "N=" + elements, "--scheme", scheme, "--require", "program"});
  };
  const Result result = generated(size);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::size_t proved = result.out.find("//   proved ");
  ASSERT_NE(proved, std::string::npos);
  const std::string line =
      result.out.substr(proved, result.out.find("//   solve", proved) - proved);
  EXPECT_TRUE(contains(line, "emitted code")) << line;
  const Result shorter = generated(size.substr(0, size.size() - 1));
  ASSERT_EQ(shorter.status, 0) << shorter.err;
  EXPECT_LE(std::ranges::count(result.out, ';'), std::ranges::count(shorter.out, ';'));
}

TEST(LargeSystems, AreProvedAtSmallSizes) {
  expect_proved(kChain, "20000", "stormer-verlet");
  expect_proved(kChain, "20000", "implicit-midpoint");
  expect_proved(kBodies, "150", "stormer-verlet");
}

// Neighbours that are far apart are seen in systems that are longer than they had to be.
TEST(LargeSystems, WithFarNeighboursAreProvedAtLargerSizes) {
  const std::string far =
      "system far\nsize N = 40\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/5 + (q[i+1] - q[i])^4/4 + cos(q[i+9] - q[i]))\n"
      "scene s {\n  q[1] = 1\n  h = 0.1\n  steps = 10\n}\n";
  expect_proved(far, "20000", "implicit-midpoint");
}

// A few elements show what there is to see, but for those that the model names.
TEST(LargeSystems, AreLookedAtWithTheFewestElementsThatShowAll) {
  const Scratch scratch;
  const auto program = [&](const std::string& model) {
    const std::string out = hamgen({"verify", scratch.write("model.ham", model)}).out;
    const std::size_t place = std::min(out.find("\nprogram "), out.size());
    return out.substr(place, out.find('\n', place + 1) - place);
  };
  const std::string head = "system m\nsize N = 60\ncoordinate q[1..N]\nmomentum p[1..N]\n";
  const std::string pairs =
      program(head + "H = sum(i = 1..N, p[i]^2/2) + sum(i = 1..N, j = 1..i-1, (q[i] - q[j])^4)\n");
  EXPECT_TRUE(contains(pairs, "proved")) << pairs;
  EXPECT_TRUE(contains(pairs, "at N = 8, N = 9 and N = 10;")) << pairs;
  const std::string kinetic = head + "H = sum(i = 1..N, p[i]^2/2 + q[i]^4) ";
  const std::string named = program(kinetic + "+ q[17]^6\n");
  EXPECT_TRUE(contains(named, "proved")) << named;
  EXPECT_TRUE(contains(named, "at N = ")) << named;
  EXPECT_FALSE(contains(named, "at N = 8")) << named;
  // There is no end that all the longer ones have.
  const std::string last = program(kinetic + "+ q[60]^6\n");
  EXPECT_FALSE(contains(last, "proved")) << last;
}

// What takes too long is not decided, and the rest is said.
TEST(LargeSystems, OfManyBodiesHaveNoLinearPart) {
  const Scratch scratch;
  const Result result = hamgen({"verify", scratch.write("model.ham", kBodies), "--set", "N=110"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "linear stability  not decided")) << result.out;
}

TEST(LargeSystems, OfAMillionElements) {
  expect_proved(kChain, "1000000", "stormer-verlet");
  expect_proved(kChain, "1000000", "implicit-midpoint");
  expect_proved(kChain, "1000000", "gauss-4");
}

TEST(LargeSystems, OfManyBodies) {
  expect_proved(kBodies, "200", "implicit-midpoint");
  expect_proved(kBodies, "1000", "stormer-verlet");
}

// A function of sums is no longer than they are, and what it is written out is the same: but for
// the digits of N the header does not know how many there are, where one that is written out does.
// What is its own, beside the fixed blocks that all headers share, is below 12 KB.
TEST(LargeSystems, AMeanFieldsHeaderDoesNotKnowHowMany) {
  const Scratch scratch;
  const std::string path = scratch.write("model.ham", kRotators);
  EXPECT_EQ(hamgen({"check", path, "--set", "N=1000"}).status, 0);
  const auto header_of = [&](const std::string& elements) {
    const Result result = hamgen({"generate", path, "--set", "N=" + elements});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  const std::string header = header_of("100");
  EXPECT_TRUE(contains(header, "const Real H_C = -0.01 * C;")) << header;
  constexpr std::size_t digits = 100;
  EXPECT_LT(header_of("1000").size(), header.size() + digits);
  EXPECT_GT(header_of("16").size(), header_of("8").size() + digits);
  const std::string shared = scratch.path("shared");
  const Result files =
      hamgen({"generate", path, "--set", "N=100", "--support", "shared", "-o", shared});
  ASSERT_EQ(files.status, 0) << files.err;
  EXPECT_LT(std::filesystem::file_size(shared + "/model.hpp"), 12'000u);
}

TEST(LargeSystems, AFunctionOfSumsMovesAsItDoesWrittenOut) {
  const Scratch scratch;
  const std::string path = scratch.write("model.ham", kRotators);
  // What is written out is large, and interpreted sooner than compiled.
  const auto last = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", path, "--set", "N=26", "--quiet", "--every", "10", "-o",
                                     "-", "--solver"});
    const Result result = hamgen(options);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::size_t row = result.out.find("\n10,");
    return result.out.substr(row, 60);
  };
  const auto number = [](const std::string& row, int column) {
    std::size_t at = 0;
    for (int k = 0; k < column; ++k) at = row.find(',', at) + 1;
    return std::stod(row.substr(at));
  };
  const std::string loops = last({"fixed-point"});
  const std::string written_out = last({"newton", "--interpret"});
  for (const int column : {1, 2, 3})
    EXPECT_NEAR(number(loops, column), number(written_out, column), 1e-13);
}

}  // namespace
}  // namespace hamgen::app_test
