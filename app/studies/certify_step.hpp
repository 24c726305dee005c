// How far a step that was taken is from the exact map of its method: proved in ball arithmetic.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen::app {

// An exact number, the sum of these; more digits than any scalar has.
using ExactSum = std::array<double, 4>;

struct StepNumbers {
  std::map<std::string, ExactSum> values;  // parameters of H and of the scheme by name; h
  int scalar_digits = 53;                  // binary, of the scalar
};

struct StepDistance {
  // Z* is the exact step: the largest |Z_i - Z*_i|, each in units of rounding,
  //   epsilon (max(|z_i|, |Z_i|) + 2^-10 max_k |Z_k|),   epsilon = 2^(1 - scalar_digits).
  // An upper bound.  (The last term: no rule of an iteration sees a component that is a thousand
  // times smaller than the others to its last digit.)
  double units = 0.0;
  std::size_t component = 0;  // where, of z = (q, p)
  // Of the equations that were solved for it: no other solution is closer, relative to the size of
  // the unknowns.  0 where none were solved.
  double radius = 0.0;
  std::string failure;  // why nothing is proved; empty if all is
};

// The model's variables as the step's: the i-th is constant[i] + sum of factors[i][j] z_j.  Empty:
// both are the same.
struct ModelState {
  std::vector<std::map<int, Rational>> factors;
  std::vector<Rational> constant;
};

class StepCertifier {
 public:
  // // Throws UsageError where the method's map cannot be enclosed, with the reason, and ToolError
  // where hamgen was built without Arb.
  static void require_possible(const Model& model, const Scheme& scheme);

  // Throws the same.  Model and scheme, those of all degrees of freedom, outlive this.
  StepCertifier(const Model& model, const Scheme& scheme, const StepNumbers& numbers,
                ModelState state = {});
  ~StepCertifier();
  StepCertifier(const StepCertifier&) = delete;
  StepCertifier& operator=(const StepCertifier&) = delete;

  // Of a step from `before` to `after`, states of the step with what rounding took from them: the
  // model's state that they stand for is compared with the exact step of the model from there.
  [[nodiscard]] StepDistance distance(const std::vector<ExactSum>& before,
                                      const std::vector<ExactSum>& after);

 private:
  struct Balls;
  std::unique_ptr<Balls> balls_;
};

}  // namespace hamgen::app
