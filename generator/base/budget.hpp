// What the symbolic work on one model may cost: counted, never timed, so that a model is accepted
// or refused alike on every machine.  The limits are those of about five seconds and a gigabyte.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

enum class Resource {
  terms,  // of sums, written out
  work,   // operands looked at: collected, compared, converted; words of exact numbers
  nodes,  // operands of expressions that were made: the memory they take
};
inline constexpr std::size_t resources = 3;

using Amounts = std::array<double, resources>;  // by Resource

// More of it than there is; caught where the formula's place is known.
class OverBudget : public std::runtime_error {
 public:
  explicit OverBudget(Resource resource);
  [[nodiscard]] Resource resource() const { return resource_; }

 private:
  Resource resource_;
};

// While the first of them lives, `spend` of its thread counts; those inside it change nothing.
class Budget {
 public:
  Budget();
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  [[nodiscard]] static const Amounts& limits();

 private:
  bool is_first_;
};

// Counts so much of it; throws OverBudget where the sum passes the limit.  Without a Budget nothing
// is counted.
void spend(Resource resource, double amount);
// What was spent by the budget of this thread, or by the last one it had.
[[nodiscard]] const Amounts& spent();

// What is said of it, and a way out, at the place of the formula that grew; and another way.
[[nodiscard]] ModelError over_budget(const OverBudget& error, const Span& span,
                                     const SourceText& source, const std::string& besides = "");

}  // namespace hamgen
