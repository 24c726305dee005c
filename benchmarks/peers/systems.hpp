// What a library integrates: the derivatives of a model, written by hand or those that hamgen
// emitted.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/library.hpp"

namespace hamgen::peers {

// What H is.
enum class Form {
  any,
  separable,  // T(p) + V(q)
  unit_mass,  // |p|^2/2 + V(q)
};

// Problem: see benchmarks/hand_problems.hpp.  Everything is inlined, and of a size that the
// compiler knows.
template <class Problem>
class HandSystem {
 public:
  static constexpr std::size_t n = Problem::n;
  using State = std::array<double, 2 * n>;
  using Half = std::array<double, n>;

  explicit HandSystem(const Problem& problem) : problem_(problem) {}

  [[nodiscard]] Form form() const {
    if constexpr (has_forces) {
      for (std::size_t i = 0; i < n; ++i) {
        if (problem_.inverse_mass(i) != 1) return Form::separable;
      }
      return Form::unit_mass;
    }
    return Form::any;
  }
  [[nodiscard]] std::size_t degrees_of_freedom() const { return n; }
  [[nodiscard]] State state() const { return {}; }
  [[nodiscard]] Half half() const { return {}; }
  // z' = J grad H(z).
  void derivative(const double* z, double* dzdt) const {
    if constexpr (has_forces) {
      for (std::size_t i = 0; i < n; ++i) dzdt[i] = problem_.inverse_mass(i) * z[n + i];
      problem_.force(z, dzdt + n);
      for (std::size_t i = 0; i < n; ++i) dzdt[n + i] = -dzdt[n + i];
    } else {
      problem_.flow(z, dzdt);
    }
  }
  // p' = -V'(q).
  void force(const Half& q, Half& dpdt) const {
    if constexpr (has_forces) {
      problem_.force(q.data(), dpdt.data());
      for (double& x : dpdt) x = -x;
    }
  }
  // q' = T'(p).
  void velocity(const Half& p, Half& dqdt) const {
    if constexpr (has_forces) {
      for (std::size_t i = 0; i < n; ++i) dqdt[i] = problem_.inverse_mass(i) * p[i];
    }
  }

 private:
  static constexpr bool has_forces = requires(const Problem& of, double* f) { of.force(f, f); };

  Problem problem_;
};

// Through the gradient that hamgen emitted, called through one pointer.
class EmittedSystem {
 public:
  using State = std::vector<double>;
  using Half = std::vector<double>;

  EmittedSystem(std::shared_ptr<const runtime::Library> library, std::vector<double> parameters,
                const std::vector<double>& start)
      : library_(std::move(library)),
        parameters_(std::move(parameters)),
        gradient_(library_->plugin().gradient),
        at_(start),
        work_(start.size()),
        form_(form_at(start)) {}

  // As far as the gradient there and at other momenta and positions tells.
  [[nodiscard]] Form form() const { return form_; }
  [[nodiscard]] std::size_t degrees_of_freedom() const { return library_->degrees_of_freedom(); }
  [[nodiscard]] State state() const { return State(work_.size()); }
  [[nodiscard]] Half half() const { return Half(work_.size() / 2); }
  void derivative(const double* z, double* dzdt) const {
    const std::size_t n = work_.size() / 2;
    gradient(z, work_.data());
    for (std::size_t i = 0; i < n; ++i) {
      dzdt[i] = work_[n + i];
      dzdt[n + i] = -work_[i];
    }
  }
  void force(const Half& q, Half& dpdt) const {
    std::ranges::copy(q, at_.begin());
    gradient(at_.data(), work_.data());
    for (std::size_t i = 0; i < dpdt.size(); ++i) dpdt[i] = -work_[i];
  }
  void velocity(const Half& p, Half& dqdt) const {
    std::copy(p.begin(), p.end(), at_.end() - static_cast<std::ptrdiff_t>(p.size()));
    gradient(at_.data(), work_.data());
    for (std::size_t i = 0; i < dqdt.size(); ++i) dqdt[i] = work_[dqdt.size() + i];
  }

 private:
  // grad H(z), H_q first; 2n values.
  void gradient(const double* z, double* values) const { gradient_(parameters_.data(), z, values); }
  [[nodiscard]] Form form_at(const std::vector<double>& z) const;

  std::shared_ptr<const runtime::Library> library_;
  std::vector<double> parameters_;
  void (*gradient_)(const double*, const double*, double*);
  mutable std::vector<double> at_, work_;
  Form form_;
};

}  // namespace hamgen::peers
