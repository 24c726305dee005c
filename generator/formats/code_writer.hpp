// Text with indentation, line by line.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace hamgen {

class CodeWriter {
 public:
  void line(const std::string& text = "") {
    if (!text.empty()) text_.append(static_cast<std::size_t>(2 * depth_), ' ');
    text_ += text;
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
  std::string text_;
  int depth_ = 0;
};

}  // namespace hamgen
