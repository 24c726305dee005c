// How reading an emitted file back can end early.
#pragma once

#include <stdexcept>
#include <string>

namespace hamgen {

// Here the text does something else than the program.
struct TextDifference : std::runtime_error {
  TextDifference(int where, const std::string& what) : std::runtime_error(what), line(where) {}
  int line;
};

// Here the text says something that the reader has no meaning for.
struct TextNotUnderstood : std::runtime_error {
  TextNotUnderstood(int where, const std::string& what) : std::runtime_error(what), line(where) {}
  int line;
};

}  // namespace hamgen
