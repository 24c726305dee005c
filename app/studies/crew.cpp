#include "app/studies/crew.hpp"

#include <atomic>
#include <chrono>
#include <mutex>

#include "app/studies/threads.hpp"

namespace hamgen::app {

void SingleCrew::hand_out(long long count, int threads, const std::function<bool(long long)>& work,
                          const std::function<void(long long)>& on_progress) {
  using PaceClock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds interval(100);
  std::atomic<long long> next{0};
  std::atomic<bool> ended{false};
  std::mutex guard;
  long long done = 0;
  PaceClock::time_point last = PaceClock::now();
  on_threads(threads, [&] {
    try {
      for (long long i = next++; i < count && !ended; i = next++) {
        if (!work(i)) ended = true;
        const std::scoped_lock lock(guard);
        ++done;
        if (!on_progress || PaceClock::now() - last < interval) continue;
        last = PaceClock::now();
        on_progress(done);
      }
    } catch (...) {
      ended = true;
      throw;
    }
  });
  if (on_progress) on_progress(done);
}

}  // namespace hamgen::app
