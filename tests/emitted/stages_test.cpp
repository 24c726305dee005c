// Implicit Runge-Kutta steps whose stages are computed at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "generator/base/diagnostic.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

std::string staged_header(const std::string& hamiltonian, const Request& request) {
  const std::string text = "system one\ncoordinate q\nmomentum p\nH = " + hamiltonian + "\n";
  return without_pragma(emit(make_source("one.ham", text), request).front().text);
}

Request gauss(const std::string& scheme) {
  Request request;
  request.scheme = scheme;
  return request;
}

// 50 steps of it, in hexadecimal digits.
std::string steps_of(const std::string& hamiltonian, const Request& request,
                     std::vector<std::string> flags) {
  const std::string main = R"(
#include <cstdio>
int main() {
  one::State z;
  z.q = 0.7;
  z.p = 0.4;
  one::Propagator run(one::Parameters(), 0.1, z);
  for (int i = 0; i < 50; ++i) {
    if (!run.step().converged) return 1;
    std::printf("%a %a\n", run.state().q, run.state().p);
  }
}
)";
  Request named = request;
  named.name_space = "one";
  flags.insert(flags.end(), {"-O2", "-ffp-contract=off"});
  return run_program(staged_header(hamiltonian, named) + main, flags);
}

// A power takes what the logarithm and the exponential function are made of.
TEST(StagesInLanes, OfAPowerAloneCompile) {
  Request batch;
  batch.batch = 2;
  for (const Request& request : {gauss("gauss-4"), batch})
    EXPECT_EQ(messages("g++", staged_header("p^2/2 + q^2.3", request)), "");
}

TEST(StagesInLanes, HaveTheSameBitsWithAnyInstructions) {
  for (const char* scheme : {"gauss-6", "gauss-16"}) {
    const std::string hamiltonian = "p^2/2 + cos(q) + exp(q/3) + (1 + q^2)^1.3";
    const std::string plain = steps_of(hamiltonian, gauss(scheme), {"-march=x86-64"});
    EXPECT_EQ(std::ranges::count(plain, '\n'), 50) << scheme;
    EXPECT_EQ(steps_of(hamiltonian, gauss(scheme), {"-march=native"}), plain) << scheme;
  }
}

// Names of the user's that the routines might have had, and a function that C++ calls otherwise.
TEST(StagesInLanes, AreThoseOfModelsWhateverTheirNames) {
  const auto proved = [](const std::string& text, const std::string& scheme) {
    Request request = gauss(scheme);
    request.require = "emitted-code";
    return emit(make_source("one.ham", "system one\n" + text), request).front().text;
  };
  const std::string masses =
      "coordinate q\nmomentum p\nparameter half = 2\nH = p^2/(2*half) - cos(q)\n";
  EXPECT_NE(proved(masses, "gauss-6").find("k.mobility[0] = 1.0 / par.half;"), std::string::npos);
  EXPECT_NE(proved("coordinate q\nmomentum p\nH = p^2/2 + sqrt(1 + abs(q))\n", "gauss-4")
                .find("lane_abs"),
            std::string::npos);
  const std::string sums =
      "size N = 30\ncoordinate q[1..N]\nmomentum p[1..N]\nparameter sum_1 = 2\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum_1*sum(i = 1..N, cos(q[i]))^2/(2*N)\n";
  const std::string header =
      emit(make_source("one.ham", "system one\n" + sums), gauss("gauss-4")).front().text;
  EXPECT_EQ(messages("g++", without_pragma(header)), "");
  EXPECT_NE(header.find("par.sum_1 * "), std::string::npos);
}

TEST(StagesInLanes, TakeTheFunctionsOfTheLibraryIfAsked) {
  Request request = gauss("gauss-8");
  request.math = "libm";
  request.require = "emitted-code";
  const std::string header = staged_header("(1 + p^2)*cos(q)", request);
  EXPECT_NE(header.find("2.0 * p * library<std::cos>(q)"), std::string::npos);
  EXPECT_EQ(header.find("lane_cos"), std::string::npos);
  EXPECT_EQ(messages("g++", header), "");
  // Where nothing is in lanes nobody has functions to choose.
  request.scheme = "gauss-2";
  EXPECT_THROW(staged_header("(1 + p^2)*cos(q)", request), UsageError);
}

// The state at the end of the lines.
std::pair<double, double> end_of(const std::string& lines) {
  double q = 0;
  double p = 0;
  const std::string last = lines.substr(lines.rfind('\n', lines.size() - 2) + 1);
  EXPECT_EQ(std::sscanf(last.c_str(), "%la %la", &q, &p), 2) << last;
  return {q, p};
}

// Its second derivative vanishes, and its velocity is no multiple of p.
TEST(StagesInLanes, OfAMomentumsMagnitudeKeepTheirMomenta) {
  const std::string header = staged_header("p^2/2 + abs(p)/3 + cos(q)", gauss("gauss-4"));
  EXPECT_EQ(header.find("evaluate_coordinates"), std::string::npos);
}

// The same H with a kinetic energy that is a sum of squares, and that is not seen to be one.
TEST(StagesInLanes, OfCoordinatesAloneEndWhereThoseOfAllDo) {
  const Request request = gauss("gauss-8");
  const std::string squares = "p^2/2 + cos(q)";
  const std::string roots = "sqrt(p^4)/2 + cos(q)";
  EXPECT_NE(staged_header(squares, request).find("evaluate_coordinates"), std::string::npos);
  EXPECT_EQ(staged_header(roots, request).find("evaluate_coordinates"), std::string::npos);
  const auto [q, p] = end_of(steps_of(squares, request, {}));
  const auto [other_q, other_p] = end_of(steps_of(roots, request, {}));
  // Fifty steps round by 2^-53 each, and from the top of the hill that grows by e^5 until t = 5.
  EXPECT_NEAR(q, other_q, 50 * 0x1p-53 * 148);
  EXPECT_NEAR(p, other_p, 50 * 0x1p-53 * 148);
}

}  // namespace
}  // namespace hamgen::emitted_test
