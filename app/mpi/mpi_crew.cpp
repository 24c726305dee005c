#include "app/mpi/mpi_crew.hpp"

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "app/studies/threads.hpp"

namespace hamgen::app {
namespace {

constexpr int kRequest = 1;  // how many threads want work; less than 0: this rank ends early
constexpr int kAnswer = 2;   // first and number of what it gets; 0 of them: there is no more

// Note [handing out]
// Work goes out in pieces that shrink with what is left: half of a rank's share of the rest, and at
// least one for each of its threads.  Ranks that are late or slow get fewer, and all end together
// but for the length of one.  A rank's threads wait for each other at the end of a piece, the
// leader's, which has the list at hand, do not.
class WorkList {
 public:
  WorkList(long long count, long long threads) : count_(count), threads_(threads) {}

  struct Piece {
    long long first = 0, count = 0;
  };
  [[nodiscard]] Piece take(long long threads) {
    const std::scoped_lock lock(guard_);
    if (ended_) return {};
    const long long left = count_ - next_;
    const long long most = std::max(4096LL, threads);
    const Piece piece{next_,
                      std::min(left, std::clamp(left / (2 * threads_) * threads, threads, most))};
    next_ += piece.count;
    return piece;
  }
  [[nodiscard]] Piece take_one() {
    const std::scoped_lock lock(guard_);
    if (ended_ || next_ == count_) return {};
    return {next_++, 1};
  }
  void end() {
    const std::scoped_lock lock(guard_);
    ended_ = true;
  }
  [[nodiscard]] long long given() const {
    const std::scoped_lock lock(guard_);
    return next_;
  }
  [[nodiscard]] bool has_ended() const {
    const std::scoped_lock lock(guard_);
    return ended_;
  }

 private:
  mutable std::mutex guard_;
  long long count_, threads_;
  long long next_ = 0;
  bool ended_ = false;
};

// A thread of the leader's.
void work_at(WorkList& list, const std::function<bool(long long)>& work) {
  try {
    for (auto piece = list.take_one(); piece.count > 0; piece = list.take_one()) {
      if (!work(piece.first)) list.end();
    }
  } catch (...) {
    list.end();
    throw;
  }
}

// Answers the other ranks until each has heard that there is no more, and the leader's own threads
// are back.
void serve(WorkList& list, const std::atomic<bool>& is_over,
           const std::function<void(long long)>& on_progress) {
  int others = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &others);
  --others;
  auto last = std::chrono::steady_clock::now();
  while (others > 0 || !is_over) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, kRequest, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) {
      // Its processor belongs to the threads that work.
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      const auto now = std::chrono::steady_clock::now();
      if (!on_progress || now - last < std::chrono::milliseconds(100)) continue;
      last = now;
      on_progress(list.given());
      continue;
    }
    long long threads = 0;
    MPI_Recv(&threads, 1, MPI_LONG_LONG, status.MPI_SOURCE, kRequest, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    if (threads < 0) list.end();
    const WorkList::Piece piece = list.take(threads);
    const long long answer[2] = {piece.first, piece.count};
    MPI_Send(answer, 2, MPI_LONG_LONG, status.MPI_SOURCE, kAnswer, MPI_COMM_WORLD);
    if (piece.count == 0) --others;
  }
}

}  // namespace

MpiCrew::MpiCrew() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

bool MpiCrew::leader_begins() {
  int begins = 0;
  MPI_Bcast(&begins, 1, MPI_INT, 0, MPI_COMM_WORLD);
  has_begun_ = true;
  return begins != 0;
}

void MpiCrew::leave() {
  if (has_begun_) return;
  int begins = 0;
  MPI_Bcast(&begins, 1, MPI_INT, 0, MPI_COMM_WORLD);
  is_done_ = true;
}

void MpiCrew::leader_first(const std::function<void()>& work) {
  if (!leads()) return work();
  work();
  has_begun_ = true;
  int begins = 1;
  MPI_Bcast(&begins, 1, MPI_INT, 0, MPI_COMM_WORLD);
}

std::vector<long long> MpiCrew::share(std::vector<long long> list) {
  long long size = static_cast<long long>(list.size());
  MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
  list.resize(static_cast<std::size_t>(size));
  constexpr long long most = 1 << 28;  // a count of MPI is an int
  for (long long first = 0; first < size; first += most)
    MPI_Bcast(list.data() + first, static_cast<int>(std::min(most, size - first)), MPI_LONG_LONG, 0,
              MPI_COMM_WORLD);
  return list;
}

bool MpiCrew::hand_out(long long count, int threads, const std::function<bool(long long)>& work,
                       const std::function<void(long long)>& on_progress) {
  return leads() ? lead(count, threads, work, on_progress) : follow(threads, work);
}

bool MpiCrew::lead(long long count, int threads, const std::function<bool(long long)>& work,
                   const std::function<void(long long)>& on_progress) {
  long long all = 0;
  const long long mine = threads;
  MPI_Reduce(&mine, &all, 1, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
  WorkList list(count, all);
  std::atomic<bool> is_over{false};
  std::exception_ptr failure;
  std::thread own([&] {
    try {
      on_threads(threads, [&] { work_at(list, work); });
    } catch (...) {
      failure = std::current_exception();
    }
    is_over = true;
  });
  serve(list, is_over, on_progress);
  own.join();
  if (failure) std::rethrow_exception(failure);
  if (on_progress) on_progress(list.given());
  return !list.has_ended();
}

bool MpiCrew::follow(int threads, const std::function<bool(long long)>& work) {
  const long long mine = threads;
  MPI_Reduce(&mine, nullptr, 1, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
  std::atomic<bool> ended{false};
  for (;;) {
    const long long request = ended ? -1 : mine;
    long long piece[2] = {};
    MPI_Sendrecv(&request, 1, MPI_LONG_LONG, 0, kRequest, piece, 2, MPI_LONG_LONG, 0, kAnswer,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (piece[1] == 0) return !ended;
    std::atomic<long long> next{piece[0]};
    const long long last = piece[0] + piece[1];
    on_threads(threads, [&] {
      for (long long i = next++; i < last && !ended; i = next++) {
        if (!work(i)) ended = true;
      }
    });
  }
}

void MpiCrew::wait_for_all() {
  MPI_Barrier(MPI_COMM_WORLD);
  is_done_ = true;
}

}  // namespace hamgen::app
