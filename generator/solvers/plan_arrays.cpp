#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

// Free of the state: parameters and numbers only.
bool is_constant(const Kernel& kernel, const Expression& e) {
  const std::set<std::string> used = symbols(e);
  return std::ranges::none_of(kernel.slots,
                              [&](const Slot& slot) { return used.contains(slot.symbol); });
}

bool has_constant_hessian(const Kernel& kernel) {
  return std::ranges::all_of(kernel.hessian,
                             [&](const auto& entry) { return is_constant(kernel, entry.second); });
}

bool has_diagonal_hessian(const Kernel& kernel) {
  return std::ranges::all_of(
      kernel.hessian, [](const auto& entry) { return entry.first.first == entry.first.second; });
}

constexpr long kWidestBand = 8;

// The largest distance from the diagonal of an entry of V''; empty if it is not small and fixed.
std::optional<int> bandwidth(const std::vector<Kernel>& kernels) {
  long widest = 0;
  for (const Kernel& kernel : kernels) {
    if (uses_momenta(kernel)) continue;
    for (const auto& [place, value] : kernel.hessian) {
      const AffineIndex& a = kernel.slots[place.first].position;
      const AffineIndex& b = kernel.slots[place.second].position;
      if (a.factors != b.factors) return std::nullopt;
      widest = std::max(widest, std::abs(a.constant - b.constant));
    }
  }
  if (widest > kWidestBand) return std::nullopt;
  return static_cast<int>(widest);
}

}  // namespace

bool uses_newton(const ArrayPlan& plan) {
  return plan.method == ArrayMethod::full_newton || plan.method == ArrayMethod::reduced_newton;
}

bool uses_sparse_matrix(const ArrayPlan& plan) {
  return plan.method == ArrayMethod::full_newton ||
         (plan.method == ArrayMethod::reduced_newton && !plan.bandwidth);
}

SolvePlan plan_arrays(const StepEquations& equations) {
  SolvePlan plan{.equations = equations};
  const FamilyParameters member = uniform_parameters(equations.scheme.member()).value();
  const std::vector<Kernel>& kernels = equations.mechanics.kernels;
  const bool separable = equations.mechanics.is_separable();
  const bool plain = member.beta.is_zero() && member.gamma.is_zero();
  const int n = equations.mechanics.degrees_of_freedom;
  ArrayPlan arrays;
  auto kinetic_is_diagonal = [&] {
    return std::ranges::all_of(kernels, [](const Kernel& k) {
      return !uses_momenta(k) || (has_constant_hessian(k) && has_diagonal_hessian(k));
    });
  };
  if (separable && plain && member.alpha.is_zero()) {
    arrays.method = ArrayMethod::explicit_a;
    plan.solver = "explicit, in loops";
  } else if (separable && plain && member.alpha.is_one()) {
    arrays.method = ArrayMethod::explicit_b;
    plan.solver = "explicit, in loops";
  } else {
    const bool reduced = separable && kinetic_is_diagonal();
    arrays.method = reduced ? ArrayMethod::reduced_newton : ArrayMethod::full_newton;
    arrays.constant_matrix = std::ranges::all_of(kernels, has_constant_hessian);
    if (reduced) arrays.bandwidth = bandwidth(kernels);
    const std::string kind = arrays.bandwidth ? "banded" : "sparse";
    plan.solver = fmt::format("{} {} of size {}{}, in loops{}", kind,
                              arrays.constant_matrix ? "linear solve" : "Newton",
                              reduced ? n : 2 * n, reduced ? "; momenta torn out" : "",
                              arrays.constant_matrix ? ", factorised once" : "");
  }
  plan.arrays = arrays;
  if (member.beta.is_zero()) plan.left_out.emplace_back("beta terms: beta = 0");
  if (member.gamma.is_zero()) plan.left_out.emplace_back("gamma terms: gamma = 0");
  plan.left_out.push_back(
      fmt::format("expansion of the sums: {} degrees of freedom stay loops", n));
  if (arrays.bandwidth) {
    plan.left_out.push_back(fmt::format("Eigen: the matrix has bandwidth {}", *arrays.bandwidth));
  }
  if (arrays.method == ArrayMethod::reduced_newton) {
    plan.left_out.push_back(fmt::format("{} of the unknowns: torn out", n));
  }
  if (!uses_newton(arrays)) {
    plan.left_out.emplace_back("equation solver: the step is explicit");
  }
  return plan;
}

}  // namespace hamgen
