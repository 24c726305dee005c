#include "generator/verify/sums_of_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace hamgen {

namespace {

// Parts, as a tree, from which on a sum is long.
constexpr std::size_t kLong = 50;

bool is_function(const Expression& e) { return e.kind() == Kind::function; }

}  // namespace

std::size_t SumsOfStep::size(const Expression& e) {
  if (e.operands().empty()) return 1;
  if (const auto it = sizes_.find(e.identity()); it != sizes_.end()) return it->second;
  std::size_t total = 1;
  for (const Expression& operand : e.operands()) total = std::min(total + size(operand), kLong);
  sizes_[e.identity()] = total;
  return total;
}

bool SumsOfStep::is_one(const Expression& e) {
  return e.kind() == Kind::sum && size(e) >= kLong && symbols(e) == std::set<std::string>{"h"} &&
         std::ranges::any_of(e.operands(), [](const Expression& term) {
           return is_function(term) || std::ranges::any_of(term.operands(), is_function);
         });
}

Expression SumsOfStep::named(const Expression& e) {
  if (e.operands().empty()) return e;
  if (const auto it = known_.find(e); it != known_.end()) return it->second;
  Expression result;
  if (is_one(e)) {
    const std::string name = fmt::format("sum#{}", meaning_.size());
    meaning_.emplace(name, e);
    result = Expression::symbol(name);
  } else {
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) operands.push_back(named(operand));
    result = with_operands(e, std::move(operands));
  }
  return known_.emplace(e, result).first->second;
}

Expression SumsOfStep::written_out(const Expression& e) const {
  return meaning_.empty() ? e : substitute(e, meaning_);
}

}  // namespace hamgen
