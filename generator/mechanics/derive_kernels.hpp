// Model to kernels.
#pragma once

#include <optional>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// H as kernels; empty if it is no sum of indexed terms and of functions of such sums.
[[nodiscard]] std::optional<KernelForm> derive_kernels(const Model& model);

}  // namespace hamgen
