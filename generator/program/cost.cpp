// What a list of statements costs, by kind of operation.
#include <fmt/format.h>

#include <algorithm>

#include "generator/program/arithmetic.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

namespace {

void add_cost(const Expression& e, Cost& total) {
  for (const Expression& operand : e.operands()) {
    if (!operand.is_number()) add_cost(operand, total);
  }
  switch (e.kind()) {
    case Kind::number:
    case Kind::symbol:
      return;
    case Kind::sum:
      total.additions += static_cast<int>(e.operands().size()) - 1;
      return;
    case Kind::function:
      if (e.name() == kProductError) {
        total.additions += 10;
        total.multiplications += 7;
      } else {
        ++total.functions;
      }
      return;
    case Kind::power:
      if (e.operands()[1] == Expression(-1)) {
        ++total.divisions;
      } else if (e.operands()[1].is_number() && e.operands()[1].number().get_den() == 1) {
        ++total.multiplications;
      } else {
        ++total.functions;
      }
      return;
    case Kind::product: {
      int factors = 0;
      bool reciprocal = false;
      for (const Expression& operand : e.operands()) {
        const bool divides =
            operand.kind() == Kind::power && operand.operands()[1] == Expression(-1);
        reciprocal = reciprocal || divides;
        if (!divides && operand != Expression(-1)) ++factors;
      }
      total.multiplications += std::max(0, factors - 1);
      return;
    }
  }
}

}  // namespace

Cost cost(const std::vector<Statement>& statements) {
  Cost total;
  for (const Statement& statement : statements) add_cost(statement.value, total);
  return total;
}

std::string to_text(const Cost& cost) {
  std::string text;
  auto add = [&](int count, const char* what) {
    if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(cost.additions + cost.multiplications, "+ - *");
  add(cost.divisions, "/");
  add(cost.functions, "sqrt and functions");
  return text.empty() ? "nothing" : text;
}

}  // namespace hamgen
