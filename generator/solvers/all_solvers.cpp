#include "generator/solvers/all_solvers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

SolverWish newton(const std::string&) { return {.kind = SolverWish::Kind::newton}; }

SolverWish fixed_point(const std::string&) { return {.kind = SolverWish::Kind::fixed_point}; }

SolverWish sweeps(const std::string& digits) {
  constexpr int most = 1000;
  SolverWish wish{.kind = SolverWish::Kind::sweeps};
  const char* last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, wish.sweeps);
  if (error != std::errc{} || end != last || wish.sweeps < 0 || wish.sweeps > most) {
    throw UsageError(fmt::format(
        "--solver sweeps:{}: K in sweeps:K must be an integer from 0 to {}", digits, most));
  }
  return wish;
}

constexpr std::array kSolvers = {
    NamedSolver{"newton", "to round-off, with the generated Hessian (the default where needed)",
                newton},
    NamedSolver{"fixed-point", "iterates to stagnation with a second chance; no Hessian",
                fixed_point},
    NamedSolver{"sweeps:K", "K sweeps from an Euler predictor, the paper's Algorithm 1", sweeps},
};

// "sweeps:" of "sweeps:K".
std::string_view before_argument(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon == std::string_view::npos ? text : text.substr(0, colon + 1);
}

}  // namespace

std::span<const NamedSolver> all_solvers() { return kSolvers; }

SolverWish SolverWish::read(const std::string& text) {
  if (text.empty()) return {};
  std::string names;
  for (const NamedSolver& solver : kSolvers) {
    const std::string_view name = before_argument(solver.name);
    if (before_argument(text) == name) return solver.wish(text.substr(name.size()));
    names += fmt::format("{}{}", names.empty() ? "" : ", ", solver.name);
  }
  throw UsageError(fmt::format("unknown solver '{}'; there are {}", text, names));
}

}  // namespace hamgen
