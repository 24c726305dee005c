#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

// generated/ is the showcase and the main golden set: what the generator writes today must be what
// is checked in.
TEST(Generated, headers_are_what_the_generator_writes) {
  const std::string command = std::string("HAMGEN='") + HAMGEN_EXECUTABLE + "' '" +
                              HAMGEN_SOURCE_DIR + "/scripts/update-generated' --check";
  EXPECT_EQ(std::system(command.c_str()), 0)
      << "read the difference, then scripts/update-generated";
}
