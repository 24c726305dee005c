// The events of a run: when, and in which state.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/studies/orbit_watch.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {

// Columns, or keys of objects: event, t, steps and fraction (of one step more), then the state, of
// a wide scalar in two parts, x and x_lo.  A name that ends in .json makes it JSON, else it is CSV.
// Appears when it is published.
class EventFile {
 public:
  // `state`: names, q then p.
  EventFile(const std::string& path, const std::vector<std::string>& metadata,
            std::vector<std::string> state, bool wide);

  // `state` is that of all degrees of freedom.
  void add(const std::string& event, const WatchedPoint& point,
           const std::vector<runtime::Wide>& state);
  void publish(const std::string& outcome);
  [[nodiscard]] long long count() const { return count_; }

 private:
  bool json_;
  bool wide_;
  std::vector<std::string> state_;
  std::string time_;  // the name of its column
  runtime::AtomicFile file_;
  long long count_ = 0;
};

// Throws UsageError unless the name ends in .csv or .json.
void require_event_file_name(const std::string& path);

}  // namespace hamgen::app
