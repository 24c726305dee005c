#include "generator/mechanics/kernel_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/generating_series.hpp"
#include "generator/mechanics/kernel_frame.hpp"
#include "generator/mechanics/operation_count.hpp"
#include "generator/mechanics/taylor.hpp"

namespace hamgen {

namespace {

// Why K is no sum over neighbours.
struct NotLocal {
  std::string why;
};

long factor_of(const AffineIndex& index) {
  return index.factors.empty() ? 0 : index.factors.begin()->second;
}
// How far apart the elements of neighbouring instances are; a constant has none.
long stride_of(const Kernel& kernel) {
  for (const Slot& slot : kernel.slots) {
    if (!slot.position.factors.empty()) return std::abs(factor_of(slot.position));
  }
  return 1;
}

// Where each instance meets a fixed number of others, but for an element that all meet.
void require_neighbours(const Kernel& kernel) {
  if (kernel.ranges.size() > 1) throw NotLocal{"a sum over several indices"};
  for (const Slot& slot : kernel.slots) {
    const bool moves = !slot.position.factors.empty();
    if (moves && std::abs(factor_of(slot.position)) != stride_of(kernel))
      throw NotLocal{fmt::format("{} beside {}, whose distance grows", kernel.slots.front().symbol,
                                 slot.symbol)};
  }
}

// What a kernel runs over: a single instance has no index.
KernelRange run(const std::string& index, long first, long last) {
  return {index, {.constant = first, .factors = {}}, {.constant = last, .factors = {}}};
}
KernelRange range_of(const Kernel& kernel) {
  return kernel.ranges.empty() ? run("", 0, 0) : kernel.ranges.front();
}
AffineIndex unit(const KernelRange& range) {
  if (range.index.empty()) return {};
  return {.constant = 0, .factors = {{range.index, 1}}};
}

// Instances of a kernel, by an index of their own.
struct Instances {
  const Kernel& kernel;
  KernelRange range;
  AffineIndex own;  // the kernel's index in that of the range
};

// They as a new kernel, to which the instances of others that they meet add.
struct Part {
  explicit Part(const Mechanics& mechanics, const Instances& instances)
      : of(instances),
        frame(mechanics, of.range.index.empty() ? std::nullopt : std::optional(of.range)),
        terms(of.kernel.terms) {}
  const Instances& of;
  KernelFrame frame;
  std::set<int> terms;
  std::set<long> cuts = {};  // where instances begin that meet others than those before

  [[nodiscard]] Expression own(const Expression& e) { return frame.seen(of.kernel, of.own, e); }
  [[nodiscard]] AffineIndex place(const Slot& slot) const {
    return of.kernel.ranges.empty() ? slot.position
                                    : composed(slot.position, range_of(of.kernel).index, of.own);
  }
};

// Which instances of a range have a slot of another kernel at an element of theirs, and at which
// index of that kernel.
struct Meeting {
  AffineIndex at;
  long first, last;
};
std::optional<Meeting> meeting(const AffineIndex& element, const KernelRange& range,
                               const AffineIndex& slot, const KernelRange& of_slot) {
  const long mine = factor_of(element);
  const long its = factor_of(slot);
  const long apart = element.constant - slot.constant;
  Meeting found{{}, range.lower.constant, range.upper.constant};
  const auto keep = [&found](long first, long last) {
    found.first = std::max(found.first, first);
    found.last = std::min(found.last, last);
  };
  if (its != 0) {
    if (apart % its != 0) return {};
    found.at.constant = apart / its;
    if (mine != 0) found.at.factors[range.index] = mine / its;
    const IndexInterval inside =
        indices_between(found.at, range.index, of_slot.lower.constant, of_slot.upper.constant);
    keep(inside.first, inside.last);
  } else if (mine != 0) {
    if (apart % mine != 0) return {};
    keep(-apart / mine, -apart / mine);
  } else if (apart != 0) {
    return {};
  }
  return found.first <= found.last ? std::optional(found) : std::nullopt;
}

// Over the same instances; of single ones, of the same elements: where they have some in common
// algebra would add what each of them has of these, and differences become sums that cancel.
bool belong_together(const Kernel& a, const Kernel& b) {
  if (a.ranges.size() != b.ranges.size()) return false;
  if (!a.ranges.empty())
    return range_of(a).lower == range_of(b).lower && range_of(a).upper == range_of(b).upper &&
           stride_of(a) == stride_of(b);
  return a.slots.size() == b.slots.size() && std::ranges::all_of(a.slots, [&](const Slot& slot) {
           return std::ranges::find(b.slots, slot.position, &Slot::position) != b.slots.end();
         });
}

// S_1 = H, S_2, ... with S = sum of h^k S_k, each as kernels.
class KernelSeries {
 public:
  KernelSeries(const Mechanics& mechanics, const std::vector<SparseMatrix>& gauge)
      : mechanics_(mechanics),
        n_(mechanics.degrees_of_freedom),
        tables_(coordinate_chart({Expression::symbol("q"), Expression::symbol("p")}, gauge)),
        terms_{{}, mechanics.kernels} {
    for (const Kernel& kernel : mechanics.kernels) {
      require_neighbours(kernel);
      stride_ = std::lcm(stride_, stride_of(kernel));
    }
  }

  // (k + 1) S_(k+1) = coefficient of h^k of H(z + w) - (1/2) grad S^T (dC/dh) J grad S.
  void solve_next(bool vanishes) {
    const int k = static_cast<int>(terms_.size()) - 1;
    std::vector<Kernel> next;
    const Expression share(Rational(1, k + 1));
    const auto add = [&](const Kernel& kernel, const Summand& value) {
      for (const Instances& all : by_stride(kernel))
        add_instances(
            all, [&](Part& part) { return share * value(part); }, next);
    };
    // p_t stands alone in H: what it moves by is a sum over all instances that t stands in.
    const auto add_of_time = [&](const SparseMatrix& table, const Expression& factor, int power) {
      for (const long column : {0, 1}) {
        const auto weight = table.find({1, static_cast<int>(column)});
        if (weight == table.end()) continue;
        const Expression share_of_it = factor * weight->second;
        for (const Kernel& other : terms_[at(power)]) {
          for (std::size_t s = 0; s < other.slots.size(); ++s) {
            const AffineIndex& place = other.slots[s].position;
            if (!(column == 0 ? mechanics_.is_time(place) : mechanics_.is_momentum_of_time(place)))
              continue;
            add(other, [&](Part& part) { return share_of_it * part.own(other.gradient[s]); });
          }
        }
      }
    };
    if (!vanishes) {
      for (const Kernel& kernel : mechanics_.kernels) {
        if (!moves_time(kernel)) {
          add(kernel, [&](Part& part) { return moved(part, k); });
          continue;
        }
        for (int l = 0; l < k; ++l) add_of_time(tables_.displacements[at(l)], 1, k - l);
      }
      for (int l = 0; l + 2 <= k; ++l) {
        for (int i = 1; i + l < k; ++i) {
          for (const Kernel& kernel : terms_[at(i)]) {
            if (moves_time(kernel)) {
              add_of_time(tables_.gauges[at(l + 1)], Expression(Rational(-(l + 1), 2)), k - l - i);
            } else {
              add(kernel, [&](Part& part) { return turned(part, l, k - l - i); });
            }
          }
        }
      }
    }
    require_few_operations(next);
    terms_.push_back(std::move(next));
  }

  // S/h, what runs over the same instances as one.
  [[nodiscard]] std::vector<Kernel> sum() const {
    std::vector<std::pair<KernelFrame, Kernel>> list;
    for (std::size_t k = 1; k < terms_.size(); ++k) {
      const Expression power = Expression::power(Expression::symbol("h", kRankOfStep),
                                                 Expression(static_cast<long>(k) - 1));
      for (const Kernel& kernel : terms_[k]) {
        auto found = std::ranges::find_if(
            list, [&](const auto& other) { return belong_together(other.second, kernel); });
        if (found == list.end()) {
          const Instances all{kernel, range_of(kernel), {}};
          found =
              list.insert(found, {Part(mechanics_, all).frame, Kernel{.ranges = kernel.ranges}});
        }
        auto& [frame, sum] = *found;
        const Expression value = frame.seen(kernel, unit(range_of(sum)), kernel.value);
        sum.terms.insert(kernel.terms.begin(), kernel.terms.end());
        sum = frame.kernel(sum.value + power * value, sum.terms);
      }
    }
    std::vector<Kernel> result;
    for (auto& [frame, kernel] : list) result.push_back(with_second_derivatives(std::move(kernel)));
    return result;
  }

 private:
  using Summand = std::function<Expression(Part&)>;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  // p_t alone: what a time adds to H.
  [[nodiscard]] bool moves_time(const Kernel& kernel) const {
    return kernel.slots.size() == 1 &&
           mechanics_.is_momentum_of_time(kernel.slots.front().position);
  }

  static void require_few_operations(const std::vector<Kernel>& kernels) {
    long total = 0;
    for (const Kernel& kernel : kernels) {
      std::set<std::string> varying;
      for (const Slot& slot : kernel.slots) varying.insert(slot.symbol);
      total += operation_count(kernel.gradient, varying);
    }
    if (total > kMostOperations) throw TooManyTerms();
  }

  // All instances, or every m-th of them, such that their elements are as far apart as those of all
  // other kernels.
  [[nodiscard]] std::vector<Instances> by_stride(const Kernel& kernel) const {
    const KernelRange range = range_of(kernel);
    const long m = kernel.ranges.empty() ? 1 : stride_ / stride_of(kernel);
    if (m == 1) return {{kernel, range, unit(range)}};
    std::vector<Instances> result;
    const long last = range.upper.constant;
    for (long first = range.lower.constant; first < range.lower.constant + m; ++first)
      result.push_back({kernel,
                        run(range.index, 0, (last - first + m) / m - 1),
                        {.constant = first, .factors = {{range.index, m}}}});
    return result;
  }

  // Cut into parts that meet the same others throughout.
  void add_instances(const Instances& of, const Summand& value, std::vector<Kernel>& list) const {
    const long last = of.range.upper.constant;
    long first = of.range.lower.constant;
    if (last < first) return;
    if (!of.range.index.empty() && first == last) {
      const AffineIndex only = composed(of.own, of.range.index, of.range.lower);
      return add_instances({of.kernel, run("", 0, 0), only}, value, list);
    }
    Part part(mechanics_, of);
    const Expression sum = value(part);
    if (part.cuts.empty()) {
      if (!sum.is_zero()) list.push_back(part.frame.kernel(sum, std::move(part.terms)));
      return;
    }
    part.cuts.insert(last + 1);
    for (const long next : part.cuts) {
      add_instances({of.kernel, run(of.range.index, first, next - 1), of.own}, value, list);
      first = next;
    }
  }

  // The coefficient of h^k of the kernel at the displaced point z + w.
  [[nodiscard]] Expression moved(Part& part, int k) const {
    TaylorSeries taylor([&](const Expression& symbol, int power) {
      const std::optional<AffineIndex> element = part.frame.place(symbol.name());
      return element ? displacement(part, *element, power) : Expression(0);
    });
    return taylor.coefficient(part.own(part.of.kernel.value), k);
  }
  // The coefficient of h^power of w.
  [[nodiscard]] Expression displacement(Part& part, const AffineIndex& element, int power) const {
    std::vector<Expression> parts;
    for (int l = 0; l < power; ++l)
      parts.push_back(row_times_slope(tables_.displacements[at(l)], part, element, power - l));
    return Expression::sum(std::move(parts));
  }
  // What a kernel of S_i has of  -(l + 1)/2 grad S_i^T C_(l+1) J grad S_power.
  [[nodiscard]] Expression turned(Part& part, int l, int power) const {
    const Kernel& kernel = part.of.kernel;
    std::vector<Expression> parts;
    for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
      const Expression other =
          row_times_slope(tables_.gauges[at(l + 1)], part, part.place(kernel.slots[s]), power);
      if (!other.is_zero()) parts.push_back(part.own(kernel.gradient[s]) * other);
    }
    return Expression(Rational(-(l + 1), 2)) * Expression::sum(std::move(parts));
  }
  // The element's row of a table of one degree of freedom, times grad S_power.
  [[nodiscard]] Expression row_times_slope(const SparseMatrix& table, Part& part,
                                           const AffineIndex& element, int power) const {
    std::vector<Expression> parts;
    const int row = least_value(element, {part.of.range}) < n_ ? 0 : 1;
    for (int column = 0; column < 2; ++column) {
      const auto weight = table.find({row, column});
      if (weight == table.end() || weight->second.is_zero()) continue;
      AffineIndex other = element;
      other.constant += (column - row) * n_;
      parts.push_back(weight->second * slope(part, other, power));
    }
    return Expression::sum(std::move(parts));
  }
  // dS_power by the element, of what all instances of the part meet.
  [[nodiscard]] Expression slope(Part& part, const AffineIndex& element, int power) const {
    const KernelRange& range = part.of.range;
    std::vector<Expression> parts;
    for (const Kernel& other : terms_[at(power)]) {
      for (std::size_t s = 0; s < other.slots.size(); ++s) {
        if (other.gradient[s].is_zero()) continue;
        if (is_fixed(other, other.slots[s]) && other.slots[s].position == element)
          throw NotLocal{fmt::format("{} in every summand of a sum", other.slots[s].symbol)};
        const auto found = meeting(element, range, other.slots[s].position, range_of(other));
        if (!found) continue;
        const bool begins = found->first > range.lower.constant;
        const bool ends = found->last < range.upper.constant;
        if (begins) part.cuts.insert(found->first);
        if (ends) part.cuts.insert(found->last + 1);
        if (begins || ends) continue;  // looked at again where all do
        parts.push_back(part.frame.seen(other, found->at, other.gradient[s]));
        part.terms.insert(other.terms.begin(), other.terms.end());
      }
    }
    return Expression::sum(std::move(parts));
  }

  const Mechanics& mechanics_;
  long n_;
  Chart tables_;                            // of one degree of freedom
  long stride_ = 1;                         // a multiple of that of every kernel
  std::vector<std::vector<Kernel>> terms_;  // from S_1 on at place 1
};

}  // namespace

std::vector<Kernel> generating_kernels(const Mechanics& mechanics, const SparseMatrix& c,
                                       int order) {
  const std::vector<SparseMatrix> gauge = gauge_series(c, order);
  const bool odd = is_odd(gauge);
  try {
    KernelSeries series(mechanics, gauge);
    for (int k = 2; k <= order; ++k) series.solve_next(odd && k % 2 == 0);
    return series.sum();
  } catch (const NotLocal& not_local) {
    throw UsageError(
        fmt::format("--order {}: the generating function of {} couples all its {} degrees of "
                    "freedom, more than are written out: H has {}\nhelp: a composition of the same "
                    "order keeps the sums as loops, see `hamgen list schemes`",
                    order, mechanics.name, mechanics.degrees_of_freedom, not_local.why));
  } catch (const TooManyTerms&) {
    throw UsageError(
        fmt::format("--order {}: an element of the generating function of {} takes more than {} "
                    "operations\nhelp: compositions and Gauss methods of this order cost more "
                    "stages but no long formulas, see `hamgen list schemes`",
                    order, mechanics.name, kMostOperations));
  }
}

}  // namespace hamgen
