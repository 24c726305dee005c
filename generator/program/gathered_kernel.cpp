#include "generator/program/gathered_kernel.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "generator/mechanics/mechanics.hpp"
#include "generator/mechanics/operation_count.hpp"

namespace hamgen {

namespace {

// Computed twice, such an instance still takes less than the memory that scattering waits for; a
// function counts 10.
constexpr long kCheap = 9;
// A polynomial is computed in lanes then: with AVX-512 a step by a fixed point of FPU N = 1000 of
// order 4, of 15 to 30 operations, takes 0.41 of the time (0.83 with SSE2, 1.12 by -O1), and
// Stormer-Verlet with some 40 operations in a summand takes no less.
constexpr long kCheapPolynomial = 32;
constexpr long kFarthest = 2;

std::string array_of(const std::string& symbol) { return symbol.substr(0, symbol.find('[')); }

bool steps_by_one(const AffineIndex& index, const std::string& name) {
  return index.factors == std::map<std::string, long>{{name, 1}};
}

// By how much a slot lies behind the first one of its array that has a gradient.
std::optional<std::vector<long>> offsets(const Kernel& kernel) {
  std::map<std::string, long> first;
  for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
    if (kernel.gradient[s].is_zero()) continue;
    if (is_fixed(kernel, kernel.slots[s])) continue;
    const long at = kernel.slots[s].position.constant;
    const auto [it, is_new] = first.emplace(array_of(kernel.slots[s].symbol), at);
    if (!is_new) it->second = std::min(it->second, at);
  }
  std::vector<long> result;
  for (const Slot& slot : kernel.slots) {
    const auto it = first.find(array_of(slot.symbol));
    result.push_back(
        it == first.end() || is_fixed(kernel, slot) ? 0 : slot.position.constant - it->second);
    if (result.back() > kFarthest) return {};
  }
  return result;
}

bool is_chain(const Kernel& kernel) {
  if (kernel.ranges.size() != 1) return false;
  const KernelRange& range = kernel.ranges.front();
  const bool fixed = range.lower.factors.empty() && range.upper.factors.empty();
  return fixed && std::ranges::all_of(kernel.slots, [&](const Slot& slot) {
           return is_fixed(kernel, slot) || steps_by_one(slot.position, range.index);
         });
}

class Gathering {
 public:
  Gathering(const Kernel& kernel, std::vector<long> offsets)
      : kernel_(kernel), index_(kernel.ranges.front().index), offsets_(std::move(offsets)) {}

  std::vector<Kernel> run() {
    const long lower = kernel_.ranges.front().lower.constant;
    const long upper = kernel_.ranges.front().upper.constant;
    const long farthest = *std::ranges::max_element(offsets_);
    std::vector<Kernel> list;
    Kernel inside = sum([&](long) { return true; });
    inside.ranges.front().lower.constant = lower + farthest;
    list.push_back(std::move(inside));
    for (long i = lower; i < lower + farthest; ++i) {
      list.push_back(at(i, [&](long offset) { return i - offset >= lower; }));
    }
    for (long i = upper + 1; i <= upper + farthest; ++i) {
      list.push_back(at(i, [&](long offset) { return i - offset <= upper; }));
    }
    return list;
  }

 private:
  // The instances that reach the elements of one index, as far as they are wanted.
  template <class Wanted>
  Kernel sum(const Wanted& wanted) {
    Kernel result{.ranges = kernel_.ranges,
                  .slots = {},
                  .parameters = {},
                  .value = {},
                  .gradient = {},
                  .hessian = {},
                  .terms = kernel_.terms};
    std::vector<Slot> targets;
    std::vector<Expression> parts;
    for (std::size_t s = 0; s < kernel_.slots.size(); ++s) {
      if (kernel_.gradient[s].is_zero() || !wanted(offsets_[s])) continue;
      const Expression part = substitute(kernel_.gradient[s], moved_by(offsets_[s], result));
      AffineIndex place = kernel_.slots[s].position;
      place.constant -= offsets_[s];
      const Slot target = *std::ranges::find(result.slots, place, &Slot::position);
      targets.push_back(target);
      parts.push_back(part);
    }
    // Apart: summed by algebra, differences of neighbours would become sums that cancel.
    result.slots.insert(result.slots.end(), targets.begin(), targets.end());
    result.gradient.insert(result.gradient.end(), parts.begin(), parts.end());
    return result;
  }
  template <class Wanted>
  Kernel at(long i, const Wanted& wanted) {
    Kernel result = sum(wanted);
    result.ranges.clear();
    Substitution known{{index_, Expression(i)}};
    const auto fix = [&](auto& slot, int rank) {
      slot.position.constant += slot.position.factors.empty() ? 0 : i;
      slot.position.factors.clear();
      const std::string symbol =
          array_of(slot.symbol) + "[" + std::to_string(i + number_in(slot.symbol)) + "]";
      known.emplace(slot.symbol, Expression::symbol(symbol, rank));
      slot.symbol = symbol;
    };
    for (Slot& slot : result.slots) {
      if (!slot.position.factors.empty()) fix(slot, rank(slot.position));
    }
    for (ParameterSlot& slot : result.parameters) fix(slot, kRankOfParameter);
    for (Expression& value : result.gradient) value = substitute(value, known);
    return result;
  }
  // 1 in "q[i+1]".
  [[nodiscard]] long number_in(const std::string& symbol) const {
    const std::size_t begin = symbol.find('[') + 1 + index_.size();
    return symbol[begin] == ']' ? 0 : std::stol(symbol.substr(begin));
  }

  // The instance before by so much; what it reads becomes slots of `into`.
  Substitution moved_by(long offset, Kernel& into) {
    Substitution moved;
    for (const Slot& slot : kernel_.slots) {
      AffineIndex position = slot.position;
      if (!is_fixed(kernel_, slot)) position.constant -= offset;
      auto known = std::ranges::find(into.slots, position, &Slot::position);
      if (known == into.slots.end()) {
        const std::string symbol =
            is_fixed(kernel_, slot) ? slot.symbol : name(slot.symbol, offset);
        into.slots.push_back({symbol, position, slot.is_momentum});
        into.gradient.emplace_back(0);
        known = std::prev(into.slots.end());
      }
      moved.emplace(slot.symbol, Expression::symbol(known->symbol, rank(position)));
    }
    for (const ParameterSlot& slot : kernel_.parameters) {
      AffineIndex position = slot.position;
      if (!position.factors.empty()) position.constant -= offset;
      const std::string symbol = offset == 0 ? slot.symbol : name(slot.symbol, offset);
      const bool known = std::ranges::find(into.parameters, symbol, &ParameterSlot::symbol) !=
                         into.parameters.end();
      if (!known) into.parameters.push_back({symbol, slot.parameter, position});
      moved.emplace(slot.symbol, Expression::symbol(symbol, kRankOfParameter));
    }
    const Expression index = Expression::symbol(index_, kRankOfParameter);
    if (offset != 0) moved.emplace(index_, index - Expression(offset));
    return moved;
  }
  // "q[i+1]" one instance before: "q[i]".
  [[nodiscard]] std::string name(const std::string& symbol, long offset) const {
    const long at = number_in(symbol) - offset;
    const std::string text = at == 0 ? "" : (at > 0 ? "+" : "") + std::to_string(at);
    return array_of(symbol) + "[" + index_ + text + "]";
  }
  static int rank(const AffineIndex& position) {
    return kRankOfVariable + static_cast<int>(position.constant);
  }

  const Kernel& kernel_;
  std::string index_;
  std::vector<long> offsets_;
};

// Is its subscript the index and a number?
bool is_plain(const std::string& symbol, const std::string& index) {
  const std::size_t bracket = symbol.find('[');
  if (bracket == std::string::npos || !symbol.ends_with(']')) return false;
  const std::string subscript = symbol.substr(bracket + 1, symbol.size() - bracket - 2);
  if (!subscript.starts_with(index)) return false;
  const std::string rest = subscript.substr(index.size());
  if (rest.empty()) return true;
  return rest.size() > 1 && (rest[0] == '+' || rest[0] == '-') &&
         rest.find_first_not_of("0123456789", 1) == std::string::npos;
}

bool is_polynomial_in_elements(const Kernel& kernel) {
  const std::set<std::string> beyond = non_polynomial_symbols(kernel.value);
  return std::ranges::none_of(varying_symbols(kernel),
                              [&](const auto& symbol) { return beyond.contains(symbol); });
}

// What is summed up for one element, each summand waiting for the one before, in a loop of its own:
// the others are computed in lanes without it.  Functions are computed once.
std::vector<Kernel> sums_apart(const Kernel& kernel) {
  if (kernel.ranges.size() != 1 || !is_polynomial_in_elements(kernel)) return {kernel};
  Kernel elements = kernel;
  Kernel sums = kernel;
  for (std::size_t s = 0; s < kernel.slots.size(); ++s)
    (is_fixed(kernel, kernel.slots[s]) ? elements : sums).gradient[s] = Expression(0);
  return {elements, sums};
}

std::vector<Kernel> gathered_alone(const Kernel& kernel) {
  if (!is_chain(kernel)) return {kernel};
  const std::string& index = kernel.ranges.front().index;
  const auto plain = [&](const auto& slot) { return is_plain(slot.symbol, index); };
  const auto fits = [&](const Slot& slot) { return is_fixed(kernel, slot) || plain(slot); };
  if (!std::ranges::all_of(kernel.slots, fits) || !std::ranges::all_of(kernel.parameters, plain))
    return {kernel};
  const std::optional<std::vector<long>> found = offsets(kernel);
  if (!found || std::ranges::none_of(*found, [](long offset) { return offset > 0; }))
    return {kernel};
  const long most = is_polynomial_in_elements(kernel) ? kCheapPolynomial : kCheap;
  const bool cheap = operation_count(kernel.gradient, varying_symbols(kernel)) <= most;
  const long length = kernel.ranges.front().upper.constant - kernel.ranges.front().lower.constant;
  if (!cheap || length <= 2 * kFarthest) return {kernel};
  return Gathering(kernel, *found).run();
}

}  // namespace

std::vector<Kernel> gathered(const Kernel& kernel) {
  std::vector<Kernel> result;
  for (const Kernel& part : sums_apart(kernel)) {
    const bool has_slope = std::ranges::any_of(
        part.gradient, [](const Expression& slope) { return !slope.is_zero(); });
    if (has_slope) std::ranges::move(gathered_alone(part), std::back_inserter(result));
  }
  return result;
}

}  // namespace hamgen
