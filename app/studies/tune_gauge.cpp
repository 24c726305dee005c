#include "app/studies/tune_gauge.hpp"

#include <fmt/format.h>

#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

std::size_t number_of(const GaugeShape& shape) { return static_cast<std::size_t>(shape.n); }

std::string times_h(const std::string& text) { return text == "0" ? text : text + "*h"; }

// The place of entry (i, j), i <= j, of a symmetric matrix kept by rows from the diagonal on.
std::size_t symmetric_place(std::size_t n, std::size_t i, std::size_t j) {
  return i * n - i * (i + 1) / 2 + j;
}

std::string block_text(const GaugeShape& shape, const std::string* entries) {
  const std::size_t n = number_of(shape);
  std::vector<std::string> pieces;
  switch (shape.form) {
    case GaugeForm::scalar:
      return times_h(entries[0]);
    case GaugeForm::diagonal:
      for (std::size_t i = 0; i < n; ++i) pieces.push_back(times_h(entries[i]));
      return fmt::format("{}", fmt::join(pieces, ","));
    case GaugeForm::matrix:
      break;
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row;
    for (std::size_t j = 0; j < n; ++j)
      row.push_back(times_h(entries[symmetric_place(n, std::min(i, j), std::max(i, j))]));
    pieces.push_back(fmt::format("[{}]", fmt::join(row, ", ")));
  }
  return fmt::format("[{}]", fmt::join(pieces, ", "));
}

}  // namespace

std::size_t GaugeShape::block_size() const {
  const auto count = static_cast<std::size_t>(n);
  switch (form) {
    case GaugeForm::scalar:
      return 1;
    case GaugeForm::diagonal:
      return count;
    case GaugeForm::matrix:
      break;
  }
  return count * (count + 1) / 2;
}

SquareMatrix block_of(const GaugeShape& shape, const std::vector<double>& coefficients,
                      bool is_gamma) {
  const std::size_t n = number_of(shape);
  const double* entries = coefficients.data() + (is_gamma ? shape.block_size() : 0);
  SquareMatrix block(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      double value = 0.0;
      if (shape.form == GaugeForm::matrix) value = entries[symmetric_place(n, i, j)];
      if (shape.form != GaugeForm::matrix && i == j)
        value = entries[shape.form == GaugeForm::scalar ? 0 : i];
      block[i][j] = value;
      block[j][i] = value;
    }
  }
  return block;
}

std::vector<double> widened(const GaugeShape& from, const std::vector<double>& coefficients,
                            const GaugeShape& to) {
  std::vector<double> result;
  for (const bool is_gamma : {false, true}) {
    const SquareMatrix block = block_of(from, coefficients, is_gamma);
    const std::size_t n = to.form == GaugeForm::scalar ? 1 : block.size();
    for (std::size_t i = 0; i < n; ++i) {
      result.push_back(block[i][i]);
      if (to.form != GaugeForm::matrix) continue;
      result.insert(result.end(), block[i].begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    block[i].end());
    }
  }
  return result;
}

std::vector<double> energy_terms(const GaugeShape& shape, const std::vector<double>& gradient) {
  const std::size_t n = number_of(shape);
  const std::size_t block = shape.block_size();
  std::vector<double> terms(shape.size(), 0.0);
  const auto product = [&](std::size_t half, std::size_t i, std::size_t j) {
    return gradient[half * n + i] * gradient[half * n + j];
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      if (shape.form != GaugeForm::matrix && i != j) continue;
      std::size_t place = shape.form == GaugeForm::scalar ? 0 : i;
      if (shape.form == GaugeForm::matrix) place = symmetric_place(n, i, j);
      const double factor = i == j ? 0.5 : 1.0;
      terms[place] -= factor * product(1, i, j);
      terms[block + place] += factor * product(0, i, j);
    }
  }
  return terms;
}

GaugeTexts gauge_texts(const GaugeShape& shape, const std::vector<std::string>& coefficients) {
  return {.beta = block_text(shape, coefficients.data()),
          .gamma = block_text(shape, coefficients.data() + shape.block_size())};
}

std::vector<std::string> number_texts(const std::vector<double>& coefficients) {
  std::vector<std::string> texts;
  for (const double x : coefficients) texts.push_back(runtime::number_text(x));
  return texts;
}

}  // namespace hamgen::app
