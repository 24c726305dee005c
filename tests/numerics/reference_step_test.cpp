// Steps as they are emitted, interpreted, against a step by hand, in long double: other
// derivatives, no tearing, dense Newton.
#include <gtest/gtest.h>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using J = Jet<long double>;
using Variables = std::vector<J>;
using Hamiltonian = J (*)(const Variables&);

J square_of_jet(const J& x) { return x * x; }

J double_pendulum(const Variables& z) {
  const J d = z[0] - z[1];
  return (square_of_jet(z[2]) + 2.0L * square_of_jet(z[3]) - 2.0L * (z[2] * z[3] * cos(d))) /
             (2.0L + 2.0L * square_of_jet(sin(d))) -
         2.0L * cos(z[0]) - cos(z[1]);
}
J magnetic(const Variables& z) {
  const J r = sqrt(square_of_jet(z[0]) + square_of_jet(z[1]));
  return 0.5L * (square_of_jet(z[2] + 0.5L * z[1]) + square_of_jet(z[3] - 0.5L * z[0])) +
         0.01L * ((1.0L + 0.0L * r) / r);
}
J product(const Variables& z) {
  return 0.5L * ((1.0L + square_of_jet(z[0])) * (1.0L + square_of_jet(z[1])));
}
J henon_heiles(const Variables& z) {
  return 0.5L * (square_of_jet(z[0]) + square_of_jet(z[1]) + square_of_jet(z[2]) +
                 square_of_jet(z[3])) +
         square_of_jet(z[0]) * z[1] - (1.0L / 3.0L) * (z[1] * square_of_jet(z[1]));
}
J toda(const Variables& z) {
  return 0.5L * (square_of_jet(z[3]) + square_of_jet(z[4]) + square_of_jet(z[5])) +
         exp(z[0] - z[1]) + exp(z[1] - z[2]) + exp(z[2] - z[0]);
}
J affine(const Variables& z) { return z[2] * sin(z[1]) + z[3] * cos(z[0]) + sin(z[0] * z[1]); }
// Second derivatives alone would make it quadratic, with |q1 - 4| on the side of q1 = 0.
J corner(const Variables& z) {
  return 0.5L * (square_of_jet(z[2]) + square_of_jet(z[3]) + square_of_jet(-8.0L + z[0])) +
         sqrt(square_of_jet(-4.0L + z[0])) + square_of_jet(z[1]) + 0.125L * (z[0] * z[1]);
}
// Six degrees of freedom, all coupled, not separable: a system that is not written out.
J six(const Variables& z) {
  J sum = 0.0L * z[0];
  J angle = 0.0L * z[0];
  for (std::size_t i = 0; i < 6; ++i) {
    const long double k = static_cast<long double>(i + 1);
    sum = sum + (1.0L / k) * (square_of_jet(z[6 + i]) * (2.0L + sin(z[i]))) +
          0.25L * square_of_jet(square_of_jet(z[i]));
    angle = angle + (1.0L / k) * z[i];
  }
  return sum + cos(angle);
}

struct Problem {
  std::string name;
  std::string text;
  Hamiltonian hamiltonian;
  Vector start;
};

const std::string two = "coordinate q1, q2\nmomentum p1, p2\n";

std::vector<Problem> problems() {
  return {
      {"double_pendulum",
       two + "H = (p1^2+2*p2^2-2*p1*p2*cos(q1-q2))/(2*(1+sin(q1-q2)^2))-2*cos(q1)-cos(q2)\n",
       double_pendulum,
       {1.5L, 0.7L, 0.3L, -0.4L}},
      {"magnetic",
       two + "H = ((p1+q2/2)^2+(p2-q1/2)^2)/2+0.01/sqrt(q1^2+q2^2)\n",
       magnetic,
       {0.1L, -1.0L, 0.6L, 0.01L}},
      {"product", "coordinate q\nmomentum p\nH = (q^2+1)*(p^2+1)/2\n", product, {0.3L, -1.5L}},
      {"henon_heiles",
       two + "H = (p1^2+p2^2+q1^2+q2^2)/2+q1^2*q2-q2^3/3\n",
       henon_heiles,
       {0.1L, 0.2L, 0.3L, -0.1L}},
      {"toda",
       "coordinate q[1..3] periodic\nmomentum p[1..3]\n"
       "H = sum(i = 1..3, p[i]^2/2 + exp(q[i]-q[i+1]))\n",
       toda,
       {0.3L, -0.2L, 0.0L, 0.1L, 0.4L, -0.5L}},
      {"corner",
       two + "H = (p1^2+p2^2+(q1-8)^2)/2 + abs(q1-4) + q2^2 + q1*q2/8\n",
       corner,
       {8.0L, 0.3L, 0.2L, -0.4L}},
      {"affine",
       two + "H = p1*sin(q2) + p2*cos(q1) + sin(q1*q2)\n",
       affine,
       {0.4L, 0.8L, -0.3L, 0.6L}},
      {"six",
       "coordinate q[1..6]\nmomentum p[1..6]\n"
       "H = sum(i = 1..6, p[i]^2*(2 + sin(q[i]))/i + q[i]^4/4) + cos(sum(i = 1..6, q[i]/i))\n",
       six,
       {0.1L, 0.2L, -0.3L, 0.4L, -0.5L, 0.6L, 0.3L, -0.1L, 0.2L, 0.05L, -0.25L, 0.15L}},
  };
}

struct MemberCase {
  std::string name;
  std::vector<std::string> alpha, beta, gamma;  // used round and round
};

std::vector<MemberCase> members() {
  return {{"midpoint", {"1/2"}, {"0"}, {"0"}},
          {"euler_a", {"0"}, {"0"}, {"0"}},
          {"euler_b", {"1"}, {"0"}, {"0"}},
          {"general", {"3/10"}, {"h/7"}, {"-h/9"}},
          {"beta", {"1/2"}, {"1/8"}, {"0"}},
          {"gamma", {"1/2"}, {"0"}, {"-1/8"}},
          {"lists", {"0", "1", "3/8"}, {"1/4", "0", "-1/16"}, {"0", "1/8", "1/32"}}};
}

long double number(const std::string& text, long double h) {
  if (text == "h/7") return h / 7;
  if (text == "-h/9") return -h / 9;
  const auto slash = text.find('/');
  if (slash == std::string::npos) return std::stold(text);
  return std::stold(text.substr(0, slash)) / std::stold(text.substr(slash + 1));
}

template <class Get>
std::string list(std::size_t n, const Get& get) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += (i ? "," : "") + get(i);
  return text;
}

Request request_for(const MemberCase& member, std::size_t n) {
  auto text = [&](const std::vector<std::string>& values) {
    if (values.size() == 1) return values[0];
    return list(n, [&](std::size_t i) { return values[i % values.size()]; });
  };
  return {.alpha = text(member.alpha), .beta = text(member.beta), .gamma = text(member.gamma)};
}

Parameters3<long double> values_for(const MemberCase& member, std::size_t n, long double h) {
  Parameters3<long double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.alpha.push_back(number(member.alpha[i % member.alpha.size()], h));
    values.beta.push_back(number(member.beta[i % member.beta.size()], h));
    values.gamma.push_back(number(member.gamma[i % member.gamma.size()], h));
  }
  return values;
}

constexpr long double kStep = 0.0625L;  // exact in every scalar
constexpr int kSteps = 32;

Vector by_hand(const Problem& problem, const MemberCase& member) {
  const std::size_t n = problem.start.size() / 2;
  Vector z = problem.start;
  for (int i = 0; i < kSteps; ++i) {
    z = dense_step<long double>(problem.hamiltonian, values_for(member, n, kStep), kStep, z);
  }
  return z;
}

class ReferenceStep : public ::testing::TestWithParam<std::string> {
 protected:
  Problem problem() const {
    for (const Problem& problem : problems()) {
      if (problem.name == GetParam()) return problem;
    }
    throw std::logic_error("no such problem");
  }
};

INSTANTIATE_TEST_SUITE_P(Models, ReferenceStep,
                         ::testing::Values("double_pendulum", "magnetic", "product", "corner",
                                           "henon_heiles", "toda", "affine", "six"),
                         [](const auto& instance) { return instance.param; });

TEST_P(ReferenceStep, IsWhatEveryMemberGives) {
  for (const MemberCase& member : members()) {
    SCOPED_TRACE(member.name);
    const Problem here = problem();
    const Emitted emitted(here.text, request_for(member, here.start.size() / 2));
    // 32 steps over t = 2: each adds about one unit in the last place, 1.1e-16 for values about 1
    // and at most 5 here, and the flow stretches differences by less than a hundred.
    EXPECT_LT(distance(emitted.after(kSteps, here.start, kStep), by_hand(here, member)), 2e-14L);
  }
}

TEST_P(ReferenceStep, IsWhatTheGeneralMemberGivesInLongDouble) {
  for (const MemberCase& member : {members()[3], members()[6]}) {
    SCOPED_TRACE(member.name);
    const Problem here = problem();
    Request request = request_for(member, here.start.size() / 2);
    request.scalar = "long-double";
    const Emitted emitted(here.text, request);
    // As above with 2^-64; the reference rounds as much.
    EXPECT_LT(distance(emitted.after(kSteps, here.start, kStep), by_hand(here, member)), 2e-17L);
  }
}

TEST_P(ReferenceStep, IsWhatTheFixedPointGives) {
  for (const MemberCase& member : {members()[0], members()[3]}) {
    SCOPED_TRACE(member.name);
    const Problem here = problem();
    Request request = request_for(member, here.start.size() / 2);
    request.solver = "fixed-point";
    const Emitted emitted(here.text, request);
    EXPECT_LT(distance(emitted.after(kSteps, here.start, kStep), by_hand(here, member)), 2e-14L);
  }
}

TEST_P(ReferenceStep, OfAlgorithm1IsWhatSweepsGive) {
  for (const MemberCase& member : {members()[0], members()[3], members()[6]}) {
    for (const int kappa : {0, 1, 2, 5}) {
      SCOPED_TRACE(member.name + ", kappa = " + std::to_string(kappa));
      const Problem here = problem();
      const std::size_t n = here.start.size() / 2;
      Request request = request_for(member, n);
      request.solver = "sweeps:" + std::to_string(kappa);
      request.scalar = "long-double";
      const Emitted emitted(here.text, request);
      Vector z = here.start;
      for (int i = 0; i < kSteps; ++i) {
        z = algorithm_1<long double>(here.hamiltonian, values_for(member, n, kStep), kStep, z,
                                     kappa);
      }
      EXPECT_LT(distance(emitted.after(kSteps, here.start, kStep), z), 2e-17L);
    }
  }
}

TEST_P(ReferenceStep, StartsFromTheGradientOfH) {
  const Problem here = problem();
  const Emitted emitted(here.text, {});
  std::vector<double> z;
  for (const long double value : here.start) z.push_back(static_cast<double>(value));
  const J jet = jet_of<long double>(here.hamiltonian, Vector(z.begin(), z.end()));
  const std::vector<double> gradient = emitted.library().gradient({}, z);
  EXPECT_NEAR(emitted.library().energy({}, z), static_cast<double>(jet.value), 1e-15);
  for (std::size_t i = 0; i < z.size(); ++i) {
    EXPECT_NEAR(gradient[i], static_cast<double>(jet.d[i]), 2e-15);
  }
}

}  // namespace
}  // namespace hamgen::numerics_test
