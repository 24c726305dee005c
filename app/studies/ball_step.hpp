// The exact map of a method, enclosed in balls: its equations are solved, from the model.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "app/studies/ball_model.hpp"
#include "app/studies/ball_solve.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen::app {

// How many unknowns are solved for at most: the inverse of their matrix is a full one.
inline constexpr std::size_t kMostBallUnknowns = 512;

class BallStep {
 public:
  // `values`: what alpha, beta, gamma and the rest of the scheme's expressions use besides h.
  BallStep(const BallModel& model, const Scheme& scheme, std::map<std::string, Ball> values,
           Ball h);

  // Z from z, numbers or balls.  `computed` is near Z: of a member it says at which solution.
  [[nodiscard]] BallSolution step(const BallVector& z, const BallVector& computed);

  // Why the method's map is not enclosed; empty if it is.
  [[nodiscard]] static std::string refusal(const Scheme& scheme, std::size_t degrees_of_freedom);

 private:
  [[nodiscard]] BallSolution member_step(const Member& member, const Ball& h, const BallVector& z,
                                         const BallVector* computed);
  [[nodiscard]] BallSolution stages_step(const RungeKutta& method, const BallVector& z,
                                         const BallVector& computed);
  [[nodiscard]] BallSolution explicit_step(const RungeKutta& method, const BallVector& z) const;
  [[nodiscard]] BallSolution split_step(const Splitting& method, const BallVector& z) const;
  [[nodiscard]] BallSolution compose(const Composition& method, const BallVector& z);

  [[nodiscard]] BallSolution solve(BallEquations equations, const BallVector& from,
                                   bool must_contain);
  // J grad H; not finite where H or its gradient has no value.
  [[nodiscard]] BallVector field(std::span<const Ball> z) const;
  [[nodiscard]] Ball number(const Expression& e, const Ball& h) const;

  const BallModel& model_;
  const Scheme& scheme_;
  std::map<std::string, Ball> values_;
  Ball h_;
  double radius_ = 0.125;               // of uniqueness, that of the step before
  std::array<double, 2> largest_ = {};  // coordinate and momentum so far
};

}  // namespace hamgen::app
