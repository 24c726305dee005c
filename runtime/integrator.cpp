#include "runtime/integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace hamgen::runtime {
namespace {

void check_finite(std::string_view what, std::span<const Wide> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i].hi) || !std::isfinite(values[i].lo)) {
      throw std::invalid_argument(fmt::format("{} value {} is not finite", what, i + 1));
    }
  }
}

std::vector<double> part(const std::vector<Wide>& values, double Wide::*member) {
  std::vector<double> parts(values.size());
  std::ranges::transform(values, parts.begin(), member);
  return parts;
}

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

// Before Judge::failure.
Status reason_of(const hamgen_report& report) {
  switch (report.status) {
    case HAMGEN_DONE:
      return Status::done;
    case HAMGEN_NOT_CONVERGED:
      return Status::not_converged;
    case HAMGEN_STOPPED:
      return Status::stopped;
    default:
      return Status::left_domain;
  }
}

// The sizes must be known to be right before anything else is made of the values.
InitialValues checked(const Library& library, const InitialValues& start) {
  library.check_sizes(start.parameters.size(), start.state.size());
  check_finite("parameter", start.parameters);
  check_finite("step size", {&start.h, 1});
  check_finite("initial state", start.state);
  return start;
}

}  // namespace

Integrator::Integrator(std::shared_ptr<const Library> library, const InitialValues& start)
    : library_(std::move(library)),
      start_(checked(*library_, start)),
      judge_(library_, start.parameters, start.state, start.defined_everywhere),
      run_(nullptr, Destroy{&library_->plugin()}) {
  go_back_to(0);
}

void Integrator::go_back_to(long long step) {
  if (remembered_step_ > 0 && remembered_step_ <= step &&
      library_->plugin().restore(run_.get(), remembered_.data(),
                                 static_cast<long long>(remembered_.size())) != 0) {
    steps_done_ = remembered_step_;
    call(step - steps_done_, false);
    return;
  }
  const std::vector<double> parameters = part(start_.parameters, &Wide::hi);
  const std::vector<double> parameters_lo = part(start_.parameters, &Wide::lo);
  const std::vector<double> state = part(start_.state, &Wide::hi);
  const std::vector<double> state_lo = part(start_.state, &Wide::lo);
  run_.reset(library_->plugin().create(parameters.data(), parameters_lo.data(), start_.h.hi,
                                       start_.h.lo, state.data(), state_lo.data()));
  if (!run_) throw std::bad_alloc();
  steps_done_ = 0;
  if (step > 0) call(step, false);
}

void Integrator::remember() {
  constexpr long long far = 4096;
  if (steps_done_ - remembered_step_ < far || library_->plugin().save == nullptr) return;
  remembered_.resize(static_cast<std::size_t>(library_->plugin().save(run_.get(), nullptr)));
  if (remembered_.empty()) return;
  library_->plugin().save(run_.get(), remembered_.data());
  remembered_step_ = steps_done_;
}

std::vector<std::byte> Integrator::saved() const {
  if (library_->plugin().save == nullptr) return {};
  const auto size = static_cast<std::size_t>(library_->plugin().save(run_.get(), nullptr));
  if (size == 0) return {};
  std::vector<std::byte> bytes(sizeof steps_done_ + sizeof energy_error_ + size);
  std::memcpy(bytes.data(), &steps_done_, sizeof steps_done_);
  std::memcpy(bytes.data() + sizeof steps_done_, &energy_error_, sizeof energy_error_);
  library_->plugin().save(run_.get(), bytes.data() + (bytes.size() - size));
  return bytes;
}

void Integrator::restore(std::span<const std::byte> bytes) {
  constexpr std::size_t head = sizeof steps_done_ + sizeof energy_error_;
  if (bytes.size() < head || library_->plugin().restore == nullptr ||
      library_->plugin().restore(run_.get(), bytes.data() + head,
                                 static_cast<long long>(bytes.size() - head)) == 0)
    throw std::invalid_argument("what was saved is not of this integrator");
  std::memcpy(&steps_done_, bytes.data(), sizeof steps_done_);
  std::memcpy(&energy_error_, bytes.data() + sizeof steps_done_, sizeof energy_error_);
  remembered_.assign(bytes.begin() + head, bytes.end());
  remembered_step_ = steps_done_;
}

hamgen_report Integrator::call(long long steps, bool watch_energy) {
  hamgen_report report{};
  if (steps == 0) return report;
  library_->plugin().advance(run_.get(), steps, watch_energy ? 1 : 0, &report);
  steps_done_ += report.steps_done;
  return report;
}

hamgen_report Integrator::last_good(long long before, bool watch_energy) {
  go_back_to(before);
  long long good = 0;
  while (is_finite(rounded_state())) {
    call(1, false);
    ++good;
  }
  go_back_to(before);
  hamgen_report report = call(good - 1, watch_energy);
  report.status = HAMGEN_NOT_FINITE;
  report.last_increment = std::numeric_limits<double>::infinity();
  return report;
}

Report Integrator::advance(long long steps, bool watch_energy) {
  remember();
  const long long before = steps_done_;
  hamgen_report raw = call(steps, watch_energy);
  if (watch_energy && raw.steps_done > 0 && !std::isfinite(raw.energy_last)) {
    // The last of these steps ended where there is no H.
    const hamgen_report failed = raw;
    go_back_to(before);
    raw = call(failed.steps_done - 1, true);
    raw.status = HAMGEN_NOT_FINITE;
    raw.last_iterations = failed.last_iterations;
    raw.last_increment = failed.last_increment;
  }
  if (raw.status == HAMGEN_NOT_FINITE && !is_finite(rounded_state()))
    raw = last_good(before, watch_energy);
  Report report{.status = reason_of(raw),
                .steps_done = raw.steps_done,
                .iterations = raw.iterations,
                .last_iterations = raw.last_iterations,
                .last_increment = {},
                .energy = {}};
  if (std::isfinite(raw.last_increment)) report.last_increment = raw.last_increment;
  if (watch_energy && raw.steps_done > 0) {
    report.energy = EnergyRange{.min = {.hi = raw.energy_min, .lo = raw.energy_min_lo},
                                .max = {.hi = raw.energy_max, .lo = raw.energy_max_lo},
                                .last = {.hi = raw.energy_last, .lo = raw.energy_last_lo}};
    energy_error_ = std::max({energy_error_, difference(report.energy->max, judge_.energy()),
                              difference(judge_.energy(), report.energy->min)});
  }
  if (report.status != Status::done && report.status != Status::stopped)
    report.status = judge_.failure(report.status, rounded_state(), energy_error_);
  return report;
}

std::vector<Wide> Integrator::state() const { return read(library_->plugin().get_state); }

std::vector<Wide> Integrator::carry() const { return read(library_->plugin().get_carry); }

std::vector<Wide> Integrator::read(void (*get)(const hamgen_run*, double*, double*)) const {
  std::vector<double> hi(2 * library_->degrees_of_freedom());
  std::vector<double> lo(hi.size());
  get(run_.get(), hi.data(), lo.data());
  std::vector<Wide> values(hi.size());
  for (std::size_t i = 0; i < hi.size(); ++i) values[i] = {.hi = hi[i], .lo = lo[i]};
  return values;
}

std::vector<double> Integrator::rounded_state() const {
  std::vector<double> values(2 * library_->degrees_of_freedom());
  library_->plugin().get_state(run_.get(), values.data(), nullptr);
  return values;
}

Wide Integrator::energy() const { return library_->energy(start_.parameters, state()); }

std::vector<Wide> Integrator::invariants() const {
  return library_->invariants(start_.parameters, state());
}

}  // namespace hamgen::runtime
