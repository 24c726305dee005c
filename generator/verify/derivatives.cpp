#include "generator/verify/derivatives.hpp"

#include <ginac/ginac.h>

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/to_ginac.hpp"
#include "generator/verify/identities.hpp"

namespace hamgen {

namespace {

Expression unless_zero(const Expression& e) { return is_zero_by_algebra(e) ? Expression(0) : e; }

}  // namespace

// Term by term: a large H is a sum of many that know few variables each.
Derivatives::Derivatives(const Mechanics& mechanics, const Expression& hamiltonian) {
  const std::size_t size = mechanics.variables.size();
  std::map<std::string, std::size_t> places;
  SymbolTable table;
  std::vector<GiNaC::symbol> variables;
  for (std::size_t i = 0; i < size; ++i) {
    const std::string& name = mechanics.variables.name(i);
    places.emplace(name, i);
    variables.push_back(
        GiNaC::ex_to<GiNaC::symbol>(table.symbol(name, kRankOfVariable + static_cast<int>(i))));
  }
  const bool is_sum = hamiltonian.kind() == Kind::sum;
  const std::span<const Expression> terms =
      is_sum ? hamiltonian.operands() : std::span(&hamiltonian, 1);
  std::vector<GiNaC::exvector> parts(size);
  for (const Expression& term : terms) {
    const GiNaC::ex value = to_ginac(term, table);
    for (const std::string& name : symbols(term)) {
      const auto place = places.find(name);
      if (place == places.end()) continue;
      parts[place->second].push_back(value.diff(variables[place->second]));
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    const GiNaC::ex slope = GiNaC::add(parts[i]);
    gradient_.push_back(unless_zero(from_ginac(slope, table)));
    for (const std::string& name : symbols(gradient_.back())) {
      const auto place = places.find(name);
      if (place == places.end() || place->second < i) continue;
      const Expression entry = unless_zero(from_ginac(slope.diff(variables[place->second]), table));
      if (entry.is_zero()) continue;
      hessian_.emplace(std::pair(static_cast<int>(i), static_cast<int>(place->second)), entry);
    }
  }
}

Derivatives::Derivatives(const GeneratingFunction& function)
    : gradient_(function.gradient), hessian_(function.hessian) {}

Expression Derivatives::second(int i, int j) const {
  const auto it = hessian_.find(std::minmax(i, j));
  return it == hessian_.end() ? Expression(0) : it->second;
}

}  // namespace hamgen
