// The numbers in a font's file: big-endian, checked against its end.
#pragma once

#include <string>
#include <string_view>

#include "app/output/font_subset.hpp"

namespace hamgen::app {

class FontBytes {
 public:
  explicit FontBytes(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t number(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || length > bytes_.size() - at) throw FontError("it ends too early");
    std::size_t value = 0;
    for (std::size_t i = 0; i < length; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes_[at + i]);
    return value;
  }
  [[nodiscard]] std::size_t byte(std::size_t at) const { return number(at, 1); }
  [[nodiscard]] std::size_t word(std::size_t at) const { return number(at, 2); }
  [[nodiscard]] std::size_t long_word(std::size_t at) const { return number(at, 4); }

  [[nodiscard]] std::string_view part(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || length > bytes_.size() - at) throw FontError("it ends too early");
    return bytes_.substr(at, length);
  }
  [[nodiscard]] FontBytes from(std::size_t at) const {
    return FontBytes(part(at, bytes_.size() - std::min(at, bytes_.size())));
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

// `value` in so many bytes.
[[nodiscard]] inline std::string font_number(std::size_t value, std::size_t length) {
  std::string text(length, '\0');
  for (std::size_t i = 0; i < length; ++i)
    text[length - 1 - i] = static_cast<char>(value >> (8 * i) & 0xFF);
  return text;
}

}  // namespace hamgen::app
