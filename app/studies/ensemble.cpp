#include "app/studies/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "app/studies/initial_data.hpp"
#include "app/studies/setting.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> state_names(const Model& model) {
  std::vector<std::string> names = element_names(model.coordinates);
  std::ranges::move(element_names(model.momenta), std::back_inserter(names));
  return names;
}

// With underscores where the name is taken.
void add_column(std::vector<std::string>& columns, std::string name) {
  const auto is_taken = [&columns](const std::string& each) {
    return each == "index" || each == "status" || each == "steps" || each == "manifest" ||
           std::ranges::find(columns, each) != columns.end();
  };
  while (is_taken(name)) name += '_';
  columns.push_back(std::move(name));
}

}  // namespace

// Of the values at every so many steps, the first state among them.  The sum is compensated
// (Neumaier).
class Ensemble::Statistics {
 public:
  void add(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    defined_ = defined_ && std::isfinite(value);
    const double sum = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
    sum_ = sum;
    ++count_;
  }

  void append_to(std::vector<double>& values) const {
    const bool known = defined_ && count_ > 0;
    values.push_back(known ? min_ : kNoNumber);
    values.push_back(known ? max_ : kNoNumber);
    values.push_back(known ? (sum_ + rest_) / static_cast<double>(count_) : kNoNumber);
  }

 private:
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0.0, rest_ = 0.0;
  long long count_ = 0;
  bool defined_ = true;
};

Ensemble::Ensemble(const EnsembleRequest& request)
    : request_(request),
      starts_(*request.plugin, *request.library, request.scene, request.plan.names()),
      watches_energy_(app::watches_energy(*request.plugin, request.values)) {
  for (const std::string& name : request_.statistics) statistics_.push_back(find(name));
  name_columns();
}

Ensemble::Observed Ensemble::find(const std::string& name) const {
  const std::vector<std::string> state = state_names(request_.plugin->model);
  if (const auto found = std::ranges::find(state, name); found != state.end())
    return {Observed::Kind::state, static_cast<std::size_t>(found - state.begin())};
  if (name == "energy") {
    if (!watches_energy_)
      throw UsageError("--statistics energy: the step leaves out what H depends on\nhelp: --whole");
    return {Observed::Kind::energy, 0};
  }
  const auto& invariants = request_.plugin->invariant_names;
  const auto found = std::ranges::find(invariants, name);
  if (found == invariants.end()) internal_error("statistics of what is not observed");
  return {Observed::Kind::invariant, static_cast<std::size_t>(found - invariants.begin())};
}

void Ensemble::name_columns() {
  const Model& model = request_.plugin->model;
  const SceneValues& scene = request_.values;
  const std::vector<std::string> state = state_names(model);
  const bool parts = observes_parts(model, scene);
  std::vector<std::string> ends;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (parts && !observes(scene, state[i])) continue;
    ends.push_back(state[i]);
    ends_.push_back({Observed::Kind::state, i});
  }
  const auto& invariants = request_.plugin->invariant_names;
  std::vector<std::string> observed;
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    if (!observes(scene, invariants[i])) continue;
    observed.push_back(invariants[i]);
    ends_.push_back({Observed::Kind::invariant, i});
  }
  for (const std::string& name : request_.plan.names()) {
    const bool is_state = std::ranges::find(state, name) != state.end();
    add_column(columns_, is_state ? name + "_0" : name);
  }
  varied_ = columns_.size();
  add_column(columns_, time_column(ends));
  for (const std::string& name : ends) add_column(columns_, name);
  for (const std::string& name : observed) add_column(columns_, name);
  energy_error_ = columns_.size() + 1;
  if (watches_energy_) {
    add_column(columns_, "H");
    add_column(columns_, "H_error");
    add_column(columns_, "H_scale");
  } else {
    energy_error_ = std::numeric_limits<std::size_t>::max();
  }
  for (const std::string& name : request_.statistics) {
    for (const char* what : {"_min", "_max", "_mean"}) add_column(columns_, name + what);
  }
}

void Ensemble::add_end(const VariedStart::Start& start, const runtime::Integrator& integrator,
                       const runtime::RunSummary& summary, EnsembleRow& row) const {
  const double steps = static_cast<double>(summary.steps_done);
  row.values.push_back(std::fma(steps, start.values.h.hi, steps * start.values.h.lo));
  const std::vector<runtime::Wide> state =
      whole_state(*request_.plugin, start.scene, integrator.state());
  const std::vector<runtime::Wide> invariants = integrator.invariants();
  for (const Observed& each : ends_)
    row.values.push_back((each.kind == Observed::Kind::state ? state : invariants)[each.place].hi);
  if (!watches_energy_) return;
  row.values.push_back(summary.energy ? summary.energy->last.hi : kNoNumber);
  row.values.push_back(summary.energy ? summary.energy->max_error() : kNoNumber);
  row.values.push_back(summary.energy ? summary.energy_terms : kNoNumber);
}

bool Ensemble::advance(long long index, EnsembleRow& row) const {
  row.values.resize(varied_);
  request_.plan.values(index, row.values);
  const std::optional<VariedStart::Start> start = starts_.at(row.values);
  if (!start) {
    row.status = runtime::Status::undefined;
    row.values.resize(columns_.size(), kNoNumber);
    return true;
  }
  runtime::Integrator integrator(request_.library, start->values);
  std::vector<Statistics> statistics(statistics_.size());
  runtime::IntegrateOptions options;
  options.steps = *start->scene.steps;
  options.every = statistics_.empty() ? 0 : request_.every;
  options.watch_energy = options.end_at_jump = watches_energy_;
  options.stop = request_.stop;
  const bool of_state = std::ranges::any_of(
      statistics_, [](const Observed& each) { return each.kind == Observed::Kind::state; });
  options.on_record = [&](const runtime::Record& record) {
    std::vector<runtime::Wide> state;
    if (of_state)
      state =
          whole_state(*request_.plugin, start->scene, {record.state.begin(), record.state.end()});
    for (std::size_t i = 0; i < statistics_.size(); ++i) {
      const Observed& each = statistics_[i];
      statistics[i].add(each.kind == Observed::Kind::state    ? state[each.place].hi
                        : each.kind == Observed::Kind::energy ? record.energy.hi
                                                              : record.invariants[each.place].hi);
    }
  };
  const runtime::RunSummary summary = runtime::integrate(integrator, options);
  if (summary.status == runtime::Status::stopped) return false;
  row.status = summary.status;
  row.steps = summary.steps_done;
  add_end(*start, integrator, summary, row);
  for (const Statistics& each : statistics) each.append_to(row.values);
  return true;
}

std::vector<EnsembleRow> Ensemble::block(long long first, long long count) const {
  std::vector<EnsembleRow> rows(static_cast<std::size_t>(count));
  for (long long i = 0; i < count; ++i) {
    if (is_stopped(request_.stop) || !advance(first + i, rows[static_cast<std::size_t>(i)]))
      return {};
  }
  return rows;
}

long long block_size(long long steps, long long count) {
  constexpr long long work = 1'000'000;         // steps: about a tenth of a second
  constexpr long long most_blocks = 4'000'000;  // whoever leads has them all in memory
  return std::max(std::clamp(work / std::max(1LL, steps), 1LL, 256LL),
                  (count + most_blocks - 1) / most_blocks);
}

std::vector<std::byte> packed(const std::vector<EnsembleRow>& rows) {
  std::vector<std::byte> bytes;
  const auto add = [&bytes](const auto* from, std::size_t count) {
    const std::size_t at = bytes.size();
    bytes.resize(at + count * sizeof *from);
    if (count > 0) std::memcpy(bytes.data() + at, from, count * sizeof *from);
  };
  for (const EnsembleRow& row : rows) {
    const std::int64_t head[2] = {static_cast<std::int64_t>(row.status), row.steps};
    add(head, 2);
    add(row.values.data(), row.values.size());
  }
  return bytes;
}

std::vector<EnsembleRow> unpacked(const std::vector<std::byte>& bytes, std::size_t columns) {
  std::vector<EnsembleRow> rows;
  const std::size_t size = 16 + 8 * columns;
  for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
    std::int64_t head[2] = {};
    std::memcpy(head, bytes.data() + at, sizeof head);
    EnsembleRow row{.status = static_cast<runtime::Status>(head[0]), .steps = head[1]};
    row.values.resize(columns);
    if (columns > 0) std::memcpy(row.values.data(), bytes.data() + at + 16, 8 * columns);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace hamgen::app
