// Text with indentation, line by line.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace hamgen {

class CodeWriter {
 public:
  // A line of code; one that would pass column 100 goes on below, four columns further in.
  void line(const std::string& text = "") {
    std::size_t indent = static_cast<std::size_t>(2 * depth_);
    std::string rest = text;
    if (text.find("//") == std::string::npos && text.find('\"') == std::string::npos) {
      while (indent + rest.size() > kColumns) {
        const std::size_t cut = break_point(rest, kColumns - indent);
        if (cut == std::string::npos) break;
        text_.append(indent, ' ');
        text_ += rest.substr(0, cut);
        text_ += '\n';
        rest = rest.substr(cut + 1);
        indent = static_cast<std::size_t>(2 * depth_ + 4);
      }
    }
    if (!rest.empty()) text_.append(indent, ' ');
    text_ += rest;
    text_ += '\n';
  }
  // Opens a block: the text, " {", and a deeper level.
  void open(const std::string& text) {
    line(text + " {");
    ++depth_;
  }
  void close(const std::string& tail = "") {
    --depth_;
    line("}" + tail);
  }
  // Several lines as they are, each at the present depth.
  void lines(const std::string& text) {
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = text.find('\n', begin);
      line(text.substr(begin, end - begin));
      if (end == std::string::npos) break;
      begin = end + 1;
    }
  }
  void indent() { ++depth_; }
  void dedent() { --depth_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kColumns = 100;

  // The blank to break at: the last one within the width that follows an operator or a comma.
  static std::size_t break_point(const std::string& text, std::size_t width) {
    const std::size_t start = text.find_first_not_of(' ');
    for (std::size_t i = std::min(width, text.size() - 1); i > start + 12; --i) {
      if (text[i] == ' ' && std::string_view("+-*/,=?:(").find(text[i - 1]) != std::string_view::npos) {
        return i;
      }
    }
    return std::string::npos;
  }

  std::string text_;
  int depth_ = 0;
};

}  // namespace hamgen
