// What libFuzzer calls (scripts/fuzz).
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/check_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_cast<void>(hamgen::fuzz::check_input({reinterpret_cast<const char*>(data), size}));
  return 0;
}
