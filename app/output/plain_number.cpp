#include "app/output/plain_number.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace hamgen::app {
namespace {

// Rounded to so many digits: mantissa and exponent.
std::pair<std::string, int> parts_of(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = text.find('e');
  return {text.substr(0, e), std::atoi(text.c_str() + e + 1)};
}

bool is_plain(double value, int exponent) {
  return value == 0.0 || (exponent >= -3 && exponent < 5);
}

std::string without_power(double value, int digits, int exponent) {
  if (value == 0.0) return "0";
  std::string text =
      fmt::format("{:.{}f}", value, exponent + 1 >= digits ? 0 : digits - 1 - exponent);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
  }
  return text;
}

std::string minus_sign(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

std::string number_with(double value, int digits, std::string (*power)(int)) {
  if (!std::isfinite(value)) return "–";
  const DecimalParts parts = decimal_parts(value, digits);
  if (!parts.exponent) return minus_sign(parts.mantissa);
  const bool is_power = parts.mantissa == "1" || parts.mantissa == "-1";
  return minus_sign(is_power ? parts.mantissa.substr(0, parts.mantissa.size() - 1) +
                                   power(*parts.exponent)
                             : parts.mantissa + "·" + power(*parts.exponent));
}

std::string html_power(int exponent) {
  return "10<sup>" + minus_sign(std::to_string(exponent)) + "</sup>";
}

}  // namespace

DecimalParts decimal_parts(double value, int digits) {
  if (!std::isfinite(value)) return {"–", std::nullopt};
  const auto [mantissa, exponent] = parts_of(value, digits);
  if (is_plain(value, exponent)) return {without_power(value, digits, exponent), std::nullopt};
  // Of many digits the last zeros are those of a round number, as all are of a power of ten.
  constexpr int many = 3;
  const std::string bare = mantissa.substr(0, mantissa.find_last_not_of("0.") + 1);
  if (bare == "1" || bare == "-1") return {bare, exponent};
  std::string shown = mantissa;
  if (digits > many && shown.find('.') != std::string::npos) {
    shown.erase(shown.find_last_not_of('0') + 1);
    if (shown.ends_with('.')) shown.pop_back();
  }
  return {shown, exponent};
}

std::string power_of_ten(int exponent) {
  constexpr std::array<std::string_view, 10> digits = {"⁰", "¹", "²", "³", "⁴",
                                                       "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char c : std::to_string(exponent))
    text += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string plain_number(double value, int digits) {
  return number_with(value, digits, power_of_ten);
}

std::string terminal_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const int exponent = parts_of(value, digits).second;
  return exponent < -3 || exponent > 12 ? fmt::format("{:.{}g}", value, digits)
                                        : without_power(value, digits, exponent);
}

std::string html_number(double value, int digits) { return number_with(value, digits, html_power); }

}  // namespace hamgen::app
