// The claims of one step while they are put together, block by block.
#pragma once

#include <functional>
#include <optional>
#include <set>

#include "generator/verify/expected_step.hpp"

namespace hamgen {

class ExpectedStep {
 public:
  ExpectedStep(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
               const Program& program);
  [[nodiscard]] Identities run();

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] const std::string& name(int i) const { return mechanics_.variables[at(i)].name; }
  [[nodiscard]] Expression free(const std::string& what, int i) const;
  void add(const std::vector<Statement>& statements);
  void claim(std::string what, const Expression& emitted, const Expression& expected);
  // A symbol for the value, which is matched with the program's of that name.
  Expression define(const std::string& what, const Expression& value);

  void set_weights(const Member& member);
  // An expression in z at the present stage values.
  [[nodiscard]] Expression at_stage(const Expression& e) const;
  // A derivative of H is evaluated where it is first asked for.
  Expression gradient(int k);
  Expression second(int k, int v);
  // What rounding took from z_i: the step starts from the sum of both.
  [[nodiscard]] Expression carry(int i) const;
  // z_i + carry_i + h sum B_ik H_k.
  Expression row(int i);
  // sum_k h B_ik sum_v H_kv value(v) over the variables v.
  Expression along(int i, const std::vector<int>& variables,
                   const std::function<Expression(int)>& value);

  void solve(const Block& block);
  void quadratic(int i);
  void newton(const Block& block);
  Expression affine_value(int t, const Expression& own);
  void affine(const Block& block);
  void simplified_newton(const Block& block);
  void fixed_point(const Block& block);
  void sweep();
  const Solve& next_solve(BlockKind kind);
  // R and R' as the program has them, -R'^-1 R from them; R'^-1 where it is written out.
  std::vector<Expression> increments(const Block& block, const std::vector<Expression>& residual,
                                     const std::vector<std::vector<Expression>>& matrix,
                                     const Solve* solve);
  std::vector<std::vector<Expression>> by_adjugate(const Block& block,
                                                   const std::vector<std::vector<Expression>>& a);
  // H_k as the last iteration evaluated it, and what its increment adds.
  void correct_gradient(int k, const Expression& change);
  // What one step of Newton's iteration solves: these components of the gradient are their values
  // at zero and their slopes times these variables.
  void claim_affine(const std::vector<int>& components, const std::vector<int>& variables);
  // Is H_k linear with constant coefficients in some of these variables and free of all others?
  [[nodiscard]] bool is_linear_in(int k, const std::set<int>& variables) const;

  const Mechanics& mechanics_;
  const int n_;
  const Derivatives& derivatives_;
  const Program& program_;
  const Expression h_ = Expression::symbol("h", kRankOfStep);
  std::map<int, std::vector<std::pair<int, Expression>>> weights_;
  std::vector<Expression> bar_;
  std::vector<std::optional<Expression>> gradient_;
  // Before the last increment, and what it adds.
  std::map<int, std::pair<Expression, Expression>> change_;
  std::map<std::pair<int, int>, Expression> second_;
  std::vector<const Solve*> solves_;
  std::size_t next_solve_ = 0;
  std::set<std::string> names_;
  Identities identities_;
};

}  // namespace hamgen
