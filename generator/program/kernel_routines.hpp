// The functions of a system whose sums stay loops, each a loop over the instances of every kernel:
//   energy(par, z)
//   potential_gradient(par, q, dq), kinetic_gradient(par, p, dp), gradient(par, q, p, dq, dp)
//   masses(par, dp)                  d2H/dp_i^2, which is constant
// and what somebody does with the entries of the Hessian, one after the other.
#pragma once

#include <functional>
#include <string>

#include "generator/program/environment.hpp"
#include "generator/program/stage_layout.hpp"

namespace hamgen {

// Which kernels a function sums, by what they read.
enum class Part { all, potential, kinetic };

// What is said of the routine `energy`.
[[nodiscard]] inline std::string energy_remark(const Mechanics& mechanics) {
  return mechanics.has_time ? "H(q, p, t) + p_t, which is constant where H(q, p, t) is not."
                            : "H(q, p).";
}
[[nodiscard]] Routine kernel_energy(const Environment& environment, const Mechanics& mechanics);
[[nodiscard]] Routine kernel_gradient(const Environment& environment, const Mechanics& mechanics,
                                      std::string name, Part part, bool in_parts);
// generating_gradient(par, h, q, p, dq, dp), of the mechanics that has K in its kernels.
[[nodiscard]] Routine kernel_generating_gradient(const Environment& environment,
                                                 const Mechanics& mechanics);
// Of a separable H: the two one after the other.
[[nodiscard]] Routine both_gradients(const Environment& environment);
// potential_gradients(par, q, dq) and the like: the routine, of arrays alone, at all stages in
// arrays of such a layout.
[[nodiscard]] Routine at_stages(Routine routine, const StageLayout& layout);
// vector_fields(par, z, values), or with the forces alone: by those, with the sign of J.
[[nodiscard]] Routine array_vector_fields(const StageLayout& layout, bool separable);
[[nodiscard]] Routine array_forces(const StageLayout& layout);
// vector_field(par, x, f): J grad H at the state as one array.
[[nodiscard]] Routine array_vector_field(const Environment& environment);
[[nodiscard]] Routine kernel_masses(const Environment& environment, const Mechanics& mechanics);

// q_index or p_index.
struct StateElement {
  bool is_momentum = false;
  AffineIndex index;
};
// d2H / d row d column; repeated entries are to be added.
struct HessianEntry {
  StateElement row, column;
  Expression value;
};
// Adds instructions to the body, which is one of the routine.
using UseEntry = std::function<void(Routine&, Body&, const HessianEntry&)>;
// Goes on in the routine `begun` with all entries at the state that has its arrays at q and p, with
// an index for their first elements.
[[nodiscard]] Routine kernel_entries(const Environment& environment, const Mechanics& mechanics,
                                     Part part, Routine begun, const Place& q, const Place& p,
                                     const UseEntry& use);

// hessian(par, x, values) of the state as one array, added to values.
[[nodiscard]] Routine array_hessian(const Environment& environment, const Mechanics& mechanics);

}  // namespace hamgen
