#include "generator/mechanics/step_series.hpp"

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

std::optional<std::vector<Expression>> step_series(const Expression& e, int count) {
  SymbolTable table;
  const GiNaC::ex h = table.symbol("h", kRankOfStep);
  try {
    const GiNaC::ex series = to_ginac(e, table).series(h == 0, count);
    if (series.ldegree(h) < 0) return std::nullopt;
    std::vector<Expression> coefficients;
    for (int l = 0; l < count; ++l) coefficients.push_back(from_ginac(series.coeff(h, l), table));
    return coefficients;
  } catch (const std::exception&) {  // an essential singularity, such as sqrt(h) has
    return std::nullopt;
  }
}

}  // namespace hamgen
