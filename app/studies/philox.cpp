#include "app/studies/philox.hpp"

namespace hamgen::app {
namespace {

// (k + 1/2) 2^-52 with the upper 52 bits k: exact, and neither 0 nor 1.
double open_unit(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (static_cast<std::uint64_t>(high) << 32 | low) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c,
                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xd2511f53} * c[0];
    const std::uint64_t b = std::uint64_t{0xcd9e8d57} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ key[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9e3779b9;
    key[1] += 0xbb67ae85;
  }
  return c;
}

std::array<double, 2> uniform_pair(std::uint64_t seed, std::uint64_t place,
                                   std::uint32_t sequence) {
  const auto bits = philox(
      {static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(place >> 32), sequence, 0},
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return {open_unit(bits[0], bits[1]), open_unit(bits[2], bits[3])};
}

}  // namespace hamgen::app
