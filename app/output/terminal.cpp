#include "app/output/terminal.hpp"

#include <cerrno>
#include <cstdio>
#include <string>

#include "generator/base/quoted_text.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {

void print_buffered(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw runtime::file_error("write to", "standard output", errno);
}

void print(std::string_view text) {
  print_buffered(visible_lines(text));
  if (std::fflush(stdout) != 0) throw runtime::file_error("write to", "standard output", errno);
}

void print_error(std::string_view text) {
  std::fflush(stdout);
  const std::string shown = visible_lines(text);
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

}  // namespace hamgen::app
