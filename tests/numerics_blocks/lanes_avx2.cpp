// The elementary functions on lanes, compiled for avx2.
namespace hamgen::numerics_blocks_test::of_avx2 {
#include "tests/numerics_blocks/lanes.inc"
}
