#include "generator/solvers/all_solvers.hpp"

#include <array>

namespace hamgen {

namespace {

constexpr std::array kSolvers = {
    NamedSolver{"newton", "to round-off, with the generated Hessian (the default where needed)"},
    NamedSolver{"fixed-point", "iterates to stagnation with a second chance; no Hessian"},
    NamedSolver{"sweeps:K", "K sweeps from an Euler predictor, the paper's Algorithm 1"},
};

}  // namespace

std::span<const NamedSolver> all_solvers() { return kSolvers; }

}  // namespace hamgen
