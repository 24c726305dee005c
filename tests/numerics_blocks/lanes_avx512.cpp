// The elementary functions on lanes, compiled for avx512.
namespace hamgen::numerics_blocks_test::of_avx512 {
#include "tests/numerics_blocks/lanes.inc"
}
