// C++ names for the symbols of a program: readable, unique, never a keyword.
#pragma once

#include <map>
#include <set>
#include <string>

#include "generator/program/code.hpp"

namespace hamgen {

// The user's name, with a trailing underscore if C++ or the emitted code has other plans for it.
[[nodiscard]] std::string identifier(const std::string& name);

// The same for a member of a struct, which may be called what a local may not: z.h, par.k.
[[nodiscard]] std::string member_identifier(const std::string& name);

// The same for a namespace, which may not be called what any header has in the global one.
[[nodiscard]] std::string namespace_identifier(const std::string& name);

// Throws UsageError unless the text is a namespace, "a" or "a::b", with names that C++ and the
// emitted code leave free.
void require_namespace(const std::string& text);

// "q[12]" is {"q", 12}; "q" is {"q", none}.
struct ElementName {
  std::string base;
  bool indexed = false;
  long index = 0;
};
[[nodiscard]] ElementName split_element(const std::string& name);

// What a sweep makes of the symbol before it: "bar(q) next" is q_bar_next.
inline constexpr const char* kNext = " next";

// Gives out names for one scope.
class Names {
 public:
  // The identifier for a symbol, the same every time: "bar(q[1])" is q_1_bar, "H(q,p)" is H_q_p,
  // "R(q)" is R_q, "delta(q)" is delta_q, a temporary is t1, t2, ...
  const std::string& local(const std::string& symbol);
  // Keeps a name from being given out.
  void reserve(const std::string& name) { taken_.insert(name); }
  // Says what a symbol is called.
  void set(const std::string& symbol, const std::string& text);
  [[nodiscard]] std::string unique(const std::string& wanted);

 private:
  std::map<std::string, std::string> names_;
  std::set<std::string> taken_;
  int temporaries_ = 0;
};

// A symbol of a routine is a local or a place: printed, one of both would be taken for the other.
void require_distinct_symbols(const Routine& routine);

}  // namespace hamgen
