// The elementary functions on lanes, compiled for any machine.
namespace hamgen::numerics_blocks_test::of_portable {
#include "tests/numerics_blocks/lanes.inc"
}
