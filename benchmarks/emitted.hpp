// The Propagator of the emitted headers behind the names the measurement uses.
#pragma once
#include <henon_heiles.hpp>
#include <pendulum.hpp>

#include "benchmarks/problems.hpp"

namespace hamgen::benchmarks {

template <class Problem>
class Emitted;

template <>
class Emitted<Pendulum> {
 public:
  static constexpr const char* name = "hamgen";
  static constexpr int solves = 1;

  Emitted(const Pendulum& problem, double h, const State<Pendulum>& z)
      : propagator_({.eps = problem.eps}, h, {.q = z[0], .p = z[1]}) {}

  bool advance(long long steps) { return propagator_.advance(steps).converged; }
  [[nodiscard]] State<Pendulum> state() const {
    const auto& z = propagator_.state();
    return {z.q, z.p};
  }

 private:
  pendulum::implicit_midpoint::Propagator propagator_;
};

template <>
class Emitted<HenonHeiles> {
 public:
  static constexpr const char* name = "hamgen";
  static constexpr int solves = 1;

  Emitted(const HenonHeiles&, double h, const State<HenonHeiles>& z)
      : propagator_({}, h, {.q1 = z[0], .q2 = z[1], .p1 = z[2], .p2 = z[3]}) {}

  bool advance(long long steps) { return propagator_.advance(steps).converged; }
  [[nodiscard]] State<HenonHeiles> state() const {
    const auto& z = propagator_.state();
    return {z.q1, z.q2, z.p1, z.p2};
  }

 private:
  henon_heiles::implicit_midpoint::Propagator propagator_;
};

}  // namespace hamgen::benchmarks
