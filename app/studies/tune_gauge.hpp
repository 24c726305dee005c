// Constant beta and gamma of one shape, as numbers and as the command line takes them.
#pragma once

#include <string>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen::app {

enum class GaugeForm { scalar, diagonal, matrix };

// beta = h B and gamma = h G with constant B and G: first the coefficients of B, then as many of G.
struct GaugeShape {
  GaugeForm form = GaugeForm::scalar;
  int n = 1;  // degrees of freedom

  [[nodiscard]] std::size_t block_size()
      const;  // 1, n, or n (n + 1)/2 by rows from the diagonal on
  [[nodiscard]] std::size_t size() const { return 2 * block_size(); }
};

using SquareMatrix = std::vector<std::vector<double>>;

// B (or G) of the coefficients, n x n.
[[nodiscard]] SquareMatrix block_of(const GaugeShape& shape,
                                    const std::vector<double>& coefficients, bool is_gamma);

// The same B and G in a wider form, one that contains `from`.
[[nodiscard]] std::vector<double> widened(const GaugeShape& from,
                                          const std::vector<double>& coefficients,
                                          const GaugeShape& to);

// The functions of the energy's h^2 term that the coefficients multiply, at a state with this
// gradient (H_q, then H_p): (1/2) grad H^T C1 J grad H = (1/2) (H_q^T G H_q - H_p^T B H_p).
[[nodiscard]] std::vector<double> energy_terms(const GaugeShape& shape,
                                               const std::vector<double>& gradient);

// "2*h", "1*h,2*h" or "[[1*h, 2*h], [2*h, 3*h]]" of the coefficients as texts (numbers or names).
struct GaugeTexts {
  std::string beta, gamma;
};
[[nodiscard]] GaugeTexts gauge_texts(const GaugeShape& shape,
                                     const std::vector<std::string>& coefficients);
[[nodiscard]] std::vector<std::string> number_texts(const std::vector<double>& coefficients);

}  // namespace hamgen::app
