// Random numbers by their place, not by their turn: whoever asks for one gets the same.
#pragma once

#include <array>
#include <cstdint>

namespace hamgen::app {

// Philox4x32-10 of J. Salmon, M. Moraes, R. Dror and D. Shaw, Parallel random numbers: as easy as
// 1, 2, 3 (SC 2011): a bijection of the counter for every key.
[[nodiscard]] std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key);

// Two numbers of (0, 1), odd multiples of 2^-53, at this place of a sequence.
[[nodiscard]] std::array<double, 2> uniform_pair(std::uint64_t seed, std::uint64_t place,
                                                 std::uint32_t sequence);

}  // namespace hamgen::app
