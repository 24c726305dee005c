// The floating-point scalars a program can be written in.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/algebra/exact.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

struct ScalarType {
  std::string_view name;     // on the command line
  std::string_view cpp;      // its C++ type
  int digits = 53;           // of the binary mantissa
  std::string_view suffix;   // of literals
  std::string_view epsilon;  // 2^(1 - digits) as a literal
  std::string_view largest;  // a literal close to the largest finite number
  int low = -1074;           // the smallest number is 2^low,
  int high = 1024;           // and all are below 2^high:
  std::string_view range;    // in decimals
  std::string_view space;    // what its namespaces are called
};

[[nodiscard]] std::span<const ScalarType> all_scalars();
// Throws UsageError, naming those there are.  "" is double.
[[nodiscard]] const ScalarType& find_scalar(std::string_view name);

// One of the list.
struct ScalarWish {
  const ScalarType* type = nullptr;
  [[nodiscard]] static ScalarWish read(const std::string& name) { return {&find_scalar(name)}; }
};

// Is there a finite number of the type nearest to the value, and not 0 unless the value is?
[[nodiscard]] bool is_in_range(const Rational& value, const ScalarType& scalar);
// "1e40, outside the range of float" and what would work.
[[nodiscard]] std::string out_of_range_message(const Rational& value, const ScalarType& scalar);
[[nodiscard]] std::string out_of_range_help(const Rational& value, const ScalarType& scalar);

// A constant the code needs and the type has no number for.
class OutOfRange : public UsageError {
 public:
  OutOfRange(const Rational& value, const ScalarType& scalar);
  // The same without a place.
  [[nodiscard]] const Diagnostic& diagnostic() const { return diagnostic_; }

 private:
  Diagnostic diagnostic_;
};

// 2^exponent.
[[nodiscard]] Rational power_of_two(long exponent);

}  // namespace hamgen
