// What a user asks in words, read where it is given: "sweeps:3" with the three sweeps it means.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace hamgen {

// Value::read(text) says what a text means, of an empty one what holds where nothing is asked, and
// throws UsageError or ModelError for one that means nothing.
template <class Value>
class Asked {
 public:
  Asked() : Asked(std::string()) {}
  Asked(std::string text) : text_(std::move(text)), value_(Value::read(text_)) {}
  Asked(const char* text) : Asked(std::string(text)) {}

  // As it was typed.
  [[nodiscard]] const std::string& text() const { return text_; }
  // Is nothing asked?
  [[nodiscard]] bool empty() const { return text_.empty(); }
  [[nodiscard]] const Value& operator*() const { return value_; }
  [[nodiscard]] const Value* operator->() const { return &value_; }

  [[nodiscard]] bool operator==(std::string_view text) const { return text_ == text; }

 private:
  std::string text_;
  Value value_;
};

}  // namespace hamgen
