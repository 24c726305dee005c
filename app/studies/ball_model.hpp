// A model evaluated as its author wrote it, in balls: the tree of the language, and neither GiNaC
// nor any later stage.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "app/studies/ball_jet.hpp"
#include "generator/language/model.hpp"

namespace hamgen::app {

class BallModel {
 public:
  // `parameters` by name, "m[2]" of an array: all that H uses.  The model outlives this.
  BallModel(const Model& model, std::map<std::string, Ball> parameters, long bits);

  // H at z = (q, p), with its gradient, and its Hessian if `second`.
  [[nodiscard]] BallJet hamiltonian(std::span<const Ball> z, bool second) const;
  // An expression of H's kind, for tests of this class.
  [[nodiscard]] BallJet value(const NodePtr& node, std::span<const Ball> z, bool second) const;

  [[nodiscard]] long bits() const { return bits_; }

 private:
  class Evaluation;
  struct Place {
    const Variable* variable;
    int first;
  };

  const Model& model_;
  std::map<std::string, Ball> parameters_;
  std::map<std::string, Place> variables_;
  std::map<std::string, Rational> sizes_;
  long bits_;
};

// A function that H uses and that has no derivatives in balls; empty if there is none.
[[nodiscard]] std::string function_without_derivatives(const Model& model);

}  // namespace hamgen::app
