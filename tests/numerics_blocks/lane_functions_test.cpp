// The elementary functions on lanes: how far from the function, to which side, and whether bits
// depend on neighbours, widths or instructions.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "generator/algebra/functions.hpp"
#include "generator/base/fixed_blocks.hpp"
#include "tests/numerics_blocks/lanes.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

int place_of(const std::string& name) {
  for (int i = 0; i < static_cast<int>(std::size(kLaneFunctions)); ++i) {
    if (kLaneFunctions[i].name == name) return i;
  }
  ADD_FAILURE() << name;
  return 0;
}

class Points {
 public:
  // Between 0 and 1.
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  // With random last digits: a sum of numbers has those of the larger one, which is rounded to one
  // side where it is even everywhere.
  double uniform(double low, double high) {
    const double value = low + (high - low) * next();
    const auto digits = static_cast<std::uint64_t>(256 * next());
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ digits);
  }
  double sign() { return next() < 0.5 ? -1 : 1; }
  // 2^e, e uniform; down to the smallest numbers.
  double size(double low, double high) {
    const double e = uniform(low, high);
    return std::ldexp(std::exp2(e - std::floor(e)), static_cast<int>(std::floor(e)));
  }

 private:
  std::uint64_t state_ = 88172645463325252ULL;
};

struct Point {
  double x = 0, y = 0;
};
// Where a function is measured.
struct LaneRange {
  const char* function;
  const char* name;
  Point (*point)(Points& points);
};

// Sizes from the smallest numbers to those below 2^high.
template <int high>
Point of_any_size(Points& points) {
  return {points.sign() * points.size(-1074, high)};
}
template <int low, int high>
Point between(Points& points) {
  return {points.uniform(low, high)};
}
// Neighbours of n pi/2, up to n = 10^6.
Point near_a_quarter(Points& points) {
  const double n = std::floor(1e6 * points.next() * points.next());
  const auto bits = std::bit_cast<std::int64_t>(n * M_PI_2);
  const auto beside = static_cast<std::int64_t>(8 * points.next()) - 4;
  return {std::bit_cast<double>(std::max<std::int64_t>(0, bits + beside))};
}
// Beyond 1, by 2^-53 and more; before it, on both sides of 0; and around it.
Point beyond_one(Points& points) { return {1 + points.size(-53, 0)}; }
Point before_one(Points& points) { return {points.sign() * (1 - points.size(-53, 0))}; }
Point around_one(Points& points) { return {1 + points.sign() * points.size(-53, -1)}; }
// Bases of so many powers of 2, and exponents that lead to all results there are.
template <int exponents>
Point of_power(Points& points) {
  const double x = points.size(-exponents, exponents);
  return {x, points.uniform(-745, 709.7) / std::log(x)};
}
Point of_power_near_one(Points& points) {
  const double x = 1 + points.sign() * points.size(-50, -2);
  return {x, points.uniform(-745, 709.7) / std::log(x)};
}
// Exponents as formulas have them.
Point of_small_power(Points& points) {
  return {points.size(-10, 10), std::floor(points.uniform(-24, 25)) / 6};
}
Point of_plane(Points& points) { return {points.uniform(-3, 3), points.uniform(-3, 3)}; }
Point of_whole_plane(Points& points) {
  return {of_any_size<1024>(points).x, of_any_size<1024>(points).x};
}

const LaneRange kRanges[] = {
    {"fabs", "all", of_any_size<1024>},
    {"sqrt", "all", [](Points& points) -> Point { return {points.size(-1074, 1024)}; }},
    {"sin", "turns", between<-10, 10>},
    {"sin", "all", of_any_size<1024>},
    {"sin", "near_a_quarter", near_a_quarter},
    {"cos", "turns", between<-10, 10>},
    {"cos", "all", of_any_size<1024>},
    {"cos", "near_a_quarter", near_a_quarter},
    {"tan", "turns", between<-10, 10>},
    {"tan", "all", of_any_size<1024>},
    {"tan", "near_a_quarter", near_a_quarter},
    {"exp", "middle", between<-5, 5>},
    {"exp", "all", between<-746, 710>},
    {"exp", "small", of_any_size<1>},
    {"sinh", "middle", between<-3, 3>},
    {"sinh", "all", between<-711, 711>},
    {"sinh", "small", of_any_size<1>},
    {"cosh", "middle", between<-3, 3>},
    {"cosh", "all", between<-711, 711>},
    {"tanh", "middle", between<-3, 3>},
    {"tanh", "all", between<-25, 25>},
    {"tanh", "small", of_any_size<1>},
    {"log", "middle", [](Points& points) -> Point { return {points.size(-3, 3)}; }},
    {"log", "all", [](Points& points) -> Point { return {points.size(-1074, 1024)}; }},
    {"log", "around_one", around_one},
    {"asinh", "middle", between<-5, 5>},
    {"asinh", "all", of_any_size<1024>},
    {"acosh", "middle", between<1, 6>},
    {"acosh", "all", [](Points& points) -> Point { return {points.size(0, 1024)}; }},
    {"acosh", "beyond_one", beyond_one},
    {"atanh", "middle", between<-1, 1>},
    {"atanh", "small", of_any_size<0>},
    {"atanh", "before_one", before_one},
    {"atan", "middle", between<-5, 5>},
    {"atan", "all", of_any_size<1024>},
    {"asin", "middle", between<-1, 1>},
    {"asin", "small", of_any_size<0>},
    {"asin", "before_one", before_one},
    {"acos", "middle", between<-1, 1>},
    {"acos", "small", of_any_size<0>},
    {"acos", "before_one", before_one},
    {"atan2", "middle", of_plane},
    {"atan2", "all", of_whole_plane},
    {"pow", "middle", of_power<3>},
    {"pow", "all", of_power<1074>},
    {"pow", "near_one", of_power_near_one},
    {"pow", "small", of_small_power},
};

struct Measured {
  double worst = 0;  // in units of the last place
  Point where;
  // Of value - (the function's value, rounded): its mean and that one's statistical error, in
  // units of the last place.  So measured, what rounding itself does near 0 or to constant values
  // is no bias.
  double bias = 0;
  double bias_error = 0;
  double outward = 0;  // the same of sizes
  long wrong = 0;      // infinities and NaN
};

double last_place(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, std::max(exponent - 53, -1074));
}

template <class Function>
Measured measured(const LaneRange& range, const Function& function, long count) {
  constexpr int block = 64;
  const LaneFunction& reference = kLaneFunctions[place_of(range.function)];
  Points points;
  Measured result;
  double squares = 0;
  for (long done = 0; done < count; done += block) {
    double x[block];
    double y[block];
    double values[block];
    for (int i = 0; i < block; ++i) {
      const Point point = range.point(points);
      x[i] = point.x;
      y[i] = point.y;
    }
    function(x, y, values, block);
    for (int i = 0; i < block; ++i) {
      const Quad exact = reference.quad(x[i], y[i]);
      const auto rounded = static_cast<double>(exact);
      if (!std::isfinite(rounded) || !std::isfinite(values[i])) {
        const bool both_nan = std::isnan(rounded) && std::isnan(values[i]);
        if (values[i] != rounded && !both_nan) {
          ++result.wrong;
          result.where = {x[i], y[i]};
        }
        continue;
      }
      const double unit = last_place(rounded);
      const double error = std::fabs(static_cast<double>((values[i] - exact) / unit));
      if (error > result.worst) {
        result.worst = error;
        result.where = {x[i], y[i]};
      }
      const double beside = (values[i] - rounded) / unit;
      result.bias += beside;
      result.outward += std::signbit(rounded) ? -beside : beside;
      squares += beside * beside;
    }
  }
  const auto n = static_cast<double>(count);
  result.bias /= n;
  result.outward /= n;
  // Of fewer than one difference in n nothing is known.
  result.bias_error = std::sqrt(std::max(squares, 1.0)) / n;
  return result;
}

// At most one last place, and no bias above four of its statistical errors: in a hundred
// measurements of two means a right function fails once in a hundred times, and the points are
// always the same.
bool is_good(const Measured& m) {
  const double most = 4 * m.bias_error;
  return m.worst <= 1 && m.wrong == 0 && std::fabs(m.bias) <= most && std::fabs(m.outward) <= most;
}
std::string said(const Measured& m) {
  char text[200];
  std::snprintf(text, sizeof text,
                "worst %.3f at %.17g, %.17g; bias %.1e, outward %.1e, both +- %.0e; %ld wrong",
                m.worst, m.where.x, m.where.y, m.bias, m.outward, m.bias_error, m.wrong);
  return text;
}

// 10^7 points where a variable asks for them.
long point_count() {
  const char* all = std::getenv("HAMGEN_LANE_POINTS");
  return all == nullptr ? 32000 : std::atol(all);
}

class LaneFunctions : public ::testing::TestWithParam<LaneRange> {};

TEST_P(LaneFunctions, AreWithinOneLastPlaceOnBothSidesAlike) {
  const int function = place_of(GetParam().function);
  const Measured m = measured(
      GetParam(),
      [&](const double* x, const double* y, double* values, int count) {
        of_portable::evaluate(function, 4, x, y, values, count);
      },
      point_count());
  RecordProperty("measured", said(m));
  EXPECT_TRUE(is_good(m)) << said(m);
}

INSTANTIATE_TEST_SUITE_P(Ranges, LaneFunctions, ::testing::ValuesIn(kRanges), [](const auto& row) {
  return std::string(row.param.function) + "_" + row.param.name;
});

// What is a little wrong is found: the last place of one value in fifty, or one value that is one
// and a half last places off.
TEST(LaneMeasurement, FindsABiasAndASingleWrongValue) {
  const int function = place_of("exp");
  const LaneRange range = {"exp", "middle", between<-5, 5>};
  long seen = 0;
  const auto spoilt = [&](int every, int places) {
    return measured(
        range,
        [&](const double* x, const double* y, double* values, int count) {
          of_portable::evaluate(function, 4, x, y, values, count);
          for (int i = 0; i < count; ++i) {
            if (++seen % every != 0) continue;
            for (int k = 0; k < places; ++k) values[i] = std::nextafter(values[i], kInfinity);
          }
        },
        32000);
  };
  EXPECT_FALSE(is_good(spoilt(50, 1)));
  seen = 0;
  EXPECT_FALSE(is_good(spoilt(31000, 2)));
  seen = 0;
  EXPECT_TRUE(is_good(spoilt(1 << 20, 1)));
}

// Every argument that is special to one of the functions, with every other one.
std::vector<double> special_numbers() {
  std::vector<double> numbers = {0,         0x1p-1074,
                                 0x1p-1022, 0x1p-60,
                                 0.25,      0.5,
                                 1,         1.5,
                                 2,         3,
                                 4,         M_PI_2,
                                 M_PI,      709.75,
                                 745.25,    746,
                                 0x1p20,    0x1p52,
                                 0x1p53,    0x1p60,
                                 0x1p600,   std::numeric_limits<double>::max(),
                                 kInfinity};
  numbers.push_back(0x1p52 + 1);
  numbers.push_back(0x1p53 - 1);
  const std::size_t count = numbers.size();
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(-numbers[i]);
    numbers.push_back(std::nextafter(numbers[i], 0));
    numbers.push_back(std::nextafter(-numbers[i], -kInfinity));
  }
  numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  return numbers;
}

TEST(LaneFunctionsAt, SpecialNumbersAreWhatTheLibrarySays) {
  const std::vector<double> numbers = special_numbers();
  for (int function = 0; function < static_cast<int>(std::size(kLaneFunctions)); ++function) {
    const std::string name = kLaneFunctions[function].name;
    const bool of_two = name == "atan2" || name == "pow";
    for (const double x : numbers) {
      for (const double y : of_two ? numbers : std::vector<double>{0}) {
        const double expected = kLaneFunctions[function].library(x, y);
        double value = 0;
        of_portable::evaluate(function, 1, &x, &y, &value, 1);
        // The library is not exact: up to two last places, or 2.5 of its hyperbolic functions.
        const bool near = std::fabs(value - expected) <= 3 * last_place(expected);
        const bool same = std::isnan(expected) ? std::isnan(value)
                          : std::isinf(expected) || expected == 0
                              ? value == expected && std::signbit(value) == std::signbit(expected)
                              : near;
        EXPECT_TRUE(same) << name << " " << x << " " << y << ": " << value << " for " << expected;
      }
    }
  }
}

// All kinds of numbers beside each other, so that each lane has neighbours that are done otherwise.
std::vector<Point> mixed_points() {
  std::vector<Point> mixed;
  Points points;
  const std::vector<double> numbers = special_numbers();
  for (int i = 0; i < 200; ++i) {
    for (const LaneRange& range : kRanges) mixed.push_back(range.point(points));
    const auto any = [&] { return numbers[static_cast<std::size_t>(points.next() * 100)]; };
    mixed.push_back({any(), any()});
  }
  mixed.resize(mixed.size() / 8 * 8);
  return mixed;
}

std::vector<std::uint64_t> bits_of_values(Evaluate* evaluate, int function, int lanes) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Point& point : mixed_points()) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  std::vector<double> values(x.size());
  evaluate(function, lanes, x.data(), y.data(), values.data(), static_cast<int>(x.size()));
  std::vector<std::uint64_t> bits;
  for (const double value : values) {
    bits.push_back(std::isnan(value) ? ~0ULL : std::bit_cast<std::uint64_t>(value));
  }
  return bits;
}

TEST(LaneFunctionsAt, AllWidthsAndInstructionsHaveTheSameBits) {
  struct Instructions {
    const char* name;
    Evaluate* evaluate;
    bool supported;
  };
  const Instructions all[] = {
    {"portable", of_portable::evaluate, true},
#if defined __x86_64__
    {"avx2", of_avx2::evaluate, __builtin_cpu_supports("avx2") != 0},
    {"avx512", of_avx512::evaluate,
     __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0},
#endif
  };
  for (int function = 0; function < static_cast<int>(std::size(kLaneFunctions)); ++function) {
    const std::vector<std::uint64_t> expected = bits_of_values(of_portable::evaluate, function, 1);
    for (const Instructions& instructions : all) {
      if (!instructions.supported) continue;
      for (const int lanes : {1, 2, 4, 8}) {
        EXPECT_EQ(bits_of_values(instructions.evaluate, function, lanes), expected)
            << kLaneFunctions[function].name << " " << instructions.name << " " << lanes;
      }
    }
  }
}

// A function of the language that lanes have of their own has its row here, as a power has.
TEST(LaneFunctionsAt, EveryFunctionOfTheLanguageIsThere) {
  std::size_t own = 1;
  for (const Function& function : all_functions()) {
    if (!is_defined(lane_blocks(), "lane_" + std::string(function.name))) continue;
    place_of(std::string(function.cpp));
    ++own;
  }
  EXPECT_EQ(std::size(kLaneFunctions), own);
  EXPECT_GE(own, 18U);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
