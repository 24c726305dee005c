#include "generator/verify/linear_enclosed_steps.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "generator/verify/interval.hpp"

namespace hamgen {

namespace {

constexpr int kMostProducts = 1000000;  // of intervals
constexpr double kShortest = 1e-6;      // of h
constexpr double kLongestOpen = 1e-2;   // of h: what stays open for longer ends the search
constexpr double kFirstAngle = 0.01;
constexpr double kLastAngle = 100.0;

using IntervalMatrix = std::vector<std::vector<Interval>>;

IntervalMatrix interval_identity(std::size_t size) {
  IntervalMatrix result(size, std::vector<Interval>(size));
  for (std::size_t i = 0; i < size; ++i) result[i][i] = 1.0;
  return result;
}

IntervalMatrix combined(const IntervalMatrix& a, const IntervalMatrix& b, int sign) {
  IntervalMatrix result = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j)
      result[i][j] = sign > 0 ? a[i][j] + b[i][j] : a[i][j] - b[i][j];
  }
  return result;
}

IntervalMatrix times(const IntervalMatrix& a, const IntervalMatrix& b) {
  IntervalMatrix result(a.size(), std::vector<Interval>(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      for (std::size_t k = 0; k < a.size(); ++k) result[i][j] = result[i][j] + a[i][k] * b[k][j];
    }
  }
  return result;
}

// a^-1 b by elimination, both multiplied by the inverse of the middle of a first; empty where a
// pivot may be 0.
std::optional<IntervalMatrix> interval_solved(IntervalMatrix a, IntervalMatrix b) {
  const std::size_t n = a.size();
  const auto rows = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd middle(rows, rows);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      middle(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          0.5 * (a[i][j].low + a[i][j].high);
  }
  const Eigen::MatrixXd inverse = middle.inverse();
  if (!inverse.allFinite()) return std::nullopt;
  IntervalMatrix condition(n, std::vector<Interval>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      condition[i][j] = inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  a = times(condition, a);
  b = times(condition, b);
  for (std::size_t k = 0; k < n; ++k) {
    if (a[k][k].holds(0.0)) return std::nullopt;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Interval factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] = a[i][j] - factor * a[k][j];
      for (std::size_t j = 0; j < n; ++j) b[i][j] = b[i][j] - factor * b[k][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) b[i][j] = b[i][j] / a[i][i];
  }
  return b;
}

std::vector<Expression> entries_of(const Member& member) {
  std::vector<Expression> entries;
  for (const auto& [place, entry] : member.c) entries.push_back(entry);
  return entries;
}

enum class Cell { bounded, unbounded, open };

class EnclosedStep {
 public:
  EnclosedStep(const Scheme& scheme, const std::map<std::string, Rational>& values,
               const ExactMatrix& s, int free_motions)
      : entries_(entries_of(scheme.member())), free_motions_(free_motions) {
    for (const auto& [place, entry] : scheme.member().c)
      places_.emplace_back(static_cast<std::size_t>(place.first),
                           static_cast<std::size_t>(place.second));
    for (const auto& [name, value] : values) symbols_[name] = enclosing(value);
    if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
      for (const Expression& e : composition->substeps)
        substeps_.push_back(enclosing(numeric_value(e)));
    } else {
      substeps_.emplace_back(1.0);
    }
    const ExactMatrix a = linear_flow(s);
    flow_ = interval_identity(s.size);
    for (std::size_t i = 0; i < s.size; ++i) {
      for (std::size_t j = 0; j < s.size; ++j) flow_[i][j] = enclosing(a(i, j));
    }
  }

  [[nodiscard]] Cell at(const Interval& h) const {
    // M - I of the product: (I + b)(I + a) - I.
    IntervalMatrix change(flow_.size(), std::vector<Interval>(flow_.size()));
    for (const Interval& part : substeps_) {
      const auto one = change_of(part * h);
      if (!one) return Cell::open;
      change = combined(combined(change, *one, 1), times(*one, change), 1);
    }
    return decided(in_t(change));
  }

 private:
  // M - I = (I - X (I/2 + C))^-1 X: near h = 0 its entries are small, and so are their errors.
  [[nodiscard]] std::optional<IntervalMatrix> change_of(const Interval& h) const {
    std::map<std::string, Interval> symbols = symbols_;
    symbols["h"] = h;
    const std::size_t size = flow_.size();
    IntervalMatrix weight = interval_identity(size);
    for (std::size_t i = 0; i < size; ++i) weight[i][i] = 0.5;
    const auto values = entries_.at(symbols);
    if (!values) return std::nullopt;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      Interval& target = weight[places_[k].first][places_[k].second];
      target = target + (*values)[k];
    }
    IntervalMatrix x = flow_;
    for (auto& row : x) {
      for (Interval& entry : row) entry = h * entry;
    }
    return interval_solved(combined(interval_identity(size), times(x, weight), -1), x);
  }

  // The coefficients of q in t = s - 2 = y^2/(1 + y), y = x - 1, without the roots t = 0 of free
  // motions.  With N = M - I
  //   det(y - N) = sum_k a_k y^(2k) (1 + y)^(n-k),
  // so that a_k = e_(2n-2k)(N) - sum_(j<k) binomial(n-j, 2k-2j) a_j, where the e_k follow from the
  // traces of the powers of N by Newton's identities.
  [[nodiscard]] std::vector<Interval> in_t(const IntervalMatrix& change) const {
    const std::size_t n = change.size() / 2;
    std::vector<Interval> e{1.0};
    std::vector<Interval> traces;
    IntervalMatrix power = change;
    for (std::size_t k = 1; k <= 2 * n; ++k) {
      if (k > 1) power = times(power, change);
      Interval trace;
      for (std::size_t i = 0; i < change.size(); ++i) trace = trace + power[i][i];
      traces.push_back(trace);
      Interval sum;
      for (std::size_t j = 1; j <= k; ++j) {
        const Interval term = e[k - j] * traces[j - 1];
        sum = j % 2 == 1 ? sum + term : sum - term;
      }
      e.push_back(sum / Interval(static_cast<double>(k)));
    }
    const auto binomial = [](std::size_t over, std::size_t under) {
      double value = 1.0;
      for (std::size_t k = 0; k < under; ++k)
        value = k < over ? value * static_cast<double>(over - k) / static_cast<double>(k + 1) : 0.0;
      return value;
    };
    std::vector<Interval> q;
    for (std::size_t k = 0; k < n; ++k) {
      Interval a = e[2 * (n - k)];
      for (std::size_t j = 0; j < k; ++j) a = a - Interval(binomial(n - j, 2 * (k - j))) * q[j];
      q.push_back(a);
    }
    q.emplace_back(1.0);
    q.erase(q.begin(), q.begin() + free_motions_);
    return q;
  }

  // All roots are real and different if the discriminant is positive, for three if there are not
  // two complex ones; and between -4 and 0 if no derivative changes its sign beyond (Budan).
  [[nodiscard]] static Cell decided(std::vector<Interval> q) {
    const std::size_t n = q.size() - 1;
    const Interval discriminant = n == 1   ? Interval(1.0)
                                  : n == 2 ? power(q[1], 2) - Interval(4.0) * q[0]
                                           : of_cubic(q);
    if (discriminant.is_below(0.0)) return Cell::unbounded;
    bool inside = discriminant.is_above(0.0);
    for (std::size_t derivative = 0; derivative < n; ++derivative) {
      for (const double end : {0.0, -4.0}) {
        Interval value;
        for (std::size_t k = q.size(); k-- > 0;) value = value * Interval(end) + q[k];
        const bool odd = (q.size() - 1) % 2 != 0;
        if (end < 0.0 && odd) value = Interval(0.0) - value;
        inside = inside && value.is_above(0.0);
        // An odd number of roots beyond the end.
        if (derivative == 0 && value.is_below(0.0)) return Cell::unbounded;
      }
      std::vector<Interval> slope;
      for (std::size_t k = 1; k < q.size(); ++k)
        slope.push_back(Interval(static_cast<double>(k)) * q[k]);
      q = std::move(slope);
    }
    return inside ? Cell::bounded : Cell::open;
  }

  [[nodiscard]] static Interval of_cubic(const std::vector<Interval>& q) {
    const Interval& d = q[0];
    const Interval& c = q[1];
    const Interval& b = q[2];
    return power(b, 2) * power(c, 2) - Interval(4.0) * power(c, 3) -
           Interval(4.0) * power(b, 3) * d - Interval(27.0) * power(d, 2) +
           Interval(18.0) * b * c * d;
  }

  Enclosures entries_;  // of C
  std::vector<std::pair<std::size_t, std::size_t>> places_;
  int free_motions_;
  std::map<std::string, Interval> symbols_;
  std::vector<Interval> substeps_;
  IntervalMatrix flow_;
};

}  // namespace

std::optional<StableSteps> enclosed_steps(const Scheme& scheme,
                                          const std::map<std::string, Rational>& values,
                                          const ExactMatrix& s, int free_motions, double w) {
  if (!scheme.has_member() || scheme.member().generating_order > 0) return std::nullopt;
  const EnclosedStep step(scheme, values, s, free_motions);
  StableSteps steps{.looked_to = kLastAngle / w, .exact = false};
  steps.intervals.emplace_back(0.0, kFirstAngle / w);
  double here = kFirstAngle / w;
  double width = here / 16;
  bool before = true;  // the last cell that was decided
  double open_from = here;
  const double last = steps.looked_to;
  const auto size = static_cast<int>(s.size);
  const int most_cells = kMostProducts / (size * size * size);
  for (int cells = 0; here < last; ++cells) {
    if (cells > most_cells || here - open_from > kLongestOpen * here) {
      steps.looked_to = open_from;
      break;
    }
    const double next = here + width;
    const Cell cell = step.at({here, next});
    if (cell == Cell::open && width > kShortest * here) {
      width /= 2;
      continue;
    }
    if (cell != Cell::open) {
      const bool bounded = cell == Cell::bounded;
      const bool is_point = here - open_from <= 4.0 * kShortest * here;
      const double border = 0.5 * (open_from + here);
      if (bounded && before && open_from < here && is_point) steps.borders.push_back(border);
      // What stays open over a length is not called bounded.
      if (bounded && (!before || !is_point))
        steps.intervals.emplace_back(is_point ? border : here, next);
      if (!bounded && before) steps.intervals.back().second = is_point ? border : open_from;
      // Nothing is known of smaller h where the first that is looked at is unbounded.
      if (!bounded && here == kFirstAngle / w) return std::nullopt;
      if (bounded) steps.intervals.back().second = next;
      before = bounded;
      open_from = next;
    }
    here = next;
    width *= 2;
  }
  if (before) steps.intervals.back().second = steps.looked_to;
  return steps.looked_to > 2.0 * kFirstAngle / w ? std::optional(steps) : std::nullopt;
}

}  // namespace hamgen
