// What a plugin's table says of the model, and what its setters do to a run.
#include <gtest/gtest.h>

#include <string>

#include "generator/pipeline.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

const std::string driver = R"(
#include <cstdio>
#include <cmath>

static int failures = 0;
static void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("not so: %s\n", what);
  ++failures;
}

static void print(const hamgen_quantity* list) {
  for (; list->name; ++list)
    std::printf("%s [%s] %s: %d %d %d\n", list->name, list->unit, list->comment, list->is_array,
                list->first, list->count);
}

int main() {
  const hamgen_plugin& plugin = *hamgen_plugin_entry();
  print(plugin.variable_list);
  print(plugin.parameter_list);
  print(plugin.invariant_list);
  double par[3], par_lo[3];
  plugin.default_parameters(par, par_lo);
  std::printf("%.17g %.17g %.17g\n", par[0], par[1], par[2]);
  expect(par_lo[0] != 0.0 && std::fabs(par_lo[0]) < 1e-17, "the lo of 1/10 in a wide scalar");
  double start[80] = {}, z[80], z_lo[80], other[80], other_lo[80], lo = 1.0;
  for (int i = 0; i < 40; ++i) start[i] = std::sin(0.3 * i);
  hamgen_report report;
  const auto state = [&](hamgen_run* run, double* values, double* low) {
    plugin.get_state(run, values, low);
  };
  const auto same = [&] {
    for (int i = 0; i < 80; ++i)
      if (z[i] != other[i] || z_lo[i] != other_lo[i]) return false;
    return true;
  };

  hamgen_run* run = plugin.create(par, par_lo, 0.125, 0.0, start, nullptr);
  expect(plugin.get_time(run, nullptr) == 0.0, "a run begins at 0");
  plugin.advance(run, 10, 0, &report);
  expect(report.steps_done == 10, "ten steps");
  expect(plugin.get_time(run, &lo) == 1.25 && lo == 0.0, "ten steps of 1/8");
  state(run, z, z_lo);

  // Another step: the state and the time stay, and it goes on as a new run with that step would.
  plugin.set_h(run, 0.0625, 0.0);
  expect(plugin.get_h(run, nullptr) == 0.0625, "h is what was set");
  expect(plugin.get_time(run, nullptr) == 1.25, "the time stays");
  state(run, other, other_lo);
  expect(same(), "the state stays");
  hamgen_run* fresh = plugin.create(par, par_lo, 0.0625, 0.0, other, other_lo);
  plugin.advance(run, 7, 0, &report);
  plugin.advance(fresh, 7, 0, &report);
  state(run, z, z_lo);
  state(fresh, other, other_lo);
  expect(same(), "it goes on as a new run with that step");
  expect(plugin.get_time(run, nullptr) == 1.25 + 7 * 0.0625, "the time goes on");

  // Other parameters, likewise; what was set is what is given.
  double changed[3] = {0.5, 2.0, 3.0}, given[3];
  plugin.set_parameters(run, changed, nullptr);
  plugin.get_parameters(run, given, nullptr);
  expect(given[0] == 0.5 && given[1] == 2.0 && given[2] == 3.0, "the parameters that were set");
  expect(plugin.get_h(run, nullptr) == 0.0625, "h stays");
  state(run, other, other_lo);
  plugin.destroy(fresh);
  fresh = plugin.create(changed, nullptr, 0.0625, 0.0, other, other_lo);
  plugin.advance(run, 5, 0, &report);
  plugin.advance(fresh, 5, 0, &report);
  state(run, z, z_lo);
  state(fresh, other, other_lo);
  expect(same(), "it goes on as a new run with these parameters");

  // Negative control: with the old ones it goes elsewhere.
  plugin.destroy(fresh);
  fresh = plugin.create(par, par_lo, 0.0625, 0.0, other, other_lo);
  plugin.advance(run, 5, 0, &report);
  plugin.advance(fresh, 5, 0, &report);
  state(run, z, z_lo);
  state(fresh, other, other_lo);
  expect(!same(), "other parameters, another orbit");

  // Another state at another time.
  plugin.set_state(run, -3.0, 0.0, start, nullptr);
  expect(plugin.get_time(run, nullptr) == -3.0, "the time that was set");
  plugin.destroy(fresh);
  fresh = plugin.create(changed, nullptr, 0.0625, 0.0, start, nullptr);
  plugin.advance(run, 16, 0, &report);
  plugin.advance(fresh, 16, 0, &report);
  expect(plugin.get_time(run, nullptr) == -2.0, "sixteen steps of 1/16 later");
  state(run, z, z_lo);
  state(fresh, other, other_lo);
  expect(same(), "it goes on as a new run from there");
  plugin.destroy(fresh);
  plugin.destroy(run);
  plugin.destroy(nullptr);
  std::printf("%d\n", failures);
}
)";

TEST(PluginTable, SaysWhatTheNumbersAreAndSetsARun) {
  const SourceText source =
      make_source("m.ham",
                  "system chain\ncoordinate q[0..39] [m]  # of the beads\n"
                  "momentum p[0..39] [kg*m/s]\nparameter k = 1/10 [kg/s^2]  # \"stiff\"\n"
                  "parameter c[1..2] = [1/2, 3/4]\n"
                  "H = sum(i = 0..39, p[i]^2/2 + k*q[i]^2/2 + c[1]*c[2]*q[i]^4/4)\n"
                  "invariant P = sum(i = 0..39, p[i])  # total\n");
  const std::string text = generate_plugin(source, {.scalar = "long-double"}).text;
  ASSERT_NE(text.find("Real q[40]"), std::string::npos) << "not in loops";
  EXPECT_EQ(run_program(text + driver),
            "q [m] of the beads: 1 0 40\n"
            "p [kg*m/s] : 1 0 40\n"
            "k [kg/s^2] \"stiff\": 0 0 1\n"
            "c [] : 1 1 2\n"
            "P [] total: 0 0 1\n"
            "0.10000000000000001 0.5 0.75\n"
            "0\n");
}

}  // namespace
}  // namespace hamgen::emitted_test
