#include "generator/interpreter/numerics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>

#include "generator/base/diagnostic.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

namespace {

using Quad = numerics_of_quad::Real;

template <class Verdict>
Answer answer(Verdict verdict) {
  switch (verdict) {
    case Verdict::go_on:
      return Answer::go_on;
    case Verdict::done:
      return Answer::done;
    case Verdict::failed:
      break;
  }
  return Answer::failed;
}

template <class Real, int Size>
struct Padded {
  explicit Padded(std::span<const Real> values) { std::copy(values.begin(), values.end(), padded); }
  Real padded[Size] = {};
};

template <class Real, int Size>
class HistoryOf final : public AnyHistory<Real> {
 public:
  [[nodiscard]] bool known() const override { return history_.known > 0; }
  void record(std::span<const Real> solution) override {
    history_.record(Padded<Real, Size>(solution).padded);
  }
  void extrapolate(std::span<Real> solution) const override {
    Padded<Real, Size> all(solution);
    history_.extrapolate(all.padded);
    std::copy_n(all.padded, solution.size(), solution.begin());
  }
  void extrapolate_twice(std::span<Real> solution) const override {
    Padded<Real, Size> all(solution);
    NumericsOf<Real>::look_twice(history_, all.padded);
    std::copy_n(all.padded, solution.size(), solution.begin());
  }
  [[nodiscard]] Real error(int degree, std::span<const Real> solution, int first,
                           int count) const override {
    return history_.error(degree, Padded<Real, Size>(solution).padded, first, count);
  }
  [[nodiscard]] Real difference(int degree, std::span<const Real> solution, int i) const override {
    return history_.difference(degree, solution, i);
  }
  [[nodiscard]] Real way(std::span<const Real> solution, int i) const override {
    return history_.way(solution, i);
  }

 private:
  typename NumericsOf<Real>::template Past<Size> history_;
};

// Of a single unknown where Size is 0.
template <class Real, int Power, int Size, bool Compares = false>
class NewtonRuleOf final : public AnyNewtonRule<Real> {
 public:
  using Sums = typename AnyNewtonRule<Real>::Sums;
  explicit NewtonRuleOf(bool waits) : waits_(waits) {}
  void begin(bool predicted) override {
    rule_.begin(predicted);
    used_ = true;
  }
  void watch(const AnyHistory<Real>& past, std::span<const Real> solution, int first,
             int count) override {
    if (used_ || !waits_) {
      rule_.watch(past, solution, first, count);
    } else {
      rule_.motion = {};
    }
    used_ = false;
  }
  void compare(const AnyMatrix<Real>& matrix, int count) override {
    if constexpr (Compares) rule_.compare(matrix, count);
  }
  Answer of_sums(std::span<const Real> values, std::span<const Real> increments, const Sums& sums,
                 int iteration) override {
    if constexpr (Size > 0) {
      return answer(rule_.of_sums(values.data(), increments.data(), sums.size, sums.uneven,
                                  sums.moved, sums.scale, static_cast<int>(increments.size()),
                                  iteration));
    } else {
      return answer(rule_(sums.moved, sums.scale, iteration));
    }
  }
  void know(std::span<const Real> value, std::span<const Real> moved) override {
    if constexpr (Size > 0) rule_.know(value.data(), moved.data(), static_cast<int>(value.size()));
  }
  [[nodiscard]] Real unit(std::size_t unknown) const override {
    if constexpr (Size > 0) return rule_.unit[unknown];
    return 1;
  }
  [[nodiscard]] Real relative(int unknown, Real moved, Real length, Real way) const override {
    if constexpr (Size > 0) return rule_.relative(unknown, moved, length, way);
    return 0;
  }
  Answer of_each(std::span<const Real> moved, std::span<const Real> length,
                 std::span<const Real> way, int iteration) override {
    if constexpr (Size > 0) {
      const auto count = static_cast<int>(moved.size());
      return answer(rule_.of_each(moved.data(), length.data(), way.data(), count, iteration));
    } else {
      return answer(rule_(moved[0], length[0], iteration));
    }
  }
  [[nodiscard]] Real last() const override { return rule_.previous; }

 private:
  using One = typename NumericsOf<Real>::template Newton<Power>;
  static constexpr int most = Size > 0 ? Size : 1;
  using Many = typename NumericsOf<Real>::template NewtonOfMany<Power, most>;
  using Comparing = typename NumericsOf<Real>::template NewtonWithMatrix<Compares ? most : 1>;
  std::conditional_t<Compares, Comparing, std::conditional_t<(Size > 0), Many, One>> rule_;
  bool waits_;  // as WaitingNewtonRule
  bool used_ = false;
};

template <class Real>
class LinearRuleOf final : public AnyNewtonRule<Real> {
 public:
  using Sums = typename AnyNewtonRule<Real>::Sums;
  void begin(bool /*predicted*/) override { rule_.begin(); }
  void watch(const AnyHistory<Real>& /*past*/, std::span<const Real> /*solution*/, int /*first*/,
             int /*count*/) override {}
  Answer of_sums(std::span<const Real> /*values*/, std::span<const Real> /*increments*/,
                 const Sums& sums, int iteration) override {
    return answer(rule_(sums.moved, sums.scale, iteration, sums.uneven));
  }
  [[nodiscard]] Real relative(int /*unknown*/, Real moved, Real length,
                              Real /*way*/) const override {
    return rule_.relative(moved, length);
  }

 private:
  typename NumericsOf<Real>::Linear rule_;
};

template <class Real, class Rule>
class FixedPointRuleOf final : public AnyFixedPointRule<Real> {
  template <int Cycle>
  using Contraction = typename NumericsOf<Real>::template Contraction<Cycle>;
  static constexpr bool kContracts =
      std::is_same_v<Rule, Contraction<1>> || std::is_same_v<Rule, Contraction<2>>;

 public:
  void begin(int work) override {
    if constexpr (kContracts) {
      rule_.begin(work);
    } else {
      rule_.begin();
    }
  }
  Answer operator()(const typename NumericsOf<Real>::Moved& moved, int iteration) override {
    return answer(rule_(moved, iteration));
  }
  [[nodiscard]] Real size() const override { return rule_.size; }
  [[nodiscard]] std::variant<std::monostate, Contraction<1>*, Contraction<2>*> contraction()
      override {
    if constexpr (kContracts) return &rule_;
    return {};
  }

 private:
  Rule rule_;
};

template <class Real>
class SimplifiedNewtonRuleOf final : public AnySimplifiedNewtonRule<Real> {
 public:
  void begin(bool factorised) override { rule_.begin(factorised); }
  Answer operator()(const typename NumericsOf<Real>::Moved& moved, Real residual, bool& factorised,
                    int iteration) override {
    return answer(rule_(moved, residual, factorised, iteration));
  }
  [[nodiscard]] Real size() const override { return rule_.size; }

 private:
  typename NumericsOf<Real>::Simplified rule_;
};

template <class Real, int Size, bool TwoForms>
class RefinementOf final : public AnyRefinement<Real> {
 public:
  bool operator()(std::span<Real> point, std::span<const Real> lack,
                  std::span<const Real> slope) override {
    Padded<Real, Size> all(point);
    const bool more = refinement_(all.padded, Padded<Real, Size>(lack).padded,
                                  Padded<Real, 2 * Size>(slope).padded);
    std::copy_n(all.padded, point.size(), point.begin());
    return more;
  }
  bool refine(AnyFixedPointRule<Real>& rule, std::span<Real> point, std::span<const Real> lack,
              std::span<const Real> slope) override {
    Padded<Real, Size> all(point);
    const Padded<Real, Size> missing(lack);
    const Padded<Real, 2 * Size> gradient(slope);
    const bool more = rule.ask([&](auto& contraction) {
      return refinement_(contraction, all.padded, missing.padded, gradient.padded);
    });
    std::copy_n(all.padded, point.size(), point.begin());
    return more;
  }
  void foresee(AnyFixedPointRule<Real>& rule, std::span<const Real> point,
               std::span<const Real> increment, std::span<const Real> from) override {
    (void)rule.ask([&](auto& contraction) {
      refinement_.foresee(contraction, Padded<Real, Size>(point).padded,
                          Padded<Real, Size>(increment).padded, Padded<Real, Size>(from).padded);
      return true;
    });
  }
  void round_beside(Real length) override { refinement_.beside = length; }
  [[nodiscard]] bool is_first() const override { return refinement_.rounds == 0; }
  [[nodiscard]] bool found() const override { return refinement_.found; }
  [[nodiscard]] Real last() const override { return refinement_.last; }
  void get_change(std::span<Real> change) const override {
    std::copy_n(refinement_.change, change.size(), change.begin());
  }
  void get_slope(std::span<Real> slope) const override {
    std::copy_n(refinement_.slope, slope.size(), slope.begin());
  }

 private:
  typename NumericsOf<Real>::template Refined<Size, TwoForms> refinement_;
};

template <class Real, int Size, class Matrix>
class MatrixOf final : public AnyMatrix<Real> {
 public:
  explicit MatrixOf(std::vector<int> place) : place_(std::move(place)) {
    for (int i = 0; i < Size; ++i) {
      if (std::ranges::find(place_, i) == place_.end()) unused_.push_back(i);
    }
    clear();
  }
  void clear() override {
    matrix_.clear();
    for (const int i : unused_) matrix_.put(i, i, 1);
  }
  void put(int row, int column, Real value) override {
    matrix_.put(place_[index(row)], place_[index(column)], value);
  }
  [[nodiscard]] Real at(int row, int column) const override {
    if constexpr (requires { matrix_.at(row, column); }) {
      return matrix_.at(place_[index(row)], place_[index(column)]);
    } else {
      internal_error("a band is not looked at");
    }
  }
  [[nodiscard]] bool factorise() override { return matrix_.factorise(); }
  void solve(std::span<Real> vector) const override {
    Padded<Real, Size> all({});
    for (std::size_t i = 0; i < vector.size(); ++i) all.padded[place_[i]] = vector[i];
    matrix_.solve(all.padded);
    for (std::size_t i = 0; i < vector.size(); ++i) vector[i] = all.padded[place_[i]];
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  std::vector<int> place_;
  std::vector<int> unused_;
  Matrix matrix_;
};

// make(std::integral_constant<int, N>) for the first of these sizes that is not below the one asked
// for.
template <int N, int... More, class Make>
auto at_least(int size, const Make& make) {
  if (size <= N) return make(std::integral_constant<int, N>());
  if constexpr (sizeof...(More) > 0) {
    return at_least<More...>(size, make);
  } else {
    throw UsageError(
        fmt::format("the interpreter has no block of size {}, {} at most\n"
                    "help: leave out --interpret, or make the system smaller",
                    size, N));
  }
}
// What takes time for each number that it has room for, in the order of those that sum up.
template <class Make>
auto at_least_up_to_256(int size, const Make& make) {
  return at_least<2, 8, 32, 64, 256>(size, make);
}

}  // namespace

template <class Real>
std::unique_ptr<AnyHistory<Real>> Blocks<Real>::history(int size) {
  return at_least<4, 32, 64, 512, 4096>(size, [](auto n) -> std::unique_ptr<AnyHistory<Real>> {
    return std::make_unique<HistoryOf<Real, decltype(n)::value>>();
  });
}

template <class Real>
std::unique_ptr<AnyNewtonRule<Real>> Blocks<Real>::newton_rule(int power, int unknowns,
                                                               bool waits) {
  using Made = std::unique_ptr<AnyNewtonRule<Real>>;
  if (unknowns == 0 && power == 1) return std::make_unique<NewtonRuleOf<Real, 1, 0>>(waits);
  if (unknowns == 0) return std::make_unique<NewtonRuleOf<Real, 2, 0>>(waits);
  return at_least<16, 256, 4096>(unknowns, [&](auto n) -> Made {
    constexpr int most = decltype(n)::value;
    if (power == 1) return std::make_unique<NewtonRuleOf<Real, 1, most>>(waits);
    return std::make_unique<NewtonRuleOf<Real, 2, most>>(waits);
  });
}

template <class Real>
std::unique_ptr<AnyNewtonRule<Real>> Blocks<Real>::newton_rule_with_matrix(int unknowns) {
  return at_least<8, 32>(unknowns, [](auto n) -> std::unique_ptr<AnyNewtonRule<Real>> {
    return std::make_unique<NewtonRuleOf<Real, 2, decltype(n)::value, true>>(false);
  });
}

template <class Real>
std::unique_ptr<AnyNewtonRule<Real>> Blocks<Real>::linear_rule() {
  return std::make_unique<LinearRuleOf<Real>>();
}

template <class Real>
std::unique_ptr<AnySimplifiedNewtonRule<Real>> Blocks<Real>::simplified_newton_rule() {
  return std::make_unique<SimplifiedNewtonRuleOf<Real>>();
}

template <class Real>
std::unique_ptr<AnyFixedPointRule<Real>> Blocks<Real>::fixed_point_rule(std::string_view type) {
  std::unique_ptr<AnyFixedPointRule<Real>> found;
  NumericsOf<Real>::for_fixed_point_rules([&](std::string_view name, auto rule) {
    if (name == type) found = std::make_unique<FixedPointRuleOf<Real, decltype(rule)>>();
  });
  return found;
}

template <class Real>
std::unique_ptr<AnyRefinement<Real>> Blocks<Real>::refinement(int unknowns, int components,
                                                              bool two_forms) {
  const int size = std::max(unknowns, (components + 1) / 2);
  if (two_forms) {
    return at_least<32, 1024>(size, [](auto n) -> std::unique_ptr<AnyRefinement<Real>> {
      return std::make_unique<RefinementOf<Real, decltype(n)::value, true>>();
    });
  }
  return at_least<2, 8, 32, 128, 1024>(size, [](auto n) -> std::unique_ptr<AnyRefinement<Real>> {
    return std::make_unique<RefinementOf<Real, decltype(n)::value, false>>();
  });
}

template <class Real>
std::unique_ptr<AnyMatrix<Real>> Blocks<Real>::matrix(int size, bool symmetric) {
  std::vector<int> place(static_cast<std::size_t>(size));
  std::iota(place.begin(), place.end(), 0);
  if (!symmetric) return matrix(std::move(place));
  return at_least_up_to_256(size, [&](auto n) -> std::unique_ptr<AnyMatrix<Real>> {
    constexpr int most = decltype(n)::value;
    using Matrix = typename NumericsOf<Real>::template Symmetric<most>;
    return std::make_unique<MatrixOf<Real, most, Matrix>>(std::move(place));
  });
}

template <class Real>
std::unique_ptr<AnyMatrix<Real>> Blocks<Real>::matrix(std::vector<int> place, bool symmetric,
                                                      int border) {
  const int inside = static_cast<int>(place.size()) - border;
  return at_least_up_to_256(inside, [&](auto n) -> std::unique_ptr<AnyMatrix<Real>> {
    constexpr int most = decltype(n)::value;
    using Symmetric = typename NumericsOf<Real>::template SymmetricBand<most>;
    using Dense = typename NumericsOf<Real>::template Dense<most>;
    const auto of = [&](auto matrix) -> std::unique_ptr<AnyMatrix<Real>> {
      using Band = typename decltype(matrix)::type;
      if (border == 0) return std::make_unique<MatrixOf<Real, most, Band>>(std::move(place));
      for (int& row : place) row += row < inside ? 0 : most - inside;
      using Bordered = typename NumericsOf<Real>::template Bordered<Band, kWidestBorder>;
      return std::make_unique<MatrixOf<Real, most + kWidestBorder, Bordered>>(std::move(place));
    };
    return symmetric ? of(std::type_identity<Symmetric>()) : of(std::type_identity<Dense>());
  });
}

template struct Blocks<float>;
template struct Blocks<double>;
template struct Blocks<long double>;
template struct Blocks<Quad>;

}  // namespace hamgen
