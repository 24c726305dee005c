// The equations of one step, before anyone decides how to solve them.
//
//   zbar = z + h B grad H(zbar),   B = (I/2 + C) J,      Z = z + h J grad H(zbar)
//
// The unknown is zbar: zero rows of I/2 + C drop unknowns by themselves.  At a higher order K(z, h)
// stands in for H.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/mechanics/generating_function.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

struct StepEquations {
  // Gradient and Hessian, or the kernels, are those of K where there is one; the energy is H.
  Mechanics mechanics;
  Scheme scheme;
  SparseMatrix stage_matrix;                        // B
  std::optional<GeneratingFunction> function = {};  // K and how it is written
  // Of H where K stands in for it: its gradient, or its kernels.
  std::vector<Expression> energy_gradient = {};
  std::vector<Kernel> energy_kernels = {};
  // By component of the gradient: symbols of which it is no polynomial.
  std::vector<std::set<std::string>> non_polynomial = {};

  // The mechanics with H in its kernels.
  [[nodiscard]] Mechanics of_energy() const;
  // Is the Hessian that of K itself, or of one cut off earlier?
  [[nodiscard]] bool has_exact_hessian() const;

  // Names of the symbols of the step for component i of the state.
  [[nodiscard]] Expression stage(int i) const;                  // zbar_i: "bar(q)"
  [[nodiscard]] Expression gradient_symbol(int i) const;        // at zbar: "H(q)", or of K "K(q)"
  [[nodiscard]] Expression hessian_symbol(int i, int j) const;  // at zbar: "H(q,p)"
  // dH/dz_i and d2H/dz_i dz_j with the stage values for the state.
  [[nodiscard]] Expression stage_gradient(int i) const;
  [[nodiscard]] Expression stage_hessian(int i, int j) const;
  // zbar_i of the right side: z_i + h sum_k B_ik H(z_k).
  [[nodiscard]] Expression row(int i) const;
  // Components of the gradient that row i uses.
  [[nodiscard]] std::vector<int> row_gradients(int i) const;
  // Does row i depend on zbar_j?
  [[nodiscard]] bool depends(int i, int j) const;
  // Is dH/dz_k a polynomial in zbar_j, so that d2H/dz_k dz_j tells how it depends on it?
  [[nodiscard]] bool is_polynomial(int k, int j) const;
  // The same as far as the Hessian knows.
  [[nodiscard]] bool hessian_couples(int i, int j) const;
  // Z_i - z_i in gradient symbols.
  [[nodiscard]] Expression increment(int i) const;
};

// Is the initial energy, E0, a parameter of the step?
[[nodiscard]] bool uses_energy_parameter(const StepEquations& equations);

// The step size.
[[nodiscard]] Expression step_size();

[[nodiscard]] StepEquations discretise(const Mechanics& mechanics, const Scheme& scheme,
                                       HessianWish wish = HessianWish::cheapest);
[[nodiscard]] std::string to_text(const StepEquations& equations);

}  // namespace hamgen
