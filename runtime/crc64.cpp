#include "runtime/crc64.hpp"

#include <array>

namespace hamgen::runtime {
namespace {

using CrcTables = std::array<std::array<std::uint64_t, 256>, 8>;

// Table k has the remainders of a byte that k bytes follow: eight bytes are taken at once.
constexpr CrcTables make_crc_tables() {
  constexpr std::uint64_t polynomial = 0xc96c5795d7870f42;  // reflected
  CrcTables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? polynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint64_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 255];
    }
  }
  return tables;
}

}  // namespace

std::uint64_t crc64(std::span<const std::byte> bytes) {
  static constexpr CrcTables kTables = make_crc_tables();
  std::uint64_t rest = ~std::uint64_t{0};
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    for (std::size_t k = 0; k < 8; ++k)
      rest ^= std::to_integer<std::uint64_t>(bytes[i + k]) << (8 * k);
    std::uint64_t next = 0;
    for (std::size_t k = 0; k < 8; ++k) next ^= kTables[7 - k][(rest >> (8 * k)) & 255];
    rest = next;
  }
  for (; i < bytes.size(); ++i)
    rest = (rest >> 8) ^ kTables[0][(rest ^ std::to_integer<std::uint64_t>(bytes[i])) & 255];
  return ~rest;
}

}  // namespace hamgen::runtime
