// Faults planted in what `hamgen run` compiles: each is found, at its line.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/readback/planted.hpp"

namespace hamgen::readback_test {
namespace {

Request plugin(Request request = {}) {
  request.format = "cpp-plugin";
  return request;
}

TEST(PlantedFaultInAPlugin, OfTheInterfaceIsFoundAtItsLine) {
  const Request wide = plugin({.scalar = "quad"});
  const Request tangent = plugin({.tangent = true});
  const Request plain = plugin({.plain_sums = true});
  const Request watched = plugin({.watch_modified = 2, .step = Rational(1, 10)});
  const std::vector<Fault> faults = {
      {"q and p exchanged when loaded", "pendulum", plugin(), "each(0, z.q,", "each(1, z.q,"},
      {"p is q", "pendulum", plugin(), "each(1, z.p,", "each(1, z.q,"},
      {"components exchanged", "kepler", plugin(), "z.q2, beside.q2", "z.q1, beside.q2"},
      {"a parameter of another place", "outer_solar_system", plugin(), "each(1, par.",
       "each(2, par."},
      {"the low part of another", "pendulum", wide, "static_cast<Real>(lo[i])",
       "static_cast<Real>(lo[0])"},
      {"the low part forgotten", "pendulum", wide, "value + static_cast<Real>(lo[i]) : value",
       "value : value"},
      {"arrays exchanged", "fput", plugin(), "each(n + i, z.p[i],", "each(n + i, z.q[i],"},
      {"given back exchanged", "pendulum", plugin(), "state[i] = high_part(x,",
       "state[1 - i] = high_part(x,"},
      {"in another order", "fput", plugin(), "each(i, z.q[i],", "each(n - 1 - i, z.q[i],"},
      {"carry of another", "pendulum", plugin(), "z.q, beside.q", "z.q, beside.p"},
      {"the state for its carry", "pendulum", plugin(), "return run.carry();",
       "return run.state();"},
      {"a carry where there is none", "pendulum", plain, "{ return State(); }",
       "{ return run.state(); }"},
      {"of which no step fails", "pendulum", plugin(), "never_fails = false", "never_fails = true"},
      {"h as a float", "pendulum", plugin(), "static_cast<Real>(h) + static_cast<Real>(h_lo)",
       "static_cast<float>(h) + static_cast<Real>(h_lo)"},
      {"two steps for one", "pendulum", plugin(), "const StepReport last = run->propagator.step();",
       "run->propagator.step(); const StepReport last = run->propagator.step();"},
      {"a failure hidden", "pendulum", plugin(), "if (!last.converged) {",
       "if (!last.converged && !finite) {"},
      {"the energy of the start", "pendulum", plugin(),
       "energy_last < energy_min) energy_min = energy_last;",
       "energy_last < energy_min) energy_min = energy_max;"},
      {"the largest energy as the last", "pendulum", plugin(),
       "total.energy_last = high_part(energy_last,", "total.energy_last = high_part(energy_max,"},
      {"invariants of another state", "kepler", plugin(), "each(i, result[i])",
       "each(i, result[0])"},
      {"modified energies of another step", "pendulum", watched, "modified_energies(par, 0.1,",
       "modified_energies(par, 0.2,"},
      {"modified energies in place of invariants", "kepler", watched, "each(3 + i, modified",
       "each(2 + i, modified"},
      {"an increment of another", "pendulum", tangent, "x -= start;", "x -= 2 * start;"},
      {"a tangent of another size", "kepler", tangent, "variables = 4", "variables = 2"},
      {"a matrix transposed", "pendulum", tangent, "(m[i][j])", "(m[j][i])"},
      {"the gradient in another place", "pendulum", plugin(), "values[i] = static_cast<double>(x);",
       "values[1 - i] = static_cast<double>(x);"},
      {"another count", "pendulum", plugin(), "VERSION, 1, 1, 0, 53", "VERSION, 1, 1, 1, 53"},
      {"another precision", "pendulum", plugin(), "VERSION, 1, 1, 0, 53", "VERSION, 1, 1, 0, 64"},
      {"functions exchanged", "pendulum", plugin(), "get_state, get_carry,",
       "get_carry, get_state,"},
      {"whatever the flags", "pendulum", plugin(), "hamgen_arithmetic_is_ieee() ?", "true ?"},
      {"another name", "pendulum", plugin(), "53, \"pendulum, implicit", "53, \"kepler, implicit"},
      {"units exchanged", "pendulum", plugin(), "{\"q\", \"rad\"", "{\"q\", \"rad/s\""},
      {"a variable in another's place", "kepler", plugin(), "{\"q1\", ", "{\"q2\", "},
      {"an array of another length", "fput", plugin(), "1, 1, 32},", "1, 1, 31},"},
      {"parameters for variables", "pendulum", plugin(), "restore_run, variable_list,",
       "restore_run, parameter_list,"},
      {"defaults of another", "outer_solar_system", plugin(), "give_parameters(Parameters(),",
       "give_parameters(Parameters(par),"},
      {"the time of the propagator alone", "pendulum", plugin(),
       "return run->start_time + run->propagator.time();", "return run->propagator.time();"},
      {"time lost where h changes", "pendulum", plugin(), "  set_time(run, t);\n",
       "  set_time(run, run->propagator.time());\n"},
      {"a start of another time", "pendulum", plugin(), "static_cast<Real>(t) +",
       "static_cast<Real>(t) -"},
      {"h and parameters that stay", "pendulum", plugin(), "Propagator(par, h, z);",
       "Propagator(par, run->propagator.h(), z);"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

// The text above the interface is that of a header.
TEST(PlantedFaultInAPlugin, OfTheStepIsFoundAtItsLine) {
  const std::vector<Fault> faults = {
      {"sin as cos", "pendulum", plugin(), "H_q = par.eps * __builtin_sin(q_bar)",
       "H_q = par.eps * __builtin_cos(q_bar)"},
      {"of another scalar", "pendulum", plugin({.scalar = "float"}), "__builtin_sinf(q)",
       "__builtin_sin(q)"},
      {"update subtracted", kNonseparable, plugin(), "q_bar += delta_q;", "q_bar -= delta_q;"},
      {"another interface", "pendulum", plugin(), "HAMGEN_NOT_FINITE = 2", "HAMGEN_NOT_FINITE = 1"},
      {"another place", "pendulum", plugin(), "return place.memory", "return nullptr"},
  };
  for (const Fault& fault : faults) expect_found(fault);
}

TEST(ReadBackOfAPlugin, EveryWordCounts) {
  expect_every_word_counts(emitted("pendulum", plugin({.tangent = true})), 13);
  expect_every_word_counts(emitted("fput", plugin({.tangent = true})), 37);
}

// A plugin is no header, and a header no plugin.
TEST(ReadBackOfAPlugin, ItsInterfaceBelongsToIt) {
  const Emitted whole = emitted("pendulum", plugin());
  const std::size_t at = whole.text.find("struct hamgen_run");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(whole.read(whole.text.substr(0, at)).outcome, ReadBack::Outcome::different);
  const Emitted header = emitted("pendulum", {});
  EXPECT_EQ(header.read(header.text + whole.text.substr(at)).outcome, ReadBack::Outcome::different);
}

}  // namespace
}  // namespace hamgen::readback_test
