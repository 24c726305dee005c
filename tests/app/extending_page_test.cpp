// What docs/extending.md shows compiles where it says that it belongs.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/page_examples.hpp"

namespace hamgen::app_test {
namespace {

const std::string tree = HAMGEN_SOURCE_DIR;

// The block of the page that begins so.
std::string block_of(const std::string& begin) {
  for (const PageBlock& block : blocks_of_page(tree + "/docs/extending.md")) {
    if (contains(block.first(), begin)) return block.text();
  }
  ADD_FAILURE() << "the page has no block that begins with " << begin;
  return "";
}

// A source of the tree with more in it.
class Edited {
 public:
  explicit Edited(const std::string& file) : text_(read(tree + "/" + file)) {}

  Edited& before(const std::string& mark, const std::string& text) {
    const std::size_t at = text_.find(mark);
    EXPECT_NE(at, std::string::npos) << mark;
    if (at != std::string::npos) text_.insert(at, text);
    return *this;
  }
  void compiles() const { compiles_with(Scratch()); }
  // With the headers in this folder before those of the tree.
  void compiles_with(const Scratch& headers) const {
    const Scratch scratch;
    scratch.write("edited.cpp", text_);
    const Result result = shell("g++ -std=gnu++20 -fsyntax-only -Wall -Wextra -Werror -I '" +
                                    headers.path(".") + "' -I '" + tree + "' edited.cpp",
                                scratch.path("."));
    EXPECT_EQ(result.status, 0) << result.out << result.err;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// But for the two that its examples make.
TEST(ExtendingPage, NamesFilesThatAreThere) {
  const std::set<std::string> made = {"generator/formats/meson_package.cpp",
                                      "generator/numerics/ends/stagnation_rule.hpp"};
  const std::string page = read(tree + "/docs/extending.md");
  const std::regex name("`((generator|app|tests|runtime)/[^` ]*)`");
  int names = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), name), end; it != end; ++it, ++names) {
    const std::string file = (*it)[1];
    EXPECT_NE(std::filesystem::exists(tree + "/" + file), made.contains(file)) << file;
  }
  EXPECT_GE(names, 20);
}

TEST(ExtendingPage, ASchemeIsARow) {
  Edited("generator/schemes/composition.cpp")
      .before("// One of the nine is free", block_of("// yoshida-4 three times"))
      .before("suzuki_4(),", "triple_jump_6(),\n")
      .compiles();
}

TEST(ExtendingPage, AFormatIsAFunctionAndARow) {
  Edited("generator/formats/all_formats.cpp")
      .before("namespace {\n\nconstexpr std::array kFormats",
              block_of("OutputFiles meson_package(") + "\n")
      .before("};\n\n}  // namespace", block_of("NamedFormat{"))
      .before("#include \"generator/formats/cpp_header.hpp\"",
              "#include \"generator/program/names.hpp\"\n")
      .compiles();
}

TEST(ExtendingPage, AFunctionIsARow) {
  const std::string table = read(tree + "/generator/algebra/functions.cpp");
  EXPECT_TRUE(contains(table, block_of(".name = \"expm1\"")));
}

TEST(ExtendingPage, ADialectOfCIsARowAndALine) {
  EXPECT_TRUE(contains(read(tree + "/generator/base/c_family.cpp"),
                       block_of("CFamily{.format = \"opencl-header\"")));
  EXPECT_TRUE(contains(read(tree + "/generator/formats/all_formats.cpp"),
                       block_of("NamedFormat{\"opencl-header\"")));
}

// Its block in a folder of headers, from which the lists are made as the build makes them.
TEST(ExtendingPage, ARuleOfFixedPointsIsABlockAndARow) {
  Edited("generator/solvers/all_solvers.cpp")
      .before("    NamedSolver{\"sweeps:K\"", block_of("NamedSolver{\"stagnation\""))
      .compiles();
  const Scratch scratch;
  const std::filesystem::path made = scratch.path("");
  const std::filesystem::path ends = made / "generator/numerics/ends";
  std::filesystem::create_directories(ends);
  std::filesystem::copy(tree + "/generator/numerics/ends", ends);
  scratch.write("generator/numerics/ends/stagnation_rule.hpp",
                block_of("// When to stop a fixed point"));
  const Result lists =
      shell("cmake -Dheaders='" + ends.string() + "' -Dfolder=generator/base -P '" + tree +
                "/generator/base/fixed_point_ends.cmake'",
            made);
  EXPECT_EQ(lists.status, 0) << lists.err;
  EXPECT_TRUE(contains(read(made / "generator/base/fixed_point_blocks.inc"),
                       "{\"stagnation_rule\", \"StagnationRule\"},"));
  for (const char* file : {"generator/base/fixed_blocks.cpp", "generator/interpreter/numerics.cpp"})
    Edited(file).compiles_with(scratch);
}

}  // namespace
}  // namespace hamgen::app_test
