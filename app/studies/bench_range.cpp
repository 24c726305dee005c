#include "app/studies/bench_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

constexpr double kWorst = 1e-2;
constexpr int kFinest = -6;
constexpr int kCoarsest = 20;
constexpr long kFewestSteps = 4;

long step_count(const Rational& time, const Rational& h) {
  const Rational count = time / h;
  const double wanted = to_double(count);
  if (wanted < 0.0)
    throw UsageError(fmt::format(
        "h = {0:g} goes the other way than the time {1:g}\nhelp: --h {2:g}, or --time {3:g}",
        to_double(h), to_double(time), -to_double(h), -to_double(time)));
  if (!(wanted > 0.0) || wanted > static_cast<double>(kMostBenchSteps))
    throw UsageError(
        fmt::format("h = {:g} makes {:.3g} steps of the time {:g}\nhelp: between 1 and "
                    "1e8 can be measured; change --h or --time",
                    to_double(h), wanted, to_double(time)));
  return std::max(1L, static_cast<long>(std::ceil(wanted - 1e-9)));
}

class Range {
 public:
  Range(const Bench& bench, std::size_t method, const RangeSearch& search)
      : bench_(&bench), method_(method), search_(&search) {}

  // The rows by falling step.
  std::deque<BenchRow> rows() {
    const int first = first_usable();
    if (is_stopped_) return std::move(rows_);
    if (!rows_.empty() && is_usable(rows_.front())) {
      if (first == 0) add_larger();
      if (!is_stopped_) add_smaller(first);
    }
    return std::move(rows_);
  }

 private:
  [[nodiscard]] double error(const BenchRow& row) const {
    const std::optional<double> known = error_of(row, bench_->observed);
    return known && std::isfinite(*known) ? *known : HUGE_VAL;
  }
  [[nodiscard]] bool is_usable(const BenchRow& row) const { return error(row) <= kWorst; }

  std::optional<BenchRow> measured(int power) {
    const Rational h =
        power >= 0 ? Rational(search_->h * (1L << power)) : Rational(search_->h / (1L << -power));
    BenchRow row = row_of(method_, search_->time, h);
    if (search_->measure(row)) return row;
    is_stopped_ = true;
    return {};
  }

  // The power of the largest step up to h that is usable; it, or the row that says how the smallest
  // fails, is kept.
  int first_usable() {
    for (int power = 0;; --power) {
      std::optional<BenchRow> row = measured(power);
      if (!row) return power;
      const bool is_last =
          is_usable(*row) || power == kFinest || row->outcome.starts_with("refused");
      if (!is_last) continue;
      rows_.push_back(std::move(*row));
      return power;
    }
  }

  void add_larger() {
    for (int power = 1; power <= kCoarsest && rows_.front().steps >= 2 * kFewestSteps; ++power) {
      std::optional<BenchRow> row = measured(power);
      if (!row || !is_usable(*row)) return;
      rows_.push_front(std::move(*row));
    }
  }

  // An error that changes its sign may be small by accident: one step without progress is not yet
  // the floor.
  void add_smaller(int power) {
    const double least_progress =
        std::max(0.25, std::pow(0.5, bench_->methods[method_].plugin.order));
    while (--power >= kFinest) {
      std::optional<BenchRow> row = measured(power);
      if (!row) return;
      rows_.push_back(std::move(*row));
      const std::size_t count = rows_.size();
      if (count < 3) continue;
      const double least = least_progress * error(rows_[count - 3]);
      if (error(rows_[count - 2]) < least || error(rows_[count - 1]) < least) continue;
      rows_[count - 3].is_floor = true;
      rows_.pop_back();
      return;
    }
  }

  const Bench* bench_;
  std::size_t method_;
  const RangeSearch* search_;
  std::deque<BenchRow> rows_;
  bool is_stopped_ = false;
};

}  // namespace

BenchRow row_of(std::size_t method, const Rational& time, const Rational& h) {
  BenchRow row{.method = method};
  row.steps = step_count(time, h);
  row.h = time / row.steps;
  return row;
}

void add_rows_in_range(Bench& bench, std::size_t method, const RangeSearch& search) {
  for (BenchRow& row : Range(bench, method, search).rows()) bench.rows.push_back(std::move(row));
}

}  // namespace hamgen::app
