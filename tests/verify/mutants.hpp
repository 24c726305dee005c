// Programs with one thing changed, and an oracle that says if they still compute the same.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/program.hpp"

namespace hamgen::verify_test {

// The model of a text without its first line.
[[nodiscard]] Mechanics mechanics_of(const std::string& text);
[[nodiscard]] Program program_of(const Mechanics& mechanics, const Scheme& scheme,
                                 const std::string& solver);

// Every expression the program holds.
void for_each_expression(Program& program, const std::function<void(Expression&)>& visit);

struct Mutant {
  std::string kind;         // "sign"
  std::string description;  // "cos(q) -> sin(q)"
  Program program;
};

// A sign, a coefficient, an operand, a power, a variable, a function changed in a handful of places
// that are spread over the program.
[[nodiscard]] std::vector<Mutant> mutants_of(const Program& original);
// Substeps exchanged, left out, repeated; entries of the tableau exchanged.
[[nodiscard]] std::vector<Mutant> mutants_of_sequence(const Program& original);

// By evaluating both in double, which shares nothing with the proof.
[[nodiscard]] bool computes_the_same(const Program& a, const Program& b);

}  // namespace hamgen::verify_test
