// CRC-64 (ECMA-182, as in the .xz format), for finding records that were not written to their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace hamgen::runtime {

// Of "123456789": 0x995dc9bbdf1939fa.
[[nodiscard]] std::uint64_t crc64(std::span<const std::byte> bytes);

}  // namespace hamgen::runtime
