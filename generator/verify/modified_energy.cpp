#include "generator/verify/modified_energy.hpp"

#include <algorithm>
#include <cmath>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

ModifiedEnergyWatch::ModifiedEnergyWatch(std::vector<Expression> terms,
                                         std::map<std::string, Rational> fixed)
    : terms_(std::move(terms)), variations_(terms_.size()) {
  for (const auto& [name, value] : fixed) fixed_.emplace(name, precise(value));
}

void ModifiedEnergyWatch::add(const std::map<std::string, Rational>& state) {
  std::map<std::string, Precise> point = fixed_;
  for (const auto& [name, value] : state) point.insert_or_assign(name, precise(value));
  const Substitution none;
  const auto value_of = [&](const Expression& e) {
    const auto value = PreciseValues(point, none)(e);
    if (!value) throw UsageError("the modified Hamiltonian is not defined on the orbit");
    return *value;
  };
  if (first_.empty()) fixed_.insert_or_assign("E0", value_of(terms_[0]));
  point.insert_or_assign("E0", fixed_.at("E0"));
  std::vector<Precise> sums;
  Precise sum = precise(0);
  Precise power = precise(1);
  for (const Expression& term : terms_) {
    sum = sum + power * value_of(term);
    power = power * point.at("h");
    sums.push_back(sum);
  }
  if (first_.empty()) first_ = sums;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    variations_[j] = std::max(variations_[j], std::abs(to_double(sums[j] - first_[j])));
  }
}

}  // namespace hamgen
