// A member's step in C++: what depends on h alone, the solution of its equations, many steps.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// What the solves of a program need besides their own text.
struct MemberParts {
  bool newton = false;
  bool simplified = false;  // its matrix is approximate
  bool fixed_point = false;
  bool elimination = false;                // a linear system is solved by emitted elimination
  bool eigen = false;                      // or by Eigen
  bool inverse = false;                    // a matrix is inverted once per run
  bool rest = false;                       // increments come with a rest
  bool coefficients = false;               // something depends on h and parameters alone
  std::vector<std::string> unknowns = {};  // of all loops: they have start values
  [[nodiscard]] bool has_start() const { return !unknowns.empty(); }
};
[[nodiscard]] MemberParts member_parts(const Program& program, const ScalarType& scalar);

// Where the symbols of the coefficients are found: "#3" is k.c1.
using CoefficientText = std::map<std::string, std::string>;

// An array of numbers times h among the coefficients.
struct ScaledNumbers {
  std::string name;
  std::vector<Rational> values;
};

// struct Coefficients and prepare(par, h).
[[nodiscard]] CoefficientText write_prepare(CodeWriter& out, CppContext& context,
                                            const MemberParts& parts,
                                            const std::vector<ScaledNumbers>& scaled = {});
// add, elimination, rules for stopping, struct Start.
void write_support(CodeWriter& out, const CppContext& context, const MemberParts& parts);
// solve(par, k, h, z, start, dz).
void write_solve(CodeWriter& out, CppContext& context, const MemberParts& parts,
                 const CoefficientText& coefficients);
// matrix[i][j] = ...; for the entries that are not zero.
void write_matrix(CodeWriter& out, const CppExpression& cpp, const std::string& name,
                  const Solve& solve);
[[nodiscard]] std::string inverse_name(std::size_t stage);

// step(par, h, z).
void write_member_step(CodeWriter& out, const CppContext& context, const MemberParts& parts);

// Who takes the steps: the class Propagator, or in a composition the class Substep, which can go on
// from a state and a carry of another.
enum class StepRole { propagator, substep };
[[nodiscard]] std::string class_name(StepRole role);
// begin_at(z, carry), carry() and, if there is anything to `reset`, forget().
void write_substep_access(CodeWriter& out, const std::string& reset);

void write_member_propagator(CodeWriter& out, const CppContext& context, const MemberParts& parts,
                             StepRole role);
// The functions advance() and state() of a class with step() and z_.
void write_advance(CodeWriter& out);

}  // namespace hamgen
