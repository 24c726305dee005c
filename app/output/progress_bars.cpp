#include "app/output/progress_bars.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>

#include "app/output/terminal.hpp"
#include "runtime/progress.hpp"

namespace hamgen::app {
namespace {

using BarClock = std::chrono::steady_clock;

struct CurrentBar {
  std::optional<runtime::ProgressBar> bar;
  BarClock::time_point begin;
  double next_line = 0.0;  // in seconds; where no bar can be drawn
};

// A log wants few lines.
constexpr double kFirstLine = 20.0;
constexpr double kBetweenLines = 120.0;

void say_line(CurrentBar& current, const WorkProgress& progress, double seconds) {
  if (seconds < current.next_line || progress.done <= 0) return;
  current.next_line = seconds + kBetweenLines;
  const double part = static_cast<double>(progress.done) / static_cast<double>(progress.all);
  print_error(fmt::format("hamgen: {}: {:.2g} % done, {} left\n", progress.work, 100.0 * part,
                          runtime::duration_text(seconds * (1.0 - part) / part)));
}

void draw_bar(CurrentBar& current, const WorkProgress& progress) {
  const std::chrono::duration<double> seconds = BarClock::now() - current.begin;
  if (!current.bar->is_visible()) return say_line(current, progress, seconds.count());
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
        current->next_line = kFirstLine;
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
