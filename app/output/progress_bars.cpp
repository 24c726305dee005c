#include "app/output/progress_bars.hpp"

#include <chrono>
#include <memory>
#include <optional>

#include "runtime/progress.hpp"

namespace hamgen::app {
namespace {

using BarClock = std::chrono::steady_clock;

struct CurrentBar {
  std::optional<runtime::ProgressBar> bar;
  BarClock::time_point begin;
};

void draw_bar(CurrentBar& current, const WorkProgress& progress) {
  const std::chrono::duration<double> seconds = BarClock::now() - current.begin;
  current.bar->update({.steps_done = progress.done,
                       .steps = progress.all,
                       .seconds = seconds.count(),
                       .show_rate = progress.counts_steps});
}

}  // namespace

ProgressSink progress_bars(bool quiet) {
  if (quiet) return {};
  return [current = std::make_shared<CurrentBar>()](const WorkProgress& progress) {
    switch (progress.phase) {
      case WorkProgress::Phase::begun:
        current->bar.emplace(progress.work);
        current->begin = BarClock::now();
        break;
      case WorkProgress::Phase::running:
        draw_bar(*current, progress);
        break;
      case WorkProgress::Phase::ended:
        current->bar.reset();
        break;
    }
  };
}

}  // namespace hamgen::app
