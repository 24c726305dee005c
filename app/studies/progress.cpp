#include "app/studies/progress.hpp"

#include <utility>

namespace hamgen::app {

Work::Work(ProgressSink sink, std::string name, long long all, bool counts_steps)
    : sink_(std::move(sink)),
      progress_{.work = std::move(name), .all = all, .counts_steps = counts_steps} {
  tell(WorkProgress::Phase::begun);
}

Work::~Work() { tell(WorkProgress::Phase::ended); }

void Work::tell(long long done) {
  progress_.done = done;
  tell(WorkProgress::Phase::running);
}

std::function<void(double)> Work::fraction() {
  return [this](double part) {
    tell(static_cast<long long>(part * static_cast<double>(progress_.all)));
  };
}

void Work::tell(WorkProgress::Phase phase) {
  progress_.phase = phase;
  if (sink_) sink_(progress_);
}

}  // namespace hamgen::app
