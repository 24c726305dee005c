// The gauge that is exact on the linear part: its text, its frequencies, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <complex>
#include <numbers>
#include <string>

#include "generator/algebra/evaluate.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/interpreter/compiled_expression.hpp"
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
  // C_qp J = C_qp for H(q) with the sign of -J, that is -(1/(6 tan(3h/2)) - 1/(9 h)), as a sum of
  // tangents of halves of 3h/2 and a fraction that ends after 17.
  const std::string equations = show_stage(model(kOscillator), locally_exact(), "equations");
  std::string sum =
      "3/67108864/(3 - 9*h^2/67108864/(5 - 9*h^2/67108864/(7 - 9*h^2/67108864/(9 - "
      "9*h^2/67108864/(11 - 9*h^2/67108864/(13 - 9*h^2/67108864/(15 - 9*h^2/1140850688)))))))";
  for (int part = 8192; part >= 4; part /= 2)
    sum += " + tan(3*h/" + std::to_string(part) + ")/" + std::to_string(part) + "/h";
  EXPECT_EQ(equations.substr(0, equations.find("dH/dq =")),
            "scheme locally-exact: C = (h A)^-1 - coth(h A/2)/2, A = J H'' at the origin, w = 3; "
            "poles at multiples of h = 2.094, order 2, symmetric\n"
            "bar(q) = q + h*dH/dp/2 + dH/dq*h^2*(" +
                sum + ")/3\nbar(p) = p - h*dH/dq/2 + 3*dH/dp*h^2*(" + sum + ")\n");
}

TEST(LocallyExact, CoefficientsAreEvaluatedOnceARunAndTheHeaderSaysWhereTheyHold) {
  const std::string header = generate(model(kOscillator), locally_exact({{"w", "5"}}))[0].text;
  EXPECT_NE(
      header.find("at the origin, w = 5; poles at multiples of h = 1.257: order 2, symmetric, "
                  "symplectic"),
      std::string::npos)
      << header;
  // Of 12 halves of h w/2, one after the other.
  const std::string prepare = header.substr(header.find("Coefficients prepare("));
  EXPECT_NE(prepare.find("std::tan(1.25 * h)"), std::string::npos) << header;
  int tangents = 0;
  for (std::size_t at = header.find("std::tan("); at != std::string::npos;
       at = header.find("std::tan(", at + 1))
    ++tangents;
  EXPECT_EQ(tangents, 12);
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
}

// y, and 1/y - coth(y/2)/2 and cot(y/2)/2 - 1/y to 50 digits.
void expect_function(const char* text, const Rational& y, const RationalMatrix& a,
                     const Rational& tolerance) {
  const MatrixFunction f = gauge_function(a);
  ASSERT_EQ(f.terms.size(), 1U);
  const Rational value = evaluate(f.terms[0].function, {{"h", y}}).value();
  const Rational expected = parse_decimal(text).value();
  EXPECT_LT(abs(value - expected), tolerance * abs(expected)) << text;
}

TEST(GaugeFunction, IsThatOfEveryArgument) {
  const RationalMatrix growing = {{0, 1}, {1, 0}};
  const RationalMatrix oscillating = {{0, 1}, {-1, 0}};
  const Rational quad = parse_decimal("1e-35").value();
  expect_function("-8.33333333333333333333333333333333333333331944e-22",
                  parse_decimal("1e-20").value(), growing, quad);
  expect_function("-8.33333333333333333333333333333333333333334722e-22",
                  parse_decimal("1e-20").value(), oscillating, quad);
  expect_function("-8.33333319444444775132266865079573846929673856e-5",
                  parse_decimal("1e-3").value(), growing, quad);
  expect_function("-8.33333347222222552910061177248886016252411549e-5",
                  parse_decimal("1e-3").value(), oscillating, quad);
  expect_function("-6.19218010690101821805497719766113711555737265e-2",
                  parse_decimal("0.75").value(), growing, quad);
  expect_function("-6.30938968211395954754618973391812779051199251e-2",
                  parse_decimal("0.75").value(), oscillating, quad);
  expect_function("-3.35818244990177918879908954747334760242194867e-1", parse_decimal("6").value(),
                  growing, quad);
  expect_function("-3.67429294238393340138094235642990495581321834e+0", parse_decimal("6").value(),
                  oscillating, quad);
  expect_function("-4.50000002061153626686912092014040156230090013e-1", parse_decimal("20").value(),
                  growing, quad);
  expect_function("7.21175522678460024138734677841214655660333603e-1", parse_decimal("20").value(),
                  oscillating, quad);
  expect_function("-4.80000000000000000000192874984796391778301771e-1", parse_decimal("50").value(),
                  growing, quad);
  expect_function("-3.76457765436133711731030307225322217141430705e+0", parse_decimal("50").value(),
                  oscillating, quad);
  expect_function("-4.99e-1", parse_decimal("1000").value(), growing, quad);
  expect_function("9.43744064707109858261081642705139652832284131e-1",
                  parse_decimal("1000").value(), oscillating, quad);
}

// In double numbers as in others: no pole is taken from a pole.
TEST(GaugeFunction, HasNoDifferenceThatCancels) {
  for (const RationalMatrix& a :
       {RationalMatrix{{0, 1}, {1, 0}}, RationalMatrix{{0, 1}, {-1, 0}}}) {
    const MatrixFunction f = gauge_function(a);
    const CompiledExpression<double> function(f.terms[0].function,
                                              [](const std::string&) { return Address{}; });
    for (double y = 1e-12; y < 3; y *= 2) {
      const Rational exact = evaluate(f.terms[0].function, {{"h", Rational(y)}}).value();
      // In units of 2^-53: 7 of a term with its function, 12 sums of one sign, a product with h.
      EXPECT_NEAR(function(Frame<double>{.objects = {&y}, .indices = {}}) / to_double(exact), 1,
                  20 * 0x1p-53)
          << y;
    }
  }
}

// Four frequencies s +- i w: f(x) = 1/x - coth(x/2)/2 of x = h (1 + 2i).
TEST(GaugeFunction, OfComplexFrequenciesIsThatOfComplexNumbers) {
  // H = x px + y py + 2 (x py - y px)
  const MatrixFunction f =
      gauge_function({{1, -2, 0, 0}, {2, 1, 0, 0}, {0, 0, -1, -2}, {0, 0, 2, -1}});
  ASSERT_EQ(f.terms.size(), 2U);
  for (const long double h : {0x1p-40L, 0x1p-3L, 1.0L, 4.0L}) {
    const std::complex<long double> x(h, 2 * h);
    // Of small arguments their series.
    const std::complex<long double> exact =
        h < 1 / 64.0L ? -x / 12.0L + x * x * x / 720.0L : 1.0L / x - 0.5L / std::tanh(x / 2.0L);
    const Rational at(static_cast<double>(h));
    const auto value = [&](std::size_t i, std::size_t j) {
      Rational sum = 0;
      for (const MatrixTerm& term : f.terms)
        sum += evaluate(term.function, {{"h", at}}).value() * term.matrix[i][j];
      return sum;
    };
    // Two double numbers; of the long double ones a difference 2^8 times as small at h = 1/8.
    const double bound = 0x1p-51 * static_cast<double>(std::abs(exact));
    EXPECT_NEAR(to_double(value(0, 0)), static_cast<double>(exact.real()), bound);
    EXPECT_NEAR(to_double(value(1, 0)), static_cast<double>(exact.imag()), bound);
  }
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

// What a long formula is multiplied with is named by its place, not by the formula.
TEST(LocallyExact, NamesOfValuesAreShort) {
  const SourceText source =
      model("coordinate q\nmomentum p\nH = p^2/2 + exp(-50*(q + 1)) + exp(50*(q - 1))");
  const std::string text = generate(source, locally_exact({{"q", "0"}})).at(0).text;
  const std::size_t begin = text.find("StepReport solve(");
  const std::string solve = text.substr(begin, text.find("\n}\n", begin) - begin);
  std::size_t longest = 0;
  std::size_t length = 0;
  for (const char c : solve) {
    length = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ? length + 1 : 0;
    longest = std::max(longest, length);
  }
  EXPECT_LE(longest, 32U);
}

}  // namespace
}  // namespace hamgen::schemes_test
