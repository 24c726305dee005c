#include "generator/verify/derivatives.hpp"

#include <ginac/ginac.h>

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/to_ginac.hpp"
#include "generator/verify/zero_by_algebra.hpp"

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
  const auto [factor, inside] = hamiltonian.split_coefficient();
  const bool is_sum = inside.kind() == Kind::sum;
  const std::span<const Expression> terms = is_sum ? inside.operands() : std::span(&inside, 1);
  std::vector<GiNaC::exvector> slopes(size);
  std::map<std::pair<int, int>, GiNaC::exvector> curvatures;
  for (const Expression& term : terms) {
    const GiNaC::ex value = to_ginac(Expression(factor) * term, table);
    std::vector<std::size_t> of_term;
    for (const std::string& name : symbols(term)) {
      if (const auto place = places.find(name); place != places.end())
        of_term.push_back(place->second);
    }
    for (const std::size_t i : of_term) {
      const GiNaC::ex slope = value.diff(variables[i]);
      slopes[i].push_back(slope);
      for (const std::size_t j : of_term) {
        if (j < i) continue;
        const GiNaC::ex curvature = slope.diff(variables[j]);
        if (!curvature.is_zero()) curvatures[{i, j}].push_back(curvature);
      }
    }
  }
  const auto sum_of = [&](const GiNaC::exvector& parts) {
    return unless_zero(from_ginac(GiNaC::add(parts), table));
  };
  for (const GiNaC::exvector& parts : slopes) gradient_.push_back(sum_of(parts));
  for (const auto& [at, parts] : curvatures) {
    if (const Expression entry = sum_of(parts); !entry.is_zero()) hessian_.emplace(at, entry);
  }
}

Derivatives::Derivatives(const GeneratingFunction& function)
    : gradient_(function.gradient), hessian_(function.hessian) {}

Expression Derivatives::second(int i, int j) const {
  const auto it = hessian_.find(std::minmax(i, j));
  return it == hessian_.end() ? Expression(0) : it->second;
}

std::vector<std::vector<int>> Derivatives::partners() const {
  std::vector<std::vector<int>> result(gradient_.size());
  for (const auto& [place, value] : hessian_) {
    result[static_cast<std::size_t>(place.first)].push_back(place.second);
    if (place.first != place.second)
      result[static_cast<std::size_t>(place.second)].push_back(place.first);
  }
  return result;
}

}  // namespace hamgen
