#include "generator/mechanics/kernel_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

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

// Single instances with so many elements are one kernel.
constexpr std::size_t kMostInOne = 8;

long factor_of(const AffineIndex& index) {
  return index.factors.empty() ? 0 : index.factors.begin()->second;
}

// A single instance is a range without an index.
constexpr const char* kSingle = "";
std::optional<KernelRange> range_of(const KernelRange& range) {
  return range.index == kSingle ? std::nullopt : std::optional(range);
}
KernelRange run(const std::string& index, long first, long last) {
  return {index, {.constant = first, .factors = {}}, {.constant = last, .factors = {}}};
}
KernelRange only_range(const Kernel& kernel) {
  return kernel.ranges.empty() ? run(kSingle, 0, 0) : kernel.ranges.front();
}

// A slot of another kernel that stands at an element seen from a range: at which index of the
// other, and for which indices of the range.
struct Meeting {
  AffineIndex at;
  long first, last;
};

std::optional<Meeting> meeting(const AffineIndex& element, const KernelRange& range,
                               const AffineIndex& position, const KernelRange& of) {
  const long mine = factor_of(element);
  const long its = factor_of(position);
  const long apart = element.constant - position.constant;
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
        indices_between(found.at, range.index, of.lower.constant, of.upper.constant);
    keep(inside.first, inside.last);
  } else if (mine != 0) {
    if (apart % mine != 0) return {};
    keep(-apart / mine, -apart / mine);
  } else if (apart != 0) {
    return {};
  }
  return found.first <= found.last ? std::optional(found) : std::nullopt;
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
      for (const auto& [range, own] : by_stride(kernel))
        add_part(
            {kernel, range, own}, [&](Part& part) { return share * value(part); }, next);
    };
    for (const Kernel& kernel : vanishes ? std::vector<Kernel>{} : mechanics_.kernels)
      add(kernel, [&](Part& part) { return moved(part, k); });
    for (int l = 0; l + 2 <= k && !vanishes; ++l) {
      for (int i = 1; i + l < k; ++i) {
        for (const Kernel& kernel : terms_[at(i)])
          add(kernel, [&, i](Part& part) { return turned(part, l, k - l - i); });
      }
    }
    terms_.push_back(std::move(next));
  }

  // S/h, loops over the same instances as one.
  [[nodiscard]] std::vector<Kernel> sum() const {
    struct Together {
      KernelFrame frame;
      Kernel kernel;  // so far
    };
    std::vector<Together> list;
    for (std::size_t k = 1; k < terms_.size(); ++k) {
      const Expression power = Expression::power(Expression::symbol("h", kRankOfStep),
                                                 Expression(static_cast<long>(k) - 1));
      for (const Kernel& kernel : terms_[k]) {
        const KernelRange range = only_range(kernel);
        auto found = std::ranges::find_if(
            list, [&](const Together& other) { return belong_together(other.kernel, kernel); });
        if (found == list.end())
          found = list.insert(found, {KernelFrame(mechanics_, range_of(range)), {}});
        const AffineIndex own =
            found->kernel.ranges.empty() ? unit(range) : unit(only_range(found->kernel));
        const Expression value = found->frame.seen(kernel, own, kernel.value);
        std::set<int> terms = found->kernel.terms;
        terms.insert(kernel.terms.begin(), kernel.terms.end());
        found->kernel = found->frame.kernel(found->kernel.value + power * value, std::move(terms));
      }
    }
    std::vector<Kernel> result;
    for (Together& each : list) result.push_back(std::move(each.kernel));
    return result;
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  static void require_neighbours(const Kernel& kernel) {
    if (kernel.ranges.size() > 1) throw NotLocal{"a sum over several indices"};
    if (kernel.ranges.empty()) return;
    for (const Slot& slot : kernel.slots) {
      if (slot.position.factors.empty())
        throw NotLocal{fmt::format("{}, which stands in every summand", slot.symbol)};
      if (std::abs(factor_of(slot.position)) != stride_of(kernel))
        throw NotLocal{
            fmt::format("{} and {}, which are no neighbours", kernel.slots[0].symbol, slot.symbol)};
    }
  }
  static long stride_of(const Kernel& kernel) {
    if (kernel.ranges.empty() || kernel.slots.empty()) return 1;
    return std::abs(factor_of(kernel.slots.front().position));
  }

  // Instances of a kernel, by an index of their own.
  struct Part {
    Part(const Mechanics& mechanics, const Kernel& of, KernelRange over, AffineIndex own_index)
        : kernel(of),
          range(std::move(over)),
          own(std::move(own_index)),
          frame(mechanics, range_of(range)) {}
    const Kernel& kernel;
    KernelRange range;
    AffineIndex own;  // the kernel's index in that of the range
    KernelFrame frame;
    std::set<int> terms = {};  // of H that others add
    std::set<long> cuts = {};  // where instances begin that meet others than those before
  };
  struct Instances {
    const Kernel& kernel;
    KernelRange range;
    AffineIndex own;
  };
  using Summand = std::function<Expression(Part&)>;

  static AffineIndex unit(const KernelRange& range) {
    if (range.index == kSingle) return {};
    return {.constant = 0, .factors = {{range.index, 1}}};
  }

  // The kernel's range, or every m-th instance of it, such that its elements are as far apart as
  // those of all others.
  [[nodiscard]] std::vector<std::pair<KernelRange, AffineIndex>> by_stride(
      const Kernel& kernel) const {
    const KernelRange range = only_range(kernel);
    const long m = kernel.ranges.empty() ? 1 : stride_ / stride_of(kernel);
    if (m == 1) return {{range, unit(range)}};
    std::vector<std::pair<KernelRange, AffineIndex>> result;
    const long last = range.upper.constant;
    for (long from = range.lower.constant; from <= std::min(last, range.lower.constant + m - 1);
         ++from)
      result.emplace_back(run(range.index, 0, (last - from) / m),
                          AffineIndex{from, {{range.index, m}}});
    return result;
  }

  void add_part(const Instances& of, const Summand& value, std::vector<Kernel>& list) const {
    const auto& [kernel, range, own] = of;
    if (range.lower.constant > range.upper.constant) return;
    if (range.index != kSingle && range.lower == range.upper) {
      const AffineIndex fixed = composed(own, range.index, range.lower);
      return add_part({kernel, run(kSingle, 0, 0), fixed}, value, list);
    }
    Part part(mechanics_, kernel, range, own);
    const Expression sum = value(part);
    if (part.cuts.empty()) {
      part.terms.insert(kernel.terms.begin(), kernel.terms.end());
      if (!sum.is_zero()) list.push_back(part.frame.kernel(sum, std::move(part.terms)));
      return;
    }
    long first = range.lower.constant;
    part.cuts.insert(range.upper.constant + 1);
    for (const long next : part.cuts) {
      add_part({kernel, run(range.index, first, next - 1), own}, value, list);
      first = next;
    }
  }

  // The coefficient of h^k of the kernel at the displaced point z + w.
  [[nodiscard]] Expression moved(Part& part, int k) const {
    const Expression here = part.frame.seen(part.kernel, part.own, part.kernel.value);
    TaylorSeries taylor([&](const Expression& symbol, int power) {
      const Slot* slot = part.frame.slot(symbol.name());
      return slot == nullptr ? Expression(0)
                             : displacement(part, AffineIndex(slot->position), power);
    });
    return taylor.coefficient(here, k);
  }
  // The coefficient of h^power of w.
  Expression displacement(Part& part, const AffineIndex& element, int power) const {
    std::vector<Expression> parts;
    for (int l = 0; l < power; ++l)
      parts.push_back(row_of(tables_.displacements[at(l)], part, element, power - l));
    return Expression::sum(std::move(parts));
  }
  // What the kernel has of  -(l + 1)/2 grad S_i^T C_(l+1) J grad S_power,  one of S_i.
  Expression turned(Part& part, int l, int power) const {
    std::vector<Expression> parts;
    for (std::size_t s = 0; s < part.kernel.slots.size(); ++s) {
      const AffineIndex element = place(part, part.kernel.slots[s]);
      const Expression slope = part.frame.seen(part.kernel, part.own, part.kernel.gradient[s]);
      parts.push_back(slope * row_of(tables_.gauges[at(l + 1)], part, element, power));
    }
    return Expression(Rational(-(l + 1), 2)) * Expression::sum(std::move(parts));
  }
  static AffineIndex place(const Part& part, const Slot& slot) {
    return part.kernel.ranges.empty()
               ? slot.position
               : composed(slot.position, part.kernel.ranges.front().index, part.own);
  }
  // The element's row of the table times grad S_power.
  Expression row_of(const SparseMatrix& table, Part& part, const AffineIndex& element,
                    int power) const {
    std::vector<Expression> parts;
    const int row = least_value(element, {part.range}) < n_ ? 0 : 1;
    for (int column = 0; column < 2; ++column) {
      const auto weight = table.find({row, column});
      if (weight == table.end() || weight->second.is_zero()) continue;
      AffineIndex other = element;
      other.constant += (column - row) * static_cast<long>(n_);
      parts.push_back(weight->second * slope(part, other, power));
    }
    return Expression::sum(std::move(parts));
  }
  // dS_power by the element, where all instances of the part meet the same others.
  Expression slope(Part& part, const AffineIndex& element, int power) const {
    std::vector<Expression> parts;
    for (const Kernel& other : terms_[at(power)]) {
      for (std::size_t s = 0; s < other.slots.size(); ++s) {
        if (other.gradient[s].is_zero()) continue;
        const auto found = meeting(element, part.range, other.slots[s].position, only_range(other));
        if (!found) continue;
        const long first = part.range.lower.constant;
        const long last = part.range.upper.constant;
        if (found->first > first) part.cuts.insert(found->first);
        if (found->last < last) part.cuts.insert(found->last + 1);
        if (found->first > first || found->last < last) continue;
        parts.push_back(part.frame.seen(other, found->at, other.gradient[s]));
        part.terms.insert(other.terms.begin(), other.terms.end());
      }
    }
    return Expression::sum(std::move(parts));
  }

  // Over the same instances; of single ones, with elements in common and few in all.
  static bool belong_together(const Kernel& a, const Kernel& b) {
    if (a.ranges.size() != b.ranges.size()) return false;
    if (!a.ranges.empty())
      return a.ranges[0].lower == b.ranges[0].lower && a.ranges[0].upper == b.ranges[0].upper &&
             stride_of(a) == stride_of(b);
    const auto common = std::ranges::count_if(a.slots, [&](const Slot& slot) {
      return std::ranges::find(b.slots, slot.position, &Slot::position) != b.slots.end();
    });
    return common > 0 &&
           a.slots.size() + b.slots.size() - static_cast<std::size_t>(common) <= kMostInOne;
  }

  const Mechanics& mechanics_;
  long n_;
  Chart tables_;
  long stride_ = 1;                         // of the elements of all loops
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
    throw UsageError(fmt::format(
        "--order {}: {} has {} degrees of freedom, more than are written out, and the generating "
        "function of what stays loops is a sum over neighbours, but H has {}\nhelp: a composition "
        "of the same order keeps the sums as loops, see `hamgen list schemes`",
        order, mechanics.name, mechanics.degrees_of_freedom, not_local.why));
  }
}

}  // namespace hamgen
