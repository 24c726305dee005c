// How far a fixed number of sweeps is from a symplectic map.
//
// Z after K sweeps is an explicit formula in z and h, so its Jacobian M has a power series in h:
// the first term of M^T J M - J that does not vanish is the order of the defect for this H and this
// member.  In general it is K + 2: each sweep multiplies the error of the gradient by
// h H'' (1/2 + C) J, from O(h) of the predictor on, and h J times it is the error of Z.
#include <fmt/format.h>

#include <stdexcept>

#include "generator/verify/formal.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

constexpr int kPointsOfSweeps = 3;
constexpr int kMostSeriesSweeps = 8;  // beyond, the general order is given
constexpr std::size_t kLargestSwept = 20;

using SeriesMatrix = std::vector<std::vector<PowerSeries>>;

class SweptStep {
 public:
  SweptStep(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
            int sweeps, std::size_t length)
      : derivatives_(derivatives),
        member_(member),
        sweeps_(sweeps),
        size_(mechanics.variables.size()),
        length_(length) {}

  // M^T J M - J by central differences, whose error is 1e-40.
  [[nodiscard]] SeriesMatrix defect(const FormalPoint& point) const {
    const Precise by = precise(*parse_decimal("1e-20"));
    SeriesMatrix columns;
    for (std::size_t j = 0; j < size_; ++j) {
      FormalPoint up = point;
      FormalPoint down = point;
      up.move(j, by);
      down.move(j, -by);
      const auto above = after(up);
      const auto below = after(down);
      auto& column = columns.emplace_back();
      for (std::size_t i = 0; i < size_; ++i) {
        column.push_back(cln::recip(by + by) * (above[i] - below[i]));
      }
    }
    const std::size_t n = size_ / 2;
    SeriesMatrix result(size_, std::vector<PowerSeries>(size_));
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        PowerSeries sum{precise(j == i + n ? -1 : (i == j + n ? 1 : 0))};
        for (std::size_t k = 0; k < n; ++k) {
          sum = sum + product(columns[i][k], columns[j][n + k], length_) -
                product(columns[i][n + k], columns[j][k], length_);
        }
        result[i][j] = sum;
      }
    }
    return result;
  }

 private:
  // z moved by h J g, each component's series shifted by h.
  [[nodiscard]] std::vector<PowerSeries> after(const FormalPoint& point) const {
    const std::vector<PowerSeries> z = point.state();
    const auto gauge = point.gauge(member_, length_);
    auto moved = [&](const std::vector<PowerSeries>& gradient) {
      auto field = rotated(gradient);
      for (PowerSeries& f : field) f = product(point.step(), f, length_);
      return field;
    };
    auto change = moved(point.values(derivatives_.gradient(), z, length_));
    const Precise half = precise(Rational(1, 2));
    for (int sweep = 0; sweep < sweeps_; ++sweep) {
      std::vector<PowerSeries> bar;
      for (std::size_t i = 0; i < size_; ++i) bar.push_back(z[i] + half * change[i]);
      for (const auto& [place, entry] : gauge) {
        PowerSeries& target = bar[static_cast<std::size_t>(place.first)];
        target = target + product(entry, change[static_cast<std::size_t>(place.second)], length_);
      }
      change = moved(point.values(derivatives_.gradient(), bar, length_));
    }
    for (std::size_t i = 0; i < size_; ++i) change[i] = z[i] + change[i];
    return change;
  }

  const Derivatives& derivatives_;
  const Member& member_;
  int sweeps_;
  std::size_t size_, length_;
};

// The first points at which all of it is defined.
template <class Use>
void at_points(const Mechanics& mechanics, const Use& use) {
  int used = 0;
  for (int number = 0; used < kPointsOfSweeps && number < 50; ++number) {
    try {
      use(FormalPoint(mechanics, number));
      ++used;
    } catch (const std::domain_error&) {
      continue;
    }
  }
}

struct LeadingTerm {
  std::size_t power = 0;
  std::size_t row = 0, column = 0;
  double value = 0;
};

// The lowest power of h in which some entry is not zero.
std::optional<LeadingTerm> leading_term(const SeriesMatrix& defect, std::size_t length) {
  static const Precise zero = precise(*parse_decimal("1e-25"));
  for (std::size_t k = 0; k < length; ++k) {
    for (std::size_t i = 0; i < defect.size(); ++i) {
      for (std::size_t j = i + 1; j < defect.size(); ++j) {
        const Precise value = coefficient(defect[i][j], k);
        if (cln::abs(value) > zero) return LeadingTerm{k, i, j, to_double(value)};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

Finding prove_swept(const Mechanics& mechanics, const Member& member, int sweeps) {
  const std::string general = fmt::format(
      "{} sweeps leave the step unsolved: the defect M^T J M - J is O(h^{})", sweeps, sweeps + 2);
  if (sweeps > kMostSeriesSweeps || mechanics.variables.size() > kLargestSwept) {
    return {"symplectic", Verdict::refuted, general};
  }
  const Derivatives derivatives(mechanics);
  // With one number for h first: the sweeps may have solved the equations, as they do where zbar
  // does not depend on itself.
  std::optional<LeadingTerm> defect;
  const SweptStep step(mechanics, derivatives, member, sweeps, 1);
  at_points(mechanics, [&](FormalPoint point) {
    point.set_step({point.random()});
    if (!defect) defect = leading_term(step.defect(point), 1);
  });
  if (!defect) {
    return {"symplectic", Verdict::tested,
            fmt::format("{} sweeps solve these equations: M^T J M - J is below 1e-25 at {} random "
                        "points",
                        sweeps, kPointsOfSweeps)};
  }
  const auto length = static_cast<std::size_t>(sweeps) + 6;
  const SweptStep series(mechanics, derivatives, member, sweeps, length);
  std::optional<LeadingTerm> leading;
  at_points(mechanics, [&](const FormalPoint& point) {
    const auto found = leading_term(series.defect(point), length);
    if (found && (!leading || found->power < leading->power)) leading = found;
  });
  if (!leading) return {"symplectic", Verdict::refuted, general + " at most"};
  return {
      "symplectic", Verdict::refuted,
      fmt::format("{} sweeps leave the step unsolved: the defect M^T J M - J is O(h^{}), by its "
                  "power series; entry ({}, {}) begins with {:.4g} h^{} at a random point",
                  sweeps, leading->power, leading->row + 1, leading->column + 1, leading->value,
                  leading->power)};
}

}  // namespace hamgen
