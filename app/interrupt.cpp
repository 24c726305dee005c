#include "app/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace hamgen::app {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void interrupt(int signal) {
  flag = true;
  // A second one from the keyboard ends it at once.  SIGTERM often comes twice, as to a process and
  // to its group, SIGXCPU every second: what they interrupt still removes its temporary files.
  if (signal == SIGINT || signal == SIGQUIT) std::signal(signal, SIG_DFL);
}

// What was ignored from the start stays ignored: nohup, and jobs in the background.
bool handle(std::initializer_list<int> signals) {
  for (const int signal : signals) {
    if (std::signal(signal, interrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  return true;
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  static const bool handled = handle({SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU});
  static_cast<void>(handled);
  return flag;
}

void report_full_files() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace hamgen::app
