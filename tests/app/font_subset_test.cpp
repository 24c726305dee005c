// The font that a page carries with it.
#include "app/output/font_subset.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "app/output/math_font.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using app::font_subset;
using app::FontError;

const char* const kFont =
    "/usr/share/texmf/fonts/opentype/public/tex-gyre-math/texgyrepagella-math.otf";

class FontSubset : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::filesystem::exists(kFont))
        << "the font of formulas is not there; scripts/install-dependencies test installs it";
    font_ = read(kFont);
  }
  std::string font_;
};

TEST_F(FontSubset, IsSmallAndGrowsWithItsCharacters) {
  const std::array<char32_t, 1> one = {U'q'};
  const std::array<char32_t, 3> three = {U'q', 0x221A, 0x2211};  // with their larger forms
  const std::string small = font_subset(font_, one);
  const std::string larger = font_subset(font_, three);
  EXPECT_EQ(small.substr(0, 4), "OTTO");
  EXPECT_LT(small.size(), font_.size() / 4);
  EXPECT_LT(small.size(), larger.size());
  EXPECT_LT(app::math_font_style().size(), font_.size() / 2);
}

// A font of a font is the same font: it is read as it was written.
TEST_F(FontSubset, OfASubsetIsTheSubset) {
  const std::array<char32_t, 2> characters = {U'q', U'('};
  const std::string once = font_subset(font_, characters);
  EXPECT_EQ(font_subset(once, characters), once);
}

TEST_F(FontSubset, RefusesWhatIsCutOffOrNoFont) {
  const std::array<char32_t, 1> one = {U'q'};
  EXPECT_THROW(static_cast<void>(font_subset("", one)), FontError);
  EXPECT_THROW(static_cast<void>(font_subset("OTTO", one)), FontError);
  EXPECT_THROW(static_cast<void>(font_subset(std::string(1000, 'x'), one)), FontError);
  for (std::size_t size = 0; size < font_.size() - 4; size += font_.size() / 97)
    EXPECT_THROW(static_cast<void>(font_subset(font_.substr(0, size), one)), FontError) << size;
}

}  // namespace
}  // namespace hamgen::app_test
