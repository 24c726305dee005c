// orbit MODEL: loads a Kepler problem, prints its periods, and stops where the bodies collide.
#include <cmath>
#include <cstdio>
#include <exception>

#include "hamgen/load.hpp"

namespace {

int follow(const char* path) {
  const hamgen::System kepler = hamgen::load(path, {.method = {"--scheme", "gauss-8"}});
  std::printf("%s by %s, order %d\n", kepler.name().c_str(), kepler.scheme().c_str(),
              kepler.order());

  hamgen::Start start = kepler.start("ellipse");
  int revolutions = 0;
  double last = 0.0;
  hamgen::RunOptions options;
  options.steps = start.steps().value();
  options.events.push_back(
      kepler.event("around", start, [&](const hamgen::runtime::EventPoint& point) {
        std::printf("revolution %d: period %.12f\n", ++revolutions, point.time - last);
        last = point.time;
        return false;  // go on
      }));
  const hamgen::Trajectory ellipse = kepler.run(start, options);
  std::printf("%lld steps: %s, energy error %.1e\n", ellipse.summary.steps_done,
              to_text(ellipse.summary.status).data(), ellipse.summary.energy->max_error());
  if (revolutions != 3 || std::abs(last - 6 * std::acos(-1.0)) > 1e-9) return 1;

  // Nearly head on, with steps that are small enough for it.
  start.set("x", 1).set("v", 0.05).set("h", 1e-4);
  options.steps = 1'000'000;
  options.events = {kepler.event("hit", start, [](const auto&) { return true; })};
  const hamgen::Trajectory fall = kepler.run(start, options);
  if (!fall.ended_by) return 1;
  const double r = std::hypot(fall.state[0].hi, fall.state[1].hi);
  std::printf("collision at t = %.9f, r = %.12f, L = %.6f\n", fall.time, r,
              kepler.invariant("L", start, fall.state));
  return std::abs(r - 1e-2) < 1e-15 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    return follow(argv[1]);
  } catch (const hamgen::LoadError& error) {  // of the model or the options, with the place
    std::fprintf(stderr, "%s", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
