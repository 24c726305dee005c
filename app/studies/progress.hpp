// How far a study has come, for whoever asked for it.
#pragma once

#include <functional>
#include <string>

namespace hamgen::app {

struct WorkProgress {
  enum class Phase { begun, running, ended };
  std::string work;  // "reference"
  Phase phase = Phase::begun;
  long long done = 0;
  long long all = 1;
  bool counts_steps = false;  // of integrations: their rate means something
};

// Called from the thread that asked; may be empty.
using ProgressSink = std::function<void(const WorkProgress&)>;

// A piece of work from its begin to its end, one at a time.
class Work {
 public:
  Work(ProgressSink sink, std::string name, long long all = 1000, bool counts_steps = false);
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work();

  void tell(long long done);
  // Tells a fraction of the whole; not beyond the end of this work.
  [[nodiscard]] std::function<void(double)> fraction();

 private:
  void tell(WorkProgress::Phase phase);

  ProgressSink sink_;
  WorkProgress progress_;
};

}  // namespace hamgen::app
