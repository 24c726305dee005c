#include <fmt/format.h>

#include <optional>

#include "generator/algebra/from_ginac.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

// {I, H} = sum I_q H_p - I_p H_q.
GiNaC::ex bracket(const GiNaC::ex& invariant, const GiNaC::ex& energy, const Mechanics& mechanics,
                  SymbolTable& table) {
  GiNaC::ex sum = 0;
  const int n = mechanics.degrees_of_freedom;
  for (int i = 0; i < n; ++i) {
    const GiNaC::symbol& q = table.find(mechanics.variables[static_cast<std::size_t>(i)].name);
    const GiNaC::symbol& p = table.find(mechanics.variables[static_cast<std::size_t>(i + n)].name);
    sum += invariant.diff(q) * energy.diff(p) - invariant.diff(p) * energy.diff(q);
  }
  return sum;
}

// The matrix M of a quadratic form z^T M z / 2; empty if the invariant is not one.
std::optional<GiNaC::matrix> quadratic_form(const GiNaC::ex& invariant, const Mechanics& mechanics,
                                            SymbolTable& table) {
  const auto size = static_cast<unsigned>(mechanics.variables.size());
  const std::set<std::string> beyond = non_polynomial_symbols(from_ginac(invariant, table));
  for (const Quantity& variable : mechanics.variables) {
    if (beyond.contains(variable.name)) return std::nullopt;
  }
  GiNaC::matrix form(size, size);
  for (unsigned i = 0; i < size; ++i) {
    for (unsigned j = 0; j < size; ++j) {
      const GiNaC::ex entry = invariant.diff(table.find(mechanics.variables[i].name))
                                  .diff(table.find(mechanics.variables[j].name))
                                  .expand();
      for (const Quantity& variable : mechanics.variables) {
        if (entry.has(table.find(variable.name))) return std::nullopt;
      }
      form(i, j) = entry;
    }
  }
  return form;
}

Finding conserved(const std::string& name, const GiNaC::ex& invariant, const Mechanics& mechanics,
                  const Member& member, SymbolTable& table) {
  const std::string property = name + " conserved by the step";
  const auto form = quadratic_form(invariant, mechanics, table);
  if (!form) {
    return {property, Verdict::not_decided,
            "neither linear nor quadratic: conserved up to the order"};
  }
  const auto size = static_cast<unsigned>(mechanics.variables.size());
  GiNaC::matrix c(size, size);
  for (const auto& [place, value] : member.c) {
    c(static_cast<unsigned>(place.first), static_cast<unsigned>(place.second)) =
        to_ginac(value, table);
  }
  const GiNaC::matrix residual = c.transpose().mul(*form).add(form->mul(c));
  for (unsigned i = 0; i < size; ++i) {
    for (unsigned j = 0; j < size; ++j) {
      const GiNaC::ex entry = residual(i, j).expand();
      if (entry.is_zero()) continue;
      return {property, Verdict::refuted,
              fmt::format("entry ({}, {}) of C^T M + M C is {}", i + 1, j + 1,
                          to_text(from_ginac(entry, table)))};
    }
  }
  return {property, Verdict::proved, "C^T M + M C = 0 for its quadratic form M"};
}

}  // namespace

Proof prove_invariants(const Mechanics& mechanics, const Member& member) {
  Proof proof;
  if (mechanics.keeps_sums()) {
    for (const NamedExpression& invariant : mechanics.invariants) {
      proof.push_back({invariant.name + " invariant", Verdict::not_decided,
                       "the sums stay loops; verify a smaller size"});
    }
    return proof;
  }
  for (const NamedExpression& invariant : mechanics.invariants) {
    SymbolTable table;
    for (std::size_t i = 0; i < mechanics.variables.size(); ++i) {
      table.symbol(mechanics.variables[i].name, kRankOfVariable + static_cast<int>(i));
    }
    const GiNaC::ex energy = to_ginac(mechanics.energy, table);
    const GiNaC::ex value = to_ginac(invariant.value, table);
    const GiNaC::ex poisson = bracket(value, energy, mechanics, table).expand();
    const bool zero = poisson.is_zero() || poisson.normal().expand().is_zero();
    std::string text = zero ? "" : to_text(from_ginac(poisson, table));
    if (text.size() > 100) text = text.substr(0, 97) + "...";
    proof.push_back({invariant.name + " invariant", zero ? Verdict::proved : Verdict::not_decided,
                     zero ? "{I, H} = 0" : "{I, H} did not expand to zero: " + text});
    if (zero) proof.push_back(conserved(invariant.name, value, mechanics, member, table));
  }
  return proof;
}

}  // namespace hamgen
