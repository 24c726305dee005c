// Names of variables that a change of variables makes.
#pragma once

#include <set>
#include <string>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

class NewNames {
 public:
  // Nothing that the system names is taken.
  explicit NewNames(const Mechanics& mechanics);
  // "x1_sum" of "x1", "q_3_sum" of "q[3]"; longer where that is taken.
  [[nodiscard]] std::string made_of(const std::string& name, const std::string& ending);

 private:
  std::set<std::string> taken_;
};

}  // namespace hamgen
