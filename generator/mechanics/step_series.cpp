#include "generator/mechanics/step_series.hpp"

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

bool has_corner(const Expression& e) {
  if (!depends_on(e, "h")) return false;
  if (std::ranges::any_of(e.operands(), has_corner)) return true;
  // h log(h) vanishes with h, but has no derivative there.
  const bool has_singularity =
      e.kind() == Kind::function && (e.name() == "abs" || e.name() == "log");
  const bool is_root = (e.kind() == Kind::function && e.name() == "sqrt") ||
                       (e.kind() == Kind::power &&
                        !(e.operands()[1].is_number() && e.operands()[1].number().get_den() == 1));
  if (!has_singularity && !is_root) return false;
  const auto inside = step_series(e.operands()[0], 1);
  return !inside || vanishes(inside->front());
}

std::optional<std::vector<Expression>> step_series(const Expression& e, int count) {
  if (has_corner(e)) return std::nullopt;
  SymbolTable table;
  const GiNaC::ex h = table.symbol("h", kRankOfStep);
  try {
    const GiNaC::ex series = to_ginac(e, table).series(h == 0, count);
    if (series.ldegree(h) < 0) return std::nullopt;
    std::vector<Expression> coefficients;
    for (int l = 0; l < count; ++l) {
      coefficients.push_back(from_ginac(series.coeff(h, l), table));
      if (depends_on(coefficients.back(), "h")) return std::nullopt;  // log(h)
    }
    return coefficients;
  } catch (const std::exception&) {  // an essential singularity, such as sqrt(h) has
    return std::nullopt;
  }
}

}  // namespace hamgen
