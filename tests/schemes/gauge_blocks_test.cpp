// C as any matrix of sp(2n): how a user writes it, what is refused, and what algebra says of it.
#include <gtest/gtest.h>

#include <string>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::schemes_test {
namespace {

const char* const kTwo =
    "system s\ncoordinate x, y\nmomentum px, py\nparameter a = 1/4\n"
    "H = (px^2 + py^2)/2 + x^4/4 + a*x*y + y^2/2\n";

SourceText two() { return make_source("two.ham", kTwo); }

std::string refusal(const Request& request) {
  try {
    (void)show_stage(two(), request, "plan");
  } catch (const UsageError& error) {
    return error.what();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "accepted";
}

Verdict verdict(const Request& request, const std::string& property) {
  for (const Finding& finding : verify_step(two(), request)) {
    if (finding.property == property) return finding.verdict;
  }
  ADD_FAILURE() << "nothing was said of " << property;
  return Verdict::not_decided;
}

TEST(GaugeBlocks, TheStageEquationsHaveTheEntriesOfTheMatrices) {
  const Request request{.alpha = "[[1/2, a], [0, 1/2]]",
                        .beta = "[[h, 2*h], [2*h, 0]]",
                        .gamma = "[[0, -h], [-h, 0]]"};
  const std::string equations = show_stage(two(), request, "equations");
  // zbar = z + h (I/2 + C) J grad H with C = [[alpha - 1/2, -gamma], [-beta, 1/2 - alpha^T]]:
  // bar(y) = y + h (dH/dpy/2 + gamma_21 dH/dx), and so on.
  EXPECT_EQ(equations.substr(0, equations.find("dH/dx =")),
            "scheme member: alpha = [[1/2, a], [0, 1/2]], beta = [[h, 2*h], [2*h, 0]], gamma = "
            "[[0, -h], [-h, 0]], order 1\n"
            "bar(x) = x + h*dH/dpx/2 - dH/dy*h^2 + h*a*dH/dpy\n"
            "bar(y) = y + h*dH/dpy/2 - dH/dx*h^2\n"
            "bar(px) = px - h*dH/dx/2 - dH/dpx*h^2 - 2*dH/dpy*h^2\n"
            "bar(py) = py - h*dH/dy/2 - 2*dH/dpx*h^2 + h*a*dH/dx\n");
}

TEST(GaugeBlocks, ADiagonalMatrixIsTheListAndAListMayStandInBrackets) {
  const auto text = [](const std::string& beta) {
    std::string equations = show_stage(two(), {.beta = beta}, "equations");
    return equations.substr(equations.find('\n'));  // the first line quotes the user
  };
  EXPECT_EQ(text("[[h, 0], [0, -h/3]]"), text("h, -h/3"));
  EXPECT_EQ(text("[h, -h/3]"), text("h, -h/3"));
  EXPECT_EQ(text("[h]"), text("h"));
  EXPECT_NE(text("[[h, h/7], [h/7, -h/3]]"), text("h, -h/3"));
}

TEST(GaugeBlocks, ABlockThatIsNotSymmetricIsRefusedWithTheReason) {
  for (const char* option : {"beta", "gamma"}) {
    Request request;
    const char* matrix = "[[h, a], [a^2, h]]";
    if (option == std::string("beta")) {
      request.beta = matrix;
    } else {
      request.gamma = matrix;
    }
    EXPECT_EQ(refusal(request),
              std::string("--") + option +
                  ": entry (1, 2) is a, but entry (2, 1) is a^2\nhelp: the " + option +
                  " block must be symmetric: C has to lie in sp(2n), C J + J C^T = 0, or the step "
                  "is not symplectic");
  }
  // Equal once expanded.
  EXPECT_EQ(refusal({.beta = "[[h, a*(1 + h)], [a + a*h, h]]"}), "accepted");
  EXPECT_EQ(refusal({.alpha = "[[h, a], [a^2, h]]"}), "accepted");
}

// What is said of a text that is refused before there is a model.
template <class Value>
std::string unread(const std::string& text) {
  try {
    static_cast<void>(Asked<Value>(text));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "read";
}

TEST(GaugeBlocks, BracketsThatMakeNoMatrixAreRefused) {
  EXPECT_NE(refusal({.beta = "[[h, h]]"}).find("the matrix has 1 rows, but there are 2"),
            std::string::npos);
  EXPECT_NE(refusal({.beta = "[[h], [h]]"}).find("has 1 entries in a row"), std::string::npos);
  EXPECT_NE(unread<BetaFormula>("[[h, 0], h]").find("'h' is not a list"), std::string::npos);
  EXPECT_NE(unread<BetaFormula>("[[h, 0], [0, h]").find("'[0, h' is not a list"),
            std::string::npos);
  EXPECT_NE(refusal({.beta = "[h, h, h]"}).find("has 3 values; give 1, or 2"), std::string::npos);
  EXPECT_NE(refusal({.beta = "[[h, x], [x, 0]]"}).find("unknown name 'x'"), std::string::npos);
}

TEST(GaugeBlocks, AlgebraProvesFullMatricesSymplecticAndTheirSymmetryAndOrder) {
  const Request odd{.alpha = "[[1/2, a*h], [-h, 1/2]]",
                    .beta = "[[h, 2*h], [2*h, h^3]]",
                    .gamma = "[[0, -h], [-h, 0]]"};
  EXPECT_EQ(verdict(odd, "symplectic"), Verdict::proved);
  EXPECT_EQ(verdict(odd, "symmetric"), Verdict::proved);
  EXPECT_EQ(verdict(odd, "order 2"), Verdict::proved);
  // One entry off the diagonal that does not vanish with h: symplectic still, but of order 1.
  const Request constant{.alpha = "[[1/2, a], [0, 1/2]]"};
  EXPECT_EQ(verdict(constant, "symplectic"), Verdict::proved);
  EXPECT_EQ(verdict(constant, "symmetric"), Verdict::refuted);
  EXPECT_EQ(verdict(constant, "order 1"), Verdict::proved);
}

TEST(GaugeMatrix, IsAllOfC) {
  const auto equations = [](const Request& request) {
    std::string text = show_stage(two(), request, "equations");
    return text.substr(text.find('\n'));  // the first line quotes the user
  };
  const std::string gauge = "[[0, a, 0, h], [0, 0, h, 0], [-h, -2*h, 0, 0], [-2*h, 0, -a, 0]]";
  EXPECT_EQ(equations({.gauge = gauge}), equations({.alpha = "[[1/2, a], [0, 1/2]]",
                                                    .beta = "[[h, 2*h], [2*h, 0]]",
                                                    .gamma = "[[0, -h], [-h, 0]]"}));
  EXPECT_EQ(verdict({.gauge = gauge}, "symplectic"), Verdict::proved);
}

TEST(GaugeMatrix, OutsideTheAlgebraIsRefutedWithTheEntryAndStillEmittedAsItIs) {
  // A wrong sign in one entry of the matrix above, and numbers at random.
  for (const char* gauge :
       {"[[0, a, 0, h], [0, 0, h, 0], [-h, -2*h, 0, 0], [-2*h, 0, a, 0]]",
        "[[3/7, -2/5, 1/9, 4/3], [1/8, 5/6, -1, 2/7], [2, 1/3, -3/8, 1/5], [1/6, -1/4, 7/9, 1]]"}) {
    for (const Finding& finding : verify_step(two(), {.gauge = gauge})) {
      if (finding.property == "gauge in sp(2n)") {
        EXPECT_EQ(finding.verdict, Verdict::refuted);
        EXPECT_TRUE(finding.detail.starts_with("entry (")) << finding.detail;
      }
      if (finding.property == "program") {
        EXPECT_EQ(finding.verdict, Verdict::proved) << finding.detail;
      }
    }
    EXPECT_EQ(verdict({.gauge = gauge}, "symplectic"), Verdict::refuted);
    EXPECT_THROW((void)generate(two(), {.gauge = gauge, .require = "symplectic"}), ProofError);
    const std::string header = generate(two(), {.gauge = gauge}).front().text;
    EXPECT_NE(header.find("not symplectic"), std::string::npos);
    EXPECT_NE(header.find("//   refuted   symplectic"), std::string::npos);
    EXPECT_NE(refusal({.order = 4, .gauge = gauge}).find("no generating function"),
              std::string::npos);
    EXPECT_NE(refusal({.scheme = "yoshida-4", .gauge = gauge}).find("composes a symplectic member"),
              std::string::npos);
  }
}

TEST(GaugeMatrix, OfAnotherSizeIsRefused) {
  EXPECT_NE(refusal({.gauge = "[[h, 0], [0, -h]]"}).find("C is 4 x 4"), std::string::npos);
  EXPECT_NE(unread<GaugeWish>("[h, 0]").find("C has rows"), std::string::npos);
  EXPECT_NE(refusal({.beta = "h", .gauge = "[[h]]"}).find("either --gauge or"), std::string::npos);
}

TEST(GaugeBlocks, ThePlanLeavesOutOnlyTheBlocksThatAreZero) {
  const std::string plan = show_stage(two(), {.beta = "[[0, h], [h, 0]]"}, "plan");
  EXPECT_EQ(plan.find("beta terms"), std::string::npos) << plan;
  EXPECT_NE(plan.find("gamma terms: gamma = 0"), std::string::npos) << plan;
}

TEST(GaugeBlocks, CoefficientsOfHAndParametersAreEvaluatedOnceARun) {
  const std::string header =
      generate(two(), {.beta = "[[0, sin(a)*h], [sin(a)*h, 0]]"}).front().text;
  // In the constructor's coefficients, not in the step.
  const std::size_t step = header.find("step(");
  ASSERT_NE(step, std::string::npos);
  EXPECT_EQ(header.find("std::sin(", header.find("std::sin(") + 1), std::string::npos) << header;
}

}  // namespace
}  // namespace hamgen::schemes_test
