#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <mutex>

#include "app/studies/threads.hpp"

namespace hamgen::app {

bool has_threads() { return true; }

int all_threads() { return tbb::this_task_arena::max_concurrency(); }

void on_threads(int threads, const std::function<void()>& work) {
  std::exception_ptr first;
  std::mutex guard;
  const auto kept = [&](int) {
    try {
      work();
    } catch (...) {
      const std::scoped_lock lock(guard);
      if (!first) first = std::current_exception();
    }
  };
  // More than the processors too, if that is asked for.
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism,
                                 static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(0, threads, kept, tbb::simple_partitioner()); });
  if (first) std::rethrow_exception(first);
}

}  // namespace hamgen::app
