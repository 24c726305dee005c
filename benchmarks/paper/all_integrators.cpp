// What 5 i says of all implicit symplectic integrators, by counting dimensions.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

using Matrix = std::vector<std::vector<double>>;

std::size_t rank_of(Matrix m) {
  std::size_t rank = 0;
  for (std::size_t column = 0; column < m.front().size() && rank < m.size(); ++column) {
    std::size_t pivot = rank;
    for (std::size_t i = rank + 1; i < m.size(); ++i) {
      if (std::fabs(m[i][column]) > std::fabs(m[pivot][column])) pivot = i;
    }
    if (std::fabs(m[pivot][column]) < 1e-9) continue;
    std::swap(m[pivot], m[rank]);
    for (std::size_t i = rank + 1; i < m.size(); ++i) {
      const double factor = m[i][column] / m[rank][column];
      for (std::size_t k = column; k < m[i].size(); ++k) m[i][k] -= factor * m[rank][k];
    }
    ++rank;
  }
  return rank;
}

// J_ij for n degrees of freedom, q first.
double j(std::size_t n, std::size_t row, std::size_t column) {
  if (column == row + n) return 1.0;
  return row == column + n ? -1.0 : 0.0;
}

// The dimension of the matrices C of size 2n with C J + J C^T = 0, from the rank of that map.
std::size_t dimension(std::size_t n) {
  const std::size_t size = 2 * n;
  Matrix map;  // a row an entry C_ab: the image of that unit matrix
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < size; ++b) {
      std::vector<double> image(size * size, 0.0);
      for (std::size_t k = 0; k < size; ++k) {
        image[a * size + k] += j(n, b, k);
        image[k * size + a] += j(n, k, b);
      }
      map.push_back(std::move(image));
    }
  }
  return size * size - rank_of(map);
}

}  // namespace

Section all_integrators(const Study& /*study*/) {
  Section section{.title = "All implicit integrators"};
  Table table{.header = {"degrees of freedom n", "matrices C with C J + J C^T = 0", "n (2n + 1)",
                         "the paper's 3n"}};
  constexpr std::array<std::size_t, 4> sizes = {1, 2, 3, 4};
  bool all = true;
  bool first = false;
  for (const std::size_t n : sizes) {
    const std::size_t found = dimension(n);
    table.rows.push_back({fmt::format("{}", n), fmt::format("{}", found),
                          fmt::format("{}", n * (2 * n + 1)), fmt::format("{}", 3 * n)});
    all &= found == 3 * n;
    if (n == 1) first = found == 3;
  }
  section.claims = {
      {"5 i",
       "alpha, beta, gamma, 3n parameters, give all possible implicit symplectic integrators "
       "through "
       "z and Z that are consistent with the projection",
       fmt::format("{} one degree of freedom. For n = 2 the symplectic ones of this form have {} "
                   "parameters, for n = 3 {} (table): what is missing couples degrees of freedom",
                   first ? "true for" : "not even for", dimension(2), dimension(3)),
       verdict(all)}};
  section.body = {
      "The step Z = z + h J grad H((z + Z)/2 + C (Z - z)) is symplectic for every H if and only if "
      "C J + J C^T = 0, that is C = [[A, B], [D, -A^T]] with B and D symmetric. In the paper's "
      "members "
      "A, B and D are diagonal. hamgen takes whole matrices: `--beta '[[a, b], [b, c]]'`.",
      to_markdown(table)};
  section.numbers = {{"dimension_1", static_cast<double>(dimension(1))},
                     {"dimension_2", static_cast<double>(dimension(2))}};
  return section;
}

}  // namespace hamgen::paper
