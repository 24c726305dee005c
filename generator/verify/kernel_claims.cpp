// Of a sum that is kept as loops, without its routines: that the loops sum up to H, and what the
// generator takes for the derivatives of their summands.
#include <fmt/format.h>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/to_ginac.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

Expression sum_of_kernels(const Mechanics& mechanics) {
  std::vector<Expression> terms;
  std::vector<std::vector<Expression>> of_sums(mechanics.sums.size());
  std::map<std::string, std::vector<Expression>> parameters;  // elements by array
  for (std::size_t i = 0; i < mechanics.parameters.size(); ++i) {
    const std::string& name = mechanics.parameters[i].name;
    parameters[name.substr(0, name.find('['))].push_back(
        Expression::symbol(name, kRankOfParameter + static_cast<int>(i)));
  }
  for (const Kernel& kernel : mechanics.kernels) {
    for_each_instance(kernel.ranges, [&](const std::vector<long>& now) {
      Substitution element;
      for (const Slot& slot : kernel.slots) {
        element.emplace(
            slot.symbol,
            mechanics.variable(static_cast<int>(value_at(slot.position, kernel.ranges, now))));
      }
      for (const ParameterSlot& slot : kernel.parameters) {
        const auto position = static_cast<std::size_t>(value_at(slot.position, kernel.ranges, now));
        element.emplace(slot.symbol, parameters.at(slot.parameter).at(position));
      }
      for (std::size_t i = 0; i < now.size(); ++i)
        element.emplace(kernel.ranges[i].index, Expression(now[i]));
      (kernel.sum ? of_sums[*kernel.sum] : terms).push_back(substitute(kernel.value, element));
    });
  }
  Substitution sums;
  for (std::size_t k = 0; k < of_sums.size(); ++k)
    sums.emplace(mechanics.sums[k].name, Expression::sum(std::move(of_sums[k])));
  terms.push_back(substitute(mechanics.of_sums, sums));
  return Expression::sum(std::move(terms));
}

namespace {

// What the kernel's loops compute, against its value and the derivatives of that by its slots.
void add_kernel(const Kernel& kernel, std::vector<Identities>& parts) {
  SymbolTable table;
  std::vector<GiNaC::symbol> slots;
  for (const Slot& slot : kernel.slots) {
    slots.push_back(GiNaC::ex_to<GiNaC::symbol>(table.symbol(slot.symbol, 0)));
  }
  const GiNaC::ex value = to_ginac(kernel.value, table);
  std::vector<Expression> gradient;
  std::vector<Expression> hessian;
  std::vector<Expression> expected_gradient;
  std::vector<Expression> expected_hessian;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const GiNaC::ex slope = value.diff(slots[i]);
    gradient.push_back(kernel.gradient[i]);
    expected_gradient.push_back(from_ginac(slope, table));
    for (std::size_t j = i; j < slots.size(); ++j) {
      const auto it = kernel.hessian.find({i, j});
      hessian.push_back(it == kernel.hessian.end() ? Expression(0) : it->second);
      expected_hessian.push_back(from_ginac(slope.diff(slots[j]), table));
    }
  }
  const auto add = [&](const char* what, const std::vector<Expression>& values,
                       const std::vector<Expression>& expected) {
    Identities identities;
    for (std::size_t i = 0; i < values.size(); ++i)
      identities.claims.push_back({fmt::format("{} {}", what, i + 1), values[i], expected[i]});
    parts.push_back(std::move(identities));
  };
  add("slope of a summand", gradient, expected_gradient);
  add("second derivative of a summand", hessian, expected_hessian);
}

// Of the function of the sums.
void add_slopes(const Mechanics& mechanics, std::vector<Identities>& parts) {
  SymbolTable table;
  for (const CollectiveSum& sum : mechanics.sums) (void)table.symbol(sum.name, kRankOfTemporary);
  const GiNaC::ex value = to_ginac(mechanics.of_sums, table);
  Identities identities;
  for (const CollectiveSum& sum : mechanics.sums)
    identities.claims.push_back({"slope of H by " + sum.name, sum.slope_value,
                                 from_ginac(value.diff(table.find(sum.name)), table)});
  parts.push_back(std::move(identities));
}

}  // namespace

std::vector<Identities> kernel_identities(const Mechanics& mechanics,
                                          const std::optional<Expression>& hamiltonian) {
  std::vector<Identities> parts;
  for (const Kernel& kernel : mechanics.kernels) add_kernel(kernel, parts);
  if (!mechanics.sums.empty()) add_slopes(mechanics, parts);
  if (hamiltonian)
    parts.push_back({{}, {}, {{"the sum of the loops", sum_of_kernels(mechanics), *hamiltonian}}});
  return parts;
}

}  // namespace hamgen
