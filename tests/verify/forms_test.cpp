// What textbooks write down: linear equations whose constants are made of parameters in one way in
// the gradient and in another in the matrix, coordinates that nothing depends on, equations that
// are solved one after the other.  A right step of each is proved, not refuted for how it is
// written.
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/program/arithmetic.hpp"
#include "generator/stages.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen::verify_test {
namespace {

const std::string kOne =
    "coordinate x\nmomentum p\nparameter a = 1.5\nparameter b = 2.25\nparameter m = 1.25\n"
    "parameter w = 2\nH = ";
const std::string kTwo =
    "coordinate x, y\nmomentum px, py\nparameter m = 1.25\nparameter w = 2\nparameter k = 1.75\n"
    "parameter B = 0.7\nH = ";

Finding program_of(const std::string& text, const Request& request) {
  const Proof proof = verify_step(make_source("m.ham", text), request);
  const auto found = std::ranges::find(proof, "program", &Finding::property);
  EXPECT_NE(found, proof.end());
  return found == proof.end() ? Finding{} : *found;
}

// Proved, or where K or a corner leaves it to many points, at least tested.
void expect_right(const std::string& system, const std::vector<std::string>& energies,
                  const std::vector<Request>& requests, Verdict least = Verdict::proved) {
  for (const std::string& energy : energies) {
    for (const Request& request : requests) {
      const Finding program = program_of(system + energy + "\n", request);
      EXPECT_TRUE(program.verdict == Verdict::proved || program.verdict == least)
          << energy << ": " << request.scheme.text() << " alpha " << request.alpha.text()
          << " beta " << request.beta.text() << " " << request.gauge.text() << " "
          << request.solver.text() << ": " << program.detail;
    }
  }
}

TEST(Forms, OfOscillatorsAreRight) {
  const std::vector<std::string> energies = {
      "p^2/2 + x^2/2",     "p^2/2 + 3*a^2*x^2",       "p^2/2 + (a+b)*x^2", "p^2/2 + exp(a)*x^2",
      "p^2/2 + x^2/(a+b)", "p^2/(2*m) + m*w^2*x^2/2", "(a+b)*p^2 + x^2"};
  expect_right(
      kOne, energies,
      {{}, {.alpha = "3/10"}, {.beta = "h/3"}, {.scheme = "yoshida-4"}, {.solver = "fixed-point"}});
  expect_right(kOne, energies, {{.gauge = "locally-exact"}}, Verdict::tested);
  expect_right(kOne, {"p^2/2 + x", "p^2/(2*m) + a*x"}, {{}, {.beta = "h/3"}});
  expect_right(kOne, {"p^2/2 + a*x*p + w^2*x^2/2"},
               {{}, {.beta = "h/3"}, {.solver = "fixed-point"}}, Verdict::tested);
  // With K in place of H.
  expect_right(kOne,
               {"p^2/2 + x^2/2", "p^2/2 + 3*a^2*x^2", "p^2/(2*m) + m*w^2*x^2/2", "(a+b)*p^2 + x^2",
                "p^2/2 + x"},
               {{.order = 4}, {.order = 6}}, Verdict::tested);
}

TEST(Forms, OfCoupledLinearEquationsAreRight) {
  expect_right(kTwo,
               {"(px^2+py^2)/2 + (x-y)^2/2", "px^2/(2*m)+py^2/2+k*(x-y)^2/2",
                "(px^2+py^2)/2 - w*(x*py-y*px) + (x^2+y^2)/2", "(px+B*y)^2/2+(py-B*x)^2/2",
                "(px^2+py^2)/(2*m) + m*w^2*(x^2+y^2)/2", "(px^2+py^2)/2 + x*y/3 + x^2 + y^2"},
               {{}, {.beta = "h/7"}, {.gauge = "locally-exact"}, {.order = 4}}, Verdict::tested);
}

TEST(Forms, OfLinearEquationsBesideOthersAreRight) {
  expect_right(kTwo,
               {"px^2/2+py^2/2 + m*w^2*x^2/2 - cos(y)", "(px^2+py^2)/2 + m*w^2*x^2/2 + y^4/4"},
               {{}, {.beta = "h/7"}, {.gauge = "locally-exact"}, {.solver = "fixed-point"}},
               Verdict::tested);
}

// Their momenta are constant, and keep what rounding once took from them.
TEST(Forms, OfCyclicCoordinatesAreRight) {
  expect_right(kTwo, {"px^2/2+py^2/2+x^4", "px^2/2 + py^2/2/m + w*x^2/2"},
               {{},
                {.beta = "h/7"},
                {.scheme = "stormer-verlet"},
                {.scheme = "position-verlet"},
                {.scheme = "symplectic-euler-a"},
                {.scheme = "ruth-3"}});
}

// Of a potential with a corner K has terms that cancel, but for the last of seventy digits.
TEST(Forms, OfACornerAreRight) {
  expect_right(kOne, {"p^2/2 + abs(x)"}, {{.order = 4}, {.order = 6}}, Verdict::tested);
}

// The fixed point of L is found below rounding, and u follows from it linearly.
TEST(Forms, OfALinearBlockBehindAFixedPointAreRight) {
  const std::string system =
      "coordinate x, phi\nmomentum u, L\nH = u^2/2 + x^4/8 + (L - x^2)^2/2*(1 + sin(phi)/10)\n";
  for (const bool plain : {false, true}) {
    for (const char* beta : {"", "h/7"}) {
      Request request{.alpha = "0", .solver = "fixed-point", .plain_sums = plain};
      if (*beta != 0) request.beta = beta;
      const Stages stages = run_stages(make_source("m.ham", system), request);
      EXPECT_NE(to_text(stages.program).find("fixed point"), std::string::npos);
      EXPECT_EQ(program_of(system, request).verdict, Verdict::proved) << plain << beta;
    }
  }
}

// A momentum that follows from a fixed point by itself has what that lacks, too.
TEST(Forms, OfAMomentumBehindAFixedPointAreRight) {
  expect_right(kOne, {"p^2/2 + x^3/3", "a*p^2/2 + b*x^4/4", "p^2/2 + b*cos(x)"},
               {{.alpha = "0", .gamma = "-h/5", .solver = "fixed-point"},
                {.alpha = "1", .beta = "h/5", .solver = "fixed-point"}});
}

// The gradient that a Newton step has renewed has lost what the one before it had.
TEST(Forms, OfRenewedGradientsAreRight) {
  expect_right(kOne, {"3*p^2/2 + a*x^2/2", "(a+b)*p^2/2 + x^2/2", "exp(a)*p^2/4 + x^4/4"},
               {{.alpha = "1", .beta = "h/10"},
                {.alpha = "0", .beta = "h/10", .gamma = "h/6"},
                {.alpha = "1", .beta = "h/7", .gamma = "-h/5"}},
               Verdict::tested);
}

// With K of order 3 in place of H the Hessian is that of a shorter K, and does not say that the
// equations are linear.
TEST(Forms, OfALongKAreNotLinear) {
  const std::string kepler =
      "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2)\n";
  for (const char* solver : {"newton", "fixed-point"}) {
    const Request request{.alpha = "0", .order = 3, .solver = solver};
    const Finding program = program_of(kepler, request);
    EXPECT_EQ(program.verdict, Verdict::tested) << solver << ": " << program.detail;
  }
}

// A loss that is told of another product than the one that is used is refuted, whatever its
// constants are called.
TEST(Forms, ALossOfAnotherProductIsRefuted) {
  const SourceText source = make_source("m.ham", kOne + "p^2/(2*m) + m*w^2*x^2/2\n");
  Stages stages = run_stages(source, {});
  const auto prove = [&] {
    const StepEquations& equations = stages.plan.equations;
    return prove_emitted(equations.mechanics, equations.scheme, stages.plan, stages.program,
                         equations.mechanics.energy);
  };
  ASSERT_EQ(prove().verdict, Verdict::proved) << prove().detail;
  int losses = 0;
  for (Routine& routine : stages.program.routines) {
    for (Instruction& instruction : routine.body) {
      auto* let = std::get_if<Let>(&instruction.value);
      if (let == nullptr || let->value.kind() != Kind::function) continue;
      if (let->value.name() != kProductError) continue;
      const Expression before = let->value;
      const Expression& x = before.operands()[0];
      const Expression& y = before.operands()[1];
      for (const Expression& other : {x + x, y}) {
        let->value = Expression::apply(kProductError, {other, y});
        EXPECT_EQ(prove().verdict, Verdict::refuted) << to_text(before) << to_text(other);
      }
      let->value = before;
      ++losses;
    }
  }
  EXPECT_GE(losses, 4);
}

}  // namespace
}  // namespace hamgen::verify_test
