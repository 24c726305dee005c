// What there is in lanes, and what is refused.
#include "generator/formats/use_lanes.hpp"

#include <fmt/format.h>

#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

void refuse_lanes(const EmitOptions& options, std::string_view what) {
  if (options.lanes == 0) return;
  throw UsageError(
      fmt::format("--batch: {} has no lanes\nhelp: --format cpp-header or cmake-package", what));
}

void require_lanes(const EmitOptions& options) {
  if (find_scalar(options.scalar).digits != 53) {
    throw UsageError("--batch: lanes are of double numbers\nhelp: drop --scalar");
  }
  if (options.shared_support) {
    throw UsageError("--batch: its fixed parts are in the header itself\nhelp: drop --support");
  }
  if (options.tangent) {
    throw UsageError("--batch: there is no tangent map in lanes\nhelp: drop --tangent");
  }
}

}  // namespace hamgen
