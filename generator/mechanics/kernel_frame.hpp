// A new kernel and the names in it: instances of other kernels, each where it stands seen from
// here, become expressions in one index.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// `index` with one of its own replaced: 2*i + 1 at i = j - 1 is 2*j - 1.
[[nodiscard]] AffineIndex composed(const AffineIndex& index, const std::string& name,
                                   const AffineIndex& value);

class KernelFrame {
 public:
  // Over a range, or a single instance.
  KernelFrame(const Mechanics& mechanics, std::optional<KernelRange> range);

  // The expression of a kernel of one range where its index is this, in symbols of the frame.
  [[nodiscard]] Expression seen(const Kernel& kernel, const AffineIndex& at, const Expression& e);
  // The symbol of an element of the state.
  [[nodiscard]] Expression element(const AffineIndex& position);
  // Where the symbol stands in the state; empty for others.
  [[nodiscard]] std::optional<AffineIndex> place(const std::string& symbol) const;

  // The sum of an expression in these symbols, with its first derivatives.
  [[nodiscard]] Kernel kernel(const Expression& value, std::set<int> terms) const;

 private:
  [[nodiscard]] Expression parameter(const ParameterSlot& slot, const AffineIndex& position);

  const Mechanics* mechanics_;
  Kernel kernel_;
};

[[nodiscard]] Kernel with_second_derivatives(Kernel kernel);

}  // namespace hamgen
