// Model to kernels.
#pragma once

#include <optional>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// H as kernels; empty if it is not a plain sum of indexed terms (a function of a sum, say).
[[nodiscard]] std::optional<std::vector<Kernel>> derive_kernels(const Model& model);

}  // namespace hamgen
