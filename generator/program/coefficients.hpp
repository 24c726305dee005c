// What a step takes of h and the parameters alone: the record Coefficients, k in the routines, and
// prepare(par, h), which fills it in.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

// Where the symbols of the coefficients stand in k.
using CoefficientPlaces = std::map<std::string, Place>;

struct Coefficients {
  Record record;
  Routine prepare;
  CoefficientPlaces places;
  [[nodiscard]] bool empty() const { return record.fields.empty(); }
};

// Numbers that are multiplied by h: k.kick[i].
struct ScaledNumbers {
  std::string name;
  std::vector<Expression> values;
};

[[nodiscard]] Coefficients coefficients_of(const Environment& environment,
                                           const LoweredStep& lowered,
                                           const std::vector<ScaledNumbers>& scaled = {});

// The field of k with the inverse of the constant matrix of a stage.
[[nodiscard]] std::string inverse_name(std::size_t stage);
// Is the matrix of this solve inverted once per run?
[[nodiscard]] bool is_inverted(const Solve& solve);

// Large ones are eliminated by Eigen; of symmetric ones the diagonal is put and what is below.
enum class MatrixForm { plain, symmetric, large };
// What the entries of this solve are, as they are written.
[[nodiscard]] MatrixForm form_of(const Solve& solve);
// matrix = the entries that are not zero.
void put_matrix(Body& body, const std::string& name,
                const std::vector<std::vector<Expression>>& entries, MatrixForm form);

}  // namespace hamgen
