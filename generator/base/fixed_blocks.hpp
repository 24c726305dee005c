// The fixed blocks of emitted files: the headers of generator/numerics and what each defines.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamgen {

struct FixedBlock {
  std::string_view name;     // of its file, there or in its folder c
  std::string_view defines;  // with blanks between them
  bool eigen = false;
  bool events = false;            // of headers that find events alone
  std::string_view helpers = {};  // what it defines for other blocks alone
};

// Not in a file, but made for each scalar: what numerics.hpp of formats/ says of it.
inline constexpr std::string_view kVocabulary = "vocabulary";
inline constexpr std::string_view kEpsilon = "epsilon";  // in C a block of its own

// Each uses those before it only.
[[nodiscard]] std::span<const FixedBlock> cpp_blocks();
[[nodiscard]] std::span<const FixedBlock> lane_blocks();  // of a batch, where Real is a pack
// Those of them that others have for stages in lanes: packs, and their functions.
[[nodiscard]] std::span<const FixedBlock> pack_blocks();
[[nodiscard]] std::span<const FixedBlock> c_blocks();

[[nodiscard]] std::vector<std::string> names_of(const FixedBlock& block);
[[nodiscard]] std::vector<std::string> helpers_of(const FixedBlock& block);
// Is the word one of these?
[[nodiscard]] bool defines(const FixedBlock& block, std::string_view word);
[[nodiscard]] bool is_defined(std::span<const FixedBlock> blocks, std::string_view word);

}  // namespace hamgen
