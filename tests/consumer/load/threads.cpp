// threads MODEL: one loaded model, orbits in several threads at once, each as it is alone.
#include <cstdio>
#include <exception>
#include <thread>
#include <vector>

#include "hamgen/load.hpp"

namespace {

constexpr int kThreads = 4;
constexpr int kOrbits = 3;  // of each

hamgen::Trajectory follow(const hamgen::System& kepler, int i) {
  hamgen::Start start = kepler.start("ellipse");
  start.set("v", 1.5 + 0.05 * i);
  hamgen::RunOptions options;
  options.steps = 1000;
  int seen = 0;
  options.events.push_back(kepler.event("around", start, [&seen](const auto&) {
    ++seen;
    return false;
  }));
  options.every = 100;
  long long records = 0;
  options.on_record = [&records](const auto&) { ++records; };
  return kepler.run(start, options);
}

int compare(const char* path) {
  std::vector<std::vector<hamgen::Trajectory>> found(kThreads);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&found, path, t] {
        // Loading is thread-safe too: one compiles, or several do, and all have the same.
        const hamgen::System kepler = hamgen::load(path, {.method = {"--scheme", "gauss-4"}});
        for (int i = 0; i < kOrbits; ++i)
          found[static_cast<std::size_t>(t)].push_back(follow(kepler, t * kOrbits + i));
      });
    }
  }
  const hamgen::System kepler = hamgen::load(path, {.method = {"--scheme", "gauss-4"}});
  std::vector<std::vector<hamgen::Trajectory>> shared(kThreads);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&shared, &kepler, t] {
        for (int i = 0; i < kOrbits; ++i)
          shared[static_cast<std::size_t>(t)].push_back(follow(kepler, t * kOrbits + i));
      });
    }
  }
  for (int k = 0; k < kThreads * kOrbits; ++k) {
    const hamgen::Trajectory alone = follow(kepler, k);
    for (const auto* all : {&found, &shared}) {
      const auto& other =
          (*all)[static_cast<std::size_t>(k / kOrbits)][static_cast<std::size_t>(k % kOrbits)];
      if (other.state != alone.state || other.summary.steps_done != 1000) return 1;
    }
  }
  std::printf("%d orbits, the same in %d threads as alone\n", kThreads * kOrbits, kThreads);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    return compare(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
