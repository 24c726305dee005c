#include "runtime/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hamgen::runtime {
namespace {

using Column = std::vector<long double>;

long double dot(const Column& x, const Column& y) {
  long double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

long double length(const Column& x) { return std::sqrt(dot(x, x)); }

// The samples without their mean.
Column centred(const std::vector<double>& samples) {
  long double mean = 0;
  for (const double x : samples) mean += x;
  mean /= static_cast<long double>(samples.size());
  Column result;
  for (const double x : samples) result.push_back(x - mean);
  return result;
}

double spread(const Column& x) {
  const auto [low, high] = std::ranges::minmax(x);
  return static_cast<double>(high - low);
}

double deviation(const Column& x) {
  return static_cast<double>(length(x) / std::sqrt(static_cast<long double>(x.size())));
}

// What doubles know of a function: less than this part of it, left after others, is rounding.
constexpr long double kRounding = 1e-11L;

}  // namespace

Flattening flatten(const std::vector<double>& target,
                   const std::vector<std::vector<double>>& functions) {
  if (target.empty()) throw std::invalid_argument("no samples to flatten");
  const std::size_t count = functions.size();
  std::vector<Column> columns;
  std::vector<long double> sizes;
  for (const std::vector<double>& function : functions) {
    if (function.size() != target.size()) throw std::invalid_argument("samples are missing");
    columns.push_back(centred(function));
    sizes.push_back(length(Column(function.begin(), function.end())));
  }
  Column rest = centred(target);
  Flattening result{.coefficients = std::vector<double>(count)};
  result.spread_before = spread(rest);
  result.deviation_before = deviation(rest);

  // Columns Q R of the functions in the order of `order`; R is kept by place of the function.
  std::vector<std::size_t> order;
  std::vector<std::vector<long double>> upper(count);  // upper[k][j] = q_j . f_k
  std::vector<bool> used(count, false);
  std::vector<long double> projections;  // q_j . (-target)
  const bool is_flat = length(rest) <= kRounding * length(Column(target.begin(), target.end()));
  while (order.size() < count && !is_flat) {
    std::size_t best = count;
    long double largest = kRounding;
    for (std::size_t k = 0; k < count; ++k) {
      if (used[k] || sizes[k] == 0) continue;
      const long double part = length(columns[k]) / sizes[k];
      if (part > largest) {
        largest = part;
        best = k;
      }
    }
    if (best == count) break;
    used[best] = true;
    order.push_back(best);
    Column q = columns[best];
    const long double norm = length(q);
    for (long double& x : q) x /= norm;
    upper[best].push_back(norm);
    const auto subtract = [&q](Column& from) {
      const long double part = dot(q, from);
      for (std::size_t i = 0; i < q.size(); ++i) from[i] -= part * q[i];
      return part;
    };
    for (std::size_t k = 0; k < count; ++k) {
      if (!used[k]) upper[k].push_back(subtract(columns[k]));
    }
    projections.push_back(-subtract(rest));
  }
  result.rank = order.size();
  std::vector<long double> x(count);
  for (std::size_t j = order.size(); j-- > 0;) {
    long double value = projections[j];
    for (std::size_t l = j + 1; l < order.size(); ++l) value -= upper[order[l]][j] * x[order[l]];
    x[order[j]] = value / upper[order[j]][j];
    result.coefficients[order[j]] = static_cast<double>(x[order[j]]);
  }
  result.spread_after = spread(rest);
  result.deviation_after = deviation(rest);
  return result;
}

}  // namespace hamgen::runtime
