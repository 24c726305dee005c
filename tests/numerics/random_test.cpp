// Hamiltonians nobody chose: emitted steps of random members against the step by hand.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/numerics/dense_step.hpp"
#include "tests/numerics/emitted_run.hpp"

namespace hamgen::numerics_test {
namespace {

using J = Jet<long double>;
using Variables = std::vector<J>;

// A function of the state both as a text of the language and as a function of jets.
struct Formula {
  std::string text;
  std::function<J(const Variables&)> value;
};

class Draw {
 public:
  Draw(unsigned seed, std::size_t n) : engine_(seed), n_(n) {}

  // A sum of `terms` random products with factors that stay of order one near the origin.
  Formula hamiltonian(int terms) {
    Formula sum = scaled(product());
    for (int i = 1; i < terms; ++i) {
      const Formula term = scaled(product());
      sum = {sum.text + " + " + term.text,
             [a = sum.value, b = term.value](const Variables& z) { return a(z) + b(z); }};
    }
    return sum;
  }
  // k/16 with |k| <= 8 and a value of it.
  std::pair<std::string, long double> sixteenth() {
    const int k = integer(-8, 8);
    return {std::to_string(k) + "/16", k / 16.0L};
  }
  int integer(int low, int high) {
    // By hand: the standard's distributions differ between libraries.
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }

 private:
  Formula variable() {
    const auto i = static_cast<std::size_t>(integer(0, static_cast<int>(2 * n_) - 1));
    const std::string name = (i < n_ ? "q" : "p") + std::to_string(i % n_ + 1);
    return {name, [i](const Variables& z) { return z[i]; }};
  }
  Formula factor() {
    const Formula x = variable();
    const Formula y = variable();
    auto with = [&](const std::string& text, std::function<J(const J&, const J&)> f) {
      return Formula{text,
                     [f, a = x.value, b = y.value](const Variables& z) { return f(a(z), b(z)); }};
    };
    const std::string& s = x.text;
    const std::string& t = y.text;
    switch (integer(0, 8)) {
      case 0:
        return x;
      case 1:
        return with(s + "^2", [](const J& a, const J&) { return a * a; });
      case 2:
        return with("sin(" + s + ")", [](const J& a, const J&) { return sin(a); });
      case 3:
        return with("cos(" + s + " - " + t + ")",
                    [](const J& a, const J& b) { return cos(a - b); });
      case 4:
        return with("exp(" + s + "/3)", [](const J& a, const J&) { return exp((1.0L / 3) * a); });
      case 5:
        return with("atan(" + s + "*" + t + ")",
                    [](const J& a, const J& b) { return atan(a * b); });
      case 6:
        return with("(1 + " + s + "^2)^(3/2)", [](const J& a, const J&) {
          const J u = 1.0L + a * a;
          return u * sqrt(u);
        });
      case 7:
        return with("1/(2 + " + s + "^2 + " + t + "^2)", [](const J& a, const J& b) {
          return (1.0L + 0.0L * a) / (2.0L + (a * a + b * b));
        });
      default:
        return with("sqrt(1 + " + s + "^2)",
                    [](const J& a, const J&) { return sqrt(1.0L + a * a); });
    }
  }
  Formula product() {
    const Formula a = factor();
    if (integer(0, 1) == 0) return a;
    const Formula b = factor();
    return {a.text + "*" + b.text,
            [f = a.value, g = b.value](const Variables& z) { return f(z) * g(z); }};
  }
  Formula scaled(const Formula& a) {
    const int k = integer(1, 12);
    return {std::to_string(k) + "/16*" + a.text,
            [k, f = a.value](const Variables& z) { return (k / 16.0L) * f(z); }};
  }

  std::mt19937 engine_;
  std::size_t n_;
};

void expect_the_step_by_hand(const std::string& text,
                             const std::function<J(const Variables&)>& hamiltonian, std::size_t n,
                             const Request& request, const Parameters3<long double>& member,
                             const Vector& start) {
  const long double h = 0.0625L;
  const Emitted emitted(text, request);
  Vector z = start;
  for (int i = 0; i < 16; ++i) z = dense_step<long double>(hamiltonian, member, h, z);
  // t = 1 with second derivatives below 5 per degree of freedom: differences grow by less than e^5;
  // 16 steps that each round by a unit in the last place, 2.2e-16 for values below 2, give 5e-13 at
  // the worst, and a tenth of it as a rule.
  EXPECT_LT(distance(emitted.after(16, start, h), z), n * 1e-13L) << text;
}

class RandomHamiltonian : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Seeds, RandomHamiltonian, ::testing::Range(0, 24));

TEST_P(RandomHamiltonian, IsSolvedAsByHand) {
  const int seed = GetParam();
  const auto n = static_cast<std::size_t>(1 + seed % 4);
  Draw draw(static_cast<unsigned>(seed), n);
  std::string text = "coordinate q1";
  for (std::size_t i = 2; i <= n; ++i) text += ", q" + std::to_string(i);
  text += "\nmomentum p1";
  for (std::size_t i = 2; i <= n; ++i) text += ", p" + std::to_string(i);
  const Formula formula = draw.hamiltonian(draw.integer(2, 5));
  text += "\nH = " + formula.text + "\n";
  const char* alphas[] = {"1/2", "0", "1", "3/8"};
  const long double alpha_values[] = {0.5L, 0, 1, 0.375L};
  const auto a = static_cast<std::size_t>(draw.integer(0, 3));
  const auto beta = draw.sixteenth();
  const auto gamma = draw.sixteenth();
  Vector start;
  for (std::size_t i = 0; i < 2 * n; ++i) start.push_back(draw.integer(-8, 8) / 16.0L);
  const bool plain = draw.integer(0, 1) == 0;
  Request request{.alpha = alphas[a]};
  if (!plain) {
    request.beta = beta.first;
    request.gamma = gamma.first;
  }
  const Parameters3<long double> member{Vector(n, alpha_values[a]),
                                        Vector(n, plain ? 0 : beta.second),
                                        Vector(n, plain ? 0 : gamma.second)};
  expect_the_step_by_hand(text, formula.value, n, request, member, start);
}

TEST(Newton, IsNotMisledByAContractionThatLooksLikeZero) {
  // Found at random: increments here fall so fast that the measured contraction was 0.
  const std::string text =
      "coordinate q1\nmomentum p1\n"
      "H = p1*sin(q1) + 33/100*(1 + q1^2)^(3/2)*atan(q1) + 86/1000*exp(p1/3)*atan(p1)\n";
  auto hamiltonian = [](const Variables& z) {
    const J u = 1.0L + z[0] * z[0];
    return z[1] * sin(z[0]) + 0.33L * (u * sqrt(u) * atan(z[0])) +
           0.086L * (exp((1.0L / 3) * z[1]) * atan(z[1]));
  };
  for (const long double q : {-0.5L, 0.25L, 0.75L}) {
    expect_the_step_by_hand(text, hamiltonian, 1, {}, {{0.5L}, {0}, {0}}, {q, 0.5L});
  }
}

}  // namespace
}  // namespace hamgen::numerics_test
