// Included by a program beside emitted code, never by a test itself: emitted steps as watch.hpp
// wants them.
#pragma once

#include <cstdio>
#include <cstring>
#include <type_traits>

#include "tests/contract/watch.hpp"

namespace hamgen::contract {

// A state is nothing but its numbers; of a batch of so many trajectories they are in memory lane by
// lane, and the first lane is looked at.
template <class Real, int lanes = 1, class State>
Vector numbers(const State& state) {
  std::vector<Real> values(sizeof(State) / sizeof(Real));
  std::memcpy(values.data(), &state, sizeof(State));
  Vector result;
  for (std::size_t k = 0; k < values.size(); k += lanes) result.push_back(values[k]);
  return result;
}
// The other lanes have these numbers too, or each its own, a little apart.
template <class Real, class State, int lanes = 1>
State state_of(const Vector& values, bool apart = false) {
  State state;
  if constexpr (!std::is_empty_v<State>) {
    std::vector<Real> rounded;
    for (const Quad value : values) {
      for (int lane = 0; lane < lanes; ++lane)
        rounded.push_back(static_cast<Real>(value * (apart ? 1 - Quad(lane) / 512 : 1)));
    }
    std::memcpy(static_cast<void*>(&state), rounded.data(), sizeof(State));
  }
  return state;
}

// What a report or a length says of the first lane.
template <class Real, class Number>
Real first_number(const Number& number) {
  Real value;
  std::memcpy(&value, &number, sizeof value);
  return value;
}
inline bool is_first(bool yes) { return yes; }
template <class Mask>
bool is_first(const Mask& mask) {
  return mask[0];
}
inline long long first_count(long long count) { return count; }
template <class Number>
long long first_count(const Number& count) {
  return static_cast<long long>(first_number<double>(count));
}

template <class Emitted, class Stepper>
Vector state_and_carry(const Stepper& stepper) {
  using Real = typename Emitted::Real;
  Vector z = numbers<Real, Emitted::lanes>(stepper.z_);
  const Vector carry = numbers<Real, Emitted::lanes>(stepper.carry_);
  for (std::size_t k = 0; k < z.size(); ++k) z[k] += carry[k];
  return z;
}

// Emitted is a namespace as a type: see the adapter in measure.cpp.
template <class Emitted>
struct Compiled {
  using Real = typename Emitted::Real;
  static constexpr Real epsilon = Emitted::epsilon;
  typename Emitted::Parameters par;
  Vector gradient(const Vector& z) const {
    std::vector<Real> g(z.size());
    Emitted::gradient(par, state_of<Real, typename Emitted::State, Emitted::lanes>(z), g.data());
    return Vector(g.begin(), g.end());
  }
};

// A whole step, and substep i of a composition's.
template <class Emitted>
struct CompiledStepper {
  typename Emitted::Propagator& all;
  Vector exact_state() const { return state_and_carry<Emitted>(all); }
  Attempt step() {
    const auto report = all.step();
    return {is_first(report.converged), first_count(report.iterations)};
  }
};
template <class Emitted>
struct CompiledSubstep {
  typename Emitted::Propagator& all;
  int i;
  typename Emitted::State z_, carry_;
  Vector exact_state() const { return state_and_carry<Emitted>(*this); }
  Attempt step() {
    const auto report = all.substep(i, z_, carry_);
    return {is_first(report.converged), first_count(report.iterations)};
  }
};

template <class Emitted>
struct CompiledExact : Compiled<Emitted> {
  using State = typename Emitted::State;
  using Propagator = typename Emitted::Propagator;
  ExactStep step(const Vector& z, Quad h) const {
    Propagator all(this->par, h, state_of<Quad, State>(z));
    ExactStep result;
    if constexpr (requires { Propagator::substeps; }) {
      all.lengths_[0] = h;
      if constexpr (requires { all.k_; }) all.k_[0] = prepare(this->par, h);
      CompiledSubstep<Emitted> first{all, 0, all.z_, all.carry_};
      result.converged = first.step().converged;
      result.end = first.exact_state();
    } else {
      result.converged = all.step().converged;
      result.end = state_and_carry<Emitted>(all);
      if constexpr (requires { all.start_.value, all.start_.state; }) {
        // z at every stage, too, where a component's numbers of all stages stand side by side.
        const std::size_t count = std::size(all.start_.value);
        const bool by_component = std::size(all.start_.state) == count;
        const std::size_t size = by_component ? z.size() : count;
        for (std::size_t i = 0; i < count / size; ++i) {
          for (std::size_t k = 0; k < size; ++k)
            result.stages.push_back(all.start_.value[k * (count / size) + i]);
        }
      }
    }
    return result;
  }
};

// Steps of a Propagator, of a composition substep by substep as its step() takes them.
template <class Emitted, class ExactEmitted>
Defects run(const Vector& parameters, const Equations& equations, typename Emitted::Real h,
            const Vector& start, long long steps, bool cancels) {
  using Real = typename Emitted::Real;
  using State = typename Emitted::State;
  constexpr int lanes = Emitted::lanes;
  Compiled<Emitted> code{state_of<Real, typename Emitted::Parameters, lanes>(parameters)};
  CompiledExact<ExactEmitted> exact{};
  if constexpr (!std::is_empty_v<typename Emitted::Parameters>) {  // the same, rounded, numbers
    exact.par = state_of<Quad, typename ExactEmitted::Parameters>(numbers<Real, lanes>(code.par));
  }
  typename Emitted::Propagator all(code.par, h, state_of<Real, State, lanes>(start, true));
  Watch watch(code, exact, cancels);
  Defects defects;
  for (defects.steps = 0; defects.steps < steps; ++defects.steps) {
    if constexpr (requires { Emitted::Propagator::substeps; }) {
      CompiledSubstep<Emitted> substep{all, 0, all.z_, all.carry_};
      for (; substep.i < Emitted::Propagator::substeps; ++substep.i) {
        defects.failed =
            !watch.solve(substep, equations, first_number<Real>(all.lengths_[substep.i]), defects);
        if (defects.failed) return defects;
      }
      all.z_ = substep.z_;
      all.carry_ = substep.carry_;
    } else {
      CompiledStepper<Emitted> stepper{all};
      defects.failed = !watch.solve(stepper, equations, h, defects);
      if (defects.failed) return defects;
    }
  }
  return defects;
}

inline void print(const char* name, const Defects& d) {
  std::printf("%s\t%lld\t%lld\t%lld\t%.6g\t%lld\t%.6g\t%.6g\t%d\t%lld\t%lld\n", name, d.steps,
              d.solves, d.iterations, d.worst, d.worst_step, d.units, d.reference, d.failed ? 1 : 0,
              d.broken, d.unknown);
}

}  // namespace hamgen::contract
