// What is emitted for every model that is shipped, by every scheme, is read back whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen {
namespace {

std::vector<std::string> shipped_models() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    if (entry.path().extension() == ".ham") paths.push_back(entry.path().string());
  }
  std::ranges::sort(paths);
  return paths;
}

// Every model with every request in `ctest -C full`; without the variable every model and every
// request, each time with others.
bool is_looked_at(std::size_t model, std::size_t request, std::size_t every) {
  return std::getenv("HAMGEN_READ_EVERY_STEP") != nullptr || (model + request) % every == 0;
}

struct Counts {
  int wished = 0;
  int refused = 0;  // by the method: there is no such step
  int read = 0;
};

Counts read_all(const std::vector<Request>& requests, std::size_t every = 11) {
  const std::vector<std::string> models = shipped_models();
  Counts counts;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const SourceText source = read_source(models[i]);
    for (std::size_t j = 0; j < requests.size(); ++j) {
      if (!is_looked_at(i, j, every)) continue;
      ++counts.wished;
      const Request& request = requests[j];
      ReadBack found;
      try {
        found = read_emitted(source, request);
      } catch (const UsageError&) {
        ++counts.refused;
        continue;
      } catch (const ModelError&) {
        ++counts.refused;
        continue;
      }
      EXPECT_EQ(found.outcome, ReadBack::Outcome::same)
          << models[i] << " " << request.scheme.text() << request.solver.text()
          << request.scalar.text() << " line " << found.line << ": " << found.what;
      EXPECT_GE(found.routines, 3);
      EXPECT_GE(found.instructions, 7);
      counts.read += found.outcome == ReadBack::Outcome::same ? 1 : 0;
    }
  }
  ::testing::Test::RecordProperty("texts", counts.read);
  return counts;
}

TEST(ReadBackOf, EveryModelByEverySchemeIsTheProgram) {
  std::vector<Request> requests;
  for (const Scheme& scheme : all_schemes()) requests.push_back({.scheme = scheme.name});
  const Counts counts = read_all(requests);
  EXPECT_EQ(counts.read + counts.refused, counts.wished);
  EXPECT_GT(counts.read, 4 * counts.wished / 5);
}

std::vector<Request> of_format(const char* format, const std::vector<Request>& requests) {
  std::vector<Request> result = requests;
  for (Request& request : result) request.format = format;
  return result;
}

std::vector<Request> other_requests() {
  std::vector<Request> requests;
  for (const char* solver : {"newton", "fixed-point", "sweeps:3"}) {
    requests.push_back({.solver = solver});
    requests.push_back({.scheme = "gauss-4", .solver = solver});
  }
  for (const char* scalar : {"float", "long-double", "quad"}) {
    requests.push_back({.scalar = scalar});
    requests.push_back({.scheme = "kahan-li-8", .scalar = scalar});
  }
  requests.push_back({.order = 4});
  requests.push_back({.alpha = "3/10", .beta = "h/7", .gamma = "-h/5"});
  requests.push_back({.tangent = true});
  requests.push_back({.scheme = "gauss-4", .tangent = true});
  requests.push_back({.plain_sums = true});
  requests.push_back({.scheme = "stormer-verlet", .plain_sums = true});
  requests.push_back({.watch_modified = 2, .step = Rational(1, 50)});
  return requests;
}

TEST(ReadBackOf, EveryModelByEverySolverScalarAndOrderIsTheProgram) {
  std::vector<Request> requests = other_requests();
  requests.push_back({.support = "shared"});
  const Counts counts = read_all(requests);
  EXPECT_EQ(counts.read + counts.refused, counts.wished);
  EXPECT_GT(counts.read, 4 * counts.wished / 5);
}

// What `hamgen run` compiles.
TEST(ReadBackOf, EveryModelAsAPluginIsTheProgram) {
  std::vector<Request> requests = of_format("cpp-plugin", other_requests());
  for (const Scheme& scheme : all_schemes())
    requests.push_back({.scheme = scheme.name, .format = "cpp-plugin"});
  const Counts counts = read_all(requests, 23);
  EXPECT_EQ(counts.read + counts.refused, counts.wished);
  EXPECT_GT(counts.read, 4 * counts.wished / 5);
}

// Of these there are steps that are explicit, or solved by Newton's iteration of a size up to 3.
TEST(ReadBackOf, EveryModelInCIsTheProgram) {
  std::vector<Request> requests = of_format("c-header", other_requests());
  for (const char* scalar : {"", "float", "long-double"}) {
    for (const Scheme& scheme : all_schemes())
      requests.push_back({.scheme = scheme.name, .scalar = scalar, .format = "c-header"});
  }
  for (const char* scalar : {"", "float"})
    requests.push_back({.scalar = scalar, .format = "opencl-header"});
  const Counts counts = read_all(requests, 23);
  EXPECT_EQ(counts.read + counts.refused, counts.wished);
  EXPECT_GT(counts.read, counts.wished / 2);
}

// Of many trajectories side by side; how many there are is a number of the text.
TEST(ReadBackOf, EveryModelAsABatchIsTheProgram) {
  std::vector<Request> requests;
  for (const Scheme& scheme : all_schemes()) {
    requests.push_back({.scheme = scheme.name, .batch = 8});
    requests.push_back({.scheme = scheme.name, .batch = 2, .math = "libm"});
  }
  for (const char* solver : {"newton", "fixed-point", "sweeps:3"}) {
    requests.push_back({.solver = solver, .batch = 4});
    requests.push_back({.scheme = "gauss-4", .solver = solver, .batch = 1});
  }
  requests.push_back({.order = 4, .batch = 4});
  requests.push_back({.alpha = "3/10", .beta = "h/7", .gamma = "-h/5", .batch = 4});
  requests.push_back({.scheme = "stormer-verlet", .batch = 4, .plain_sums = true});
  requests.push_back({.batch = 4, .watch_modified = 2, .step = Rational(1, 50)});
  const Counts counts = read_all(requests, 23);
  EXPECT_EQ(counts.read + counts.refused, counts.wished);
  EXPECT_GT(counts.read, 4 * counts.wished / 5);
}

}  // namespace
}  // namespace hamgen
