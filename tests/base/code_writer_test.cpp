#include "generator/base/code_writer.hpp"

#include <gtest/gtest.h>

namespace hamgen {
namespace {

std::string written(const std::string& line) {
  CodeWriter out;
  out.line(line);
  return out.text();
}

TEST(CodeWriter, GoesOnUnderTheFirstArgumentOfAHead) {
  EXPECT_EQ(written("inline StepReport solve(const Parameters& par, Real h, const State& z, const "
                    "State& carry, State& dz) {"),
            "inline StepReport solve(const Parameters& par, Real h, const State& z, const State& "
            "carry,\n"
            "                        State& dz) {\n");
}

// Where an argument would pass the last column there.
TEST(CodeWriter, GoesOnInALineOfItsOwnBehindALongName) {
  EXPECT_EQ(written("static inline void pendulum_implicit_midpoint_History_forget("
                    "pendulum_implicit_midpoint_History* history, int count) {"),
            "static inline void pendulum_implicit_midpoint_History_forget(\n"
            "    pendulum_implicit_midpoint_History* history, int count) {\n");
}

TEST(CodeWriter, TearsNoTypeOfAnAddressFromItsName) {
  EXPECT_EQ(written("inline void collect_all_of_what_is_lost(const Parameters& parameters_of_it, "
                    "const State& state_of_it) {"),
            "inline void collect_all_of_what_is_lost(const Parameters& parameters_of_it,\n"
            "                                        const State& state_of_it) {\n");
  EXPECT_EQ(written("return first_of_the_conditions_that_hold_of_it_and_of_all && "
                    "the_second_of_the_conditions_of_all_others;"),
            "return first_of_the_conditions_that_hold_of_it_and_of_all &&\n"
            "       the_second_of_the_conditions_of_all_others;\n");
}

TEST(CodeWriter, PutsWhatAConditionControlsInALineOfItsOwn) {
  EXPECT_EQ(written("  if (unit && rule->power == 2 && 1024 * rule->contraction < 1) "
                    "rule->contraction = (double)1 / 1024;"),
            "  if (unit && rule->power == 2 && 1024 * rule->contraction < 1)\n"
            "    rule->contraction = (double)1 / 1024;\n");
}

// And no bracket.
TEST(CodeWriter, LeavesABlockWhereItBegins) {
  EXPECT_EQ(written("if (first_of_the_conditions_that_hold_of_it_and_of_all && "
                    "the_second_of_the_conditions_of_all_othe) {"),
            "if (first_of_the_conditions_that_hold_of_it_and_of_all &&\n"
            "    the_second_of_the_conditions_of_all_othe) {\n");
}

// Behind its " = ", then less far to the right, then as soon as may be.
TEST(CodeWriter, BreaksWhereItCanIfNothingFits) {
  const std::string call = "henon_heiles_float32_implicit_midpoint_sweeps_2_solve_of_all_of_them";
  const std::string report = "  const hamgen_StepReportf report =";
  EXPECT_EQ(written(report + " " + call + "(&self->par, NULL);"),
            report + "\n      " + call + "(&self->par, NULL);\n");
  EXPECT_EQ(written(report + " " + call + "(&self->par_of_it, self->h_of_it, NULL);"),
            report + "\n      " + call + "(&self->par_of_it,\n" +
                std::string(call.size() + 7, ' ') + "self->h_of_it, NULL);\n");
  const std::string name(60, 'x');
  EXPECT_EQ(written("double a = b * (" + name + " + " + name + ");"),
            "double a = b *\n           (" + name + " +\n            " + name + ");\n");
  const std::string long_name(98, 'y');
  EXPECT_EQ(written("f(" + long_name + ", " + name + ");"),
            "f(" + long_name + ",\n  " + name + ");\n");
}

TEST(CodeWriter, LeavesALineThatFits) {
  for (const char* line : {"if (open) close(all);", "inline void f(A* a) {", ""})
    EXPECT_EQ(written(line), std::string(line) + "\n");
}

}  // namespace
}  // namespace hamgen
