// How many places of an array belong to one element of the system: the components of all stages
// stand side by side, and a loop over elements takes one place of a mass while it takes as many of
// a slope as there are stages.  They are what makes neighbours in all loops that grow neighbours in
// the system: one number for each array, one for each loop, and each place in a loop has that of
// its array.  What is handed to a routine, copied or solved for has the same on both sides.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/verify/growing_events.hpp"

namespace hamgen {

class Rooms {
 public:
  // Throws NotLonger where there are no such numbers.
  explicit Rooms(const std::vector<GrowingEvent>& events);
  // 1 where no loop that grows goes over the array.
  [[nodiscard]] long of(const std::string& routine, const std::string& array,
                        std::size_t dimension) const;

 private:
  std::map<std::string, long> rooms_;
};

// Does a loop that begins so have more instances in a longer system?
[[nodiscard]] bool grows(const GrowingEvent& loop);

}  // namespace hamgen
