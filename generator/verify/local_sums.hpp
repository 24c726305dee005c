// The sums over all elements that are locals of a routine.  Such a sum is read when it is whole,
// and is one number for all that read it.
#pragma once

#include <map>
#include <set>
#include <string>

namespace hamgen {

// All throw NotLonger where a longer system would have another sum.
class LocalSums {
 public:
  void begin_routine();
  // Of loops one in the other, of which the outermost that grows begins or ends.
  void begin_nest();
  // Inside so many loops.
  void declare(const std::string& name, long loops);
  // By an instance of loops that grow, inside so many others.
  void add(const std::string& name, bool in_pairs, long inside);
  // Is it a sum?
  bool read(const std::string& name, bool in_growing);

 private:
  struct Sum {
    bool grows = false;  // in the nest
    bool is_read = false, of_pairs = false, goes_on = false;
  };
  std::map<std::string, Sum> sums_;
  std::map<std::string, long> declared_in_;
  std::set<std::string> read_here_;  // in the nest, sums or not
};

}  // namespace hamgen
