// A word to who waits for work that has no steps to count.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hamgen::app {

// Calls `say` once, from a thread of its own, if this lives so long.
class Patience {
 public:
  explicit Patience(std::function<void()> say,
                    std::chrono::milliseconds after = std::chrono::seconds(5));
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;
  ~Patience();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::thread thread_;
};

// On a terminal.
void say_that_proofs_take_long();

}  // namespace hamgen::app
