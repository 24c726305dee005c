// What is proved of a step, property by property.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/solvers/solve_plan.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/sample_points.hpp"
#include "generator/verify/verdict.hpp"

namespace hamgen {

// The same model and method with another value of its size.
struct SizedSystem {
  long size = 0;
  Mechanics mechanics;
  Scheme scheme;
  SolvePlan plan;
  Program program;
  Expression hamiltonian;    // written out
  Finding read = {};         // what is known of the model's text at this size
  Surroundings around = {};  // of its scenes
};
// Of a large system, what it is a longer one of.
struct SmallerSystems {
  std::string constant;  // "N"
  long size = 0;         // of the large one
  SizedSystem first, second;
  std::optional<SizedSystem> third = {};  // where there are sums over pairs
};
// Up to so many degrees of freedom every element of a system in loops is looked at.
inline constexpr int kMostLookedAt = 32;
// Beyond, nothing is said of the invariants of a system in loops.
inline constexpr int kMostBracketed = 64;
// With more instances of its loops a system is not written out to be looked at.
inline constexpr long kMostInstances = 30'000;
[[nodiscard]] long instances_of_loops(const Mechanics& mechanics);

// Everything that can be decided by algebra about the scheme's step for this system, and about the
// program that computes it.  `hamiltonian` is H with its sums written out; it may be left out where
// the claims about the smaller systems are inherited and there are no invariants.
// Claims are tried `around` the places where the model is used.
[[nodiscard]] Proof verify(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan,
                           const Program& program, const std::optional<Expression>& hamiltonian,
                           const Surroundings& around = {},
                           const std::optional<SmallerSystems>& smaller = {});
// "N = 25 and N = 26"
[[nodiscard]] std::string sizes_text(const SmallerSystems& smaller);
// Do two indices of a sum run over elements?
[[nodiscard]] bool sums_over_pairs(const Mechanics& mechanics);
// How many elements a system has at least of which the order of a K in loops is shown: the flow of
// H carries every element to others, as many times as the order is, and K knows neighbours itself.
// 0 where there is no such K.
[[nodiscard]] long least_size_of_order(const StepEquations& equations);
// Why the claims about the smaller systems are not those about this one; empty if they are.
[[nodiscard]] std::optional<std::string> why_not_inherited(const Mechanics& mechanics,
                                                           const SolvePlan& plan,
                                                           const Program& program,
                                                           const SmallerSystems& smaller);

// How long the smaller systems have to be for what the loops reach; 0 where that is not known.
[[nodiscard]] long least_size_of_loops(const Mechanics& mechanics, const SolvePlan& plan,
                                       const Program& program, const SmallerSystems& smaller);

inline constexpr const char* kGauge = "gauge in sp(2n)";
// The routines before they are text, the text read back, and that of what `hamgen run` compiles.
inline constexpr const char* kProgram = "program";
inline constexpr const char* kEmittedCode = "emitted code";
inline constexpr const char* kPlugin = "plugin";

// The single proofs.  A member must satisfy C J + J C^T = 0; the residual entries are exact.
[[nodiscard]] Finding prove_gauge(const Member& member, const Surroundings& around = {});
// A+ J A+^T = A- J A-^T with a generic symmetric S of symbols, entry by entry, on the first
// min(n, 3) degrees of freedom; beyond, by the factorisation of the difference.
[[nodiscard]] Finding prove_step_symplectic(const Member& member, int degrees_of_freedom,
                                            const Surroundings& around = {});
[[nodiscard]] Finding prove_symmetric(const Member& member, const Surroundings& around = {});
[[nodiscard]] Finding prove_order(const Member& member, const Surroundings& around = {});
// The order of a K is what its flow shows: no better known than by points.
[[nodiscard]] Finding prove_raised_order(const GeneratingFunction& function, const Decision& of_k);
// A fixed number of sweeps in place of the solution, symplectic and symmetric: as the member, where
// they solve its equations; else the orders of M^T J M - J and of the way back by power series, of
// the step or of one that has these parts.
[[nodiscard]] Proof prove_swept(const Mechanics& mechanics, const Member& member, int sweeps,
                                const Surroundings& around = {},
                                const std::vector<Expression>& substeps = {Expression(1)});
// Splittings, compositions, tableaus: symplectic, symmetric, and their order found by formal
// series, which are looked at up to order + 1.  `nystrom`: T is quadratic in p.
[[nodiscard]] Proof prove_splitting(const Splitting& splitting, int order, bool nystrom);
[[nodiscard]] Finding prove_shears(const Splitting& splitting);
[[nodiscard]] Proof prove_composition(const Composition& composition, int degrees_of_freedom,
                                      int order, const Surroundings& around = {});
[[nodiscard]] Proof prove_tableau(const RungeKutta& tableau, int order);
// {I, H} = 0, and whether the scheme conserves I exactly, which is known no better.  `hamiltonian`
// is H written out; `solved`: no equations are left over by sweeps; `symplectic` is the verdict.
[[nodiscard]] Proof prove_invariants(const Mechanics& mechanics, const Expression& hamiltonian,
                                     const Scheme& scheme, bool solved, Verdict symplectic,
                                     const Surroundings& around = {});
[[nodiscard]] bool says_nothing_of_invariants(const Mechanics& mechanics);
// The routines of the program, as they are printed and interpreted, are the step's equations, their
// derivatives, their solution and H.  `of_k` is what `decide_function` says of the K that
// stands in for H, which is asked here if it is left out.  Of a system in loops of more than
// kMostLookedAt degrees of freedom the claims are made about the `smaller` ones.
[[nodiscard]] Finding prove_emitted(const Mechanics& mechanics, const Scheme& scheme,
                                    const SolvePlan& plan, const Program& program,
                                    const std::optional<Expression>& hamiltonian,
                                    const Surroundings& around = {},
                                    std::optional<Decision> of_k = {},
                                    const std::optional<SmallerSystems>& smaller = {});

}  // namespace hamgen
