// A step's routines, or a sum's loops, as a list of events in which numbers that tell places apart
// stand by themselves: two sizes of one system are compared by it.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/program/program.hpp"

namespace hamgen {

// Among the names of a loop: those of its upper end follow.
inline constexpr const char* kUpTo = "to";
// The word before a symbol of which a multiple is added or assigned, and nothing else.
inline constexpr const char* kAlone = "alone";

struct CodeEvent {
  enum class Kind {
    word,     // anything that has to be the same; names: objects that it takes whole
    routine,  // begins: its name
    call,     // of a routine: its name
    shared,   // its arguments: one that it changes is a part of one that it reads
    loop,     // begins: its index; names and numbers of its two ends
    end,      // of a loop
    local,    // is declared
    get,      // an object or a local is read, and elements of it follow
    set,      // ... is assigned
    add,      // ... is added to
    element,  // in one dimension: the names of the indices; their factors and the constant
    index,    // an index itself is the number
  };
  Kind kind = Kind::word;
  std::string text = {};
  std::vector<std::string> names = {};
  std::vector<long> numbers = {};
  int lanes = 0;  // of a loop: so many at once
};

// All but `left_out`.
[[nodiscard]] std::vector<CodeEvent> outline(const Program& code,
                                             const std::set<std::string>& left_out);
[[nodiscard]] std::vector<CodeEvent> outline(const std::vector<Kernel>& kernels);

}  // namespace hamgen
