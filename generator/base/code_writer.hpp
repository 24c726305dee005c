// Text with indentation, line by line.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generator/base/quoted_text.hpp"

namespace hamgen {

class CodeWriter {
 public:
  // A line of code; one that would pass column 100 is broken as clang-format would: at the
  // outermost operator or comma that fits, going on under what the operand began with.  The head of
  // a function that has an argument too long for that goes on in a line of its own.
  void line(const std::string& text = "") {
    std::string_view rest = text;
    const std::size_t blanks = std::min(text.find_first_not_of(' '), text.size());
    rest.remove_prefix(blanks);
    const std::size_t depth = static_cast<std::size_t>(2 * depth_) + blanks;
    std::size_t indent = depth;
    std::vector<std::size_t> columns{
        first_operand(rest, depth)};  // where each bracket level goes on
    if (text.find("//") == std::string::npos && text.find('"') == std::string::npos) {
      if (const std::size_t begin = arguments_of_head(rest, indent); begin != rest.npos) {
        text_.append(indent, ' ');
        text_.append(rest.substr(0, begin)) += '\n';
        rest = rest.substr(begin);
        indent = depth + 4;
        columns = {indent};
      }
      if (const std::size_t begin = controlled(rest, indent); begin != rest.npos) {
        text_.append(indent, ' ');
        text_.append(rest.substr(0, begin - 1)) += '\n';
        return line(std::string(blanks + 2, ' ').append(rest.substr(begin)));
      }
      std::size_t equals = rest.find(" = ");
      const auto go_on_behind_equals = [&] {
        text_.append(indent, ' ');
        text_.append(rest.substr(0, equals + 2)) += '\n';
        rest = rest.substr(equals + 3);
        indent = depth + 4;
        equals = rest.npos;
      };
      while (indent + rest.size() > kColumns) {
        if (equals != std::string_view::npos && depth + 4 + rest.size() - equals - 3 <= kColumns) {
          go_on_behind_equals();
          break;
        }
        std::size_t cut = break_point(rest, equals, kColumns - indent, columns.size());
        if (cut == std::string_view::npos) {
          // Nothing fits: behind the " = ", or less far to the right, or as soon as may be.
          columns.assign(columns.size(), depth + 4);
          if (equals != std::string_view::npos) {
            go_on_behind_equals();
            continue;
          }
          if (indent > depth + 4) {
            indent = depth + 4;
            continue;
          }
          cut = first_break(rest, columns.size());
          if (cut == std::string_view::npos) break;
        }
        for (std::size_t i = 0; i < cut; ++i) {
          if (rest[i] == '(' || rest[i] == '{') columns.push_back(indent + i + 1);
          if ((rest[i] == ')' || rest[i] == '}') && columns.size() > 1) columns.pop_back();
        }
        text_.append(indent, ' ');
        text_.append(rest.substr(0, cut)) += '\n';
        rest = rest.substr(cut + 1);
        // Sought anew only once it is behind: a line may have a thousand breaks.
        if (equals != std::string_view::npos)
          equals = equals > cut ? equals - cut - 1 : rest.find(" = ");
        indent = columns.back();
      }
    }
    if (!rest.empty()) text_.append(indent, ' ');
    text_ += rest;
    text_ += '\n';
  }
  // A comment that hangs under its own beginning: "//   solve     Newton ...".
  void comment(const std::string& lead, const std::string& text) {
    std::string line = lead;
    const std::string hanging = "//" + std::string(lead.size() - 2, ' ');
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      const std::string word = text.substr(begin, end - begin);
      if (line.size() + word.size() > kColumns - 2 && line != hanging) {
        while (line.ends_with(' ')) line.pop_back();
        text_ += comment_text(line) + '\n';
        line = hanging;
      }
      line += word + " ";
      begin = end + 1;
    }
    while (line.ends_with(' ')) line.pop_back();
    text_ += comment_text(line) + '\n';
  }
  // A comment of one line, however long: a command, a path.
  void remark(const std::string& lead, const std::string& text) { line(lead + comment_text(text)); }
  // Opens a block: the text, " {", and a deeper level.
  void open(const std::string& text) {
    line(text.empty() ? "{" : text + " {");
    ++depth_;
  }
  void close(const std::string& tail = "") {
    --depth_;
    line("}" + tail);
  }
  // Members with their remarks in one column; a long member has its remark above it.
  void aligned(const std::vector<std::pair<std::string, std::string>>& members) {
    constexpr std::size_t kLong = 60;
    std::size_t width = 0;
    for (const auto& [code, remark] : members) {
      if (!remark.empty() && code.size() <= kLong) width = std::max(width, code.size());
    }
    for (const auto& [code, remark] : members) {
      if (remark.empty()) {
        line(code);
      } else if (code.size() > kLong) {
        line("// " + comment_text(remark));
        line(code);
      } else {
        line(code + std::string(width - code.size() + 2, ' ') + "// " + comment_text(remark));
      }
    }
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
  // Does the text fit one line at the present depth?
  [[nodiscard]] bool fits(const std::string& text) const {
    return 2 * static_cast<std::size_t>(depth_) + text.size() <= kColumns;
  }
  void indent() { ++depth_; }
  void dedent() { --depth_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kColumns = 100;

  // Where the operands of a statement begin: after "return " or " = ".
  static std::size_t first_operand(std::string_view text, std::size_t depth) {
    if (text.starts_with("return ")) return depth + 7;
    const std::size_t equals = text.find(" = ");
    return equals == std::string_view::npos ? depth + 4 : depth + equals + 3;
  }

  // Where the statement begins that "if (...)" or "for (...)" stands before, if both are too long
  // for a line and the first is not.
  static std::size_t controlled(std::string_view text, std::size_t indent) {
    if (indent + text.size() <= kColumns ||
        !(text.starts_with("if (") || text.starts_with("for (")))
      return text.npos;
    int open = 0;
    for (std::size_t i = 0; i + 2 < text.size() && indent + i < kColumns; ++i) {
      if (text[i] == '(') ++open;
      if (text[i] != ')' || --open > 0) continue;
      return text[i + 2] == '{' ? text.npos : i + 2;
    }
    return text.npos;
  }
  // Where the arguments of the head of a function begin, if one of them passes the last column
  // there.
  static std::size_t arguments_of_head(std::string_view text, std::size_t indent) {
    const bool is_head = text.find("inline ") != text.npos && text.ends_with(") {");
    if (!is_head || indent + text.size() <= kColumns) return text.npos;
    const std::size_t begin = text.find('(') + 1;
    for (std::size_t at = begin; at < text.size();) {
      const std::size_t end = std::min(text.find(", ", at), text.size() - 1) + 1;
      if (indent + begin + end - at > kColumns) return begin;
      at = end + 1;
    }
    return text.npos;
  }

  // The blank to break at: within the width, at the outermost bracket level that has one, after
  // a comma, plus or minus rather than after times or divided by, as late as possible; behind the
  // " = " that starts at `start`, if there is one.
  static std::size_t break_point(std::string_view text, std::size_t start, std::size_t width,
                                 std::size_t level) {
    std::size_t best = std::string::npos;
    std::pair<std::size_t, int> least{1000, 0};
    for (std::size_t i = 1; i < std::min(width + 1, text.size()); ++i) {
      const char before = text[i - 1];
      if (before == '(' || before == '{' || before == '[') ++level;
      if ((before == ')' || before == '}' || before == ']') && level > 0) --level;
      if (text[i] != ' ' || (start != std::string::npos && i <= start + 2)) continue;
      // Not what makes a type that of an address.
      const bool of_two = i >= 2 && (text[i - 2] == ' ' || text[i - 2] == '&');
      const bool weak = std::string_view("+-,?|").find(before) != std::string_view::npos ||
                        (before == '&' && of_two);
      const bool strong = (before == '*' || before == '/') && i >= 2 && text[i - 2] == ' ';
      if (!weak && !strong) continue;
      const std::pair<std::size_t, int> rank{level, weak ? 0 : 1};
      if (rank <= least) {
        least = rank;
        best = i;
      }
    }
    return best;
  }

  // The first blank to break at.
  static std::size_t first_break(std::string_view text, std::size_t level) {
    std::size_t width = std::min(text.find(' '), text.size());
    while (width < text.size()) {
      const std::size_t cut = break_point(text, text.npos, width, level);
      if (cut != text.npos) return cut;
      width = std::min(text.find(' ', width + 1), text.size());
    }
    return text.npos;
  }

  std::string text_;
  int depth_ = 0;
};

}  // namespace hamgen
