#include "app/studies/tune_map.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

namespace hamgen::app {
namespace {

// Applies `function` to 0 .. count-1 on all processors; the caller's thread looks on.
void for_all_cells(std::size_t count, StopFlag stop,
                   const std::function<void(std::size_t)>& function,
                   const std::function<void(std::size_t)>& on_progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !is_stopped(stop); i = next++) {
      try {
        function(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
      ++done;
    }
  };
  {
    std::vector<std::jthread> threads;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < processors; ++i) threads.emplace_back(work);
    while (done < count && next < count && !is_stopped(stop)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      on_progress(done);
    }
  }
  if (failure) std::rethrow_exception(failure);
  on_progress(done);
}

}  // namespace

EnergyMap energy_map(const GaugedIntegrator& integrator, const MapAxis& b, const MapAxis& c,
                     double h, long steps, StopFlag stop,
                     const std::function<void(std::size_t)>& on_progress) {
  const auto width = static_cast<std::size_t>(b.count);
  const std::size_t cells = width * static_cast<std::size_t>(c.count);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EnergyMap map{.b = b, .c = c, .spread = std::vector<double>(cells, kNone)};
  for_all_cells(
      cells, stop,
      [&](std::size_t i) {
        const std::vector<double> pair = {b.at(static_cast<int>(i % width)),
                                          c.at(static_cast<int>(i / width))};
        const Measurement measured = integrator.measure(pair, h, steps);
        if (measured.failure.empty()) map.spread[i] = measured.energy_spread;
      },
      [&](std::size_t done) {
        map.done = done;
        on_progress(done);
      });
  return map;
}

}  // namespace hamgen::app
