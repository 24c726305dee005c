#include "app/studies/measure_tangent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>

namespace hamgen::app {
namespace {

// Solving for M leaves some 2n rounding errors in its entries, and M^T J M multiplies and adds two
// of them: relative to the terms that are added that is far below this for the sizes that are
// written out: 450 units of the last place.
constexpr double kRoundOff = 1e-13;  // in double
constexpr int kStates = 100;
// Of a component's amplitude: error some 1e-10 on both sides, in double.
constexpr double kDifference = 1e-5;
// Another solution of the equations is farther away than this part of the amplitudes.
constexpr double kOtherSolution = 1e-6;
// Where a step may have come to one, the state is moved from the orbit by a quarter of that, so
// many times.
constexpr int kQuarters = 6;

using Vector = std::vector<double>;

bool all_finite(const Vector& values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

struct Sample {
  Vector parameters, state;
};

class TangentMeasurement {
 public:
  TangentMeasurement(const runtime::LoadedPlugin& loaded, const runtime::InitialValues& start)
      : step_(loaded.library->plugin()),
        start_(start),
        n_(static_cast<std::size_t>(step_.degrees_of_freedom)),
        epsilon_(std::ldexp(1.0, 1 - std::min(step_.scalar_digits, 53))),
        matrix_(4 * n_ * n_),
        end_(2 * n_) {
    // Along the orbit, for what the scene starts at zero has a size as well.
    runtime::Integrator integrator(loaded.library, start);
    orbit_.push_back(integrator.rounded_state());
    while (orbit_.size() < 100 && integrator.advance(10, false).status == runtime::Status::done) {
      orbit_.push_back(integrator.rounded_state());
    }
    amplitude_.resize(2 * n_);
    for (const Vector& z : orbit_) {
      for (std::size_t i = 0; i < 2 * n_; ++i) {
        amplitude_[i] = std::max(amplitude_[i], std::abs(z[i]));
      }
    }
    fill_amplitude(0);
    fill_amplitude(n_);
  }

  void run() {
    for (int i = 0; i < kStates; ++i) {
      const Move move = draw();
      Seen seen;
      for (int quarters = 0; quarters <= kQuarters; ++quarters) {
        const bool compares = i % 10 == 0;
        seen = look_at(moved_by(move, std::ldexp(1.0, -2 * quarters)), compares);
        if (!seen.may_be_another) break;
        if (quarters == 0) ++nearer_;
      }
      take(seen);
    }
  }

  [[nodiscard]] Proof findings(bool symmetric) const {
    const std::string where = fmt::format(
        "at {} states and parameters around the scene, h = {:g}{}", kStates, start_.h.hi,
        failed_ == 0 ? "" : fmt::format(" ({} of them without a step)", failed_));
    const std::string nearer =
        nearer_ == 0 ? ""
                     : fmt::format(
                           "; {} of them moved less, for farther off steps differ by more "
                           "than M tells, or do not lead back",
                           nearer_);
    if (failed_ == kStates)
      return {{"tangent map symplectic", Verdict::not_decided, "no step could be taken " + where}};
    const double round_off = kRoundOff * doubles_of_epsilon();
    auto within = [&](const std::string& property, double value) {
      return Finding{property, value <= round_off ? Verdict::tested : Verdict::refuted,
                     fmt::format("at most {:.2e} {}; round-off is below {:.0e}{}", value, where,
                                 round_off, nearer)};
    };
    Proof proof{within("tangent map symplectic", defect_)};
    if (compared_ == 0) {
      proof.push_back({"tangent map of the step", Verdict::not_decided,
                       "no difference quotient of the step could be formed"});
    } else {
      proof.push_back(
          {"tangent map of the step", wrong_ ? Verdict::refuted : Verdict::tested,
           fmt::format("differs from difference quotients of the step by at most {:.1e}{}{}",
                       difference_, wrong_ ? ", which is more than their error" : "", nearer)});
    }
    if (!symmetric) return proof;
    proof.push_back(reversed_ > 0 ? within("reversal", reversal_)
                                  : Finding{"reversal", Verdict::not_decided,
                                            "no step back could be taken " + where});
    return proof;
  }

 private:
  [[nodiscard]] double doubles_of_epsilon() const {
    return epsilon_ / std::numeric_limits<double>::epsilon();
  }

  // What rests but for rounding, as sin(pi) does, has no size of its own: it takes that of the
  // largest coordinate, or momentum, or of all if these are 0.  Such rounding is a few units of the
  // largest: up to 64 are taken for it.
  void fill_amplitude(std::size_t first) {
    const double rest = 64 * epsilon_;
    const std::span<double> part(amplitude_.data() + first, n_);
    const double all = std::max(*std::ranges::max_element(amplitude_), 1e-300);
    const double own = *std::ranges::max_element(part);
    const double most = own > 0 ? own : all;
    for (double& a : part) a = a > rest * most ? a : most;
  }

  // From a state of the orbit and the scene's parameters, each by up to a tenth.
  struct Move {
    std::size_t from = 0;
    Vector parameters, state;
  };
  Move draw() {
    std::uniform_real_distribution<double> tenth(-0.1, 0.1);
    Move result;
    for (std::size_t i = 0; i < start_.parameters.size(); ++i)
      result.parameters.push_back(tenth(source_));
    result.from = source_() % orbit_.size();
    for (std::size_t i = 0; i < 2 * n_; ++i) result.state.push_back(tenth(source_));
    return result;
  }
  [[nodiscard]] Sample moved_by(const Move& move, double part) const {
    Sample result;
    for (std::size_t i = 0; i < move.parameters.size(); ++i)
      result.parameters.push_back(start_.parameters[i].hi * (1 + part * move.parameters[i]));
    const Vector& z = orbit_[move.from];
    for (std::size_t i = 0; i < z.size(); ++i)
      result.state.push_back(z[i] + part * move.state[i] * amplitude_[i]);
    return result;
  }

  // What one state shows.
  struct Seen {
    bool failed = false, reversed = false, wrong = false;
    bool may_be_another = false;  // may the step, or the one back, have come to another solution?
    double defect = 0, reversal = 0, difference = 0;
    int compared = 0;
  };
  Seen look_at(const Sample& z, bool compares) {
    Seen seen;
    if (!take_step(z, start_.h.hi) || !all_finite(end_) || !all_finite(matrix_)) {
      seen.failed = true;
      return seen;
    }
    const Vector end = end_;
    const Vector matrix = matrix_;
    seen.defect = symplectic_defect(matrix);
    if (compares) compare_with_differences(z, matrix, seen);
    seen.may_be_another = seen.wrong;  // a jump, or next to one, where M grows without bounds
    if (take_step({z.parameters, end}, -start_.h.hi) && all_finite(end_)) {
      seen.reversed = true;
      for (std::size_t k = 0; k < 2 * n_; ++k) {
        const double miss = std::abs(end_[k] - z.state[k]) / amplitude_[k];
        seen.reversal = std::max(seen.reversal, miss / growth_of_errors(matrix_, k));
        seen.may_be_another = seen.may_be_another || miss > kOtherSolution;
      }
    }
    return seen;
  }
  // What rounding of all components comes to in one of them, by a step of this tangent map.
  [[nodiscard]] double growth_of_errors(const Vector& matrix, std::size_t k) const {
    double sum = 0;
    for (std::size_t j = 0; j < 2 * n_; ++j)
      sum += std::abs(matrix[2 * n_ * k + j]) * amplitude_[j] / amplitude_[k];
    return std::max(sum, 1.0);
  }
  void take(const Seen& seen) {
    if (seen.failed) ++failed_;
    if (seen.reversed) ++reversed_;
    compared_ += seen.compared;
    wrong_ = wrong_ || seen.wrong;
    defect_ = std::max(defect_, seen.defect);
    reversal_ = std::max(reversal_, seen.reversal);
    difference_ = std::max(difference_, seen.difference);
  }

  bool take_step(const Sample& z, double h) {
    return step_.tangent(z.parameters.data(), h, z.state.data(), end_.data(), matrix_.data()) != 0;
  }

  // max |(M^T J M - J)_ij| over what its terms can add up to, by the norms of the columns of M: far
  // from the diagonal its entries may be smaller than the rounding of what made them.  The norms
  // weigh M_ki by the orbit's sizes in q_k and p_k, so that they do not depend on units.
  [[nodiscard]] double symplectic_defect(const Vector& m) const {
    const std::size_t size = 2 * n_;
    Vector of_q(size);
    Vector of_p(size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = 0; k < n_; ++k) {
        const double weight = std::sqrt(amplitude_[n_ + k] / amplitude_[k]);
        of_q[i] = std::hypot(of_q[i], weight * m[k * size + i]);
        of_p[i] = std::hypot(of_p[i], m[(n_ + k) * size + i] / weight);
      }
    }
    double worst = 0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        double sum = j == i + n_ ? -1 : (i == j + n_ ? 1 : 0);
        for (std::size_t k = 0; k < n_; ++k) {
          sum +=
              m[k * size + i] * m[(n_ + k) * size + j] - m[(n_ + k) * size + i] * m[k * size + j];
        }
        const double most = of_q[i] * of_p[j] + of_p[i] * of_q[j];
        if (most > 0) worst = std::max(worst, std::abs(sum) / most);
      }
    }
    return worst;
  }

  // (Z(z + d) - Z(z - d)) / 2d with d and 2d: the error of the first, c d^2, is a third of the
  // difference of the two; rounding of Z adds some units of its last place over d, and what
  // those of z grow to in it.
  void compare_with_differences(const Sample& z, const Vector& matrix, Seen& seen) {
    const std::size_t size = 2 * n_;
    // Both errors grow alike: c d^2, and epsilon over d.
    const double relative = kDifference * std::cbrt(doubles_of_epsilon());
    for (std::size_t j = 0; j < size; ++j) {
      const double d = relative * amplitude_[j];
      Vector quotient[2];
      for (const int factor : {1, 2}) {
        Sample up = z;
        Sample down = z;
        up.state[j] += factor * d;
        down.state[j] -= factor * d;
        if (!take_step(up, start_.h.hi)) return;
        const Vector above = end_;
        if (!take_step(down, start_.h.hi)) return;
        for (std::size_t i = 0; i < size; ++i) {
          quotient[factor - 1].push_back((above[i] - end_[i]) / (up.state[j] - down.state[j]));
        }
      }
      ++seen.compared;
      for (std::size_t i = 0; i < size; ++i) {
        const double scale = growth_of_errors(matrix, i) * amplitude_[i] / amplitude_[j];
        const double error = std::abs(matrix[i * size + j] - quotient[0][i]) / scale;
        const double rounding = 64 * epsilon_ / relative;
        const double bound = std::abs(quotient[1][i] - quotient[0][i]) / scale + rounding;
        seen.difference = std::max(seen.difference, error);
        seen.wrong = seen.wrong || !(error <= bound);
      }
    }
  }

  const hamgen_plugin& step_;
  const runtime::InitialValues& start_;
  std::size_t n_;
  double epsilon_;  // of the numbers that the step computes with, or of double where they have more
  Vector matrix_, end_;  // of the step taken last
  std::vector<Vector> orbit_;
  Vector amplitude_;
  std::mt19937_64 source_{1};
  int failed_ = 0;    // states without a step
  int nearer_ = 0;    // states that were moved less
  int reversed_ = 0;  // steps back
  int compared_ = 0;  // columns of M
  double defect_ = 0;
  double reversal_ = 0;
  double difference_ = 0;
  bool wrong_ = false;
};

}  // namespace

Proof measure_tangent(const runtime::LoadedPlugin& loaded, const runtime::InitialValues& start,
                      bool symmetric) {
  TangentMeasurement measurement(loaded, start);
  measurement.run();
  return measurement.findings(symmetric);
}

}  // namespace hamgen::app
