// All cells of a stress map.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <thread>

#include "app/studies/load_integrator.hpp"
#include "app/studies/stress_grid.hpp"
#include "app/studies/stress_references.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/csv_writer.hpp"
#include "runtime/provenance.hpp"

namespace hamgen::app {
namespace {

constexpr unsigned kThreads = 2;

StressMap empty_map(const StressGrid& grid, const StressLimits& limits) {
  const runtime::Provenance made_by =
      runtime::provenance_of(chosen_compiler({}), nullptr, {.optimisation = grid.optimisation()});
  StressMap map{.model = grid.plugin().model.name,
                .scene = grid.scene_name(),
                .method = grid.plugin().scheme_name,
                .axes = grid.axes(),
                .steps = limits.steps,
                .compiler = made_by.compiler + " " + made_by.flags};
  map.cells.resize(map.columns() * map.rows());
  return map;
}

// work(0), work(1), ... on two threads; the calling one tells how many are done.
void run_all(const std::string& label, std::size_t count, const StressRequest& request,
             const std::function<void(std::size_t)>& work) {
  const StopFlag stop = request.limits.stop;
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> finished = 0;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      for (std::size_t k = next++; k < count && !is_stopped(stop); k = next++) {
        work(k);
        ++finished;
      }
    });
  }
  Work progress(request.on_progress, label, static_cast<long long>(count));
  while (finished < count && !is_stopped(stop)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    progress.tell(static_cast<long long>(finished.load()));
  }
}

void run_cells(StressGrid& grid, const StressLimits& limits, const StressRequest& request,
               StressMap& map) {
  std::vector<runtime::InitialValues> starts(map.cells.size());
  std::optional<double> first_h;
  std::size_t undefined = 0;
  // In a map of nothing but these the model or the command is wrong: the caller's exception.
  const auto is_undefined = [&](StressCell& cell, const std::string& reason) {
    if (++undefined == map.cells.size()) return false;
    cell.outcome = runtime::Status::undefined;
    cell.bounded = false;
    cell.reason = reason;
    cell.state_missing = runtime::to_text(cell.outcome);
    return true;
  };
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    StressCell& cell = map.cells[i];
    const std::vector<double> at = map.place(i);
    std::ranges::copy(at, cell.at.begin());
    try {
      starts[i] = grid.start_at(at);
    } catch (const ModelError& error) {
      if (!is_undefined(cell, error.diagnostics().front().message)) throw;
      continue;
    } catch (const UsageError& error) {  // a pole of the gauge, a value beyond the scalar's range
      const std::string text = error.what();
      if (!is_undefined(cell, text.substr(0, text.find('\n')))) throw;
      continue;
    }
    const double h = starts[i].h.hi;
    cell.h = h;
    if (!first_h) first_h = h;
    if (request.of_one_time && h != *first_h)
      throw UsageError(
          fmt::format("--time: h is {} in one cell and {} in another, and so many steps are of "
                      "different lengths\nhelp: say --steps N, or one --h H for all cells",
                      runtime::number_text(*first_h), runtime::number_text(h)));
    if (const auto linear = grid.linear_at(at)) {
      cell.h_omega = linear->h_omega;
      cell.linear_bounded = linear->margin > 0.0;
    }
  }
  StressReferences references(grid, map, limits);
  run_all(map.model + ", references", references.count(), request,
          [&](std::size_t i) { references.compute(i); });
  map.references = references.method();
  run_all(map.model, map.cells.size(), request, [&](std::size_t i) {
    StressCell& cell = map.cells[i];
    if (cell.outcome == runtime::Status::undefined) return;
    const auto state = run_stress_cell(grid.library(), starts[i], limits, cell);
    references.compare(i, starts[i].state, state, grid.plugin(), cell);
  });
}

}  // namespace

StressMap stress_map(const StressRequest& request) {
  StressGrid grid(request);
  StressLimits limits = request.limits;
  StressMap map = empty_map(grid, limits);
  run_cells(grid, limits, request, map);
  if (request.with_bound && !is_stopped(limits.stop)) map.linear_bound = grid.linear_bound();
  return map;
}

}  // namespace hamgen::app
