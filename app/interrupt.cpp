#include "app/interrupt.hpp"

#include <csignal>

namespace hamgen::app {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void interrupt(int signal) {
  flag = true;
  // A second Ctrl-C ends it at once.  SIGTERM often comes twice, as to a process and to its group:
  // what it interrupts still removes its temporary files.
  if (signal == SIGINT) std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  return flag;
}

}  // namespace hamgen::app
