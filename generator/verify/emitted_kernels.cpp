#include <fmt/format.h>

#include "generator/algebra/from_ginac.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

using Indices = std::map<std::string, long>;

long at(const AffineIndex& index, const Indices& indices) {
  long value = index.constant;
  for (const auto& [name, factor] : index.factors) value += factor * indices.at(name);
  return value;
}

// Calls `use` with the indices of every instance.
template <class Use>
void for_instances(const Kernel& kernel, std::size_t depth, Indices& indices, const Use& use) {
  if (depth == kernel.ranges.size()) {
    use(indices);
    return;
  }
  const KernelRange& range = kernel.ranges[depth];
  const long last = at(range.upper, indices);
  for (long i = at(range.lower, indices); i <= last; ++i) {
    indices[range.index] = i;
    for_instances(kernel, depth + 1, indices, use);
  }
  indices.erase(range.index);
}

// The sum over all instances, in the symbols of the state and of the parameters.
Expression written_out(const Mechanics& mechanics) {
  std::vector<Expression> terms;
  std::map<std::string, std::vector<Expression>> parameters;  // elements by array
  for (std::size_t i = 0; i < mechanics.parameters.size(); ++i) {
    const std::string& name = mechanics.parameters[i].name;
    parameters[name.substr(0, name.find('['))].push_back(
        Expression::symbol(name, kRankOfParameter + static_cast<int>(i)));
  }
  for (const Kernel& kernel : mechanics.kernels) {
    Indices indices;
    for_instances(kernel, 0, indices, [&](const Indices& now) {
      Substitution element;
      for (const Slot& slot : kernel.slots) {
        element.emplace(slot.symbol, mechanics.variable(static_cast<int>(at(slot.position, now))));
      }
      for (const ParameterSlot& slot : kernel.parameters) {
        const auto position = static_cast<std::size_t>(at(slot.position, now));
        element.emplace(slot.symbol, parameters.at(slot.parameter).at(position));
      }
      for (const auto& [index, value] : now) element.emplace(index, Expression(value));
      terms.push_back(substitute(kernel.value, element));
    });
  }
  return Expression::sum(std::move(terms));
}

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
  parts.push_back(identities_of(evaluate_together({kernel.value}), "a summand", {kernel.value}));
  parts.push_back(
      identities_of(evaluate_together(gradient), "slope of a summand", expected_gradient));
  parts.push_back(identities_of(evaluate_together(hessian), "second derivative of a summand",
                                expected_hessian));
}

}  // namespace

std::vector<Identities> kernel_identities(const Mechanics& mechanics,
                                          const Expression& hamiltonian) {
  std::vector<Identities> parts;
  for (const Kernel& kernel : mechanics.kernels) add_kernel(kernel, parts);
  parts.push_back({{}, {}, {{"the sum of the loops", written_out(mechanics), hamiltonian}}});
  return parts;
}

}  // namespace hamgen
