#include "generator/specialise/linear_change.hpp"

#include <algorithm>

#include "generator/algebra/from_ginac.hpp"

namespace hamgen {

namespace {

SparseRationalMatrix transposed(const SparseRationalMatrix& matrix) {
  SparseRationalMatrix result;
  for (const auto& [place, entry] : matrix)
    result.emplace(std::pair(place.second, place.first), entry);
  return result;
}

// Two blocks, the second below and to the right of the first, which is rows x columns.
SparseRationalMatrix blocks(const SparseRationalMatrix& first, const SparseRationalMatrix& second,
                            int rows, int columns) {
  SparseRationalMatrix result = first;
  for (const auto& [place, entry] : second)
    result.emplace(std::pair(rows + place.first, columns + place.second), entry);
  return result;
}

std::size_t at_place(int i) { return static_cast<std::size_t>(i); }

Expression new_variable(const LinearChange& change, int i) {
  return Expression::symbol(change.variables[at_place(i)].name, kRankOfVariable + i);
}

// The symbol of that name as it stands in the expression.
const Expression* find_symbol(const Expression& e, const std::string& name) {
  if (e.kind() == Kind::symbol) return e.name() == name ? &e : nullptr;
  for (const Expression& operand : e.operands()) {
    if (const Expression* found = find_symbol(operand, name)) return found;
  }
  return nullptr;
}

SparseMatrix times(const SparseMatrix& c, const SparseRationalMatrix& l) {
  SparseMatrix result;
  for (const auto& [place, entry] : c) {
    for (auto it = l.lower_bound({place.second, 0});
         it != l.end() && it->first.first == place.second; ++it) {
      Expression& sum = result[{place.first, it->first.second}];
      sum = sum + entry * Expression(it->second);
    }
  }
  return result;
}
SparseMatrix times(const SparseRationalMatrix& l, const SparseMatrix& c) {
  SparseMatrix result;
  for (const auto& [place, entry] : l) {
    for (auto it = c.lower_bound({place.second, 0});
         it != c.end() && it->first.first == place.second; ++it) {
      Expression& sum = result[{place.first, it->first.second}];
      sum = sum + Expression(entry) * it->second;
    }
  }
  return result;
}

// C' with C L = L C'.
std::optional<SparseMatrix> in_new_variables(const LinearChange& change, const SparseMatrix& c) {
  const SparseRationalMatrix embedding = change.embedding();
  const SparseMatrix image = times(c, embedding);
  SparseMatrix result = times(change.projection(), image);
  std::erase_if(result, [](const auto& entry) { return vanishes(entry.second); });
  SparseMatrix defect = times(embedding, result);
  for (const auto& [place, entry] : image) defect[place] = defect[place] - entry;
  const bool respects =
      std::ranges::all_of(defect, [](const auto& entry) { return vanishes(entry.second); });
  return respects ? std::optional(std::move(result)) : std::nullopt;
}

bool change_member(const LinearChange& change, Member& member) {
  std::optional<SparseMatrix> c = in_new_variables(change, of_all(member, change.from).c);
  if (!c) return false;
  member.c = std::move(*c);
  member.degrees_of_freedom = change.to;
  return true;
}

}  // namespace

SparseRationalMatrix LinearChange::embedding() const { return blocks(a, b, from, to); }
SparseRationalMatrix LinearChange::projection() const {
  return blocks(transposed(b), transposed(a), to, from);
}

SparseRationalMatrix product(const SparseRationalMatrix& a, const SparseRationalMatrix& b) {
  SparseRationalMatrix result;
  for (const auto& [place, entry] : a) {
    for (auto it = b.lower_bound({place.second, 0});
         it != b.end() && it->first.first == place.second; ++it)
      result[{place.first, it->first.second}] += entry * it->second;
  }
  std::erase_if(result, [](const auto& entry) { return entry.second == 0; });
  return result;
}

Substitution united_parameters(const std::vector<std::pair<std::string, std::string>>& united,
                               const Expression& energy) {
  Substitution result;
  for (const auto& [name, other] : united) {
    const Expression* symbol = find_symbol(energy, other);
    result.emplace(name, symbol != nullptr ? *symbol : Expression::symbol(other, kRankOfParameter));
  }
  return result;
}

Substitution new_variables(const LinearChange& change, const Mechanics& mechanics) {
  std::map<int, std::vector<Expression>> sums;
  for (const auto& [place, entry] : change.embedding())
    sums[place.first].push_back(Expression(entry) * new_variable(change, place.second));
  Substitution result;
  for (int i = 0; i < 2 * change.from; ++i)
    result.emplace(mechanics.variables.name(at_place(i)), Expression::sum(sums[i]));
  result.merge(united_parameters(change.united, mechanics.energy));
  return result;
}

Mechanics in_new_variables(const LinearChange& change, const Mechanics& mechanics) {
  const Substitution replacements = new_variables(change, mechanics);
  Mechanics result = mechanics;
  result.degrees_of_freedom = change.to;
  result.variables = QuantityList(change.variables);
  result.energy = substitute(mechanics.energy, replacements);
  result.gradient.clear();
  result.hessian.clear();
  SymbolTable table;
  for (int i = 0; i < 2 * change.to; ++i)
    table.symbol(change.variables[at_place(i)].name, kRankOfVariable + i);
  const GiNaC::ex energy = to_ginac(result.energy, table);
  const auto symbol = [&](int i) -> const GiNaC::symbol& {
    return table.find(change.variables[at_place(i)].name);
  };
  for (int i = 0; i < 2 * change.to; ++i) {
    const GiNaC::ex slope = energy.diff(symbol(i));
    const Expression component = from_ginac(slope, table);
    result.gradient.push_back(vanishes(component) ? Expression(0) : component);
    const std::set<std::string> present = symbols(result.gradient.back());
    for (int j = i; j < 2 * change.to; ++j) {
      if (!present.contains(change.variables[at_place(j)].name)) continue;
      const Expression entry = from_ginac(slope.diff(symbol(j)), table);
      if (!vanishes(entry)) result.hessian.emplace(std::pair(i, j), entry);
    }
  }
  std::erase_if(result.parameters, [&](const Quantity& parameter) {
    return std::ranges::any_of(change.united,
                               [&](const auto& pair) { return pair.first == parameter.name; });
  });
  for (NamedExpression& invariant : result.invariants)
    invariant.value = substitute(invariant.value, replacements);
  for (EnergyTerm& term : result.terms) {
    std::set<std::string> variables;
    for (const std::string& name : term.variables)
      collect_symbols(replacements.at(name), variables);
    term.variables = std::move(variables);
  }
  return result;
}

std::optional<Scheme> in_new_variables(const LinearChange& change, const Scheme& scheme) {
  Scheme result = scheme;
  bool respects = true;
  if (auto* member = std::get_if<Member>(&result.method)) {
    respects = change_member(change, *member);
  } else if (auto* composition = std::get_if<Composition>(&result.method)) {
    respects = change_member(change, composition->base);
  }
  return respects ? std::optional(std::move(result)) : std::nullopt;
}

SceneFacts in_new_variables(const LinearChange& change, SceneFacts scene) {
  const auto image = [&](const SparseRationalMatrix& matrix, const std::vector<Rational>& old) {
    std::vector<Rational> values(at_place(change.to));
    for (const auto& [place, entry] : matrix)
      values[at_place(place.second)] += entry * old[at_place(place.first)];
    return values;
  };
  scene.values.q = image(change.b, scene.values.q);
  scene.values.p = image(change.a, scene.values.p);
  return scene;
}

}  // namespace hamgen
