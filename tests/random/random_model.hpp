// Models by chance: H smooth and defined everywhere, of every construct of the language.
#pragma once

#include <cstdint>
#include <string>

#include "generator/pipeline.hpp"

namespace hamgen::random {

struct RandomCase {
  std::string text;  // with one scene, of h and steps
  Request request;   // a method that suits any H, or H = T(p) + V(q) where `separable`
  bool separable = false;
};

// The same case for the same seed everywhere.
[[nodiscard]] RandomCase random_case(std::uint64_t seed);

}  // namespace hamgen::random
