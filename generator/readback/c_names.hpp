// A header in C: its names have prefixes where C++ has namespaces, and records go by their
// addresses.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/readback/precision.hpp"
#include "generator/readback/tokens.hpp"

namespace hamgen {

// pendulum_State, pendulum_stormer_verlet_solve, hamgen_two_sumf
struct CNames {
  std::string system, method;  // prefixes without "_"
  const Precision& precision;

  // With the prefix of the system for what a system has whatever its method.
  [[nodiscard]] std::string named(std::string_view name) const;
  [[nodiscard]] std::string block(std::string_view name) const;
  // A text in which Real stands for the type of numbers, N::x for a name of the header and
  // hamgen::x for one of the fixed blocks, as C.
  [[nodiscard]] std::string text(std::string_view of) const;
};

// "f" of float, "l" of long double.
[[nodiscard]] std::string_view suffix_of(const Precision& precision);
// Is it one of <math.h>, without such a suffix, that is called for a function of the language?
[[nodiscard]] bool is_library_function(std::string_view name);

// What stands before a name of the header in `cpp_words`: no word of C begins with it.
inline constexpr char kOfHeader = '@';

// The words of functions as those of C++: "@solve", "@State", "@two_sum" for names of the header
// and of the fixed blocks, "@Real", "std::sin", State() for (State){0}.  Without "(void)par;".
[[nodiscard]] std::vector<CppToken> cpp_words(std::span<const CppToken> tokens,
                                              const CNames& names);

}  // namespace hamgen
