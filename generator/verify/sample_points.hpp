// Points at which claims are tried that algebra does not decide.
#pragma once

#include <map>
#include <random>
#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/language/scene.hpp"
#include "generator/verify/precise.hpp"

namespace hamgen {

// Where a model is used: values of its variables, its parameters and h by their names.
struct Surroundings {
  std::vector<std::map<std::string, Rational>> centres;
};

// Every scene of the model, and its parameters' defaults where it has none.
[[nodiscard]] Surroundings surroundings_of(const Model& model);
// The scene a run asks for, with whatever it changes.
[[nodiscard]] std::map<std::string, Rational> centre_of(const Model& model,
                                                        const SceneValues& scene);

// One point, symbol by symbol.  Its number says what kind it is, in turn: near a centre, of a
// centre's sizes with other signs, of sizes 0.1 to 10, of 0.001 to 1000, and positive ones of 1/4
// to 7/4.  Where a point lies outside the domain of a model the next attempt is of the next kind,
// and closer to the centre.  The same in every process.
class SamplePoint {
 public:
  SamplePoint(const Surroundings& around, int number, int attempt);
  // A name that holds another in parentheses, "bar(q)", is drawn about that one's value.
  [[nodiscard]] Precise operator()(const std::string& name);

 private:
  enum class Kind { near, around, medium, wide, positive };
  [[nodiscard]] double uniform(double low, double high);
  [[nodiscard]] double drawn(const std::string& name);
  [[nodiscard]] double signed_size(const std::string& name, double decades);
  [[nodiscard]] const Rational* value_at_centre(const std::string& name) const;

  const std::map<std::string, Rational>* centre_ = nullptr;
  double scale_ = 1.0;  // of what is zero at the centre
  Kind kind_;
  double radius_;
  std::mt19937_64 source_;
};

}  // namespace hamgen
