// h alpha, h (1 - alpha), h beta, h gamma: what a stage of a system in loops is made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/program/rounded_terms.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// dH/dq_i and dH/dp_i.
struct Gradient {
  Expression by_q, by_p;
};

// What a row of zbar = z + h (I/2 + C) J grad H adds to z.
struct StageRow {
  std::vector<Expression> large;
  Expression small = Expression(0);  // errors of the products
};

// A coefficient of k, of h and the parameters.
struct NamedWeight {
  std::string name;
  Expression value;
  std::string remark;
};

// See Note [weights that sum to h] in program/step_builder.hpp: with alpha neither 0, 1/2 nor 1 the
// larger of alpha and 1 - alpha is the share of h dH that one row takes, product and error, and the
// other row takes what is left.
struct StepWeights {
  explicit StepWeights(const FamilyParameters& member);

  FamilyParameters member;
  std::optional<Expression> q_by_p, p_by_q, p_by_p, q_by_q;  // none where it is zero
  bool shares = false;
  bool q_takes_more = false;
  std::vector<NamedWeight> coefficients;
  // What q moves by, h dH/dp, with h in two parts: see Note [constants in two parts] in
  // program/step_builder.hpp.
  void split_flow();
  [[nodiscard]] bool splits_flow() const { return splits_flow_; }
  // The larger part of h times `slope`, and the smaller one.
  static std::pair<Expression, Expression> flow_in_two_parts(const Expression& slope);
  [[nodiscard]] bool uses_h() const;  // apart from the coefficients
  // Binds the symbols of the weights.
  void bind(Routine& routine) const;

  // The row's products as locals of the body, the flow's as split_flow() has them; or `exactly`,
  // all with their errors.
  [[nodiscard]] StageRow row_of_q_in_parts(RoutineBuilder& b, Body& body, const Gradient& at) const;
  [[nodiscard]] StageRow row_of_q(RoutineBuilder& b, Body& body, const Gradient& at,
                                  bool exactly = false) const;
  [[nodiscard]] StageRow row_of_p(RoutineBuilder& b, Body& body, const Gradient& at,
                                  bool exactly = false) const;
  // h times a slope as a local of the body, and what rounding took from it.
  static RoundedTerm flow_of(RoutineBuilder& b, Body& body, bool is_q, const Expression& slope);

 private:
  bool splits_flow_ = false;
  void add_share(RoutineBuilder& b, Body& body, StageRow& row, bool is_q, const Expression& slope,
                 bool exactly) const;
  // sign * weight * slope
  static void add_product(RoutineBuilder& b, Body& body, StageRow& row, const std::string& name,
                          const Expression& sign, const Expression& weight, const Expression& slope,
                          bool exactly);
};

}  // namespace hamgen
