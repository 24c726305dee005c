#include "app/studies/chaos.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>

#include "app/studies/natural_sizes.hpp"

namespace hamgen::app {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<double> upper(const std::vector<runtime::Wide>& values) {
  std::vector<double> result;
  for (const runtime::Wide& x : values) result.push_back(x.hi);
  return result;
}

// Deviations of length 1 in directions by chance, the same ones each time.
Matrix deviations(Eigen::Index size, Eigen::Index count) {
  std::mt19937_64 source(20010920);
  Matrix columns(size, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < size; ++i) {
      // Uniform in (-1, 1): the same bits with every library.
      columns(i, j) = std::ldexp(static_cast<double>(source() >> 11), -52) - 1.0;
    }
    columns.col(j).normalize();
  }
  return columns;
}

class Deviations {
 public:
  explicit Deviations(const ChaosRequest& request)
      : request_(request),
        plugin_(request.library->plugin()),
        size_(2 * plugin_.degrees_of_freedom),
        parameters_(upper(request.start.parameters)),
        state_(upper(request.start.state)),
        next_(state_),
        map_(size_, size_),
        sizes_(natural_sizes(*request.library, request.start)),
        columns_(deviations(size_, std::clamp<Eigen::Index>(request.deviations, 2, size_))) {
    if (plugin_.tangent == nullptr) throw std::invalid_argument("the plugin has no tangent map");
    if (request.spectrum) {
      frame_ = Eigen::MatrixXd::Identity(size_, size_);
      logarithms_ = Eigen::VectorXd::Zero(size_);
    }
  }

  // Where the next step ends, and by which map; or why it cannot be made.
  [[nodiscard]] std::optional<runtime::Status> look_ahead() {
    if (plugin_.tangent(parameters_.data(), request_.start.h.hi, state_.data(), next_.data(),
                        map_.data()) == 0)
      return runtime::Status::not_converged;
    const auto is_number = [](double x) { return std::isfinite(x); };
    if (!map_.allFinite() || !std::ranges::all_of(next_, is_number) || !is_number(energy_ahead()))
      return runtime::Status::left_domain;
    // In units of the sizes.
    for (Eigen::Index i = 0; i < size_; ++i) {
      for (Eigen::Index j = 0; j < size_; ++j) map_(i, j) *= size_at(j) / size_at(i);
    }
    return {};
  }
  [[nodiscard]] double energy_ahead() const { return request_.library->energy(parameters_, next_); }
  [[nodiscard]] const std::vector<double>& state_ahead() const { return next_; }

  // Makes the step that was looked at.
  void take() {
    state_.swap(next_);
    ++steps_;
    columns_ = map_ * columns_;
    for (Eigen::Index j = 0; j < columns_.cols(); ++j) {
      const double length = columns_.col(j).norm();
      if (j == 0) grow(std::log(length));
      columns_.col(j) /= length;
    }
    if (request_.spectrum) turn_frame();
  }

  [[nodiscard]] double time() const { return static_cast<double>(steps_) * request_.start.h.hi; }
  [[nodiscard]] const std::vector<double>& state() const { return state_; }

  [[nodiscard]] ChaosSample sample() const {
    const double time = std::abs(this->time());
    const Eigen::VectorXd sum = columns_.col(0) + columns_.col(1);
    const Eigen::VectorXd difference = columns_.col(0) - columns_.col(1);
    return {.time = this->time(),
            .lyapunov = length_ / time,
            .megno = megno_mean_,
            .fli = longest_,
            .sali = std::min(sum.norm(), difference.norm()),
            .gali = volume()};
  }
  [[nodiscard]] int count() const { return static_cast<int>(columns_.cols()); }

  [[nodiscard]] std::vector<double> spectrum() const {
    std::vector<double> exponents;
    for (const double logarithm : logarithms_) exponents.push_back(logarithm / std::abs(time()));
    std::ranges::sort(exponents, std::greater<>());
    return exponents;
  }

 private:
  [[nodiscard]] double size_at(Eigen::Index i) const { return sizes_[static_cast<std::size_t>(i)]; }

  // Of the first deviation in this step.  Its growth is taken at the middle of the step.
  void grow(double logarithm) {
    length_ += logarithm;
    longest_ = std::max(longest_, length_);
    const auto k = static_cast<double>(steps_);
    weighted_ += (k - 0.5) * logarithm;
    const double megno = 2.0 * weighted_ / k;
    megno_mean_ += (megno - megno_mean_) / k;
  }

  // That the deviations span.
  [[nodiscard]] double volume() const {
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(columns_);
    return std::abs(factors.matrixQR().diagonal().prod());
  }

  // The frame stays orthonormal; what it is stretched by is collected.
  void turn_frame() {
    frame_ = map_ * frame_;
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(frame_);
    for (Eigen::Index i = 0; i < size_; ++i)
      logarithms_[i] += std::log(std::abs(factors.matrixQR()(i, i)));
    frame_ = factors.householderQ();
  }

  const ChaosRequest& request_;
  const hamgen_plugin& plugin_;
  Eigen::Index size_;
  std::vector<double> parameters_, state_, next_;
  Matrix map_;
  std::vector<double> sizes_;  // of the state's components
  Matrix columns_;
  Eigen::MatrixXd frame_;
  Eigen::VectorXd logarithms_;
  long steps_ = 0;
  double length_ = 0.0, longest_ = 0.0, weighted_ = 0.0, megno_mean_ = 0.0;
};

constexpr double kGrowth = 1.1;  // from sample to sample
constexpr long kFirstSample = 10;
constexpr long kStepsOfAProgress = 1024;

}  // namespace

Chaos chaos(const ChaosRequest& request) {
  Deviations deviations(request);
  const runtime::Judge judge(request.library, request.start.parameters, request.start.state,
                             request.start.defined_everywhere);
  Chaos result{.samples = {}, .spectrum = {}, .deviations = deviations.count()};
  result.energy_scale = judge.energy_terms();
  double limit = judge.jump_limit();
  long sampled = 0;
  long next = std::min(kFirstSample, request.steps);
  while (result.steps < request.steps && result.status == runtime::Status::done) {
    if (result.steps % kStepsOfAProgress == 0) {
      if (request.on_progress) request.on_progress(result.steps);
      if (is_stopped(request.stop)) result.status = runtime::Status::stopped;
    }
    if (result.status != runtime::Status::done) break;
    std::optional<runtime::Status> failure = deviations.look_ahead();
    const double error = failure ? 0.0 : std::abs(deviations.energy_ahead() - judge.energy().hi);
    if (!failure && error > limit) {
      const auto raised = judge.raised_limit(limit, deviations.state_ahead(), error);
      if (!raised) failure = runtime::Status::jumped;
      limit = raised.value_or(limit);
    }
    if (failure) {
      result.status = judge.failure(*failure, deviations.state(), result.largest_energy_error);
      break;
    }
    deviations.take();
    result.largest_energy_error = std::max(result.largest_energy_error, error);
    if (++result.steps < next) continue;
    next = std::min(request.steps,
                    std::max(next + 1, static_cast<long>(kGrowth * static_cast<double>(next))));
    result.samples.push_back(deviations.sample());
    sampled = result.steps;
  }
  if (sampled < result.steps) result.samples.push_back(deviations.sample());
  if (request.spectrum && result.steps > 0) result.spectrum = deviations.spectrum();
  return result;
}

}  // namespace hamgen::app
