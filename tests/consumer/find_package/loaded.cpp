// swing_loaded PLUGIN.cpp: compiles and loads a pendulum's plugin, takes 1e5 steps near the top.
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

#include "hamgen/integrator.hpp"
#include "hamgen/load_plugin.hpp"

namespace {

int swing(const char* path) {
  using namespace hamgen::runtime;
  std::ifstream in(path);
  PluginSource source;
  source.text.assign(std::istreambuf_iterator<char>(in), {});
  const LoadedPlugin loaded = load_plugin(source, find_compiler(), {}, open_cache());
  InitialValues start;
  start.parameters = {{0.03}};
  start.h = {0.1};
  start.state = {{3.1}, {0.0}};
  Integrator integrator(loaded.library, start);
  const double energy = integrator.energy().hi;
  const Report report = integrator.advance(100000, true);
  if (report.status != Status::done || !report.energy) return 1;
  const double spread = difference(report.energy->max, report.energy->min);
  std::printf("energy %.6f, spread %.4e\n", energy, spread);
  return spread > 1.48e-6 && spread < 1.51e-6 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    return swing(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
