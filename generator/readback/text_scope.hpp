// The names of a function and what the program calls them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "generator/program/code.hpp"
#include "generator/readback/machine_value.hpp"
#include "generator/readback/syntax.hpp"

namespace hamgen {

struct Meaning {
  enum class Kind { number, object, index };
  Kind kind = Kind::number;
  std::string name;
};

// Values have symbols called
//   "q"          a local number of the routine
//   "@z.q[0]"    a place
//   "#2*i + 1"   an index, an integer
//   "::pi"       what is no name of the function
class TextScope {
 public:
  // lanes: numbers are packs everywhere, of one of each trajectory.
  TextScope(const Precision& precision, int n, bool lanes)
      : precision_(precision), n_(n), of_lanes_(lanes) {
    frames_.emplace_back();
  }

  void enter() { frames_.emplace_back(); }
  void leave() { frames_.pop_back(); }
  // Throws TextDifference for a name that is there already.
  void declare(const std::string& name, Meaning meaning, int line);

  [[nodiscard]] MachineValue value(const CppExpression& e) const;
  // Of an index.  Throws TextNotUnderstood for what is none.
  [[nodiscard]] AffineIndex index(const CppExpression& e) const;
  // So many times: a number, or the name that stands for it here.
  [[nodiscard]] bool is_count(const CppExpression& e, const std::string& count) const;
  // Of a loop over stages in lanes, until it is set to nothing: its numbers are packs.
  void set_lanes(const std::string& index) { lane_index_ = index; }
  [[nodiscard]] bool in_lanes() const { return !lane_index_.empty(); }
  // Is it that of all stages?
  [[nodiscard]] bool is_of_stages(const Place& place) const;
  // What an address is that of: array + n + 2 * i.
  [[nodiscard]] std::optional<Place> element(const CppExpression& e) const;
  // The same of the stages of such a loop.  Throws TextDifference if it is not.
  [[nodiscard]] Place lanes(const CppExpression& e) const;
  // An object, a field or an element; none for anything else.
  [[nodiscard]] std::optional<Place> place(const CppExpression& e) const;
  [[nodiscard]] bool is_place(const CppExpression& e, const Place& exact) const;
  [[nodiscard]] const Precision& precision() const { return precision_; }

 private:
  [[nodiscard]] bool has_packs() const { return of_lanes_ || in_lanes(); }
  [[nodiscard]] const Meaning* find(const std::string& name) const;
  [[nodiscard]] MachineValue number(const CppExpression& e) const;
  [[nodiscard]] MachineValue name(const CppExpression& e) const;
  [[nodiscard]] MachineValue binary(const CppExpression& e) const;
  [[nodiscard]] MachineValue call(const CppExpression& e) const;
  [[nodiscard]] MachineValue converted(const CppExpression& argument) const;
  [[nodiscard]] std::string function(const std::string& name, int line) const;

  const Precision& precision_;
  int n_;  // what the text calls n; 0: nothing
  std::vector<std::map<std::string, Meaning>> frames_;
  bool of_lanes_;
  std::string lane_index_;
};

// a + sign b.
[[nodiscard]] AffineIndex plus(AffineIndex a, const AffineIndex& b, long sign);
// What a place is called in a value.
[[nodiscard]] std::string symbol_of(const Place& place);

}  // namespace hamgen
