#include "runtime/kill_point.hpp"

#include <signal.h>

#include <atomic>
#include <cstdlib>

namespace hamgen::runtime {
namespace {

long kill_number() {
  static const long number = [] {
    const char* const text = std::getenv("HAMGEN_KILL_POINT");
    return text != nullptr ? std::atol(text) : 0L;
  }();
  return number;
}

}  // namespace

bool has_kill_points() { return kill_number() > 0; }

void kill_point() {
  static std::atomic<long> passed{0};
  if (has_kill_points() && ++passed == kill_number()) ::raise(SIGKILL);
}

}  // namespace hamgen::runtime
