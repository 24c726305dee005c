// The gauge that is exact on the linear part: its text, its frequencies, and what it refuses.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/pipeline.hpp"
#include "generator/read_request.hpp"
#include "generator/schemes/matrix_function.hpp"

namespace hamgen::schemes_test {
namespace {

SourceText model(const std::string& text) {
  return make_source("m.ham", "system m\n" + text + "\n");
}

const char* const kOscillator = "coordinate q\nmomentum p\nparameter w = 3\nH = p^2/2 + w^2*q^2/2";

Request locally_exact(std::vector<std::pair<std::string, std::string>> reference = {}) {
  return {.gauge = "locally-exact", .reference = std::move(reference)};
}

std::string refusal(const SourceText& source, const Request& request) {
  try {
    (void)show_stage(source, request, "plan");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LocallyExact, TheGaugeOfAnOscillatorIsWrittenAsAFunctionOfH) {
  // C = A/w (cot(h w/2)/2 - 1/(h w)) with A = [[0, 1], [-w^2, 0]], w = 3: the row of bar(q) has
  // C_qp J = C_qp for H(q) with the sign of -J, that is -(1/(6 tan(3h/2)) - 1/(9 h)).
  const std::string equations = show_stage(model(kOscillator), locally_exact(), "equations");
  EXPECT_EQ(equations.substr(0, equations.find("dH/dq =")),
            "scheme locally-exact: C = (h A)^-1 - coth(h A/2)/2, A = J H'' at the origin, w = 3; "
            "poles at multiples of h = 2.094, order 2, symmetric\n"
            "bar(q) = q + h*dH/dp/2 + h*dH/dq*(1/9/h - 1/6/tan(3*h/2))\n"
            "bar(p) = p - h*dH/dq/2 + h*dH/dp*(1/h - 3/2/tan(3*h/2))\n");
}

TEST(LocallyExact, CoefficientsAreEvaluatedOnceARunAndTheHeaderSaysWhereTheyHold) {
  const std::string header = generate(model(kOscillator), locally_exact({{"w", "5"}}))[0].text;
  EXPECT_NE(
      header.find("at the origin, w = 5; poles at multiples of h = 1.257: order 2, symmetric, "
                  "symplectic"),
      std::string::npos)
      << header;
  EXPECT_NE(header.find(" = 1.0 / std::tan(2.5 * h);"), std::string::npos) << header;
  EXPECT_EQ(header.find("std::tan", header.find("std::tan") + 1), std::string::npos);
  EXPECT_NE(header.find("namespace m::locally_exact"), std::string::npos);
}

TEST(LocallyExact, AlgebraProvesItSymplecticSymmetricAndOfOrderTwo) {
  for (const char* text :
       {kOscillator, "coordinate q\nmomentum p\nH = p^2/2 - cos(q)",
        // Coupled oscillators with irrational modes, a free mode, a growing spiral, no linear part.
        "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^2 + x*y + y^2/3 + x^3",
        "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + (x - y)^2/2 + x^4",
        "coordinate x, y\nmomentum px, py\nH = x*px + y*py + x*py - y*px + x^3",
        "coordinate q\nmomentum p\nH = p^4 + q^4"}) {
    const Proof proof = verify_step(model(text), locally_exact());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(proof[i].verdict, Verdict::proved) << text << "\n" << to_text(proof);
    }
    EXPECT_EQ(proof[3].property, "order 2") << text;
  }
}

TEST(LocallyExact, APlaceWhereTheLinearPartIsNotDefinedIsRefused) {
  const SourceText kepler =
      model("coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2)");
  EXPECT_EQ(refusal(kepler, locally_exact()),
            "--gauge locally-exact: the second derivative of H by x and x is not defined at the "
            "origin\nhelp: choose another point, for example --reference x=1");
  EXPECT_EQ(refusal(kepler, locally_exact({{"x", "1"}})), "accepted");
  // Where one coordinate away from the origin is not enough.
  const SourceText bodies = model(
      "coordinate x[1..3]\nmomentum p[1..3]\nH = sum(i = 1..3, p[i]^2/2) - sum(i = 1..2, "
      "j = i+1..3, 1/abs(x[i] - x[j]))");
  const std::string refused = refusal(bodies, locally_exact());
  EXPECT_NE(refused.find("--reference x[1]=1,x[2]=2,x[3]=3"), std::string::npos) << refused;
  EXPECT_EQ(refusal(bodies, locally_exact({{"x[1]", "1"}, {"x[2]", "2"}, {"x[3]", "3"}})),
            "accepted");
}

TEST(LocallyExact, ALinearPartThatIsNotDiagonalisableIsRefused) {
  // Two equal frequencies with one mode between them: q'' = -q driven by another such oscillator.
  const SourceText resonant =
      model("coordinate x, y\nmomentum px, py\nH = x*py - y*px + (px^2 + py^2)/2");
  EXPECT_NE(refusal(resonant, locally_exact()).find("not diagonalisable"), std::string::npos)
      << refusal(resonant, locally_exact());
}

TEST(LocallyExact, OptionsThatContradictEachOtherAreRefused) {
  const SourceText source = model(kOscillator);
  EXPECT_EQ(refusal(source, {.beta = "h", .gauge = "locally-exact"}),
            "give either --gauge or --alpha, --beta, --gamma");
  try {
    static_cast<void>(Asked<GaugeWish>("exact"));
    ADD_FAILURE() << "--gauge exact is there";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "unknown gauge 'exact'; there is locally-exact, and a matrix C is written "
                 "'[[a, b], [c, -a]]'");
  }
  EXPECT_EQ(refusal(source, {.reference = {{"q", "1"}}}),
            "--reference says where --gauge locally-exact is exact, but there is no --gauge");
}

TEST(LocallyExact, TooManyCoupledDegreesOfFreedomAreRefused) {
  const SourceText chain = model(
      "size N = 25\ncoordinate q[1..N] with q[0] = 0\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2 + (q[i] - q[i-1])^2)/2");
  EXPECT_NE(refusal(chain, locally_exact()).find("couples 25 degrees of freedom, more than 24"),
            std::string::npos);
}

// The sums of many bodies are not written out to see it; a chain has to be looked at whole.
TEST(LocallyExact, ADenseOneIsRefusedBeforeAllIsDerived) {
  const std::string head = "size N = 30\ncoordinate q[1..N]\nmomentum p[1..N]\n";
  const Request request = locally_exact();
  const auto look = [&](const std::string& hamiltonian) {
    require_few_coupled(read_request(model(head + hamiltonian), request), request);
  };
  EXPECT_THROW(look("H = sum(i = 1..N, p[i]^2)/2 - sum(i = 2..N, j = 1..i-1, "
                    "1/sqrt((q[i] - q[j])^2 + 1))"),
               UsageError);
  EXPECT_NO_THROW(look("H = sum(i = 1..N, p[i]^2)/2 + sum(i = 2..N, (q[i] - q[i-1])^2)/2"));
}

TEST(GaugeFunction, OfARationalMatrixHasRationalCoefficients) {
  // H = p^2/2 + 2 q^2: w = 2, and A/w has the entries 1/2 and -2.
  const MatrixFunction f = gauge_function({{0, 1}, {-4, 0}});
  ASSERT_EQ(f.terms.size(), 1U);
  EXPECT_EQ(f.frequencies, std::vector<Rational>{2});
  EXPECT_EQ(f.terms[0].matrix, (RationalMatrix{{0, Rational(1, 2)}, {-2, 0}}));
  EXPECT_EQ(to_text(f.terms[0].function), "-(1/h - 1/tan(h))/2");
}

TEST(GaugeFunction, OfANilpotentMatrixIsAPolynomial) {
  // H = p1^2/2 + q1 p2, one chain of four: f(x) = -x/12 + x^3/720 ends there.
  const RationalMatrix a = {{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, -1}, {0, 0, 0, 0}};
  const MatrixFunction f = gauge_function(a);
  ASSERT_EQ(f.terms.size(), 2U);
  EXPECT_TRUE(f.frequencies.empty());
  EXPECT_EQ(to_text(f.terms[0].function), "-h/12");
  EXPECT_EQ(f.terms[0].matrix, a);
  EXPECT_EQ(to_text(f.terms[1].function), "h^3/720");
}

TEST(GaugeFunction, CollectsEqualFrequencies) {
  const MatrixFunction f =
      gauge_function({{0, 0, 1, 0}, {0, 0, 0, 1}, {-1, 0, 0, 0}, {0, -1, 0, 0}});
  ASSERT_EQ(f.terms.size(), 1U);
  EXPECT_EQ(f.frequencies, std::vector<Rational>{1});
}

}  // namespace
}  // namespace hamgen::schemes_test
