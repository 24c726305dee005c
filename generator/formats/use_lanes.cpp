// What there is in lanes, and what is refused.
#include "generator/formats/use_lanes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// What there are no blocks for in lanes.
std::string without_lanes(const Instruction& instruction) {
  const auto& value = instruction.value;
  const auto* iterate = std::get_if<Iterate>(&value);
  const bool fixed_point = iterate != nullptr && iterate->rule != Rule::newton;
  if (fixed_point || std::holds_alternative<Refine>(value) ||
      std::holds_alternative<RefineArray>(value) || std::holds_alternative<Alternate>(value)) {
    return "a fixed-point iteration";
  }
  if (std::holds_alternative<IterateArray>(value)) return "an iteration of arrays";
  return std::holds_alternative<Invert>(value) ? "the inverse of a matrix" : "";
}

}  // namespace

void refuse_lanes(const EmitOptions& options, std::string_view what) {
  if (options.lanes == 0) return;
  throw UsageError(
      fmt::format("--batch: {} has no lanes\nhelp: --format cpp-header or cmake-package", what));
}

void require_lanes(const Program& program, const EmitOptions& options) {
  if (find_scalar(options.scalar).digits != 53) {
    throw UsageError("--batch: lanes are of double numbers\nhelp: drop --scalar");
  }
  if (options.shared_support) {
    throw UsageError("--batch: its fixed parts are in the header itself\nhelp: drop --support");
  }
  if (options.tangent) {
    throw UsageError("--batch: there is no tangent map in lanes\nhelp: drop --tangent");
  }
  std::set<std::string> needed = callees(program, "prepare");
  needed.merge(callees(program, "solve"));
  for (const std::string& name : needed) {
    const std::string found = find_in(program.routine(name)->body, without_lanes);
    if (found.empty()) continue;
    throw UsageError(
        fmt::format("--batch: {0} has {1} in its step, and there is none in lanes\n"
                    "help: what there is are explicit steps, as --scheme stormer-verlet, and "
                    "Newton's iteration "
                    "of members and their compositions for small systems: --solver newton",
                    program.facts.scheme, found));
  }
}

}  // namespace hamgen
