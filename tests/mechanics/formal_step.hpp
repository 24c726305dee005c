// Steps and flows of a Hamiltonian in long double, straight from its mathematics.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "tests/mechanics/tape.hpp"

namespace hamgen::mechanics_test {

// The model of a text without its first line; parameters have their defaults.
[[nodiscard]] Mechanics mechanics_of(const std::string& text);
// The model that is shipped under this name.
[[nodiscard]] Mechanics shipped(const std::string& name);

// alpha, beta, gamma in the language's notation, the same for all degrees of freedom.
struct Gauge {
  std::string alpha = "1/2", beta = "0", gamma = "0";
};
[[nodiscard]] Scheme scheme_of(const Mechanics& mechanics, const Gauge& gauge);

// Z = z + h J grad K(zbar, h) with the stage value iterated to round-off.
class FormalStep {
 public:
  FormalStep(const Mechanics& mechanics, const Member& member,
             const std::vector<Expression>& slopes);
  [[nodiscard]] Vector after(int steps, const Vector& start, long double h) const;

 private:
  Vector parameters_;
  Tape slopes_;
  Tape matrix_;  // the nonzero entries of (1/2 + C) J at h
  std::vector<std::pair<int, int>> places_;
};

// The flow by the classical Runge-Kutta method with step t/n and t/2n, extrapolated to order 5.
[[nodiscard]] Vector flow(const Mechanics& mechanics, const Vector& start, long double t, int n);

// log2 of the ratios of the errors at t for steps t/n, t/2n, t/4n.
[[nodiscard]] std::vector<double> observed_orders(const FormalStep& step, const Vector& start,
                                                  long double t, int n, const Vector& exact);

}  // namespace hamgen::mechanics_test
