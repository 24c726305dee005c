#include "runtime/library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "runtime/load_plugin.hpp"
#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

using tests::oscillator;
using tests::oscillator_library;
using tests::oscillator_run;

// The oscillator with some words replaced, loaded without a cache.
std::shared_ptr<const Library> load_changed(const std::string& from, const std::string& to) {
  PluginSource source = oscillator();
  source.text.replace(source.text.find(from), from.size(), to);
  const Cache none{.directory = {}, .problem = "no cache"};
  return load_plugin(source, find_compiler(), {}, none).library;
}

std::string failure_of_changed(const std::string& from, const std::string& to) {
  try {
    (void)load_changed(from, to);
  } catch (const ToolError& error) {
    return error.what();
  }
  return "loaded";
}

TEST(Library, GivesEnergyGradientAndInvariants) {
  const Library& library = *oscillator_library();
  const std::vector<double> parameters = {2.0, 0.0};
  const std::vector<double> state = {1.0, 3.0};
  EXPECT_EQ(library.degrees_of_freedom(), 1u);
  EXPECT_EQ(library.energy(parameters, state), 6.5);
  EXPECT_EQ(library.gradient(parameters, state), (std::vector<double>{4.0, 3.0}));
  EXPECT_EQ(library.invariants(parameters, state), std::vector<double>{3.25});
  EXPECT_THROW((void)library.energy(state, {}), std::invalid_argument);
}

TEST(Library, RefusesWhatIsNotAPluginOfThisVersion) {
  const std::string versions = "it has version " + std::to_string(HAMGEN_PLUGIN_VERSION + 1) +
                               " of the plugin interface, this program has " +
                               std::to_string(HAMGEN_PLUGIN_VERSION);
  EXPECT_NE(
      failure_of_changed("{HAMGEN_PLUGIN_VERSION,", "{HAMGEN_PLUGIN_VERSION + 1,").find(versions),
      std::string::npos);
  EXPECT_NE(failure_of_changed("advance, get_state, get_carry,", "nullptr, get_state, get_carry,")
                .find("its table of functions is incomplete"),
            std::string::npos);
  EXPECT_NE(failure_of_changed("return &plugin;", "return nullptr;")
                .find("its table of functions is missing"),
            std::string::npos);
  EXPECT_NE(
      failure_of_changed(" hamgen_plugin_entry(", " another_entry(").find("it is no hamgen plugin"),
      std::string::npos);
  EXPECT_THROW(Library("no/such/file.so"), ToolError);
}

// Both plugins define the same inline function with a variable of its own.
TEST(Library, DoesNotMixTwoPluginsThatShareNames) {
  const std::string from = "namespace {";
  const std::string shared =
      "inline double& scale() { static double s = FACTOR; return s; }\n"
      "namespace model { inline double twice() { return 2 * scale(); } }\n"
      "extern \"C\" double f() { return model::twice(); }\n namespace {";
  std::string text_one = "#define FACTOR 1.0\n" + shared;
  std::string text_two = "#define FACTOR 5.0\n" + shared;
  const std::string use = "return 0.5 * z[1] * z[1]";
  const auto source = [&](const std::string& text) {
    PluginSource changed = oscillator();
    changed.text.replace(changed.text.find(from), from.size(), text);
    changed.text.replace(changed.text.find(use), use.size(), "return f() * z[1] * z[1]");
    return changed;
  };
  const Cache none{.directory = {}, .problem = "no cache"};
  const LoadedPlugin one = load_plugin(source(text_one), find_compiler(), {}, none);
  const LoadedPlugin two = load_plugin(source(text_two), find_compiler(), {}, none);
  const std::vector<double> parameters = {0.0, 0.0};
  const std::vector<double> state = {0.0, 1.0};
  EXPECT_EQ(one.library->energy(parameters, state), 2.0);
  EXPECT_EQ(two.library->energy(parameters, state), 10.0);
}

TEST(Integrator, TakesTheStepsOfTheMethod) {
  Integrator run = oscillator_run();
  // One kick - drift - kick by hand: p = -h/2 4 q, q += h p, p -= h/2 4 q; exact in binary.
  const Report report = run.advance(1, true);
  EXPECT_EQ(report.status, Status::done);
  EXPECT_EQ(report.steps_done, 1);
  EXPECT_EQ(run.state(), (std::vector<Wide>{{0.96875, 0.0}, {-0.4921875, 0.0}}));
  EXPECT_EQ(run.rounded_state(), (std::vector<double>{0.96875, -0.4921875}));
  ASSERT_TRUE(report.energy.has_value());
  EXPECT_EQ(report.energy->last, run.energy());
  EXPECT_EQ(run.invariants(), std::vector<Wide>{{run.energy().hi / 2.0}});
}

TEST(Integrator, KeepsItsLibraryLoaded) {
  std::optional<Integrator> run;
  {
    const std::shared_ptr<const Library> library = load_changed("oscillator,", "another,");
    run.emplace(library,
                InitialValues{.parameters = {{1.0}, {0.0}}, .h = {0.5}, .state = {{1.0}, {0.0}}});
  }
  EXPECT_EQ(run->advance(3, false).steps_done, 3);
  Integrator moved = std::move(*run);
  run.reset();
  EXPECT_EQ(moved.advance(3, false).steps_done, 3);
}

TEST(Integrator, StopsAtTheLastGoodState) {
  Integrator run = oscillator_run(2);
  const Report report = run.advance(5, false);
  EXPECT_EQ(report.status, Status::not_converged);
  EXPECT_EQ(report.steps_done, 2);
  EXPECT_EQ(report.last_increment, 0.125);
  EXPECT_FALSE(report.energy.has_value());
}

TEST(Integrator, RefusesSizesAndValuesThatMakeNoSense) {
  const std::shared_ptr<const Library> library = oscillator_library();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const InitialValues good{.parameters = {{1.0}, {0.0}}, .h = {0.5}, .state = {{1.0}, {0.0}}};
  InitialValues bad = good;
  bad.parameters.pop_back();
  EXPECT_THROW(Integrator(library, bad), std::invalid_argument);
  bad = good;
  bad.state.push_back({});
  EXPECT_THROW(Integrator(library, bad), std::invalid_argument);
  for (Wide InitialValues::*member : {&InitialValues::h}) {
    bad = good;
    (bad.*member).hi = nan;
    EXPECT_THROW(Integrator(library, bad), std::invalid_argument);
  }
  bad = good;
  bad.state[1].lo = nan;
  EXPECT_THROW(Integrator(library, bad), std::invalid_argument);
}

TEST(Integrator, NeverReportsAnEnergyThatIsNotFinite) {
  Integrator run(oscillator_library(), {.parameters = {{2.0}, {0.0}},
                                        .h = {1e3},
                                        .state = {{1e150}, {0.0}},
                                        .defined_everywhere = true});
  const Report report = run.advance(200, true);
  EXPECT_EQ(report.status, Status::overflow);
  EXPECT_TRUE(std::isfinite(run.energy().hi));
  if (report.energy) {
    EXPECT_TRUE(std::isfinite(report.energy->max.hi));
  }
}

}  // namespace
}  // namespace hamgen::runtime
