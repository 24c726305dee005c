#include "generator/solvers/array_matrix.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace hamgen {

namespace {

// Elimination within a band of width w costs 2 w^2 operations a row and a solve 5 w, Eigen's sparse
// one some microseconds and less than a tenth of one, and twenty seconds of compilation: measured
// of lattices, Newton's steps are as long at w = 75, those of a constant matrix at w = 28.
constexpr int kWidestBand = 64;
constexpr int kWidestConstantBand = 24;  // of a matrix that is eliminated once
// A dense matrix of this size is half a megabyte of the object that takes the steps.
constexpr int kLargestOwn = 256;
constexpr int kLargestDense = 1024;
// Up to here dense elimination takes less than 100 microseconds, whatever the pattern.
constexpr int kSmall = 64;
// Without Eigen a matrix has at most so many numbers, four megabytes of quad ones.
constexpr long kMostWithoutEigen = 512L * 512L;

// How many arrays of the same length the first `size` variables are, without those of a border; 1
// if they differ in length.
int equal_arrays(const Mechanics& mechanics, int size, const std::vector<int>& border) {
  std::vector<int> lengths;
  std::string last;
  for (const QuantityList::Run& run : mechanics.variables.runs()) {
    const auto begin = static_cast<int>(run.begin);
    const int end = std::min(size, begin + static_cast<int>(run.count));
    const auto left_out =
        std::ranges::count_if(border, [&](int i) { return begin <= i && i < end; });
    const int count = end - begin - static_cast<int>(left_out);
    if (count <= 0) continue;
    if (lengths.empty() || run.of.name != last) lengths.push_back(0);
    lengths.back() += count;
    last = run.of.name;
  }
  if (lengths.empty()) return 1;
  const bool equal = std::ranges::all_of(lengths, [&](int l) { return l == lengths.front(); });
  return equal ? static_cast<int>(lengths.size()) : 1;
}

// Calls use(row, column) for every place of the matrix that a loop fills, repeated ones too.
template <class Use>
void for_each_entry(const Mechanics& mechanics, const FamilyParameters& member, bool reduced,
                    const Use& use) {
  const int n = mechanics.degrees_of_freedom;
  const bool q_by_q = !member.gamma.is_zero();
  const bool q_by_p = !member.alpha.is_zero();
  const bool p_by_q = !member.alpha.is_one();
  const bool p_by_p = !member.beta.is_zero();
  // Row `row` of the Hessian enters the equations of qbar and pbar.
  auto use_row = [&](int row, int column) {
    if (reduced) return use(row, column);
    const bool by_q = row < n;
    const int i = by_q ? row : row - n;
    if (by_q ? q_by_q : q_by_p) use(i, column);
    if (by_q ? p_by_q : p_by_p) use(n + i, column);
  };
  for (const Kernel& kernel : kernels_of_matrix(mechanics, member)) {
    if (kernel.hessian.empty() || (reduced && uses_momenta(kernel))) continue;
    std::vector<int> at;
    for_each_instance(kernel.ranges, [&](const std::vector<long>& indices) {
      at.clear();
      for (const Slot& slot : kernel.slots) {
        at.push_back(static_cast<int>(value_at(slot.position, kernel.ranges, indices)));
      }
      for (const auto& [slots, value] : kernel.hessian) {
        use_row(at[slots.first], at[slots.second]);
        if (slots.first != slots.second) use_row(at[slots.second], at[slots.first]);
      }
    });
  }
}

// The narrowest of the orders of a band without these unknowns.
ArrayMatrix narrowest_band(const Mechanics& mechanics, const FamilyParameters& member, bool reduced,
                           std::vector<int> border) {
  const int size = (reduced ? 1 : 2) * mechanics.degrees_of_freedom;
  const int alone = reduced && knows_time(mechanics, member) ? 1 : 0;
  std::set<int> counts = {equal_arrays(mechanics, size - alone, border)};
  if (!reduced) counts.insert(2);  // coordinates and momenta
  counts.erase(1);
  // I + c m V'' is symmetric if m is the same for all that it has besides the unit.
  const bool symmetric =
      reduced && uniform_mass(mechanics, knows_time(mechanics, member)).has_value();
  std::vector<ArrayMatrix> orders{{.kind = MatrixKind::band,
                                   .size = size,
                                   .alone = alone,
                                   .border = std::move(border),
                                   .symmetric = symmetric}};
  const auto add_order = [&](int arrays, bool folded) {
    orders.push_back(orders.front());
    orders.back().arrays = arrays;
    orders.back().folded = folded;
  };
  add_order(1, true);
  for (const int arrays : counts) {
    add_order(arrays, false);
    add_order(arrays, true);
  }
  for_each_entry(mechanics, member, reduced, [&](int row, int column) {
    if (orders.front().is_in_border(row) || orders.front().is_in_border(column)) return;
    for (ArrayMatrix& order : orders) {
      order.bandwidth = std::max(order.bandwidth, std::abs(order.row(row) - order.row(column)));
    }
  });
  return *std::ranges::min_element(orders, {}, &ArrayMatrix::bandwidth);
}

// What stands in every summand of a sum meets all that this goes over, and so does its partner;
// with `single` also each variable that is in no array.
std::vector<int> met_by_many(const Mechanics& mechanics, const FamilyParameters& member,
                             bool reduced, bool single) {
  const int n = mechanics.degrees_of_freedom;
  std::set<int> found;
  // Of an element those of the other arrays too, which then still have one length.
  const auto add = [&](int i) {
    const std::vector<QuantityList::Run>& runs = mechanics.variables.runs();
    const QuantityList::Run* own = nullptr;
    for (const QuantityList::Run& run : runs) {
      if (static_cast<int>(run.begin) <= i % n) own = &run;
    }
    for (const QuantityList::Run& run : runs) {
      const int begin = static_cast<int>(run.begin);
      if (begin >= n || (&run != own && (run.count == 1 || run.count != own->count))) continue;
      const int each = begin + i % n - static_cast<int>(own->begin);
      found.insert(each);
      if (!reduced) found.insert(each + n);
    }
  };
  for (const Kernel& kernel : kernels_of_matrix(mechanics, member)) {
    if (kernel.ranges.empty() || (reduced && uses_momenta(kernel))) continue;
    for (const auto& [slots, value] : kernel.hessian) {
      for (const std::size_t s : {slots.first, slots.second}) {
        const Slot& slot = kernel.slots[s];
        if (is_fixed(kernel, slot)) add(static_cast<int>(slot.position.constant));
      }
    }
  }
  for (const QuantityList::Run& run : mechanics.variables.runs()) {
    const AffineIndex place{.constant = static_cast<long>(run.begin), .factors = {}};
    const bool is_time = mechanics.is_time(place) || mechanics.is_momentum_of_time(place);
    if (single && run.count == 1 && !is_time) add(static_cast<int>(run.begin));
  }
  return {found.begin(), found.end()};
}

}  // namespace

std::optional<ArrayMatrix> choose_matrix(const Mechanics& mechanics, const FamilyParameters& member,
                                         bool reduced, bool eigen) {
  const int size = (reduced ? 1 : 2) * mechanics.degrees_of_freedom;
  const auto is_narrow_band = [&](const ArrayMatrix& m) { return 4 * m.bandwidth < size; };
  const int widest = has_constant_matrix(mechanics, member) ? kWidestConstantBand : kWidestBand;
  ArrayMatrix best = narrowest_band(mechanics, member, reduced, {});
  if (is_narrow_band(best) && best.bandwidth <= widest) return best;
  for (const bool single : {false, true}) {
    std::vector<int> border = met_by_many(mechanics, member, reduced, single);
    if (border.empty() || border.size() > std::size_t{kWidestBorder}) continue;
    ArrayMatrix bordered = narrowest_band(mechanics, member, reduced, std::move(border));
    if (is_narrow_band(bordered) && bordered.bandwidth <= widest) return bordered;
  }
  const bool is_narrow = is_narrow_band(best);
  if (!eigen) {
    const long width = is_narrow ? 3L * best.bandwidth + 1 : size;
    if (width * size > kMostWithoutEigen) return {};
    return is_narrow ? best : ArrayMatrix{.kind = MatrixKind::dense, .size = size};
  }
  const auto rows = static_cast<std::size_t>(size);
  const bool maybe_dense = size <= kLargestDense;
  std::vector<bool> filled(maybe_dense ? rows * rows : 0);
  for_each_entry(mechanics, member, reduced, [&](int row, int column) {
    if (maybe_dense)
      filled[static_cast<std::size_t>(row) * rows + static_cast<std::size_t>(column)] = true;
  });
  const auto count = std::ranges::count(filled, true);
  ArrayMatrix matrix{.kind = MatrixKind::eigen_sparse, .size = size};
  const bool full = maybe_dense && 4 * count > static_cast<long>(rows * rows);
  if (full || size <= kSmall) {
    matrix.kind = size <= kLargestOwn ? MatrixKind::dense : MatrixKind::eigen_dense;
  }
  return matrix;
}

}  // namespace hamgen
