// The processes of an MPI job, working on one ensemble.
#pragma once

#include "app/studies/crew.hpp"

namespace hamgen::app {

// Between MPI_Init_thread(MPI_THREAD_FUNNELED) and MPI_Finalize.
class MpiCrew : public Crew {
 public:
  MpiCrew();

  // The others wait here for the leader to begin; false if it ended without having begun: the
  // command was wrong, or asked for help.
  [[nodiscard]] bool leader_begins();
  // Of the leader, at the end: so that they need not wait.
  void leave();
  // All are past the work they have in common: each can end for itself.
  [[nodiscard]] bool is_done() const { return is_done_; }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  void leader_first(const std::function<void()>& work) override;
  [[nodiscard]] std::vector<long long> share(std::vector<long long> list) override;
  bool hand_out(long long count, int threads, const std::function<bool(long long)>& work,
                const std::function<void(long long)>& on_progress) override;
  void wait_for_all() override;

 private:
  bool lead(long long count, int threads, const std::function<bool(long long)>& work,
            const std::function<void(long long)>& on_progress);
  bool follow(int threads, const std::function<bool(long long)>& work);

  int rank_ = 0, size_ = 1;
  bool has_begun_ = false, is_done_ = false;
};

}  // namespace hamgen::app
