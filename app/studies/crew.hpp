// Who works on an ensemble: the threads of this process, or with them those of others.
#pragma once

#include <functional>
#include <vector>

namespace hamgen::app {

class Crew {
 public:
  virtual ~Crew() = default;

  // 0 leads: it reads and writes what all share.
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] bool leads() const { return rank() == 0; }

  // The leader does it before all others do.
  virtual void leader_first(const std::function<void()>& work) = 0;
  // The leader's list, for everybody.
  [[nodiscard]] virtual std::vector<long long> share(std::vector<long long> list) = 0;
  // Each of the numbers 0, 1, ..., count - 1 is given to work() once, in one of the processes, from
  // so many threads of each; ends early, everywhere, when work() returns false.  The leader hears
  // about once in a while how many were given out.  Everybody returns when all are done.
  virtual void hand_out(long long count, int threads, const std::function<bool(long long)>& work,
                        const std::function<void(long long)>& on_progress) = 0;
};

// This process alone.
class SingleCrew : public Crew {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 1; }
  void leader_first(const std::function<void()>& work) override { work(); }
  [[nodiscard]] std::vector<long long> share(std::vector<long long> list) override { return list; }
  void hand_out(long long count, int threads, const std::function<bool(long long)>& work,
                const std::function<void(long long)>& on_progress) override;
};

}  // namespace hamgen::app
