#include "runtime/object_file.hpp"

#include <gtest/gtest.h>
#include <link.h>

#include <cstddef>

#include "runtime/load_plugin.hpp"
#include "runtime/tool_error.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::text_of;
using tests::write_text;

// Cut at every length the object has, the linker would map pages that are not there for many: a
// SIGBUS, which no test survives.
TEST(ObjectFile, CutOffIsRefusedBeforeItIsLoaded) {
  const TemporaryDirectory directory = private_directory();
  write_sources(tests::oscillator(), directory.path());
  const fs::path object =
      compile_sources(tests::oscillator(), find_compiler(), {}, directory.path());
  EXPECT_EQ(object_problem(object), "");
  const std::string whole = text_of(object);
  const fs::path cut = directory.path() / "cut.so";
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 100) {
    write_text(cut, whole.substr(0, size));
    EXPECT_EQ(object_problem(cut), "it is cut off") << size;
    EXPECT_THROW(Library{cut}, ToolError) << size;
  }
  write_text(cut, whole.substr(0, whole.size() - 1));
  EXPECT_EQ(object_problem(cut), "it is cut off");
  // Of one without a table of sections the segments tell.
  std::string bare = whole;
  for (std::size_t i = 0; i < sizeof(ElfW(Ehdr)::e_shoff); ++i)
    bare[offsetof(ElfW(Ehdr), e_shoff) + i] = 0;
  for (std::size_t i = 0; i < sizeof(ElfW(Ehdr)::e_shnum); ++i)
    bare[offsetof(ElfW(Ehdr), e_shnum) + i] = 0;
  write_text(cut, bare);
  EXPECT_EQ(object_problem(cut), "");
  write_text(cut, bare.substr(0, bare.size() / 2));
  EXPECT_EQ(object_problem(cut), "it is cut off");
  write_text(cut, whole + "\nmore");  // as the cache's seal
  EXPECT_EQ(object_problem(cut), "");
  EXPECT_NO_THROW(Library{cut});
  write_text(cut, std::string(100000, 'x'));
  EXPECT_EQ(object_problem(cut), "it is no shared object");
  EXPECT_NE(object_problem(directory.path() / "none.so"), "");
}

TEST(ObjectFile, OfACompilerThatLiesIsNotLoaded) {
  const TemporaryDirectory directory = private_directory();
  const std::string compiler =
      tests::script(directory.path() / "compiler", "g++ \"$@\" && truncate -s 3000 plugin.so");
  const Cache none{.directory = {}, .problem = "no cache"};
  try {
    (void)load_plugin(tests::oscillator(), find_compiler(compiler), {}, none);
    FAIL() << "it was loaded";
  } catch (const ToolError& error) {
    EXPECT_NE(std::string(error.what()).find("it is cut off"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hamgen::runtime
