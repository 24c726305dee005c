// Derivatives that are ready before a step: Note [derivatives ahead] of program/ahead.hpp.
#include <gtest/gtest.h>

#include <functional>

#include "generator/schemes/all_schemes.hpp"
#include "generator/verify/proof.hpp"
#include "tests/verify/mutants.hpp"

namespace hamgen::verify_test {
namespace {

// Note [derivatives ahead]: the first iteration is at the point of what is ready.
TEST(Ahead, DerivativesThatAreReadyAreTakenWithTheirPoint) {
  const Mechanics mechanics = mechanics_of("coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n");
  const Scheme scheme = for_system(*find_scheme("implicit-midpoint"), mechanics);
  const LoweredStep lowered = lowered_of(mechanics, scheme, "");
  ASSERT_TRUE(lowered.plan.ahead);
  const auto with = [&](const std::function<void(Routine&)>& change) {
    Program code = build_program(lowered);
    for (Routine& routine : code.routines) change(routine);
    return prove_emitted(mechanics, scheme, lowered.plan, code, mechanics.energy).verdict;
  };
  EXPECT_EQ(with([](Routine&) {}), Verdict::proved);
  const auto in_solve = [](const std::function<void(If&)>& change) {
    return [change](Routine& routine) {
      for (Instruction& outer : routine.body) {
        auto* iterate = std::get_if<Iterate>(&outer.value);
        for (std::size_t i = 0; iterate != nullptr && i < iterate->body.size(); ++i) {
          auto* branch = std::get_if<If>(&iterate->body[i].value);
          if (branch != nullptr) change(*branch);
        }
      }
    };
  };
  // The point is not taken; nor is it where they are evaluated.
  EXPECT_EQ(with(in_solve([](If& branch) {
              if (branch.set) branch.then.clear();
            })),
            Verdict::refuted);
  EXPECT_EQ(with(in_solve([](If& branch) {
              if (!branch.set) branch.then.erase(branch.then.begin());
            })),
            Verdict::refuted);
  // They are not those at the point.
  EXPECT_EQ(with([](Routine& routine) {
              if (routine.name == "derivatives") routine.body.pop_back();
            }),
            Verdict::refuted);
}

}  // namespace
}  // namespace hamgen::verify_test
