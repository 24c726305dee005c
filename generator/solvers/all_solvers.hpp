// THE LIST of ways to solve the implicit step that a user can ask for.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/base/asked.hpp"

namespace hamgen {

// A fixed block: when a fixed point ends, if nobody says otherwise.
inline constexpr std::string_view kFixedPointRule = "FixedPointRule<2>";

// How the equations of a step are to be solved.
struct SolverWish {
  enum class Kind { cheapest, newton, fixed_point, sweeps };
  Kind kind = Kind::cheapest;
  int sweeps = 0;                           // of the paper's Algorithm 1
  std::string_view rule = kFixedPointRule;  // of a fixed point with nothing else behind it

  // Throws UsageError for what is not in the list.
  [[nodiscard]] static SolverWish read(const std::string& text);
  bool operator==(const SolverWish&) const = default;
};
using SolverChoice = Asked<SolverWish>;

struct NamedSolver {
  std::string_view name;         // "newton", "fixed-point", "sweeps:K"
  std::string_view description;  // one line
  // What the name asks for; `argument` is what stands behind its colon.
  SolverWish (*wish)(const std::string& argument);
};

[[nodiscard]] std::span<const NamedSolver> all_solvers();

}  // namespace hamgen
