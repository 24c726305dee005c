// The blocks of generator/numerics for every scalar, and for any size: they have their sizes from
// the compiler, so that one of the next power of two is used, and what is beyond stays zero.
#pragma once

#include <array>
#include <memory>
#include <span>

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
  [[nodiscard]] virtual Real error(int degree, std::span<const Real> solution, int first,
                                   int count) const = 0;
};
template <class Real>
struct AnyNewtonRule {
  virtual ~AnyNewtonRule() = default;
  virtual void begin(bool predicted) = 0;
  virtual void watch(const AnyHistory<Real>& past, std::span<const Real> solution, int first,
                     int count) = 0;
  virtual Answer operator()(Real size, Real scale, int iteration) = 0;
};
// FixedPointRule, and ImpatientRule.
template <class Real>
struct AnyFixedPointRule {
  virtual ~AnyFixedPointRule() = default;
  using Distance = typename NumericsOf<Real>::Moved;
  virtual void begin() = 0;
  virtual Answer operator()(const Distance& moved, int iteration) = 0;
  [[nodiscard]] virtual Real size() const = 0;
};
template <class Real>
struct AnyContractionRule {
  virtual ~AnyContractionRule() = default;
  virtual void begin(int work) = 0;
  virtual Answer operator()(const typename NumericsOf<Real>::Moved& moved, int iteration) = 0;
  [[nodiscard]] virtual Real size() const = 0;
  [[nodiscard]] virtual typename NumericsOf<Real>::Contraction& block() = 0;
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
  // The same with a rule that may have settled it.
  virtual bool refine(AnyContractionRule<Real>& rule, std::span<Real> point,
                      std::span<const Real> lack, std::span<const Real> slope) = 0;
  [[nodiscard]] virtual bool is_first() const = 0;
  virtual void get_change(std::span<Real> change) const = 0;
  virtual void get_slope(std::span<Real> slope) const = 0;
};
template <class Real>
struct AnyMatrix {
  virtual ~AnyMatrix() = default;
  virtual void clear() = 0;
  virtual void put(int row, int column, Real value) = 0;
  [[nodiscard]] virtual bool factorise() = 0;
  virtual void solve(std::span<Real> vector) const = 0;
};

// These throw UsageError for what is too large: more than 4096 unknowns.
template <class Real>
[[nodiscard]] std::unique_ptr<AnyHistory<Real>> make_history(int size);
template <class Real>
[[nodiscard]] std::unique_ptr<AnyNewtonRule<Real>> make_newton_rule(int power, bool waits = false);
template <class Real>
[[nodiscard]] std::unique_ptr<AnyFixedPointRule<Real>> make_fixed_point_rule();
template <class Real>
[[nodiscard]] std::unique_ptr<AnyFixedPointRule<Real>> make_impatient_rule();
template <class Real>
[[nodiscard]] std::unique_ptr<AnyContractionRule<Real>> make_contraction_rule();
template <class Real>
[[nodiscard]] std::unique_ptr<AnySimplifiedNewtonRule<Real>> make_simplified_newton_rule();
// For up to twice as many components of the gradient as unknowns, 1024 of them.
template <class Real>
[[nodiscard]] std::unique_ptr<AnyRefinement<Real>> make_refinement(int unknowns, int components);
// Up to 256 rows.
template <class Real>
[[nodiscard]] std::unique_ptr<AnyMatrix<Real>> make_matrix(int size);

}  // namespace hamgen
