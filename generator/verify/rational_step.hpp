// The linear step of a scheme, z -> M z, in rationals.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "generator/schemes/scheme.hpp"
#include "generator/verify/exact_matrix.hpp"

namespace hamgen {

// As LinearStep, without rounding: what is irrational in a scheme is taken to 38 digits, and then
// the step is not `exact`.
class RationalStep {
 public:
  // `values` are those of the parameters and E0 that the scheme's coefficients use.
  RationalStep(const Scheme& scheme, std::map<std::string, Rational> values);

  [[nodiscard]] bool is_exact() const { return exact_; }

  // M for H = z^T S z/2; of size 0 where the equations of the step have no solution, or C no value.
  [[nodiscard]] ExactMatrix matrix(const Rational& h, const ExactMatrix& s) const;
  // det(x - M) times this is a polynomial in h of degree `degree_in_h` at most; no such degree
  // where C is no rational function of h.
  [[nodiscard]] Rational denominator(const Rational& h, const ExactMatrix& s) const;
  [[nodiscard]] std::optional<int> degree_in_h(std::size_t size) const;

 private:
  struct Pencil {
    ExactMatrix plus, minus;  // plus Z = minus z
  };
  [[nodiscard]] std::optional<ExactMatrix> gauge(const Rational& h, std::size_t size) const;
  [[nodiscard]] ExactMatrix increment(const Rational& h, const ExactMatrix& a) const;
  [[nodiscard]] std::optional<Pencil> pencil(const Rational& h, const ExactMatrix& s) const;
  [[nodiscard]] ExactMatrix splitting_matrix(const Rational& h, const ExactMatrix& s) const;
  [[nodiscard]] ExactMatrix explicit_matrix(const Rational& h, const ExactMatrix& s) const;
  [[nodiscard]] Rational number(const Expression& e);
  void read_gauge(const Member& member);

  bool exact_ = true;
  std::map<std::string, Rational> values_;
  // Of a member, or a composition: C, its terms by powers of h where K stands in for H.
  std::optional<SparseMatrix> c_;
  std::vector<SparseMatrix> series_;
  int order_ = 0;
  RationalPolynomial common_denominator_{Rational(1)};  // of the entries of C, in h
  std::optional<int> gauge_degree_ = 0;                 // of C times that
  std::vector<Rational> substeps_{Rational(1)};
  // Of a splitting: kick or drift, and how long.
  std::vector<std::pair<bool, Rational>> shears_;
  // Of an explicit tableau.
  std::vector<std::vector<Rational>> a_;
  std::vector<Rational> b_;
};

// J S.
[[nodiscard]] ExactMatrix linear_flow(const ExactMatrix& s);

// A number that a person may have meant, rather than the first digits of an irrational one.
[[nodiscard]] bool is_short(const Rational& value);

}  // namespace hamgen
