#include "generator/solvers/cost.hpp"

#include <algorithm>

#include "generator/mechanics/operation_count.hpp"

namespace hamgen {

namespace {

// By a half an iteration it would have come as far as the rule asks for; where q and p move each
// other, by a half in two of them.
constexpr int kMostWork = 13;
// An unknown's part in the equations besides the gradient: its momentum, what it lacks, its sums.
constexpr double kOfUnknown = 10;
// In operations, what is no such one.
struct Prices {
  long function;
  double band_row, symmetric_row;
};
// A sine takes 11 ns where 30 operations in lanes, or some of them, take 2 to 15.  A row of a band
// waits for the row before it: its division, and the choice of a pivot; without the pivot, and with
// half of the products, 12 ns for 26 of a width of 1, 49 for 59 of 8.
constexpr Prices kOfProcessor{.function = 30, .band_row = 100, .symmetric_row = 45};
// Of a library, where each operation takes some 30 ns, nothing waits for another.
constexpr Prices kOfLibrary{.function = 50, .band_row = 10, .symmetric_row = 10};
// A row of Eigen's sparse matrix, whose entries are sorted and whose fill-in is looked up.
constexpr double kOfSparseRow = 20000;

struct Counts {
  double gradient = 0;
  double hessian = 0;
};

Counts count(const std::vector<Kernel>& kernels, long function) {
  Counts counts;
  for (const Kernel& kernel : kernels) {
    double instances = 0;
    for_each_instance(kernel.ranges, [&](const std::vector<long>&) { ++instances; });
    const std::set<std::string> varying = varying_symbols(kernel);
    std::vector<Expression> second;
    for (const auto& [slots, value] : kernel.hessian) second.push_back(value);
    const auto slots = static_cast<double>(kernel.slots.size());
    const auto entries = static_cast<double>(second.size());
    counts.gradient +=
        instances *
        (static_cast<double>(operation_count(kernel.gradient, varying, function)) + slots);
    counts.hessian +=
        instances * (static_cast<double>(operation_count(second, varying, function)) + entries);
  }
  return counts;
}

double elimination(const ArrayMatrix& matrix, const Prices& prices) {
  const double size = matrix.size;
  const double width = matrix.bandwidth;
  switch (matrix.kind) {
    case MatrixKind::band: {
      // For each column of the border the band is solved, and multiplied by each of its rows.
      const auto border = static_cast<double>(matrix.border.size());
      const double around = border * size * (6 * width + 2 + 2 * border);
      return around + (matrix.symmetric ? size * (prices.symmetric_row + 3 * width * width)
                                        : size * (prices.band_row + 6 * width * width));
    }
    case MatrixKind::dense:
    case MatrixKind::eigen_dense:
      return 2 * size * size * size / 3;
    case MatrixKind::eigen_sparse:
      return size * kOfSparseRow;
  }
  return 0;
}

}  // namespace

int matrix_work(const std::vector<Kernel>& kernels, const ArrayMatrix& matrix, bool reduced,
                NumbersOf numbers) {
  const Prices& prices = numbers == NumbersOf::processor ? kOfProcessor : kOfLibrary;
  const Counts counts = count(kernels, prices.function);
  const double evaluation = counts.gradient + kOfUnknown * matrix.size;
  const double work = (counts.hessian + elimination(matrix, prices)) / evaluation;
  const double most = reduced ? kMostWork : 2 * kMostWork;
  return static_cast<int>(std::clamp(work + 0.5, 1.0, most));
}

}  // namespace hamgen
