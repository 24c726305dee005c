// Degrees of freedom that nothing observed depends on, by backward reachability through the step.
#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

// Which variables the step needs to know what becomes of others.
class Reachability {
 public:
  Reachability(const Mechanics& mechanics, const Scheme& scheme)
      : mechanics_(mechanics), n_(mechanics.degrees_of_freedom) {
    if (scheme.has_member()) {
      for (const auto& [place, entry] : of_all(scheme.member(), n_).c) {
        if (!vanishes(entry)) c_[place.first].insert(place.second);
      }
    }
    for (int i = 0; i < 2 * n_; ++i) by_name_[name(i)] = i;
  }

  void need(const std::set<std::string>& names) {
    for (const std::string& each : names) {
      if (const auto it = by_name_.find(each); it != by_name_.end()) need(it->second);
    }
  }

  // Pairs of which the coordinate is not needed, after all that are needed.
  Unobserved run() {
    Unobserved result;
    for (bool more = true; more;) {
      more = false;
      result = {};
      for (int i = 0; i < n_; ++i) {
        if (needed_.contains(i)) {
          more = need(n_ + i) || more;
          continue;
        }
        const bool momentum = needed_.contains(n_ + i);
        if (enters_a_row(i) || (momentum && !is_constant(i))) {
          more = need(i) || more;
        } else if (momentum) {
          result.cyclic.push_back(i);
        } else {
          result.dropped.push_back(i);
        }
      }
    }
    return result;
  }

 private:
  std::string name(int i) const { return mechanics_.variables.name(static_cast<std::size_t>(i)); }
  // The component of the gradient that moves z_i.
  const Expression& mover(int i) const {
    return mechanics_.gradient[static_cast<std::size_t>(i < n_ ? i + n_ : i - n_)];
  }

  // z_i, and whatever moves zbar_i; false if it was needed before.
  bool need(int i) {
    if (!needed_.insert(i).second) return false;
    need(symbols(mover(i)));
    for (const int l : c_[i]) need(symbols(mover(l)));
    return true;
  }

  // Neither H nor C moves p_i.
  bool is_constant(int i) {
    if (!mover(n_ + i).is_zero()) return false;
    return std::ranges::all_of(c_[n_ + i], [this](int l) { return mover(l).is_zero(); });
  }

  // Does the motion of the pair enter the stage value of something that is needed?
  bool enters_a_row(int i) {
    return std::ranges::any_of(needed_, [this, i](int v) {
      if (v == n_ + i) return false;
      return (c_[v].contains(i) && !mover(i).is_zero()) ||
             (c_[v].contains(n_ + i) && !mover(n_ + i).is_zero());
    });
  }

  const Mechanics& mechanics_;
  int n_;
  std::map<int, std::set<int>> c_;  // columns of the nonzero entries of each row
  std::map<std::string, int> by_name_;
  std::set<int> needed_;
};

// Array of a variable: "q" of "q[3]".
std::string array_of(const std::string& name) { return name.substr(0, name.find('[')); }

// The same where sums stay loops, of arrays as a whole: C has no entries between two of them, for
// it is one for all degrees of freedom, and a coordinate is needed with its momentum.
class ArrayReachability {
 public:
  explicit ArrayReachability(const Mechanics& mechanics)
      : mechanics_(mechanics), n_(mechanics.degrees_of_freedom) {
    for (const Kernel& kernel : mechanics.kernels) {
      std::vector<std::string> arrays;
      for (const Slot& slot : kernel.slots) arrays.push_back(array_of_slot(slot, kernel));
      for (std::size_t s = 0; s < arrays.size(); ++s) {
        const std::set<std::string> used = symbols(kernel.gradient[s]);
        for (std::size_t t = 0; t < arrays.size(); ++t) {
          if (used.contains(kernel.slots[t].symbol)) movers_[arrays[s]].insert(arrays[t]);
        }
      }
    }
  }

  // By the name of a coordinate or of a momentum, or of an element.
  void need(const std::string& name) {
    for (int v = 0; v < 2 * n_; ++v) {
      const std::string& each = mechanics_.variables.name(static_cast<std::size_t>(v));
      if (each == name || array_of(each) == name) need_array(coordinates_of(v));
    }
  }

  [[nodiscard]] Unobserved run() const {
    Unobserved result;
    for (int i = 0; i < n_; ++i) {
      if (!needed_.contains(coordinates_of(i))) result.dropped.push_back(i);
    }
    return result;
  }

 private:
  // The array of the coordinate that z_v belongs to.
  [[nodiscard]] std::string coordinates_of(int v) const {
    return array_of(mechanics_.variables.name(static_cast<std::size_t>(v % n_)));
  }
  [[nodiscard]] std::string array_of_slot(const Slot& slot, const Kernel& kernel) const {
    std::vector<long> first;
    for (const KernelRange& range : kernel.ranges)
      first.push_back(value_at(range.lower, kernel.ranges, first));
    return coordinates_of(static_cast<int>(value_at(slot.position, kernel.ranges, first)));
  }
  void need_array(const std::string& array) {
    if (!needed_.insert(array).second) return;
    for (const std::string& other : movers_[array]) need_array(other);
  }

  const Mechanics& mechanics_;
  int n_;
  std::map<std::string, std::set<std::string>> movers_;  // what moves the variables of an array
  std::set<std::string> needed_;
};

std::string names_of(const std::vector<int>& pairs, int first, const Mechanics& mechanics) {
  std::vector<std::string> names;
  for (const int i : pairs) {
    const std::string& name = mechanics.variables.name(static_cast<std::size_t>(first + i));
    const std::string text = mechanics.keeps_sums() ? array_of(name) : name;
    if (std::ranges::find(names, text) == names.end()) names.push_back(text);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Unobserved unobserved(const Mechanics& mechanics, const Scheme& scheme,
                      const std::set<std::string>& observed) {
  if (observed.empty()) return {};
  Unobserved left;
  if (mechanics.keeps_sums()) {
    if (observed.contains("energy")) return {};
    ArrayReachability reachability(mechanics);
    for (const std::string& name : observed) reachability.need(name);
    left = reachability.run();
  } else {
    Reachability reachability(mechanics, scheme);
    reachability.need(observed);
    left = reachability.run();
  }
  const std::size_t all = left.dropped.size() + left.cyclic.size();
  if (all == static_cast<std::size_t>(mechanics.degrees_of_freedom)) return {};
  return left;
}

std::vector<std::string> to_text(const Unobserved& left, const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  std::vector<std::string> lines;
  if (!left.dropped.empty()) {
    lines.push_back(fmt::format("{}, {}: nothing observed depends on them",
                                names_of(left.dropped, 0, mechanics),
                                names_of(left.dropped, n, mechanics)));
  }
  if (!left.cyclic.empty()) {
    const bool one = left.cyclic.size() == 1;
    lines.push_back(fmt::format(
        "{}: cyclic and not observed; {} {}", names_of(left.cyclic, 0, mechanics),
        names_of(left.cyclic, n, mechanics), one ? "is a parameter" : "are parameters"));
  }
  return lines;
}

}  // namespace hamgen
