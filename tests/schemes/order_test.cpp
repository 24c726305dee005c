// Orders, and that they hang on every coefficient.
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/schemes/all_schemes.hpp"
#include "tests/schemes/series.hpp"

namespace hamgen::schemes_test {
namespace {

// Coefficients have 40 digits, quad has 34 and the series' terms are of size 1 to 1e4: equal terms
// differ by less than this, and a leading error of Gauss with 8 stages is still far above.
constexpr double kRounding = 1e-27;

Problem problem_of(const Scheme& scheme) {
  if (scheme.needs == "any H") return mixed_problem();
  return separable_problem(scheme.needs.find("quadratic") != std::string::npos);
}

// The number of leading terms, from h^1 on, that agree with the flow's.
int order_seen(const Scheme& scheme, int most) {
  const Problem problem = problem_of(scheme);
  const State exact = exact_series(problem, most);
  const State step = step_series(problem, scheme, most);
  int order = 0;
  while (order < most && difference(step, exact, order + 1) < kRounding) ++order;
  return order;
}

// Compositions in THE LIST have no base yet.
Scheme complete(Scheme scheme) {
  if (auto* composition = std::get_if<Composition>(&scheme.method)) {
    composition->base = find_scheme("implicit-midpoint")->member();
  }
  return scheme;
}

class NamedSchemes : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] Scheme scheme() const { return complete(*find_scheme(GetParam())); }
};

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const Scheme& scheme : all_schemes()) list.push_back(scheme.name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(List, NamedSchemes, ::testing::ValuesIn(names()),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(NamedSchemes, HasExactlyTheOrderItClaims) {
  EXPECT_EQ(order_seen(scheme(), scheme().order + 1), scheme().order);
}

void change(Expression& e, const Rational& by) { e = Expression(Rational(numeric_value(e) + by)); }

// Element i and its mirror image are changed, and the middle so that the sum stays: what no
// condition but that of the order itself can notice.
void change_symmetrically(std::vector<Expression>& c, std::size_t i, const Rational& by) {
  const std::size_t last = c.size() - 1;
  change(c[i], by);
  change(c[last - i], by);
  change(c[c.size() / 2], Rational(-by));
  change(c[last - c.size() / 2], Rational(-by));
}

// A wrong 20th digit.
TEST_P(NamedSchemes, LosesItsOrderByAWrongDigitInAnyCoefficient) {
  const Rational by(Integer(1), Integer("100000000000000000000"));
  const Scheme good = scheme();
  std::vector<Scheme> wrong;
  auto mutate = [&](auto alter) {
    wrong.push_back(good);
    alter(wrong.back().method);
  };
  if (const auto* composition = std::get_if<Composition>(&good.method)) {
    for (std::size_t i = 0; i < composition->substeps.size() / 2; ++i) {
      mutate([&](Method& m) { change_symmetrically(std::get<Composition>(m).substeps, i, by); });
    }
  } else if (const auto* splitting = std::get_if<Splitting>(&good.method)) {
    // Splittings of order 2 have no condition beyond symmetry and the sums.
    const bool keep_sums = good.symmetric && good.order > 2;
    auto all = [&](std::vector<Expression> Splitting::*list) {
      const std::size_t count = (splitting->*list).size();
      for (std::size_t i = 0; i < (keep_sums ? count / 2 : count); ++i) {
        if (keep_sums && (i == count / 2 || i + 1 == count - count / 2)) continue;  // the middle
        mutate([&](Method& m) {
          auto& values = std::get<Splitting>(m).*list;
          if (keep_sums) {
            change_symmetrically(values, i, by);
          } else {
            change(values[i], by);
          }
        });
      }
    };
    all(&Splitting::kicks);
    all(&Splitting::drifts);
  } else if (const auto* tableau = std::get_if<RungeKutta>(&good.method)) {
    for (std::size_t i = 0; i < tableau->b.size(); ++i) {
      mutate([&](Method& m) { change(std::get<RungeKutta>(m).b[i], by); });
      if (good.order == 1) continue;  // its only condition is the sum of the b_i
      mutate([&](Method& m) {
        auto& a = std::get<RungeKutta>(m).a;
        change(a[i][i == 0 ? a.size() - 1 : i - 1], by);
      });
    }
    // Of one stage too many entries would be one; of many, some will do.
    if (wrong.size() > 8) wrong.resize(8);
  }
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    EXPECT_LT(order_seen(wrong[k], good.order), good.order) << "mutation " << k;
  }
  EXPECT_TRUE(good.is_member() || !wrong.empty());
}

// Laskar and Robutel: with a potential of size eps the step errs by O(eps h^(2n+1)) + O(eps^2 h^3).
// The terms of the second kind are eps times smaller; those of the first vanish up to h^(2n).
int order_in_potential(const std::string& name) {
  const Problem problem = separable_problem(false, Quad(1) / 1000000000000);
  const int most = 11;
  const State exact = exact_series(problem, most);
  const State step = step_series(problem, *find_scheme(name), most);
  int order = 0;
  while (order < most && difference(step, exact, order + 1) < 1e-20) ++order;
  return order;
}

TEST(LaskarRobutel, SchemesHaveTheOrderOfTheirQuadratureForAWeakPotential) {
  for (int n = 1; n <= 4; ++n) {
    EXPECT_EQ(order_in_potential("saba-" + std::to_string(n)), 2 * n);
    EXPECT_EQ(order_in_potential("sbab-" + std::to_string(n)), 2 * n);
  }
}

TEST(LaskarRobutel, ThePrintedCoefficientsAreNotOfThem) {
  EXPECT_EQ(order_in_potential("saba-2-printed"), 2);
}

TEST(TheList, NamesEachSchemeOnce) {
  std::vector<std::string> all = names();
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
  EXPECT_GE(all.size(), 50u);
}

TEST(TheList, SaysWhatEachSchemeNeedsAndWhereItComesFrom) {
  for (const Scheme& scheme : all_schemes()) {
    EXPECT_FALSE(scheme.description.empty()) << scheme.name;
    EXPECT_FALSE(scheme.source.empty()) << scheme.name;
    EXPECT_EQ(std::holds_alternative<Splitting>(scheme.method),
              scheme.needs.starts_with("separable H"))
        << scheme.name;
  }
}

// Abramowitz and Stegun 25.4.30, moved to [0, 1].
TEST(Gauss, HasTheTabulatedNodesAndWeights) {
  const auto& tableau = std::get<RungeKutta>(find_scheme("gauss-16")->method);
  EXPECT_NEAR(to_double(numeric_value(tableau.c[0])), (1 - 0.960289856497536) / 2, 1e-15);
  EXPECT_NEAR(to_double(numeric_value(tableau.b[0])), 0.101228536290376 / 2, 1e-15);
}

TEST(SchemeNames, ThatOthersUseAreThoseOfSchemes) {
  EXPECT_EQ(scheme_meant_by("leapfrog"), "stormer-verlet");
  EXPECT_EQ(scheme_meant_by("drift-kick-drift"), "position-verlet");
  EXPECT_EQ(scheme_meant_by("yoshida4"), "yoshida-4");
  EXPECT_EQ(scheme_meant_by("something else"), "");
  for (const char* name : {"verlet", "velocity-verlet", "leap-frog", "kick-drift-kick", "kdk",
                           "dkd", "midpoint", "symplectic-euler", "runge-kutta", "runge-kutta-4"})
    EXPECT_NE(find_scheme(scheme_meant_by(name)), nullptr) << name;
}

}  // namespace
}  // namespace hamgen::schemes_test
