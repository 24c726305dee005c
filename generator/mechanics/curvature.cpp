#include "generator/mechanics/curvature.hpp"

#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

std::vector<NamedExpression> energy_curvature(const Mechanics& mechanics) {
  if (mechanics.keeps_sums()) internal_error("the curvature of sums that stay loops");
  const int n = mechanics.degrees_of_freedom;
  // J grad H = (H_p, -H_q).
  const auto flow = [&](int i) {
    return i < n ? mechanics.gradient[static_cast<std::size_t>(n + i)]
                 : -mechanics.gradient[static_cast<std::size_t>(i - n)];
  };
  std::vector<Expression> terms;
  for (const auto& [place, value] : mechanics.hessian) {
    const auto [i, j] = place;
    terms.push_back(Expression(i == j ? 1 : 2) * value * flow(i) * flow(j));
  }
  std::vector<NamedExpression> result{{"energy_curvature", Expression::sum(std::move(terms))}};
  const auto add_block = [&](const char* name, int row, int column) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        result.push_back({fmt::format("energy_{}_{}_{}", name, i + 1, j + 1),
                          mechanics.second_derivative(row + i, column + j)});
      }
    }
  };
  add_block("qq", 0, 0);
  add_block("pp", n, n);
  add_block("qp", 0, n);
  return result;
}

}  // namespace hamgen
