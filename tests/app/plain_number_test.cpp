// Numbers and names as pictures and pages show them.
#include "app/output/plain_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/output/gnuplot.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/plot.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using app::greek_text;
using app::html_number;
using app::plain_number;
using app::plain_symbol;

TEST(PlainNumber, HasAPowerOfTenOnlyWhereItIsLargeOrSmall) {
  EXPECT_EQ(plain_number(0.0, 3), "0");
  EXPECT_EQ(plain_number(1060.0, 3), "1060");
  EXPECT_EQ(plain_number(-0.0125, 3), "−0.0125");
  EXPECT_EQ(plain_number(9.6e-5, 2), "9.6·10⁻⁵");
  EXPECT_EQ(plain_number(1e-8, 2), "10⁻⁸");
  EXPECT_EQ(plain_number(9.999e-4, 2), "0.001");  // rounded first
  EXPECT_EQ(plain_number(2e5, 6), "2·10⁵");
  EXPECT_EQ(html_number(-2.5e7, 2), "−2.5·10<sup>7</sup>");
  EXPECT_EQ(plain_number(std::numeric_limits<double>::quiet_NaN(), 3), "–");
  EXPECT_EQ(plain_number(HUGE_VAL, 3), "–");
}

TEST(PlainNumber, NamesOnOneLineHaveGreekLettersAndLowDigits) {
  EXPECT_EQ(plain_symbol("theta1"), "θ₁");
  EXPECT_EQ(plain_symbol("ptheta"), "pθ");
  EXPECT_EQ(plain_symbol("x[12]"), "x[12]");
  EXPECT_EQ(plain_symbol("12"), "12");
  EXPECT_EQ(greek_text("alpha = 1/2, beta = beta, order 4"), "α = 1/2, β varied, order 4");
  EXPECT_EQ(greek_text("alphabet"), "alphabet");
}

// Small numbers leave their power of ten to the axis, and rounding is shaded only where data reach
// it.
TEST(PlainNumber, AxesHaveOnePowerOfTenAndAFloor) {
  const auto script = [](double size, std::optional<double> floor, bool logarithmic) {
    return app::gnuplot_script(
        {.panels = {{.title = "",
                     .x_label = "t",
                     .y_label = "error",
                     .logarithmic_y = logarithmic,
                     .series = {{.label = "", .points = {{0, size}, {1, 2 * size}}}},
                     .floor = floor}}},
        "folder/m.svg");
  };
  EXPECT_TRUE(contains(script(1e-7, {}, false), "set ylabel 'error  [10⁻⁷]'"));
  EXPECT_TRUE(contains(script(1e-7, {}, false), "using 1:($2/1e-7)"));
  EXPECT_TRUE(contains(script(1.0, {}, false), "set ylabel 'error'"));
  EXPECT_TRUE(contains(script(1e-15, 1e-16, true), "'rounding'"));
  EXPECT_FALSE(contains(script(1e-3, 1e-16, true), "'rounding'"));
  EXPECT_TRUE(contains(script(1.0, {}, false), "set output 'm.svg'"));
}

TEST(PlainNumber, WhatIsNoPictureHasNoDarkForm) {
  EXPECT_EQ(app::with_dark_form("no picture"), "no picture");
  EXPECT_TRUE(contains(app::with_dark_form("<svg a='b'><g/></svg>"), "prefers-color-scheme: dark"));
}

}  // namespace
}  // namespace hamgen::app_test
