// What the tests of the runtime share: a plugin written by hand, scripts in the place of compilers,
// a directory of their own.
#pragma once

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "runtime/compile.hpp"
#include "runtime/compiler.hpp"
#include "runtime/integrator.hpp"
#include "runtime/library.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::runtime::tests {

// H = p^2/2 + omega^2 q^2/2, kick - drift - kick.  Parameters: omega, and the number of steps after
// which a step "does not converge" (0: none).  The invariant is H again, divided by omega: not
// finite for omega = 0.
inline constexpr const char* kOscillator = R"(
#include "plugin.h"

struct hamgen_run {
  double omega;
  long long fail_after;
  long long steps_done;
  double h, q, p;
};

namespace {

double energy(const double* par, const double* z) {
  return 0.5 * z[1] * z[1] + 0.5 * par[0] * par[0] * z[0] * z[0];
}

double energy_of(const double* par, const double*, const double* z, const double*, double* lo) {
  if (lo) *lo = 0.0;
  return energy(par, z);
}

hamgen_run* create(const double* par, const double*, double h, double, const double* z,
                   const double*) {
  return new hamgen_run{par[0], static_cast<long long>(par[1]), 0, h, z[0], z[1]};
}

void destroy(hamgen_run* run) { delete run; }

void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  const double par[2] = {run->omega, 0.0};
  *report = {};
  for (long long i = 0; i < steps; ++i) {
    report->last_iterations = 1;
    if (run->fail_after > 0 && run->steps_done == run->fail_after) {
      report->status = HAMGEN_NOT_CONVERGED;
      report->last_increment = 0.125;
      return;
    }
    run->p -= 0.5 * run->h * run->omega * run->omega * run->q;
    run->q += run->h * run->p;
    run->p -= 0.5 * run->h * run->omega * run->omega * run->q;
    ++run->steps_done;
    ++report->steps_done;
    ++report->iterations;
    if (!watch_energy) continue;
    const double z[2] = {run->q, run->p};
    const double e = energy(par, z);
    if (report->steps_done == 1 || e < report->energy_min) report->energy_min = e;
    if (report->steps_done == 1 || e > report->energy_max) report->energy_max = e;
    report->energy_last = e;
    if (!(e - e == 0.0)) {
      report->status = HAMGEN_NOT_FINITE;
      return;
    }
  }
}

void get_state(const hamgen_run* run, double* z, double* lo) {
  z[0] = run->q;
  z[1] = run->p;
  if (lo) lo[0] = lo[1] = 0.0;
}

void get_carry(const hamgen_run*, double* carry, double* lo) {
  carry[0] = carry[1] = lo[0] = lo[1] = 0.0;
}

void invariants(const double* par, const double*, const double* z, const double*, double* values,
                double* lo) {
  values[0] = energy(par, z) / par[0];
  if (lo) lo[0] = 0.0;
}

void gradient(const double* par, const double* z, double* g) {
  g[0] = par[0] * par[0] * z[0];
  g[1] = z[1];
}

const hamgen_plugin plugin = {HAMGEN_PLUGIN_VERSION, 1, 2, 1, 53, "oscillator, stormer-verlet",
                              "explicit", create, destroy, advance, get_state, get_carry, energy_of, invariants,
                              gradient};

}  // namespace

extern "C" const hamgen_plugin* hamgen_plugin_entry(void) { return &plugin; }
)";

inline PluginSource oscillator() { return {.text = kOscillator}; }

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// An executable shell script in the place of a compiler.
inline std::string script(const std::filesystem::path& path, const std::string& body) {
  write_text(path, "#!/bin/sh\n" + body + "\n");
  ::chmod(path.c_str(), 0755);
  return path.string();
}

inline std::size_t count_entries(const std::filesystem::path& directory) {
  std::size_t count = 0;
  for (const std::filesystem::directory_entry& entry :
       std::filesystem::directory_iterator(directory)) {
    count += entry.exists() ? 1 : 0;
  }
  return count;
}

// Sets an environment variable, or removes it, until the end of the scope.
class Environment {
 public:
  Environment(const char* name, const std::optional<std::string>& value) : name_(name) {
    if (const char* const old = std::getenv(name)) old_ = old;
    set(value);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { set(old_); }

 private:
  void set(const std::optional<std::string>& value) const {
    if (value) {
      ::setenv(name_, value->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  const char* name_;
  std::optional<std::string> old_;
};

// The oscillator, compiled once for a test program.
inline std::shared_ptr<const Library> oscillator_library() {
  static const std::shared_ptr<const Library> library = [] {
    const TemporaryDirectory build = private_directory();
    write_sources(oscillator(), build.path());
    return std::make_shared<const Library>(
        compile_sources(oscillator(), find_compiler(), {}, build.path()));
  }();
  return library;
}

// omega = 2, (q, p) = (1, 0), h = 1/8.
inline Integrator oscillator_run(long long fail_after = 0) {
  return Integrator(oscillator_library(),
                    {.parameters = {{2.0, 0.0}, {static_cast<double>(fail_after), 0.0}},
                     .h = {0.125, 0.0},
                     .state = {{1.0, 0.0}, {0.0, 0.0}}});
}

}  // namespace hamgen::runtime::tests
