// The fixed blocks of emitted files, compiled for every scalar that a file can be written in.
#pragma once

#include <gtest/gtest.h>

namespace hamgen::numerics_blocks_test {

// As strict as what compiles an emitted file may be.
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wconversion"
namespace of_float {
using Real = float;
inline constexpr int digits = 24;
#include "tests/numerics_blocks/blocks.inc"
}  // namespace of_float

namespace of_double {
using Real = double;
inline constexpr int digits = 53;
#include "tests/numerics_blocks/blocks.inc"
}  // namespace of_double

namespace of_long_double {
using Real = long double;
inline constexpr int digits = 64;
#include "tests/numerics_blocks/blocks.inc"
}  // namespace of_long_double

namespace of_quad {
__extension__ typedef __float128 Real;
inline constexpr int digits = 113;
#include "tests/numerics_blocks/blocks.inc"
}  // namespace of_quad
#pragma GCC diagnostic pop

using EveryScalar =
    ::testing::Types<of_float::Blocks, of_double::Blocks, of_long_double::Blocks, of_quad::Blocks>;

// Reproducible numbers between -1 and 1, exact in every scalar: multiples of 2^-10.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(static_cast<int>(state_ >> 53) - 1024) / 1024;
  }

 private:
  unsigned long long state_ = 1;
};

}  // namespace hamgen::numerics_blocks_test
