// How far a fixed number of sweeps is from a symplectic map, and from one that is its own adjoint.
//
// Z after K sweeps is an explicit formula in z and h, so its Jacobian M has a power series in h:
// the first term of M^T J M - J that does not vanish is the order of the defect for this H and this
// member.  In general it is K + 2: each sweep multiplies the error of the gradient by
// h H'' (1/2 + C) J, from O(h) of the predictor on, and h J times it is the error of Z.
#include "generator/verify/swept.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "generator/verify/formal.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

constexpr int kPointsOfSweeps = 3;
constexpr int kMostSeriesSweeps = 8;  // beyond, one number for h is taken
constexpr std::size_t kLargestSwept = 20;

// A series, and that of the sizes of the terms it was added up from.
struct ScaledSeries {
  PowerSeries value, scale;
};

PowerSeries sizes(const PowerSeries& a) {
  PowerSeries result;
  for (const Precise& x : a) result.push_back(cln::abs(x));
  return result;
}

struct LeadingTerm {
  std::size_t power = 0;
  std::string entry;
  double value = 0;
};

// The lowest power of h at which the series is not zero: differences with 1e-20 leave 40 digits.
std::optional<LeadingTerm> leading_term(const ScaledSeries& defect, const std::string& entry) {
  static const Precise zero = precise(*parse_decimal("1e-25"));
  for (std::size_t k = 0; k < defect.value.size(); ++k) {
    const Precise value = coefficient(defect.value, k);
    if (cln::abs(value) > zero * coefficient(defect.scale, k))
      return LeadingTerm{k, entry, to_double(value)};
  }
  return std::nullopt;
}

void keep_lower(const std::optional<LeadingTerm>& found, std::optional<LeadingTerm>& lowest) {
  if (found && (!lowest || found->power < lowest->power)) lowest = found;
}

class SweptStep {
 public:
  SweptStep(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
            int sweeps, const std::vector<Expression>& substeps, std::size_t length)
      : derivatives_(derivatives),
        member_(member),
        sweeps_(sweeps),
        size_(mechanics.variables.size()),
        length_(length) {
    for (const Expression& part : substeps) substeps_.push_back(value_of_exact(part));
  }

  // Of M^T J M - J, by central differences, whose error is 1e-40.  Of a large system only some
  // columns.
  [[nodiscard]] std::optional<LeadingTerm> symplectic_defect(const FormalPoint& point) const {
    const std::size_t n = size_ / 2;
    std::vector<std::size_t> places;
    for (std::size_t j = 0; j < size_; ++j) {
      if (size_ <= kLargestSwept || j % n < 2) places.push_back(j);
    }
    std::map<std::size_t, std::vector<PowerSeries>> columns;
    for (const std::size_t j : places) columns[j] = column(point, j);
    std::optional<LeadingTerm> lowest;
    for (const std::size_t i : places) {
      for (const std::size_t j : places) {
        if (j <= i) continue;
        ScaledSeries sum{{precise(j == i + n ? -1 : 0)}, {precise(j == i + n ? 1 : 0)}};
        for (std::size_t k = 0; k < n; ++k) {
          add(sum, columns[i][k], columns[j][n + k], 1);
          add(sum, columns[i][n + k], columns[j][k], -1);
        }
        keep_lower(leading_term(sum, fmt::format("entry ({}, {})", i + 1, j + 1)), lowest);
      }
    }
    return lowest;
  }

  // Of a step back from the end of a step, against its start.
  [[nodiscard]] std::optional<LeadingTerm> reversal_defect(const FormalPoint& point) const {
    const std::vector<PowerSeries> start = point.state();
    const std::vector<PowerSeries> end = after(point, start);
    FormalPoint mirrored = point;
    mirrored.set_step(-point.step());
    const std::vector<PowerSeries> back = after(mirrored, end);
    // No component is more exact than the largest terms of the step.
    PowerSeries scale(length_, precise(0));
    for (std::size_t i = 0; i < size_; ++i) {
      const PowerSeries size = sizes(end[i]);
      for (std::size_t k = 0; k < length_; ++k)
        scale[k] = std::max({scale[k], coefficient(size, k), cln::abs(coefficient(back[i], k))});
    }
    std::optional<LeadingTerm> lowest;
    for (std::size_t i = 0; i < size_; ++i) {
      keep_lower(leading_term({back[i] - start[i], scale}, fmt::format("component {}", i + 1)),
                 lowest);
    }
    return lowest;
  }

 private:
  void add(ScaledSeries& sum, const PowerSeries& a, const PowerSeries& b, int sign) const {
    sum.value = sum.value + precise(sign) * product(a, b, length_);
    sum.scale = sum.scale + product(sizes(a), sizes(b), length_);
  }

  [[nodiscard]] std::vector<PowerSeries> column(const FormalPoint& point, std::size_t j) const {
    const Precise by = point.spacing(j);
    FormalPoint up = point;
    FormalPoint down = point;
    up.move(j, by);
    down.move(j, -by);
    const auto above = after(up, up.state());
    const auto below = after(down, down.state());
    std::vector<PowerSeries> result;
    for (std::size_t i = 0; i < size_; ++i)
      result.push_back(cln::recip(by + by) * (above[i] - below[i]));
    return result;
  }

  [[nodiscard]] std::vector<PowerSeries> after(FormalPoint point,
                                               std::vector<PowerSeries> z) const {
    const PowerSeries h = point.step();
    for (const Precise& part : substeps_) {
      point.set_step(part * h);
      z = after_substep(point, z);
    }
    return z;
  }

  // z moved by h J g, each component's series shifted by h.
  [[nodiscard]] std::vector<PowerSeries> after_substep(const FormalPoint& point,
                                                       const std::vector<PowerSeries>& z) const {
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
  std::vector<Precise> substeps_;  // 1, or those of a composition
  std::size_t size_, length_;
};

// The first points at which all of it is defined.
template <class Use>
void at_points(const Mechanics& mechanics, const Surroundings& around, const Use& use) {
  int used = 0;
  for (int number = 0; used < kPointsOfSweeps && number < 50; ++number) {
    try {
      use(FormalPoint(mechanics, around, number));
      ++used;
    } catch (const std::domain_error&) {
      continue;
    }
  }
}

Proof prove_unsolved(const Mechanics& mechanics, const Derivatives& derivatives,
                     const Member& member, int sweeps, const std::vector<Expression>& substeps,
                     const Surroundings& around) {
  const std::string general =
      fmt::format("{} sweeps leave the step unsolved: the defect `M^T J M - J` is `O(h^{})`",
                  sweeps, sweeps + 2);
  const bool by_series = sweeps <= kMostSeriesSweeps;
  const auto length = by_series ? static_cast<std::size_t>(sweeps) + 6 : 1;
  const SweptStep step(mechanics, derivatives, member, sweeps, substeps, length);
  std::optional<LeadingTerm> defect;
  std::optional<LeadingTerm> reversal;
  at_points(mechanics, around, [&](FormalPoint point) {
    if (!by_series) point.set_step({point.random()});
    const auto of_matrix = step.symplectic_defect(point);
    const auto of_way_back = step.reversal_defect(point);
    keep_lower(of_matrix, defect);
    keep_lower(of_way_back, reversal);
  });
  Finding symplectic{"symplectic", Verdict::refuted, general};
  Finding symmetric{"symmetric", Verdict::refuted, "the predictor is explicit Euler"};
  if (!defect) {
    symplectic = {"symplectic", Verdict::not_decided,
                  general + " in general, and nothing of it was found at the points looked at"};
  } else if (by_series) {
    symplectic.detail = fmt::format(
        "{} sweeps leave the step unsolved: the defect `M^T J M - J` is `O(h^{})`, by its power "
        "series; {} begins with `{:.4g} h^{}` at a random point",
        sweeps, defect->power, defect->entry, defect->value, defect->power);
  } else {
    symplectic.detail +=
        fmt::format(" in general; {} is {:.4g} at a random point", defect->entry, defect->value);
  }
  if (!reversal) {
    symmetric = {"symmetric", Verdict::not_decided,
                 "the step is unsolved, and yet no step back was found that misses the start"};
  } else if (by_series) {
    symmetric.detail += fmt::format("; a step back misses the start, {} by `{:.4g} h^{}`",
                                    reversal->entry, reversal->value, reversal->power);
  }
  return {symplectic, symmetric};
}

}  // namespace

Proof prove_swept(const Mechanics& mechanics, const Member& member, int sweeps,
                  const Surroundings& around, const std::vector<Expression>& substeps) {
  if (mechanics.keeps_sums()) {
    const std::string why = fmt::format(
        "{} sweeps leave the step unsolved, and the defect, `O(h^{})` in general, is not looked at "
        "where sums stay loops",
        sweeps, sweeps + 2);
    return {{"symplectic", Verdict::not_decided, why}, {"symmetric", Verdict::not_decided, why}};
  }
  const Derivatives derivatives(mechanics);
  if (!sweeps_solve(mechanics, derivatives, member, sweeps))
    return prove_unsolved(mechanics, derivatives, member, sweeps, substeps, around);
  Proof proof{prove_step_symplectic(member, mechanics.degrees_of_freedom, around),
              prove_symmetric(member, around)};
  for (Finding& finding : proof) {
    finding.detail = fmt::format(
        "{} sweep{} solve{} these equations: zbar does not depend on "
        "itself; {}",
        sweeps, sweeps == 1 ? "" : "s", sweeps == 1 ? "s" : "", finding.detail);
  }
  return proof;
}

}  // namespace hamgen
