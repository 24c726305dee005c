// The modified Hamiltonian along an orbit, with more digits than the orbit has.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/verify/precise.hpp"

namespace hamgen {

// Ht = sum of h^j H_j cut off after each of its terms.
class ModifiedEnergyWatch {
 public:
  // `terms` are H_0, H_1, ...; `fixed` has h and the parameters.  E0 is H_0 at the first state.
  ModifiedEnergyWatch(std::vector<Expression> terms, std::map<std::string, Rational> fixed);

  // One more state of the orbit, by names.
  void add(const std::map<std::string, Rational>& state);
  // The largest |Ht - Ht at the first state| so far, with the terms up to h^j, for each j.
  [[nodiscard]] const std::vector<double>& variations() const { return variations_; }

 private:
  std::vector<Expression> terms_;
  std::map<std::string, Precise> fixed_;
  std::vector<Precise> first_;
  std::vector<double> variations_;
};

}  // namespace hamgen
