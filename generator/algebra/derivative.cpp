#include "generator/algebra/derivative.hpp"

#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/ginac_functions.hpp"

namespace hamgen {

namespace {

// The nodes of e that depend on a variable, operands before what uses them.
std::vector<Expression> dependent_nodes(const Expression& e,
                                        std::span<const Expression> variables) {
  std::map<const void*, bool> depends;
  for (const Expression& variable : variables) depends[variable.identity()] = true;
  std::vector<Expression> order(variables.begin(), variables.end());
  auto visit = [&](auto&& self, const Expression& node) -> bool {
    if (const auto it = depends.find(node.identity()); it != depends.end()) return it->second;
    bool any = false;
    for (const Expression& operand : node.operands()) any = self(self, operand) || any;
    depends[node.identity()] = any;
    if (any) order.push_back(node);
    return any;
  };
  visit(visit, e);
  return order;
}

}  // namespace

Expression partial_derivative(const Expression& call, std::size_t k) {
  // The table's functions are differentiated by GiNaC, at placeholders.
  SymbolTable table;
  GiNaC::exvector placeholders;
  Substitution arguments;
  for (std::size_t i = 0; i < call.operands().size(); ++i) {
    const std::string name = "argument " + std::to_string(i);
    placeholders.push_back(table.symbol(name, static_cast<int>(i)));
    arguments.emplace(name, call.operands()[i]);
  }
  const GiNaC::ex value = ginac_function(call.name(), placeholders);
  const GiNaC::ex slope = value.diff(GiNaC::ex_to<GiNaC::symbol>(placeholders.at(k)));
  return substitute(from_ginac(slope, table), arguments);
}

std::vector<Expression> gradient(const Expression& e, std::span<const Expression> variables) {
  const std::vector<Expression> nodes = dependent_nodes(e, variables);
  std::map<const void*, std::vector<Expression>> parts;  // of de/d(node), one for every use
  for (const Expression& node : nodes) parts[node.identity()];
  if (const auto it = parts.find(e.identity()); it != parts.end()) it->second.emplace_back(1);
  auto add = [&](const Expression& operand, auto&& part) {
    const auto it = parts.find(operand.identity());
    if (it != parts.end()) it->second.push_back(part());
  };
  for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) {
    const Expression& node = *it;
    if (node.kind() == Kind::symbol) continue;
    const Expression outer = Expression::sum(parts.at(node.identity()));
    if (outer.is_zero()) continue;
    const auto operands = node.operands();
    switch (node.kind()) {
      case Kind::sum:
        for (const Expression& term : operands) add(term, [&] { return outer; });
        break;
      case Kind::product:
        for (std::size_t i = 0; i < operands.size(); ++i) {
          add(operands[i], [&] {
            std::vector<Expression> factors(operands.begin(), operands.end());
            factors[i] = outer;
            return Expression::product(std::move(factors));
          });
        }
        break;
      case Kind::power: {
        const Expression& base = operands[0];
        const Expression& exponent = operands[1];
        add(base,
            [&] { return outer * exponent * Expression::power(base, exponent - Expression(1)); });
        add(exponent, [&] { return outer * node * Expression::apply("log", {base}); });
        break;
      }
      case Kind::function:
        for (std::size_t i = 0; i < operands.size(); ++i) {
          add(operands[i], [&] { return outer * partial_derivative(node, i); });
        }
        break;
      case Kind::number:
      case Kind::symbol:
        break;
    }
  }
  std::vector<Expression> result;
  for (const Expression& variable : variables) {
    result.push_back(Expression::sum(parts.at(variable.identity())));
  }
  return result;
}

Expression derivative(const Expression& e, const Expression& variable) {
  return gradient(e, std::span(&variable, 1))[0];
}

}  // namespace hamgen
