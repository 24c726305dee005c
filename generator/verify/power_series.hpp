// Power series in h with coefficients of 60 digits, and expressions evaluated in them: what a step
// and a flow are compared with term by term.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "generator/verify/precise.hpp"

namespace hamgen {

// Coefficients of h^0, h^1, ...; those that are missing at the end are zero, so that a constant has
// one.
using PowerSeries = std::vector<Precise>;

[[nodiscard]] Precise coefficient(const PowerSeries& a, std::size_t k);
[[nodiscard]] PowerSeries operator+(const PowerSeries& a, const PowerSeries& b);
[[nodiscard]] PowerSeries operator-(const PowerSeries& a);
[[nodiscard]] PowerSeries operator-(const PowerSeries& a, const PowerSeries& b);
[[nodiscard]] PowerSeries operator*(const Precise& a, const PowerSeries& b);
// The product as far as h^(length - 1).
[[nodiscard]] PowerSeries product(const PowerSeries& a, const PowerSeries& b, std::size_t length);

// The values of expressions whose symbols are series, as far as h^(length - 1).  Empty where an
// expression has none: outside its domain, or at a pole.
class SeriesValues {
 public:
  SeriesValues(std::map<std::string, PowerSeries> symbols, std::size_t length)
      : symbols_(std::move(symbols)), length_(length) {}
  [[nodiscard]] std::optional<PowerSeries> operator()(const Expression& e);

 private:
  // Throws std::domain_error.
  const PowerSeries& value(const Expression& e);
  [[nodiscard]] PowerSeries computed(const Expression& e);
  [[nodiscard]] PowerSeries power_of(const PowerSeries& base, const Expression& exponent);

  std::map<std::string, PowerSeries> symbols_;
  std::size_t length_;
  std::unordered_map<const void*, PowerSeries> done_;  // by node
  std::vector<Expression> kept_;                       // alive, so that addresses stay keys
};

}  // namespace hamgen
