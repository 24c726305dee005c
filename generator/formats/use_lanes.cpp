// What there is in lanes, and what is refused.
#include "generator/formats/use_lanes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

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
  if (program.matrix && program.matrix->kind == MatrixKind::eigen_sparse) {
    throw UsageError(
        fmt::format("--batch: the matrix of {} unknowns is sparse and not a band: Eigen eliminates "
                    "it, with other bits by the instructions it has\n"
                    "help: --solver fixed-point, where that converges, or --scheme stormer-verlet",
                    program.matrix->size));
  }
}

}  // namespace hamgen
