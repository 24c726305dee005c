// Routines with one thing changed.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/build_program.hpp"

namespace hamgen::verify_test {

// The model of a text without its first line.
[[nodiscard]] Mechanics mechanics_of(const std::string& text);
[[nodiscard]] LoweredStep lowered_of(const Mechanics& mechanics, const Scheme& scheme,
                                     const std::string& solver, bool lanes = false);

// Every value that a routine computes.
void for_each_expression(Program& code, const std::function<void(Expression&)>& visit);

struct Mutant {
  std::string kind;         // "sign"
  std::string description;  // "cos(q) -> sin(q)"
  Program code;
};

// Of all of them every so many, from `first` on, which differs from case to case: all take minutes.
struct Some {
  std::size_t every = 1;
  std::size_t first = 0;
};

// A sign, a coefficient, an operand, a power, a variable, a function changed in a handful of places
// that are spread over the routines, or over those of these names.
[[nodiscard]] std::vector<Mutant> mutants_of(const Program& original, Some some = {},
                                             const std::set<std::string>& routines = {});
// Substeps exchanged and left out; instructions left out, loops that run too far or not far enough;
// or only instructions and loops of routines of these names, each of them.
[[nodiscard]] std::vector<Mutant> mutants_of_structure(const Program& original, Some some = {},
                                                       const std::set<std::string>& routines = {});

}  // namespace hamgen::verify_test
