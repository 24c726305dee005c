// Truncated power series in h with quad coefficients: a step and the flow as series can be compared
// term by term, so that an order is a statement about digits and not about a slope.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "generator/schemes/scheme.hpp"

namespace hamgen::schemes_test {

using Quad = __float128;

class Series {
 public:
  explicit Series(int order, Quad constant = 0) : terms_(static_cast<std::size_t>(order) + 1) {
    terms_[0] = constant;
  }
  [[nodiscard]] int order() const { return static_cast<int>(terms_.size()) - 1; }
  Quad& operator[](int k) { return terms_[static_cast<std::size_t>(k)]; }
  Quad operator[](int k) const { return terms_[static_cast<std::size_t>(k)]; }

 private:
  std::vector<Quad> terms_;
};

Series operator+(const Series& a, const Series& b);
Series operator-(const Series& a, const Series& b);
Series operator*(const Series& a, const Series& b);
Series operator*(Quad a, const Series& b);
Series operator/(Quad a, const Series& b);
[[nodiscard]] Series times_h(const Series& a);

// q1, q2, p1, p2.
using State = std::vector<Series>;

// Two degrees of freedom; grad H as series, the derivatives by q first.
struct Problem {
  std::function<State(const State&)> gradient;
  std::array<Quad, 4> start;
};
// All derivatives of T and V differ from zero; with `quadratic`, T = (p1^2 + p2^2)/2.
[[nodiscard]] Problem separable_problem(bool quadratic, Quad size_of_potential = 1);
[[nodiscard]] Problem mixed_problem();

// The flow and one step of the scheme from the problem's start, through h^order.
[[nodiscard]] State exact_series(const Problem& problem, int order);
[[nodiscard]] State step_series(const Problem& problem, const Scheme& scheme, int order);

// The largest difference of the terms in h^k.
[[nodiscard]] double difference(const State& a, const State& b, int k);

[[nodiscard]] Quad quad_value(const Expression& e);

}  // namespace hamgen::schemes_test
