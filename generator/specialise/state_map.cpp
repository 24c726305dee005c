#include <algorithm>

#include "generator/specialise/specialisation.hpp"

namespace hamgen {

namespace {

SparseRationalMatrix unit_matrix(int size) {
  SparseRationalMatrix result;
  for (int i = 0; i < size; ++i) result[{i, i}] = 1;
  return result;
}

// Variables of the model where the scene begins: row `i` of a projection.
std::map<int, Rational> row_of(const SparseRationalMatrix& matrix, int i) {
  std::map<int, Rational> row;
  for (auto it = matrix.lower_bound({i, 0}); it != matrix.end() && it->first.first == i; ++it)
    row[it->first.second] = it->second;
  return row;
}

void add_multiple(std::map<int, Rational>& sum, const Rational& factor,
                  const std::map<int, Rational>& other) {
  for (const auto& [place, value] : other) {
    sum[place] += factor * value;
    if (sum[place] == 0) sum.erase(place);
  }
}

}  // namespace

StateMap state_map(const Specialised& system) {
  const int n = system.given.degrees_of_freedom;
  const int w = system.whole.degrees_of_freedom;
  SparseRationalMatrix embedding = unit_matrix(2 * n);
  SparseRationalMatrix projection = embedding;
  for (const LinearChange& change : system.changes) {
    embedding = product(embedding, change.embedding());
    projection = product(change.projection(), projection);
  }
  // Of the variables of `whole`: where it begins, unless the step has it.
  std::vector<StateMap::Sum> parts(static_cast<std::size_t>(2 * w));
  for (int v = 0; v < 2 * w; ++v)
    parts[static_cast<std::size_t>(v)].at_start = row_of(projection, v);
  const auto part = [&](int v) -> StateMap::Sum& { return parts[static_cast<std::size_t>(v)]; };
  StateMap map;
  for (const int i : system.left.dropped) part(i).known = part(w + i).known = false;
  for (const int i : system.left.cyclic) {
    part(i).known = false;
    map.constants.emplace(system.whole.variables.name(static_cast<std::size_t>(w + i)),
                          part(w + i));
  }
  const auto m = static_cast<int>(system.kept.size());
  for (const int half : {0, 1}) {
    for (int k = 0; k < m; ++k) {
      const int v = half * w + system.kept[static_cast<std::size_t>(k)];
      map.step.push_back(part(v));
      map.step_names.push_back(system.whole.variables.name(static_cast<std::size_t>(v)));
      part(v) = {.known = true, .of = {{half * m + k, Rational(1)}}, .at_start = {}};
    }
  }
  map.model.resize(static_cast<std::size_t>(2 * n));
  for (const auto& [place, entry] : embedding) {
    StateMap::Sum& sum = map.model[static_cast<std::size_t>(place.first)];
    sum.known = sum.known && part(place.second).known;
    add_multiple(sum.of, entry, part(place.second).of);
    add_multiple(sum.at_start, entry, part(place.second).at_start);
  }
  return map;
}

}  // namespace hamgen
