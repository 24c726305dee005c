// The numbers of a model in the emitted code: what the compiler makes of them.
#include "generator/formats/literal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "generator/algebra/exact.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

// Half the distance of neighbouring numbers of the scalar at the value.
Rational half_unit(const Rational& value, const ScalarType& scalar) {
  const long smallest = scalar.digits == 24 ? -126 : scalar.digits == 53 ? -1022 : -16382;
  Rational size = abs(value);
  long exponent = 0;  // 2^exponent <= size < 2^(exponent + 1)
  for (; size >= 2; size /= 2) ++exponent;
  for (; size != 0 && size < 1; size *= 2) --exponent;
  exponent = std::max(exponent, smallest) - scalar.digits;
  Rational result = 1;
  if (exponent >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return result;
}

// For every literal one line: its value as mantissa and exponent, exactly.
std::string printer(const std::vector<Rational>& values) {
  std::string text =
      "#include <cstdio>\n"
      "template <class Real> void print(Real x) {\n"
      "  // x = (a + b + c) 2^e with doubles a, b, c: 159 bits.\n"
      "  int e = 0;\n"
      "  if (x != 0) {\n"
      "    for (; x >= 2 || x <= -2; x /= 2) ++e;\n"
      "    for (; x < 1 && x > -1; x *= 2) --e;\n"
      "  }\n"
      "  const double a = static_cast<double>(x);\n"
      "  const double b = static_cast<double>(x - static_cast<Real>(a));\n"
      "  const double c = static_cast<double>(x - static_cast<Real>(a) - static_cast<Real>(b));\n"
      "  std::printf(\"%a %a %a %d\\n\", a, b, c, e);\n"
      "}\n"
      "int main() {\n";
  for (const ScalarType& scalar : all_scalars()) {
    text += "  { using Real = " + std::string(scalar.cpp) + ";\n";
    for (const Rational& value : values) {
      if (!is_in_range(value, scalar)) continue;
      text += "    print<Real>(" + literal(value, scalar) + ");\n";
    }
    text += "  }\n";
  }
  return text + "}\n";
}

TEST(Literals, AreCorrectlyRoundedInEveryScalar) {
  std::vector<Rational> values;
  for (const char* text :
       {"0.1", "123456789012345678901", "3.14159265358979323846264338327950288419716939937510",
        "1e20", "0.33333333333333333333333333333", "1e-30", "16777217", "9007199254740993",
        "9007199254740995", "0", "1", "2.5", "1e-20", "299792458", "6.62607015e-34", "0.03",
        "-2.4978136594e-3", "16777217.000000001", "1.00000005960464477539062501"}) {
    values.push_back(text[0] == '-' ? Rational(-*parse_decimal(text + 1)) : *parse_decimal(text));
  }
  for (const Rational& value :
       {Rational(1, 3), Rational(-2, 7), Rational(22, 7), Rational(1, 12)}) {
    values.push_back(value);
  }
  std::istringstream lines(run_program(printer(values)));
  for (const ScalarType& scalar : all_scalars()) {
    for (const Rational& value : values) {
      std::string part[4];
      lines >> part[0] >> part[1] >> part[2] >> part[3];
      ASSERT_FALSE(part[3].empty());
      Rational got = 0;
      for (int i = 0; i < 3; ++i) got += from_double(std::strtod(part[i].c_str(), nullptr));
      for (int e = std::atoi(part[3].c_str()); e != 0; e += e > 0 ? -1 : 1) {
        e > 0 ? got *= 2 : got /= 2;
      }
      EXPECT_LE(abs(got - value), half_unit(value, scalar))
          << to_text(value) << " as " << scalar.name << " is " << literal(value, scalar);
    }
  }
}

TEST(Literals, BelowTheSmallestNormalNumberAreCorrectlyRounded) {
  const std::vector<Rational> values{*parse_decimal("1e-320"), *parse_decimal("1e-310"),
                                     *parse_decimal("4.9406564584124654e-324")};
  std::istringstream lines(run_program(printer(values)));
  for (const ScalarType& scalar : all_scalars()) {
    for (const Rational& value : values) {
      if (!is_in_range(value, scalar)) continue;
      std::string part[4];
      lines >> part[0] >> part[1] >> part[2] >> part[3];
      Rational got = 0;
      for (int i = 0; i < 3; ++i) got += from_double(std::strtod(part[i].c_str(), nullptr));
      for (int e = std::atoi(part[3].c_str()); e != 0; e += e > 0 ? -1 : 1) {
        e > 0 ? got *= 2 : got /= 2;
      }
      EXPECT_LE(abs(got - value), half_unit(value, scalar))
          << value.get_d() << " as " << scalar.name << " is " << literal(value, scalar);
    }
  }
}

// Each scalar's last numbers, and what would round to infinity or to 0.
TEST(Literals, OutsideTheRangeAreRefused) {
  struct Case {
    const char* scalar;
    const char* value;
    bool fits;
  };
  for (const auto& [name, text, fits] :
       {Case{"float", "3.4028234e38", true}, Case{"float", "3.4028236e38", false},
        Case{"float", "1.4e-45", true}, Case{"float", "7e-46", false},
        Case{"double", "1.7976931348623157e308", true},
        Case{"double", "1.797693134862316e308", false}, Case{"double", "4.9e-324", true},
        Case{"double", "2.4e-324", false}, Case{"long-double", "1e309", true},
        Case{"quad", "1e-390", true}}) {
    const ScalarType& scalar = find_scalar(name);
    const Rational value = *parse_decimal(text);
    EXPECT_EQ(is_in_range(value, scalar), fits) << name << " " << text;
    if (fits) {
      EXPECT_NO_THROW(static_cast<void>(literal(value, scalar))) << text;
    } else {
      EXPECT_THROW(static_cast<void>(literal(value, scalar)), OutOfRange) << text;
    }
  }
  Rational huge = *parse_decimal("1e400");
  for (int i = 0; i < 4; ++i) huge *= huge;  // 1e6400
  for (const ScalarType& scalar : all_scalars()) {
    EXPECT_THROW(static_cast<void>(literal(huge, scalar)), OutOfRange) << scalar.name;
    EXPECT_THROW(static_cast<void>(literal(1 / huge, scalar)), OutOfRange) << scalar.name;
    EXPECT_NO_THROW(static_cast<void>(literal(0, scalar))) << scalar.name;
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
