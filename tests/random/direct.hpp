// A model evaluated as its author wrote it: the tree of the language, no later stage and no
// algebra.
#pragma once

#include <map>
#include <string>

#include "generator/language/model.hpp"
#include "tests/random/jet.hpp"

namespace hamgen::random {

class DirectModel {
 public:
  // `parameters` in the order of element_names; the model outlives this.
  DirectModel(const Model& model, const std::vector<Rational>& parameters);

  // H at z = (q, p) with its gradient; with the p_t of a system with time.
  [[nodiscard]] Jet hamiltonian(const Vector& z) const;
  [[nodiscard]] Jet value(const NodePtr& node, const Vector& z) const;
  // The value of a parameter by name, "m[2]" of an array.
  [[nodiscard]] Quad parameter(const std::string& name) const { return parameters_.at(name); }
  [[nodiscard]] std::size_t degrees_of_freedom() const { return n_; }

 private:
  class Evaluation;
  const Model& model_;
  std::size_t n_;
  std::map<std::string, Quad> parameters_;
};

// The nearest quad number, and back.
[[nodiscard]] Quad to_quad(const Rational& value);

}  // namespace hamgen::random
