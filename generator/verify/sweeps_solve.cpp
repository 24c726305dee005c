// Do K sweeps solve the equations of the step?
//
// A sweep is zbar <- T(zbar), T(x) = z + h (I/2 + C) J grad H(x), from the start zbar = z.  Where
// T^K(x) does not depend on x it is the solution whatever the start: T^K(z) = T^K(solution).
#include <algorithm>
#include <optional>

#include "generator/verify/swept.hpp"
#include "generator/verify/zero_by_algebra.hpp"

namespace hamgen {

namespace {

constexpr int kMostSubstituted = 4;        // degrees of freedom
constexpr int kMostSubstitutedSweeps = 8;  // a nilpotent T^m is constant for m <= 2n

class Substituted {
 public:
  Substituted(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member)
      : mechanics_(mechanics), derivatives_(derivatives), weights_(stage_matrix(member)) {}

  // By what depends on what: how many sweeps until every argument of the gradient is right; empty
  // if one depends on itself.
  [[nodiscard]] std::optional<int> sweeps_by_pattern() const {
    const int size = static_cast<int>(mechanics_.variables.size());
    std::vector<std::optional<int>> known(static_cast<std::size_t>(size));
    // z_i itself is right at once, a sum of what is right one sweep later.
    for (int pass = 0; pass <= size; ++pass) {
      for (int i = 0; i < size; ++i) known[static_cast<std::size_t>(i)] = sweeps_of(i, known);
    }
    int most = 0;
    for (int j = 0; j < size; ++j) {
      if (!is_argument(j)) continue;
      const std::optional<int>& of_j = known[static_cast<std::size_t>(j)];
      if (!of_j) return std::nullopt;
      most = std::max(most, *of_j);
    }
    return most;
  }

  // By algebra, where what depends on itself cancels: is the gradient at T^m(x) free of x?
  [[nodiscard]] bool is_constant_after(int sweeps) const {
    if (mechanics_.degrees_of_freedom > kMostSubstituted) return false;
    std::vector<Expression> one = started("x#");
    std::vector<Expression> other = started("y#");
    const int last = std::min({sweeps, kMostSubstitutedSweeps, 2 * mechanics_.degrees_of_freedom});
    for (int m = 0; m < last; ++m) {
      one = swept(one);
      other = swept(other);
    }
    const std::vector<Expression> a = gradient_at(one);
    const std::vector<Expression> b = gradient_at(other);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!is_zero_by_algebra(a[i] - b[i])) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] bool depends(int k, int j) const {
    return depends_on(derivatives_.first(k), mechanics_.variable(j).name());
  }
  [[nodiscard]] bool is_argument(int j) const {
    for (int k = 0; k < static_cast<int>(mechanics_.variables.size()); ++k) {
      if (depends(k, j)) return true;
    }
    return false;
  }
  [[nodiscard]] std::optional<int> sweeps_of(int i,
                                             const std::vector<std::optional<int>>& known) const {
    int most = 0;
    for (const auto& [place, weight] : weights_) {
      if (place.first != i || derivatives_.first(place.second).is_zero()) continue;
      most = std::max(most, 1);
      for (int j = 0; j < static_cast<int>(known.size()); ++j) {
        if (!depends(place.second, j)) continue;
        const std::optional<int>& of_j = known[static_cast<std::size_t>(j)];
        if (!of_j) return std::nullopt;
        most = std::max(most, 1 + *of_j);
      }
    }
    return most;
  }

  [[nodiscard]] std::vector<Expression> started(const std::string& prefix) const {
    std::vector<Expression> result;
    for (const Quantity& variable : mechanics_.variables)
      result.push_back(Expression::symbol(prefix + variable.name));
    return result;
  }
  [[nodiscard]] std::vector<Expression> gradient_at(const std::vector<Expression>& x) const {
    Substitution at;
    for (std::size_t i = 0; i < x.size(); ++i) at.emplace(mechanics_.variables.name(i), x[i]);
    return substitute(derivatives_.gradient(), at);
  }
  [[nodiscard]] std::vector<Expression> swept(const std::vector<Expression>& x) const {
    const std::vector<Expression> gradient = gradient_at(x);
    std::vector<Expression> result;
    for (int i = 0; i < static_cast<int>(x.size()); ++i) result.push_back(mechanics_.variable(i));
    const Expression h = Expression::symbol("h", kRankOfStep);
    for (const auto& [place, weight] : weights_) {
      result[static_cast<std::size_t>(place.first)] +=
          h * weight * gradient[static_cast<std::size_t>(place.second)];
    }
    return result;
  }

  const Mechanics& mechanics_;
  const Derivatives& derivatives_;
  SparseMatrix weights_;
};

}  // namespace

bool sweeps_solve(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
                  int sweeps) {
  const Substituted step(mechanics, derivatives, member);
  const std::optional<int> needed = step.sweeps_by_pattern();
  return (needed && *needed <= sweeps) || step.is_constant_after(sweeps);
}

}  // namespace hamgen
