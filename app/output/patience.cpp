#include "app/output/patience.hpp"

#include <utility>

#include "app/output/terminal.hpp"
#include "runtime/progress.hpp"

namespace hamgen::app {

Patience::Patience(std::function<void()> say, std::chrono::milliseconds after)
    : thread_([this, after, say = std::move(say)] {
        std::unique_lock lock(mutex_);
        if (!ended_.wait_for(lock, after, [this] { return is_over_; })) say();
      }) {}

Patience::~Patience() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void say_that_proofs_take_long() {
  if (!runtime::is_watched()) return;
  print_error("hamgen: what is derived and proved of this step takes long; Ctrl-C ends it\n");
}

}  // namespace hamgen::app
