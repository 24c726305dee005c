// The derivatives of H, anew.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "generator/mechanics/generating_function.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// What stands for the derivatives of H in the step.
class Derivatives {
 public:
  // H differentiated anew, from its expression.
  explicit Derivatives(const Mechanics& mechanics) : Derivatives(mechanics, mechanics.energy) {}
  // The same where the sums of the mechanics are loops, and `hamiltonian` is H written out.
  Derivatives(const Mechanics& mechanics, const Expression& hamiltonian);
  // Those of K as they were derived; `decide_function` says if they are right.
  explicit Derivatives(const GeneratingFunction& function);
  [[nodiscard]] const Expression& first(int i) const {
    return gradient_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const std::vector<Expression>& gradient() const { return gradient_; }
  // Null where it vanishes.
  [[nodiscard]] Expression second(int i, int j) const;
  // Of those that do not vanish, i <= j.
  [[nodiscard]] const std::map<std::pair<int, int>, Expression>& hessian() const {
    return hessian_;
  }
  // Of every component those that the second derivatives couple with it.
  [[nodiscard]] std::vector<std::vector<int>> partners() const;

 private:
  std::vector<Expression> gradient_;
  std::map<std::pair<int, int>, Expression> hessian_;
};

}  // namespace hamgen
