// Indexed sums kept as sums: what large systems are made of.
//
// H = sum over kernels, sum over their index ranges, of `value` in the kernel's slots.  A slot is
// one element of the state whose position depends on the indices, such as q[i+1]; derivatives are
// taken by slot and scattered.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// constant + sum of factor * index.
struct AffineIndex {
  long constant = 0;
  std::map<std::string, long> factors;
  bool operator==(const AffineIndex&) const = default;
};

struct KernelRange {
  std::string index;
  AffineIndex lower, upper;  // in the indices of the ranges before it
  bool operator==(const KernelRange&) const = default;
};

struct Slot {
  std::string symbol;    // "q[i+1]" as a symbol of the kernel's expressions
  AffineIndex position;  // in the state z: 0..2n-1
  bool is_momentum = false;
  bool operator==(const Slot&) const = default;
};

// An element of an array parameter whose subscript depends on the indices.
struct ParameterSlot {
  std::string symbol;
  std::string parameter;  // its declared name
  AffineIndex position;   // from 0
  bool operator==(const ParameterSlot&) const = default;
};

struct Kernel {
  std::vector<KernelRange> ranges;  // empty: a single instance
  std::vector<Slot> slots;
  std::vector<ParameterSlot> parameters;
  Expression value;
  std::vector<Expression> gradient;                                   // by slot
  std::map<std::pair<std::size_t, std::size_t>, Expression> hessian;  // slots i <= j, nonzero
  std::set<int> terms = {};             // of H that it is made of, by number
  std::optional<std::size_t> sum = {};  // which of the sums that H is a function of it adds to
};

// A sum over elements that H is a function of, as C in C^2.
struct CollectiveSum {
  std::string name;        // its symbol
  std::string slope;       // the symbol of dH/dC
  Expression slope_value;  // in the symbols of all of them
};
// What H is made of where its sums are kept: the kernels that are of no sum, and a function of the
// sums.
struct KernelForm {
  std::vector<Kernel> kernels;
  std::vector<CollectiveSum> sums;
  Expression of_sums;
};

// Is the slot the same element in all instances of a loop?
[[nodiscard]] bool is_fixed(const Kernel& kernel, const Slot& slot);
// The symbols of the others.
[[nodiscard]] std::set<std::string> varying_symbols(const Kernel& kernel);
// Which part of the state the kernel's slots lie in.
[[nodiscard]] bool uses_coordinates(const Kernel& kernel);
[[nodiscard]] bool uses_momenta(const Kernel& kernel);
// In the state: abs(p) is none, for all that its second derivative vanishes.
[[nodiscard]] bool is_polynomial(const Kernel& kernel);

// "2*i + 1"
[[nodiscard]] std::string to_text(const AffineIndex& index);
// As it stands in a slot's symbol: "2*i+1".
[[nodiscard]] std::string subscript_text(const AffineIndex& index);
// Its value where the indices of the ranges, in their order, are these.
[[nodiscard]] long value_at(const AffineIndex& index, const std::vector<KernelRange>& ranges,
                            const std::vector<long>& indices);
// The least and the largest value over the ranges, or one beyond it where a range may be empty.
[[nodiscard]] long least_value(const AffineIndex& index, const std::vector<KernelRange>& ranges);
[[nodiscard]] long largest_value(const AffineIndex& index, const std::vector<KernelRange>& ranges);
// The values of the one index for which `place` lies between `least` and `most`.
struct IndexInterval {
  long first = std::numeric_limits<long>::min();
  long last = std::numeric_limits<long>::max();
};
[[nodiscard]] IndexInterval indices_between(const AffineIndex& place, const std::string& index,
                                            long least, long most);
// The indices of every instance: one empty list if there are no ranges.
void for_each_instance(const std::vector<KernelRange>& ranges,
                       const std::function<void(const std::vector<long>&)>& use);

}  // namespace hamgen
