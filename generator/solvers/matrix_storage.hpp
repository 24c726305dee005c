// How the matrix of a system in loops is stored and eliminated.
#pragma once

#include <algorithm>
#include <vector>

namespace hamgen {

enum class MatrixKind {
  band,         // elimination within the band, and of a border around it
  dense,        // elimination of all of it
  eigen_dense,  // the same by Eigen where it is large
  eigen_sparse
};
// Unknowns of a border: the planner takes no more, and the interpreter has room for these.
inline constexpr int kWidestBorder = 8;
struct ArrayMatrix {
  MatrixKind kind = MatrixKind::eigen_sparse;
  int size = 0;
  // A band has entries only this near to its diagonal, with the unknowns in this order: of `arrays`
  // arrays of equal length first the first elements, then the second ones; of a ring folded flat
  // the first, the last, the second, the last but one, ...
  int bandwidth = 0;
  int arrays = 1;
  bool folded = false;
  int alone = 0;  // behind the arrays so many have no neighbours, and stay there
  // Ascending: unknowns that meet many others.  They stand behind all others, outside of the band.
  std::vector<int> border = {};
  bool symmetric = false;  // a band, whatever the state
  // Of trajectories in lanes: it is eliminated without Eigen; does it serve over many steps?
  bool in_lanes = false;
  bool kept = false;
  [[nodiscard]] int rows_of_border() const { return static_cast<int>(border.size()); }
  [[nodiscard]] int inside() const { return size - rows_of_border(); }
  [[nodiscard]] bool in_natural_order() const {
    return arrays == 1 && !folded && (border.empty() || border.front() == inside());
  }
  [[nodiscard]] int length() const { return (inside() - alone) / arrays; }  // of each array
  [[nodiscard]] bool is_in_border(int unknown) const {
    return std::ranges::binary_search(border, unknown);
  }
  // Where this unknown stands.
  [[nodiscard]] int row(int unknown) const {
    const auto next = std::ranges::lower_bound(border, unknown);
    const auto before = static_cast<int>(next - border.begin());
    if (next != border.end() && *next == unknown) return inside() + before;
    return row_inside(unknown - before);
  }
  // Of one that is in no border, counted without those that are.
  [[nodiscard]] int row_inside(int unknown) const {
    const int length = this->length();
    if (unknown >= arrays * length) return unknown;
    const int element = unknown % length;
    const bool second_half = 2 * element >= length;
    const int place = !folded       ? element
                      : second_half ? 2 * (length - 1 - element) + 1
                                    : 2 * element;
    return place * arrays + unknown / length;
  }
  [[nodiscard]] std::vector<int> rows() const {
    std::vector<int> result;
    for (int i = 0; i < size; ++i) result.push_back(row(i));
    return result;
  }
};

}  // namespace hamgen
