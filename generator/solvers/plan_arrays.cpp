#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/base/diagnostic.hpp"
#include "generator/solvers/array_matrix.hpp"
#include "generator/solvers/cost.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

namespace {

// Free of the state: parameters and numbers only.
bool is_constant(const Kernel& kernel, const Expression& e) {
  const std::set<std::string> used = symbols(e);
  return std::ranges::none_of(kernel.slots,
                              [&](const Slot& slot) { return used.contains(slot.symbol); });
}

// Is the kernel a polynomial of degree two in the state, or in what the slots `counts` are?
template <class Counts>
bool has_constant_hessian(const Kernel& kernel, const Counts& counts) {
  const std::set<std::string> beyond = non_polynomial_symbols(kernel.value);
  return std::ranges::none_of(
             kernel.slots,
             [&](const Slot& slot) { return counts(slot) && beyond.contains(slot.symbol); }) &&
         std::ranges::all_of(kernel.hessian,
                             [&](const auto& entry) { return is_constant(kernel, entry.second); });
}
bool has_constant_hessian(const Kernel& kernel) {
  return has_constant_hessian(kernel, [](const Slot&) { return true; });
}

bool has_diagonal_hessian(const Kernel& kernel) {
  return std::ranges::all_of(
      kernel.hessian, [](const auto& entry) { return entry.first.first == entry.first.second; });
}

}  // namespace

bool has_constant_matrix(const Mechanics& mechanics, const FamilyParameters& member) {
  const bool apart = knows_time(mechanics, member);
  const auto counts = [&](const Slot& slot) { return !apart || !mechanics.is_time(slot.position); };
  return std::ranges::all_of(kernels_of_matrix(mechanics, member), [&](const Kernel& kernel) {
    return has_constant_hessian(kernel, counts);
  });
}

bool has_diagonal_kinetic_energy(const Mechanics& mechanics) {
  return std::ranges::all_of(mechanics.kernels, [](const Kernel& kernel) {
    return !uses_momenta(kernel) ||
           (!kernel.sum && has_constant_hessian(kernel) && has_diagonal_hessian(kernel));
  });
}

std::optional<Expression> uniform_mass(const Mechanics& mechanics, bool apart_from_time) {
  const int n = mechanics.degrees_of_freedom;
  std::vector<Expression> masses(static_cast<std::size_t>(n));
  for (const Kernel& kernel : mechanics.kernels) {
    if (!uses_momenta(kernel)) continue;
    for (const auto& [slots, value] : kernel.hessian) {
      const std::set<std::string> used = symbols(value);
      const bool varies =
          std::ranges::any_of(kernel.ranges,
                              [&](const KernelRange& r) { return used.contains(r.index); }) ||
          std::ranges::any_of(kernel.parameters,
                              [&](const ParameterSlot& p) { return used.contains(p.symbol); });
      if (varies) return std::nullopt;
      // Of most sums the one before was the same.
      Expression before;
      Expression after = value;
      for_each_instance(kernel.ranges, [&](const std::vector<long>& indices) {
        const long place = value_at(kernel.slots[slots.first].position, kernel.ranges, indices) - n;
        Expression& mass = masses[static_cast<std::size_t>(place)];
        if (mass != before) {
          before = mass;
          after = mass + value;
        }
        mass = after;
      });
    }
  }
  if (apart_from_time && mechanics.has_time) masses.pop_back();
  const bool same =
      std::ranges::all_of(masses, [&](const Expression& m) { return m == masses[0]; });
  return same ? std::optional(masses[0]) : std::nullopt;
}

namespace {

std::string matrix_text(const ArrayMatrix& matrix) {
  switch (matrix.kind) {
    case MatrixKind::band:
      return matrix.border.empty() ? "banded" : "bordered";
    case MatrixKind::dense:
    case MatrixKind::eigen_dense:
      return "dense";
    case MatrixKind::eigen_sparse:
      return "sparse";
  }
  return "";
}

// Why there is no Eigen.
std::string without_eigen(const ArrayMatrix& matrix) {
  if (matrix.kind == MatrixKind::dense) {
    return fmt::format("Eigen: a full matrix of size {} is eliminated here", matrix.size);
  }
  const std::string around =
      matrix.border.empty() ? "" : fmt::format(" within a border of {}", matrix.border.size());
  return fmt::format("Eigen: the matrix has bandwidth {}{}{}", matrix.bandwidth,
                     matrix.folded ? ", the ring folded flat" : "", around);
}

std::string solver_text(const SolvePlan& plan, int n) {
  const ArrayPlan& arrays = *plan.arrays;
  const std::string torn = arrays.reduced ? "; momenta torn out" : "";
  const int size = arrays.reduced ? n : 2 * n;
  switch (arrays.method) {
    case ArrayMethod::explicit_a:
    case ArrayMethod::explicit_b:
      return "explicit, in loops";
    case ArrayMethod::fixed_point:
      return fmt::format("fixed point of size {}{}, in loops", size, torn);
    case ArrayMethod::both:
      return fmt::format("fixed point, {} Newton of size {} where it contracts slowly{}, in loops",
                         matrix_text(*arrays.matrix), size, torn);
    case ArrayMethod::sweeps:
      return fmt::format(
          "{} fixed-point sweep{} (Algorithm 1 of the paper), in loops: not symplectic",
          *plan.sweeps, *plan.sweeps == 1 ? "" : "s");
    case ArrayMethod::newton:
      return fmt::format("{} {} of size {}{}, in loops{}", matrix_text(*arrays.matrix),
                         arrays.constant_matrix ? "linear solve" : "Newton", size, torn,
                         arrays.constant_matrix ? ", factorised once" : "");
    case ArrayMethod::gradient_only:
      break;
  }
  return "";
}

}  // namespace

bool iterates(const ArrayPlan& plan) {
  return plan.method == ArrayMethod::newton || plan.method == ArrayMethod::fixed_point ||
         plan.method == ArrayMethod::both;
}

bool knows_time(const Mechanics& mechanics, const FamilyParameters& member) {
  return mechanics.has_time && member.gamma.is_zero();
}

std::vector<Kernel> kernels_of_matrix(const Mechanics& mechanics, const FamilyParameters& member) {
  std::vector<Kernel> kernels = mechanics.kernels;
  if (!knows_time(mechanics, member)) return kernels;
  for (Kernel& kernel : kernels) {
    const auto is_time = [&](std::size_t slot) {
      return mechanics.is_time(kernel.slots[slot].position);
    };
    std::erase_if(kernel.hessian, [&](const auto& entry) {
      return is_time(entry.first.first) || is_time(entry.first.second);
    });
  }
  return kernels;
}

bool uses_eigen(const ArrayPlan& plan) {
  return plan.matrix && (plan.matrix->kind == MatrixKind::eigen_dense ||
                         plan.matrix->kind == MatrixKind::eigen_sparse);
}

SolvePlan plan_arrays(const StepEquations& equations, const SolverWish& wish, NumbersOf numbers) {
  const bool eigen = numbers == NumbersOf::processor;
  using Wish = SolverWish::Kind;
  SolvePlan plan{.equations = equations};
  if (wish.kind == Wish::sweeps) plan.sweeps = wish.sweeps;
  const Mechanics& mechanics = equations.mechanics;
  const FamilyParameters member = uniform_parameters(equations.scheme.member()).value();
  const bool separable = mechanics.is_separable();
  const bool plain = member.beta.is_zero() && member.gamma.is_zero();
  const int n = mechanics.degrees_of_freedom;
  ArrayPlan arrays{.eigen = eigen};
  if (plan.sweeps) {
    arrays.method = ArrayMethod::sweeps;
  } else if (separable && plain && member.alpha.is_zero()) {
    arrays.method = ArrayMethod::explicit_a;
  } else if (separable && plain && member.alpha.is_one()) {
    arrays.method = ArrayMethod::explicit_b;
  } else {
    arrays.reduced = separable && has_diagonal_kinetic_energy(mechanics);
    if (arrays.reduced) arrays.mass = uniform_mass(mechanics);
    const bool of_sums = !mechanics.sums.empty();
    if (of_sums && wish.kind == Wish::newton)
      throw UsageError(
          "--solver newton: H is a function of sums over all elements, whose second derivatives "
          "are not made\nhelp: --solver fixed-point");
    if (wish.kind != Wish::fixed_point && !of_sums)
      arrays.matrix = choose_matrix(mechanics, member, arrays.reduced, eigen);
    if (wish.kind == Wish::newton && !arrays.matrix)
      throw UsageError(
          fmt::format("--solver newton: a matrix of {} rows like this one is eliminated by Eigen, "
                      "which does not know quad numbers\nhelp: --solver fixed-point",
                      (arrays.reduced ? 1 : 2) * n));
    if (!arrays.matrix) {
      arrays.method = ArrayMethod::fixed_point;
    } else {
      arrays.constant_matrix = has_constant_matrix(mechanics, member);
      arrays.matrix_work = matrix_work(kernels_of_matrix(mechanics, member), *arrays.matrix,
                                       arrays.reduced, numbers);
      const bool either = wish.kind == Wish::cheapest && !arrays.constant_matrix;
      if (either && arrays.matrix_work > 1) arrays.method = ArrayMethod::both;
    }
  }
  plan.arrays = arrays;
  plan.solver = solver_text(plan, n);
  if (member.beta.is_zero()) plan.left_out.emplace_back("beta terms: beta = 0");
  if (member.gamma.is_zero()) plan.left_out.emplace_back("gamma terms: gamma = 0");
  plan.left_out.push_back(
      fmt::format("expansion of the sums: {} degrees of freedom stay loops", n));
  if (!mechanics.sums.empty() && arrays.method == ArrayMethod::fixed_point)
    plan.left_out.emplace_back("Newton's matrix: H is a function of sums over all elements");
  if (arrays.matrix && !uses_eigen(arrays)) {
    plan.left_out.push_back(without_eigen(*arrays.matrix));
  }
  if (arrays.reduced) {
    plan.left_out.push_back(fmt::format("{} of the unknowns: torn out", n));
    if (arrays.mass) {
      plan.left_out.push_back("masses as an array: all are " + to_text(*arrays.mass));
    }
  }
  if (!iterates(arrays) && !plan.sweeps) {
    plan.left_out.emplace_back("equation solver: the step is explicit");
  }
  return plan;
}

}  // namespace hamgen
