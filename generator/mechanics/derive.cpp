#include "generator/mechanics/derive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>
#include <set>

#include "generator/algebra/ginac_derivatives.hpp"
#include "generator/algebra/ginac_parts.hpp"
#include "generator/base/budget.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/check_names.hpp"
#include "generator/language/scene.hpp"
#include "generator/mechanics/derive_kernels.hpp"
#include "generator/mechanics/energy_terms.hpp"
#include "generator/mechanics/to_ginac.hpp"

namespace hamgen {

namespace {

// Derivatives that vanish identically, such as those of sin^2 + cos^2, are worth a moment's work
// for small expressions; for large ones only GiNaC's own automatic simplification is used.
constexpr std::size_t kSmall = 300;

// Counting further would not make a formula longer in anybody's eyes.
constexpr std::size_t kLong = 100'000;

// Of a sum that was written out by hand nobody looks up its thousandth term.
constexpr std::size_t kMostTraced = 200;

bool vanishes(const GiNaC::ex& e) {
  if (e.is_zero()) return true;
  return node_count(e, kSmall) < kSmall && vanishes_when_expanded(e);
}

QuantityList state_of(const Model& model) {
  QuantityList result;
  for (const auto* group : {&model.coordinates, &model.momenta}) {
    for (const Variable& variable : *group) {
      const Quantity quantity{variable.name, variable.unit, variable.comment, 0};
      if (variable.range) {
        result.append(quantity, variable.range->first, variable.range->size());
      } else {
        result.push_back(quantity);
      }
    }
  }
  return result;
}

// Parameters that are folded, or those that are not, with their default values.
std::vector<Quantity> parameters_of(const Model& model, bool folded) {
  std::vector<Quantity> result;
  std::map<std::string, Rational> values = numbers_of_sizes(model);
  for (const Parameter& parameter : model.parameters) {
    std::size_t k = 0;
    for (const std::string& name : element_names(std::vector{parameter})) {
      const NodePtr& node = parameter.values[std::min(k++, parameter.values.size() - 1)];
      values[name] = evaluate_constant(node, model.source, values);
      if (parameter.folded != folded) continue;
      result.push_back({name, parameter.unit, parameter.comment, values[name]});
    }
  }
  return result;
}

GiNaC::ex hamiltonian(const Model& model, TreeConverter& converter, const SymbolTable& table) {
  GiNaC::ex energy = converter.convert(model.hamiltonian);
  // Extended phase space: H(q, p, t) + p_t makes t advance as t' = 1 and keeps the step symplectic.
  for (const Variable& momentum : model.momenta) {
    if (momentum.is_time) energy += table.find(momentum.name);
  }
  return energy;
}

// A derivative that is complex, or infinite, for every state is a mistake of the formula.
template <class Work>
auto with_place(const Model& model, const Span& span, const Work& work) {
  try {
    return work();
  } catch (const std::domain_error& error) {
    throw ModelError({{.severity = Severity::error,
                       .span = span,
                       .message = fmt::format("undefined or not real: {}", reason_of(error)),
                       .help = "it, or a derivative of it, has no real value at any state"}},
                     model.source);
  } catch (const OverBudget& error) {
    throw over_budget(error, span, model.source);
  }
}

// The first and second derivatives of H, into the mechanics.
void differentiate(const GiNaC::ex& energy, const std::map<std::string, int>& places,
                   const SymbolTable& table, FromGinac& expression, Mechanics& mechanics) {
  Differentiator differentiator;
  std::vector<GiNaC::ex> gradient;
  const auto symbol = [&](std::size_t i) -> const GiNaC::symbol& {
    return table.find(mechanics.variables.name(i));
  };
  for (std::size_t i = 0; i < mechanics.variables.size(); ++i) {
    GiNaC::ex derivative = differentiator(energy, symbol(i));
    if (vanishes(derivative)) derivative = 0;
    mechanics.gradient.push_back(expression(derivative));
    gradient.push_back(std::move(derivative));
  }
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    std::set<std::size_t> columns;
    for (const std::string& name : symbols(mechanics.gradient[i])) {
      const auto place = places.find(name);
      if (place != places.end() && place->second >= static_cast<int>(i))
        columns.insert(static_cast<std::size_t>(place->second));
    }
    for (const std::size_t j : columns) {
      const GiNaC::ex entry = differentiator(gradient[i], symbol(j));
      if (vanishes(entry)) continue;
      mechanics.hessian.emplace(std::pair(static_cast<int>(i), static_cast<int>(j)),
                                expression(entry));
    }
  }
}

// What H names, and what that does, in the order of the file.
std::vector<std::pair<std::string, std::string>> definitions_of(const Model& model) {
  std::set<std::string> used = names_in(model.hamiltonian);
  std::vector<std::pair<std::string, std::string>> list;
  for (const Definition& definition : std::views::reverse(model.definitions)) {
    if (!used.contains(definition.name)) continue;
    list.emplace_back(definition.name, definition.text);
    used.merge(names_in(definition.value));
  }
  std::ranges::reverse(list);
  return list;
}

Mechanics derived(const Model& model, bool keep_sums, int most) {
  Mechanics mechanics;
  mechanics.name = model.name;
  mechanics.hamiltonian_text = model.hamiltonian_text;
  mechanics.definitions = definitions_of(model);
  mechanics.has_time = std::ranges::any_of(model.coordinates, &Variable::is_time);
  mechanics.degrees_of_freedom = static_cast<int>(degrees_of_freedom(model));
  mechanics.variables = state_of(model);
  mechanics.parameters = parameters_of(model, false);
  mechanics.constants = parameters_of(model, true);

  const std::vector<WrittenTerm> terms = written_terms(model);
  for (const WrittenTerm& written : terms) mechanics.terms.push_back(written.term);
  if (keep_sums && mechanics.degrees_of_freedom > most) {
    if (auto form = derive_kernels(model)) {
      mechanics.kernels = std::move(form->kernels);
      mechanics.sums = std::move(form->sums);
      mechanics.of_sums = std::move(form->of_sums);
      return mechanics;
    }
  }
  SymbolTable table;
  TreeConverter converter(model, table);
  std::map<std::string, int> places;
  for (const Quantity& variable : mechanics.variables) {
    const int place = static_cast<int>(places.size());
    table.symbol(variable.name, kRankOfVariable + place);
    places[variable.name] = place;
  }
  const GiNaC::ex energy = hamiltonian(model, converter, table);
  FromGinac expression(table);
  mechanics.energy = expression(energy);
  std::size_t longest = 0;
  Span span_of_longest = model.hamiltonian->span;
  for (std::size_t t = 0; t < terms.size() && terms.size() <= kMostTraced; ++t) {
    const GiNaC::ex value = converter.convert(terms[t].node);
    for (const std::string& name : symbols(expression(value))) {
      if (places.contains(name)) mechanics.terms[t].variables.insert(name);
    }
    const std::size_t length = node_count(value, kLong);
    if (length <= longest) continue;
    longest = length;
    span_of_longest = terms[t].node->span;
  }
  try {
    differentiate(energy, places, table, expression, mechanics);
  } catch (const OverBudget& error) {
    throw over_budget(error, span_of_longest, model.source);
  }
  return mechanics;
}

// Of what is computed beside H, in one sum or product: a compiler takes half a minute for as many
// terms.
constexpr std::size_t kLongestObserved = 30'000;

std::size_t longest_list(const Expression& e) {
  std::size_t longest = e.operands().size();
  for (const Expression& each : e.operands()) longest = std::max(longest, longest_list(each));
  return longest;
}

}  // namespace

Mechanics derive(const Model& model, bool keep_sums, int most) {
  const Budget budget;
  Mechanics mechanics =
      with_place(model, model.hamiltonian->span, [&] { return derived(model, keep_sums, most); });
  // The ranks of the symbols are those of their declarations, see TreeConverter.
  SymbolTable table;
  TreeConverter converter(model, table);
  for (const Invariant& invariant : model.invariants) {
    const Expression value = with_place(model, invariant.value->span, [&] {
      return from_ginac(converter.convert(invariant.value), table);
    });
    if (longest_list(value) > kLongestObserved)
      throw ModelError({{.severity = Severity::error,
                         .span = invariant.value->span,
                         .message = fmt::format("a sum of more than {} terms is written out here",
                                                kLongestObserved),
                         .help = "sums of H stay loops, others do not; a run with --observe energy "
                                 "needs none"}},
                       model.source);
    mechanics.invariants.push_back({invariant.name, value, invariant.only_observed,
                                    invariant.comment, invariant.rising, invariant.falling});
  }
  return mechanics;
}

Expression written_out_hamiltonian(const Model& model) {
  SymbolTable table;
  TreeConverter converter(model, table);
  int rank = kRankOfVariable;
  for (const Quantity& variable : state_of(model)) table.symbol(variable.name, rank++);
  return with_place(model, model.hamiltonian->span,
                    [&] { return from_ginac(hamiltonian(model, converter, table), table); });
}

Expression scheme_parameter(const Model& model, const std::string& option, const NodePtr& node) {
  SymbolTable table;
  TreeConverter converter(model, table);
  try {
    return from_ginac(converter.convert(node), table);
  } catch (const std::domain_error& error) {
    throw UsageError("--" + option + ": " + error.what());
  }
}

}  // namespace hamgen
