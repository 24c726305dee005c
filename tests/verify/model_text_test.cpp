// What the front end makes of a file, held against the file's text: faults of a parser, of a table
// of functions, of a derivative are noticed.
#include "generator/verify/model_text.hpp"

#include <gtest/gtest.h>

#include <string>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/pipeline.hpp"
#include "generator/schemes/scheme.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen {
namespace {

std::string system_of(const std::string& formula) {
  return "size N = 3\ncoordinate q, x[1..N] with x[0] = 0, x[N+1] = 1/2\n"
         "coordinate y[0..2] periodic\nmomentum p, u[1..N], v[0..2]\nparameter a = 2\n"
         "let r = 1 + q^2\nH = " +
         formula + "\n";
}

// H of the one formula, as if the front end had read the other.
Finding read_as(const std::string& formula, const std::string& misread) {
  const Model model = read_model(make_source("system.ham", system_of(formula)));
  const Mechanics mechanics =
      derive(read_model(make_source("system.ham", system_of(misread))), false);
  return prove_model_read(model, mechanics,
                          {mechanics.energy, mechanics.gradient, mechanics.invariants});
}

TEST(ModelText, IsWhatIsDerived) {
  for (const std::string formula :
       {"p^2/2 - q^2/(1 + q^2)", "p^2/2 + sin(q)", "-2^2^3*q + 2^-3^2*p", "p^2/2 - -q^2",
        "p^2/2 + a*q/r/2*3 - q^2^-1^2",
        "sum(i = 1..N, u[i]^2/2) + sum(i = 0..N, (x[i+1] - x[i])^2)",
        "sum(i = 0..2, (y[i+1] - y[i-1])^4*i) + sum(i = 1..N, j = i+1..N, x[i]*u[j])",
        "p^2/2 + sum(i = 2..1, q) + atan2(q, 1 + p^2) + abs(q)^3 + pi*q*1.5e-1*.5",
        "log(5 + sin(q)) + exp(-q^2) + cosh(p) + (1 + q^2)^(1/3)"}) {
    const Finding found = read_as(formula, formula);
    EXPECT_EQ(found.verdict, Verdict::tested) << formula << ": " << found.detail;
  }
}

// Most are sums of names and digits; these are what such a sum may be taken for.
TEST(ModelText, HasSubscriptsAndEndsOfEveryKind) {
  for (const std::string subscript : {"1.0", "2*1", "0.5*2", "(i)", "1/1", "2^1 - 1", "i + 1 - 1",
                                      "-i + 2*i", "N - 2*1", "1e0", "+i", "i - -0", "N+1-N"}) {
    const std::string formula = "p^2/2 + sum(i = 1..1, x[" + subscript + "]^3*u[i])";
    const Finding found = read_as(formula, formula);
    EXPECT_EQ(found.verdict, Verdict::tested) << formula << ": " << found.detail;
  }
  for (const std::string range : {"1.0..N", "1..2.0", "1..0.5*4", "1. ..N", "1 .. N", "N - 2..N",
                                  "-1 + 2..2*1", "3 - N + 1..N"}) {
    const std::string formula = "p^2/2 + sum(i = " + range + ", x[i]^3*u[i])";
    const Finding found = read_as(formula, formula);
    EXPECT_EQ(found.verdict, Verdict::tested) << formula << ": " << found.detail;
    EXPECT_EQ(read_as(formula, "p^2/2 + x[2]^3*u[2]").verdict, Verdict::refuted) << formula;
  }
}

TEST(ModelText, IsNotWhatAFaultyFrontEndReads) {
  const std::pair<const char*, const char*> misread[] = {
      {"p^2/2 - q^2/(1 + q^2)", "p^2/2 + (-q)^2/(1 + q^2)"},  // -q^2 as (-q)^2
      {"p^2/2 + -q^2/(1 + q^2)", "p^2/2 + (-q)^2/(1 + q^2)"},
      {"p^2/2 - sin(q)", "p^2/2 - tan(q)"},  // a row of the table
      {"p^2/2 + 2^3^2*q", "p^2/2 + (2^3)^2*q"},
      {"p^2/2 + q/2*3", "p^2/2 + q/(2*3)"},
      {"p^2/2 + abs(q)*q^2", "p^2/2 + q*q^2"},
      {"p^2/2 + q*1e-3", "p^2/2 + q*1e-2"},
      {"p^2/2 + sum(i = 0..N, (x[i+1] - x[i])^2)", "p^2/2 + sum(i = 0..N-1, (x[i+1] - x[i])^2)"},
  };
  for (const auto& [formula, other] : misread) {
    const Finding found = read_as(formula, other);
    EXPECT_EQ(found.verdict, Verdict::refuted) << formula << " read as " << other;
    EXPECT_NE(found.detail.find("by the text of the file"), std::string::npos) << found.detail;
  }
}

TEST(ModelText, HasAnotherGradientThanAWrongDerivative) {
  const Model model = read_model(make_source("system.ham", system_of("p^2/2 - cos(q)*x[1]")));
  const Mechanics mechanics = derive(model, false);
  for (std::size_t i = 0; i < mechanics.gradient.size(); ++i) {
    std::vector<Expression> gradient = mechanics.gradient;
    gradient[i] += Expression(Rational(1, 1000)) * Expression::symbol("p");
    const Finding found = prove_model_read(model, mechanics, {mechanics.energy, gradient, {}});
    EXPECT_EQ(found.verdict, Verdict::refuted) << i;
  }
}

// What cancels takes the end of the domain away with it.
TEST(ModelText, HasNoValueWhereWhatCancelsHasNone) {
  const auto beyond = [](const std::string& formula) {
    return point_beyond_text(make_source("system.ham", system_of(formula)), {});
  };
  for (const char* formula : {"p^2/2 + (q^(1/3))^3", "p^2/2 + exp(log(q))", "p^2/2 + sqrt(q)^2*p"})
    EXPECT_NE(beyond(formula).find("q = -"), std::string::npos)
        << formula << ": " << beyond(formula);
  for (const char* formula :
       {"p^2/2 + q^(1/3)", "p^2/2 + sqrt(r)^2", "p^2/2 + log(q)", "p^2/2 - 1/q"})
    EXPECT_EQ(beyond(formula), "") << formula;
  const Finding found = read_as("p^2/2 + (q^(1/3))^3", "p^2/2 + (q^(1/3))^3");
  EXPECT_EQ(found.verdict, Verdict::tested);
  EXPECT_NE(found.detail.find("where the text has no value"), std::string::npos) << found.detail;
}

// abs(x) as x in the instructions: only negative points tell.
TEST(Program, WithAMagnitudeLeftOutIsRefuted) {
  const Mechanics mechanics =
      verify_test::mechanics_of("coordinate q\nmomentum p\nH = p^2/2 + q^2/2 + exp(-abs(q))*q^2\n");
  const Expression half(Rational(1, 2));
  const Scheme scheme = family_member(1, {{half}}, {{Expression(0)}}, {{Expression(0)}});
  const LoweredStep lowered = verify_test::lowered_of(mechanics, scheme, "");
  Program code = build_program(lowered);
  const auto verdict = [&] {
    return prove_emitted(mechanics, scheme, lowered.plan, code, mechanics.energy).verdict;
  };
  ASSERT_EQ(verdict(), Verdict::tested);
  int changed = 0;
  verify_test::for_each_expression(code, [&](Expression& e) {
    if (e.kind() != Kind::function || e.name() != "abs") return;
    const Expression inside = e.operands()[0];
    e = inside;
    ++changed;
  });
  ASSERT_GT(changed, 0);
  EXPECT_EQ(verdict(), Verdict::refuted);
}

TEST(Required, EmittedCodeFailsWithTheModelAndTheProgram) {
  for (const char* property : {kModelRead, kProgram, kEmittedCode}) {
    EXPECT_NO_THROW(require_emitted({{property, Verdict::tested, ""}}));
    EXPECT_THROW(require_emitted({{property, Verdict::refuted, "line 3"}}), ProofError) << property;
  }
}

}  // namespace
}  // namespace hamgen
