// Many trajectories, of which only what is asked about them is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "app/studies/ensemble_plan.hpp"
#include "app/studies/stop.hpp"
#include "app/studies/varied_start.hpp"
#include "runtime/library.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

struct EnsembleRequest {
  const PluginSource* plugin = nullptr;
  std::shared_ptr<const runtime::Library> library;
  SceneRequest scene;  // with what is observed, of the statistics too
  SceneValues values;  // of that, as if nothing were varied
  EnsemblePlan plan;
  std::vector<std::string> statistics;  // observed names: their least, largest and mean values
  long long every = 1;                  // over the states after each so many steps
  StopFlag stop = nullptr;
};

// What is kept of a trajectory.
struct EnsembleRow {
  runtime::Status status = runtime::Status::done;
  long long steps = 0;
  std::vector<double> values;  // one a column; not a number where there is none
};

class Ensemble {
 public:
  // The request lives as long.
  explicit Ensemble(const EnsembleRequest& request);

  [[nodiscard]] long long count() const { return request_.plan.count(); }
  // Names of the values of a row: what was varied, time, state, what is observed, H, its largest
  // error and the scale of that, statistics.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  // Of those the first, which were varied.
  [[nodiscard]] std::size_t varied() const { return varied_; }
  [[nodiscard]] bool watches_energy() const { return watches_energy_; }
  // The column of the largest energy error, before that of the scale it is compared with; that of
  // none if H is not watched.
  [[nodiscard]] std::size_t energy_error() const { return energy_error_; }

  // Trajectories [first, first + count), one after the other, as rows; empty if it was stopped.
  // Each depends on nothing but its index.  From any thread.
  [[nodiscard]] std::vector<EnsembleRow> block(long long first, long long count) const;

 private:
  class Statistics;
  struct Observed {
    enum class Kind { state, energy, invariant } kind = Kind::state;
    std::size_t place = 0;  // of the model's state, or among the invariants
  };

  [[nodiscard]] bool advance(long long index, EnsembleRow& row) const;
  [[nodiscard]] Observed find(const std::string& name) const;
  void add_end(const VariedStart::Start& start, const runtime::Integrator& integrator,
               const runtime::RunSummary& summary, EnsembleRow& row) const;
  void name_columns();

  const EnsembleRequest& request_;
  VariedStart starts_;
  bool watches_energy_ = false;
  std::vector<Observed> ends_, statistics_;
  std::vector<std::string> columns_;
  std::size_t varied_ = 0, energy_error_ = 0;
};

// How many trajectories are handed out, and kept, at a time: about this much work, whatever runs
// it.
[[nodiscard]] long long block_size(long long steps, long long count);

// The rows as bytes and back; `columns` is the number of values of each.
[[nodiscard]] std::vector<std::byte> packed(const std::vector<EnsembleRow>& rows);
[[nodiscard]] std::vector<EnsembleRow> unpacked(const std::vector<std::byte>& bytes,
                                                std::size_t columns);

}  // namespace hamgen::app
