// Languages that are C but for some words.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hamgen {

// What is written in one of them is the text in C11 with its words in place of C11's, and what is
// read back is turned into C11 first: formats/c_header.hpp and readback/c_file.hpp both take from
// here what is different.
struct CFamily {
  std::string_view format;                     // that is written in it
  std::string_view language;                   // as the first lines of a file say it
  std::string_view extension = ".h";           // of a file
  std::vector<std::string_view> opening;       // lines behind #pragma once, directives all
  bool has_suffixes = true;                    // is it sinf for a float, sinl for a long double?
  bool has_array_arguments = true;             // else a row of numbers is given by its address
  std::vector<std::string_view> scalars = {};  // that it has; none: all that C has
  std::vector<std::pair<std::string_view, std::string_view>> words = {};  // of C11, and its own
  std::vector<std::string_view> reserved = {};  // that C11 leaves free: a name gets a '_'

  // The words, and the names that are reserved.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> replacements() const;
};

// The first is C11; the row of another one is all that is said of it.
[[nodiscard]] std::span<const CFamily> c_families();
// That of this format, of which there is one.
[[nodiscard]] const CFamily& c_family_of_format(std::string_view format);
// That of files whose names end so; null of another one.
[[nodiscard]] const CFamily* c_family_of_file(std::string_view name);
// The text in C11 with this language's words, in comments none.  Refuses a name that a reserved one
// would get.
[[nodiscard]] std::string in_words_of(const CFamily& family, const std::string& text);

}  // namespace hamgen
