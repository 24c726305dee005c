// What an emitted member of the family should compute, from H and the scheme alone.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/verify/identities.hpp"

namespace hamgen {

// What stands for the derivatives of H in the step.
class Derivatives {
 public:
  // H differentiated anew, from its expression.
  explicit Derivatives(const Mechanics& mechanics);
  // Those of K as they were derived; `decide_function` says if they are right.
  explicit Derivatives(const GeneratingFunction& function);
  [[nodiscard]] const Expression& first(int i) const {
    return gradient_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const std::vector<Expression>& gradient() const { return gradient_; }
  [[nodiscard]] Expression second(int i, int j) const;

 private:
  std::vector<Expression> gradient_;
  std::map<std::pair<int, int>, Expression> hessian_;
};

// The claims of one step:
//   residuals R and their matrix R' along the unknowns of a block, the variables torn out of it
//   eliminated by the chain rule; -R'^-1 R where it is written out; the next values of fixed points
//   and sweeps; and the increments h J grad H(zbar), corrected to first order by the last increment
//   of each iteration.  Loop variables, and corrections that are computed by elimination, are free.
[[nodiscard]] Identities step_identities(const Mechanics& mechanics, const Derivatives& derivatives,
                                         const Member& member, const Program& program);

}  // namespace hamgen
