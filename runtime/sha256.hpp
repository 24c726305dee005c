// SHA-256 (FIPS 180-4), for cache keys and for checking cached objects.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace hamgen::runtime {

class Sha256 {
 public:
  void update(std::string_view bytes);

  // A field of its own: the length goes in first, so that ("ab", "c") and ("a", "bc") differ.
  void update_field(std::string_view bytes);

  // 64 lower-case hexadecimal digits of everything given so far.  The object may go on afterwards.
  [[nodiscard]] std::string hex() const;

 private:
  void absorb(const unsigned char* block);

  // The first 32 bits of the fractional parts of the square roots of the first 8 primes.
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> pending_{};
  std::uint64_t length_ = 0;  // in bytes
};

[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace hamgen::runtime
