// The parts of an emitted file that are the same in all of them.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/fixed_blocks.hpp"
#include "generator/readback/precision.hpp"
#include "generator/readback/tokens.hpp"

namespace hamgen {

// Includes, and the functions of quad numbers: what a file may begin with.  The names of files
// between quotes are kept.
[[nodiscard]] std::vector<std::string> read_includes(TokenCursor& cursor,
                                                     const Precision& precision);
// What is demanded of the compiler's arithmetic.
void expect_ieee_begin(TokenCursor& cursor, const Precision& precision);
void expect_ieee_end(TokenCursor& cursor, const Precision& precision);

// The headers of generator/numerics in their namespace: each is compared with the tested one,
// letter by letter.  The digest in the namespace's name is that of them all.
struct FixedBlocks {
  std::string digest;
  std::set<std::string> names;
};
[[nodiscard]] FixedBlocks read_blocks(TokenCursor& cursor, std::string_view text,
                                      const Precision& precision);
// Those of packs, where stages are computed in lanes.
[[nodiscard]] FixedBlocks read_packs(TokenCursor& cursor, std::string_view text,
                                     const Precision& precision);
// Those of a batch of so many trajectories, where a number is a pack.
[[nodiscard]] FixedBlocks read_lane_blocks(TokenCursor& cursor, std::string_view text,
                                           const Precision& precision, int lanes);
// "using numerics::two_sum, ...": of names that the blocks define, in the namespace `space`.
void read_block_names(TokenCursor& cursor, const std::string& space,
                      std::span<const FixedBlock> blocks);

// The header of generator/numerics of this name.
[[nodiscard]] std::string_view tested_text(std::string_view name);

void expect_directive(TokenCursor& cursor, const std::string& text);

}  // namespace hamgen
