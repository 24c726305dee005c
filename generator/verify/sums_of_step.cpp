#include "generator/verify/sums_of_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace hamgen {

namespace {

// Parts, as a tree, from which on a sum is long.
constexpr std::size_t kLong = 50;

bool is_function(const Expression& e) { return e.kind() == Kind::function; }

}  // namespace

SumsOfStep::Facts SumsOfStep::facts(const Expression& e) {
  if (e.kind() == Kind::symbol) return {1, e.name() == "h" ? Of::step : Of::others};
  if (e.operands().empty()) return {1, Of::numbers};
  if (const auto it = facts_.find(e.identity()); it != facts_.end()) return it->second;
  Facts whole{1, Of::numbers};
  for (const Expression& operand : e.operands()) {
    const Facts part = facts(operand);
    whole.size = std::min(whole.size + part.size, kLong);
    whole.symbols = std::max(whole.symbols, part.symbols);
  }
  facts_.emplace(e.identity(), whole);
  return whole;
}

bool SumsOfStep::is_one(const Expression& e) {
  if (e.kind() != Kind::sum) return false;
  const Facts whole = facts(e);
  return whole.size >= kLong && whole.symbols == Of::step &&
         std::ranges::any_of(e.operands(), [](const Expression& term) {
           return is_function(term) || std::ranges::any_of(term.operands(), is_function);
         });
}

Expression SumsOfStep::named(const Expression& e) {
  if (e.operands().empty()) return e;
  if (const auto it = known_.find(e); it != known_.end()) return it->second;
  Expression result = e;
  if (is_one(e)) {
    const std::string name = fmt::format("sum#{}", meaning_.size());
    meaning_.emplace(name, e);
    result = Expression::symbol(name);
  } else {
    std::vector<Expression> operands;
    bool same = true;
    for (const Expression& operand : e.operands()) {
      operands.push_back(named(operand));
      same = same && operands.back().identity() == operand.identity();
    }
    if (!same) result = with_operands(e, std::move(operands));
  }
  return known_.emplace(e, result).first->second;
}

Expression SumsOfStep::written_out(const Expression& e) const {
  return meaning_.empty() ? e : substitute(e, meaning_);
}

}  // namespace hamgen
