// What is emitted for every model that is shipped, by every scheme, is read back whole.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen {
namespace {

struct Counts {
  int refused = 0;  // by the method: no such step
  int read = 0;
  int instructions = 0;
};

Counts read_all(const std::vector<Request>& requests) {
  Counts counts;
  for (const auto& entry : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    if (entry.path().extension() != ".ham") continue;
    const SourceText source = read_source(entry.path().string());
    for (const Request& request : requests) {
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
          << entry.path().filename() << " " << request.scheme << request.solver << request.scalar
          << " line " << found.line << ": " << found.what;
      counts.read += found.outcome == ReadBack::Outcome::same ? 1 : 0;
      counts.instructions += found.instructions;
    }
  }
  return counts;
}

TEST(ReadBackOf, EveryModelByEverySchemeIsTheProgram) {
  std::vector<Request> requests;
  for (const Scheme& scheme : all_schemes()) requests.push_back({.scheme = scheme.name});
  const Counts counts = read_all(requests);
  EXPECT_GT(counts.read, 400);
}

TEST(ReadBackOf, EveryModelByEverySolverScalarAndOrderIsTheProgram) {
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
  requests.push_back({.support = "shared"});
  requests.push_back({.watch_modified = 2});
  const Counts counts = read_all(requests);
  EXPECT_GT(counts.read, 300);
}

}  // namespace
}  // namespace hamgen
