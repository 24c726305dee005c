// Faults planted in headers in C: each is found, at its line.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/readback/planted.hpp"

namespace hamgen::readback_test {
namespace {

Request in_c(Request request = {}) {
  request.format = "c-header";
  return request;
}

TEST(PlantedFaultInC, OfTheTextIsFoundAtItsLine) {
  const Request splitting = in_c({.scheme = "stormer-verlet"});
  const std::vector<Fault> faults = {
      {"a - b as a + b", "pendulum", in_c(), "(p * p) - par->eps", "(p * p) + par->eps"},
      {"parentheses dropped", kRational, in_c(), "((1.0 + t2) * (par->a", "(1.0 + t2 * (par->a"},
      {"0.5 as 0.25", "kepler", in_c(), "k.c1 = -0.5 * h", "k.c1 = -0.25 * h"},
      {"sign of the residual", "pendulum", in_c(), "delta_q = -R_q", "delta_q = R_q"},
      {"matrix transposed", "henon_heiles", in_c(), "const double R_q1_q2 = k->c1 * d_p1_d_q2",
       "const double R_q1_q2 = k->c1 * d_p2_d_q2"},
      {"update subtracted", "pendulum", in_c(), "q_bar += delta_q;", "q_bar -= delta_q;"},
      {"dz added twice", "pendulum", in_c(),
       "hamgen_two_sum_with_rest(&self->z.q, &self->carry.q, dz.q, rest.q);",
       "hamgen_two_sum_with_rest(&self->z.q, &self->carry.q, dz.q, rest.q);\n"
       "  hamgen_two_sum_with_rest(&self->z.q, &self->carry.q, dz.q, rest.q);"},
      {"sign of the kick", "pendulum", splitting, "-k->kick[0]", "k->kick[0]"},
      {"a number of the tableau", "pendulum", in_c({.scheme = "rk4"}), "0.5 * h * f_2[k]",
       "0.5000000000000002 * h * f_2[k]"},
      {"all substeps of the first's length", "pendulum", in_c({.scheme = "yoshida-4"}),
       "self.lengths[i] = h * fractions[i];", "self.lengths[i] = h * fractions[0];"},
      {"q and p exchanged", "pendulum", in_c(), "const double q = z->q;", "const double q = z->p;"},
      {"index of the solution", "henon_heiles", in_c(), "start->value[1] = q2_bar",
       "start->value[0] = q2_bar"},
      {"stops at 1e9 eps", "pendulum", in_c(), "round_off = hamgen_epsilon * scale;",
       "round_off = 1e9 * hamgen_epsilon * scale;"},
      {"lengths h^2", "pendulum", splitting, "k.kick[0] = 0.5 * h;", "k.kick[0] = 0.5 * h * h;"},
      {"a/(b*c) as a/b*c", kRational, in_c(), "t2 / ((1.0 + t2) * (par->a + q * t1))",
       "t2 / (1.0 + t2) * (par->a + q * t1)"},
      {"sin as cos", "pendulum", in_c(), "H_q = par->eps * sin(q_bar)",
       "H_q = par->eps * cos(q_bar)"},
  };
  EXPECT_EQ(faults.size(), 16U);
  for (const Fault& fault : faults) expect_found(fault);
}

// What only C has: addresses, suffixes, prefixes, lists of values in order.
TEST(PlantedFaultInC, OfAddressesAndNamesIsFound) {
  const Request single = in_c({.scalar = "float"});
  const std::vector<Fault> faults = {
      {"in double", "pendulum", single, "par->eps * sinf(q)", "par->eps * sin(q)"},
      {"of another scalar", "pendulum", single, "hamgen_two_sum_with_restf(&self->z.q",
       "hamgen_two_sum_with_rest(&self->z.q"},
      {"in C++", "pendulum", in_c(), "par->eps * sin(q)", "par->eps * std::sin(q)"},
      {"another literal", "pendulum", single, "0.5f * (p * p)", "0.5 * (p * p)"},
      {"another type", "pendulum", in_c(), "const double R_q =", "const float R_q ="},
      {"integers' magnitude", "pendulum", in_c(), "{ return fabs(x); }", "{ return abs(x); }"},
      {"values in another order", "harmonic", in_c(), "  double q;\n  double p;\n",
       "  double p;\n  double q;\n"},
      {"another default", "pendulum", in_c(), "par = {0.03}", "par = {0.3}"},
      {"an address for a value", "pendulum", in_c(), "const double q = z->q;",
       "const double q = *z;"},
      {"a value for an address", "pendulum", in_c(), "hamgen_NewtonRule_begin(&start->rule_0",
       "hamgen_NewtonRule_begin(start->rule_0"},
      {"a function without its prefix", "henon_heiles", in_c({.scheme = "stormer-verlet"}),
       "if (!start->known) henon_heiles_stormer_verlet_potential_gradient",
       "if (!start->known) potential_gradient"},
      {"of the other prefix", "pendulum", in_c(), "pendulum_State* z) {",
       "pendulum_implicit_midpoint_State* z) {"},
      {"start without its rule", "pendulum", in_c(), "NewtonRule_of_power(2);",
       "NewtonRule_of_power(1);"},
      {"carry of z", "pendulum", in_c({.scheme = "yoshida-4"}), "self->carry = carry;",
       "self->carry = z;"},
      {"not reset", "pendulum", in_c(), "self->carry = (pendulum_State){0};", "self->steps = 0;"},
      {"extrapolation of another degree", "pendulum", in_c(), "(double)(degree + 1) * solution[i]",
       "(double)(degree + 2) * solution[i]"},
      {"a section that is skipped", "pendulum", in_c(), "#ifndef HAMGEN_C_FLOAT64_NEWTON_RULE",
       "#ifndef HAMGEN_C_FLOAT64_TWO_SUM"},
      {"fast arithmetic allowed", "pendulum", in_c(), "#pragma clang fp reassociate(off)",
       "#pragma clang fp reassociate(on)"},
      {"an argument without a name", "kepler", in_c({.scheme = "saba-2"}),
       "potential_gradient(const kepler_Parameters* par,",
       "potential_gradient(const kepler_Parameters*,"},
      {"another include", "pendulum", in_c(), "#include <stdbool.h>", "#include <tgmath.h>"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

// What OpenCL C has in other words than C.
TEST(PlantedFaultInC, OfTheWordsOfOpenClIsFound) {
  const Request opencl = {.format = "opencl-header"};
  const Request single = {.scalar = "float", .format = "opencl-header"};
  const std::vector<Fault> faults = {
      {"sin as cos", "pendulum", opencl, "H_q = par->eps * sin(q_bar)",
       "H_q = par->eps * cos(q_bar)"},
      {"a constant that varies", "pendulum", opencl, "__constant double hamgen_epsilon",
       "static double hamgen_epsilon"},
      {"another constant", "pendulum", opencl, "hamgen_epsilon = 0x1p-52",
       "hamgen_epsilon = 0x1p-42"},
      {"a function of C", "pendulum", single, "par->eps * sin(q)", "par->eps * sinf(q)"},
      {"a shorter number", "pendulum", opencl, "  long iterations;", "  int iterations;"},
      {"products that are contracted", "pendulum", opencl, "#pragma OPENCL FP_CONTRACT OFF",
       "#pragma OPENCL FP_CONTRACT ON"},
      {"an include", "pendulum", opencl, "#pragma OPENCL FP_CONTRACT OFF", "#include <math.h>"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

// What is no scalar of the language is no header in it, whatever it says.
TEST(PlantedFaultInC, OfAScalarThatThereIsNotIsFound) {
  const Request opencl = {.format = "opencl-header"};
  for (const auto& [request, scalar] :
       {std::pair(in_c(), "quad"), {opencl, "quad"}, {opencl, "long-double"}}) {
    Emitted file = emitted("pendulum", request);
    file.scalar = scalar;
    const ReadBack found = file.read(file.text);
    EXPECT_EQ(found.outcome, ReadBack::Outcome::different);
    EXPECT_EQ(found.line, 1);
    EXPECT_NE(found.what.find(" has no "), std::string::npos) << found.what;
  }
}

TEST(ReadBackOfC, ATextThatComputesTheSameIsTheSame) {
  const Emitted header = emitted("pendulum", in_c());
  const std::vector<std::pair<std::string, std::string>> freedoms = {
      {"par->eps * sin(q_bar)", "sin((q_bar)) * par->eps"},
      {"k.c1 = -0.5 * h;", "k.c1 = -(h * 0x1p-1);  // half"},
      {"const double q = z->q;\n", "/* q */ double\n  q=z->q;\n"},
      {"  (void)par;\n", ""},
      {"rest->p = carry->p - h * change_H_q;", "rest->p = carry->p + -change_H_q * h;"},
  };
  for (const auto& [from, to] : freedoms) {
    std::string changed = header.text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    const ReadBack found = header.read(changed);
    EXPECT_EQ(found.outcome, ReadBack::Outcome::same) << to << ": " << found.line << found.what;
  }
}

// Names of the model that look like those of the header.
TEST(ReadBackOfC, NamesOfTheModelAreNamesOfTheModel) {
  for (const char* model :
       {"coordinate solve\nmomentum State\nparameter Real = 2\nH = State^2/2 + Real*solve^4\n",
        "system hamgen\ncoordinate epsilon, start\nmomentum largest, step\n"
        "H = (largest^2 + step^2)/2 + epsilon^2*start^2\n",
        "system a\ncoordinate two_sum\nmomentum Verdict\nparameter N = 1\n"
        "H = Verdict^2/2 + N*sin(two_sum)\n"}) {
    for (const char* name_space : {"", "b", "b::b", "solve_all::a"}) {
      const Emitted header = emitted(model, in_c({.name_space = name_space}));
      const ReadBack found = header.read(header.text);
      EXPECT_EQ(found.outcome, ReadBack::Outcome::same)
          << model << name_space << " " << found.line << ": " << found.what;
    }
  }
}

TEST(ReadBackOfC, EveryWordCounts) {
  expect_every_word_counts(emitted("pendulum", in_c()), 9);
  expect_every_word_counts(emitted("henon_heiles", in_c({.scheme = "yoshida-4"})), 29);
  expect_every_word_counts(emitted("kepler", in_c({.scheme = "saba-2", .scalar = "float"})), 17);
}

}  // namespace
}  // namespace hamgen::readback_test
