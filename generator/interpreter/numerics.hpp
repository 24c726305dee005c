// The blocks of generator/numerics for every scalar, and for any size: they have their sizes from
// the compiler, so that one of the next power of two is used, and what is beyond stays zero.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace hamgen {

namespace numerics_of_float {
using Real = float;
inline constexpr Real largest = 3.0e38F;
inline constexpr Real epsilon = 0x1p-23F;
#include "generator/interpreter/numerics.inc"
}  // namespace numerics_of_float

namespace numerics_of_double {
using Real = double;
inline constexpr Real largest = 1.0e308;
inline constexpr Real epsilon = 0x1p-52;
#include "generator/interpreter/numerics.inc"
}  // namespace numerics_of_double

namespace numerics_of_long_double {
using Real = long double;
inline constexpr Real largest = 1.0e4932L;
inline constexpr Real epsilon = 0x1p-63L;
#include "generator/interpreter/numerics.inc"
}  // namespace numerics_of_long_double

namespace numerics_of_quad {
__extension__ typedef __float128 Real;
inline constexpr Real largest = Real(1.0e308);
inline constexpr Real epsilon = Real(0x1p-112);
#include "generator/interpreter/numerics.inc"
}  // namespace numerics_of_quad

template <class Real>
struct NumericsOf;
template <>
struct NumericsOf<float> : numerics_of_float::Numerics {};
template <>
struct NumericsOf<double> : numerics_of_double::Numerics {};
template <>
struct NumericsOf<long double> : numerics_of_long_double::Numerics {};
template <>
struct NumericsOf<numerics_of_quad::Real> : numerics_of_quad::Numerics {};

enum class Answer { go_on, done, failed };

template <class Real>
struct AnyHistory {
  virtual ~AnyHistory() = default;
  [[nodiscard]] virtual bool known() const = 0;
  virtual void record(std::span<const Real> solution) = 0;
  virtual void extrapolate(std::span<Real> solution) const = 0;
  virtual void extrapolate_twice(std::span<Real> solution) const = 0;
  [[nodiscard]] virtual Real error(int degree, std::span<const Real> solution, int first,
                                   int count) const = 0;
  [[nodiscard]] virtual Real difference(int degree, std::span<const Real> solution,
                                        int i) const = 0;
  [[nodiscard]] virtual Real way(std::span<const Real> solution, int i) const = 0;
};
template <class Real>
struct AnyMatrix {
  virtual ~AnyMatrix() = default;
  virtual void clear() = 0;
  virtual void put(int row, int column, Real value) = 0;
  // Before it is factorised.
  [[nodiscard]] virtual Real at(int row, int column) const = 0;
  [[nodiscard]] virtual bool factorise() = 0;
  virtual void solve(std::span<Real> vector) const = 0;
};
template <class Real>
struct AnyNewtonRule {
  virtual ~AnyNewtonRule() = default;
  virtual void begin(bool predicted) = 0;
  virtual void watch(const AnyHistory<Real>& past, std::span<const Real> solution, int first,
                     int count) = 0;
  // Of a rule that looks at the matrix of so many unknowns.
  virtual void compare(const AnyMatrix<Real>& /*matrix*/, int /*count*/) {}
  // Over the unknowns of arrays: of increments as parts of sizes, of what is relative of each, of
  // increments and of lengths.
  struct Sums {
    Real size = 0, uneven = 0, moved = 0, scale = 0;
  };
  virtual Answer of_sums(std::span<const Real> values, std::span<const Real> increments,
                         const Sums& sums, int iteration) = 0;
  [[nodiscard]] virtual Real relative(int unknown, Real moved, Real length, Real way) const = 0;
  // One over the size of each unknown, once a first iteration is known.
  virtual void know(std::span<const Real> /*value*/, std::span<const Real> /*moved*/) {}
  [[nodiscard]] virtual Real unit(std::size_t /*unknown*/) const { return 1; }
  // Of unknowns that are written out, one by one, and what they were moved by together.
  virtual Answer of_each(std::span<const Real> /*moved*/, std::span<const Real> /*length*/,
                         std::span<const Real> /*way*/, int /*iteration*/) {
    return Answer::failed;
  }
  [[nodiscard]] virtual Real last() const { return 0; }
};
// When a fixed point ends: one of the rules that Blocks::fixed_point_rule knows.
template <class Real>
struct AnyFixedPointRule {
  virtual ~AnyFixedPointRule() = default;
  using Distance = typename NumericsOf<Real>::Moved;
  // What another solver's matrix would cost is for a rule that gives up for it.
  virtual void begin(int work) = 0;
  virtual Answer operator()(const Distance& moved, int iteration) = 0;
  [[nodiscard]] virtual Real size() const = 0;
  // Of a ContractionRule; of others false.
  [[nodiscard]] bool moves() {
    return ask([](const auto& rule) { return rule.moves(); });
  }
  bool gives_up() {
    return ask([](auto& rule) { return rule.gives_up(); });
  }
  // For Refinement; none if it is no ContractionRule.
  template <int Cycle>
  using Contraction = typename NumericsOf<Real>::template Contraction<Cycle>;
  [[nodiscard]] virtual std::variant<std::monostate, Contraction<1>*, Contraction<2>*>
  contraction() = 0;
  // What `use` says of the contraction rule.
  template <class Use>
  bool ask(const Use& use) {
    return std::visit(
        [&](auto rule) {
          if constexpr (std::is_same_v<decltype(rule), std::monostate>) {
            return false;
          } else {
            return use(*rule);
          }
        },
        contraction());
  }
};
template <class Real>
struct AnySimplifiedNewtonRule {
  virtual ~AnySimplifiedNewtonRule() = default;
  virtual void begin(bool factorised) = 0;
  virtual Answer operator()(const typename NumericsOf<Real>::Moved& moved, Real residual,
                            bool& factorised, int iteration) = 0;
  [[nodiscard]] virtual Real size() const = 0;
};
template <class Real>
struct AnyRefinement {
  virtual ~AnyRefinement() = default;
  // True if it wants the values once more, at the point it has moved.
  virtual bool operator()(std::span<Real> point, std::span<const Real> lack,
                          std::span<const Real> slope) = 0;
  // The same with a ContractionRule that may have settled it.
  virtual bool refine(AnyFixedPointRule<Real>& rule, std::span<Real> point,
                      std::span<const Real> lack, std::span<const Real> slope) = 0;
  // Before the last increment of such a rule, from where the step began.
  virtual void foresee(AnyFixedPointRule<Real>& rule, std::span<const Real> point,
                       std::span<const Real> increment, std::span<const Real> from) = 0;
  virtual void round_beside(Real length) = 0;
  [[nodiscard]] virtual bool is_first() const = 0;
  [[nodiscard]] virtual bool found() const = 0;
  [[nodiscard]] virtual Real last() const = 0;  // what the last round moved all together
  virtual void get_change(std::span<Real> change) const = 0;
  virtual void get_slope(std::span<Real> slope) const = 0;
};

// New ones.  UsageError for what is too large.
template <class Real>
struct Blocks {
  [[nodiscard]] static std::unique_ptr<AnyHistory<Real>> history(int size);  // up to 4096 unknowns
  [[nodiscard]] static std::unique_ptr<AnyNewtonRule<Real>> newton_rule(int power, int unknowns,
                                                                        bool waits);
  // NewtonRuleWithMatrix, of up to 32 unknowns.
  [[nodiscard]] static std::unique_ptr<AnyNewtonRule<Real>> newton_rule_with_matrix(int unknowns);
  [[nodiscard]] static std::unique_ptr<AnyNewtonRule<Real>> linear_rule();
  [[nodiscard]] static std::unique_ptr<AnySimplifiedNewtonRule<Real>> simplified_newton_rule();
  // Of this type; null if there is none.
  [[nodiscard]] static std::unique_ptr<AnyFixedPointRule<Real>> fixed_point_rule(
      std::string_view type);
  // For up to twice as many components of the gradient as unknowns, 1024 of them; see Note [two
  // forms of the equations].
  [[nodiscard]] static std::unique_ptr<AnyRefinement<Real>> refinement(int unknowns, int components,
                                                                       bool two_forms = false);
  // Up to 256 rows.
  [[nodiscard]] static std::unique_ptr<AnyMatrix<Real>> matrix(int size, bool symmetric = false);
  // Eliminated in this order, place[i] for unknown i: what elimination within a band leaves out are
  // products with zeros.
  // The last `border` of these stand in a border.
  [[nodiscard]] static std::unique_ptr<AnyMatrix<Real>> matrix(std::vector<int> place,
                                                               bool symmetric = false,
                                                               int border = 0);
};

}  // namespace hamgen
