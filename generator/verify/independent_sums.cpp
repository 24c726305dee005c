#include "generator/verify/independent_sums.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "generator/algebra/derivative.hpp"
#include "generator/verify/claim_list.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/symbolic_machine.hpp"

namespace hamgen {

namespace {

constexpr int kThirds = 3;

// Locals that loops add to.
void collect_sums(const Routine& routine, const Body& body, bool in_loop,
                  std::set<std::string>& declared, std::set<std::string>& sums) {
  for (const Instruction& instruction : body) {
    if (const auto* let = std::get_if<Let>(&instruction.value)) declared.insert(let->symbol);
    const auto* sum = std::get_if<Accumulate>(&instruction.value);
    const bool local = sum != nullptr && !routine.places.contains(sum->symbol);
    if (local && in_loop) sums.insert(sum->symbol);
    const bool loop = std::holds_alternative<For>(instruction.value);
    for (const Body* inner : inner_bodies(instruction))
      collect_sums(routine, *inner, in_loop || loop, declared, sums);
  }
}

// What a routine is given of the state, element by element.
class Elements {
 public:
  Elements(const SizedSystem& system, SymbolicMachine& machine)
      : system_(system), machine_(machine) {}

  void set(const Argument& argument) {
    if (argument.changes || argument.record == "Parameters") return;
    if (argument.record == "State") {
      long first = 0;
      for (const Record& record : system_.program.records) {
        if (record.name != "State") continue;
        for (const Field& field : record.fields) {
          if (field.sizes.size() == 1) set({argument.name, field.name}, field.sizes[0], 1, first);
          first += field.sizes.size() == 1 ? field.sizes[0] : 1;
        }
      }
    }
    if (argument.sizes.size() == 1) {
      const int rooms = system_.program.stages ? system_.program.stages->room() : 1;
      const bool of_stages = argument.sizes[0] % (rooms * degrees_of_freedom()) == 0;
      set({argument.name}, argument.sizes[0], of_stages ? rooms : 1, 0);
    }
  }

  // By the third of the system that they are in.
  std::vector<std::string> thirds[kThirds];

 private:
  [[nodiscard]] int degrees_of_freedom() const { return system_.mechanics.degrees_of_freedom; }
  [[nodiscard]] bool by_component() const {
    return system_.program.stages && system_.program.stages->by_component();
  }

  void set(Place array, int size, int rooms, long first) {
    const QuantityList& variables = system_.mechanics.variables;
    array.indices.resize(1);
    for (int i = 0; i < size; ++i) {
      const int component = by_component() ? i / rooms : i % (size / rooms);
      const auto at = static_cast<std::size_t>(first + component) % variables.size();
      array.indices[0].constant = i;
      const std::string name = "element " + to_text(array);
      machine_.set(array, Expression::symbol(name));
      const long element = variables.element(at) * kThirds / (system_.size + 1);
      thirds[std::clamp(element, 0L, kThirds - 1L)].push_back(name);
    }
  }

  const SizedSystem& system_;
  SymbolicMachine& machine_;
};

using Rows = std::vector<std::vector<ScaledValue>>;

// By elimination with the largest pivot; what 40 digits cancel to is zero.
bool has_full_rank(Rows rows) {
  const std::size_t columns = rows.front().size();
  for (std::size_t done = 0; done < rows.size(); ++done) {
    std::size_t row = done;
    std::size_t column = columns;
    for (std::size_t i = done; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < columns; ++j) {
        if (is_zero(rows[i][j])) continue;
        if (column < columns && cln::abs(rows[i][j].value) <= cln::abs(rows[row][column].value))
          continue;
        row = i;
        column = j;
      }
    }
    if (column == columns) return false;
    std::swap(rows[done], rows[row]);
    for (std::size_t i = done + 1; i < rows.size(); ++i) {
      const Precise factor = rows[i][column].value / rows[done][column].value;
      for (std::size_t j = 0; j < columns; ++j) {
        const ScaledValue& pivot = rows[done][j];
        rows[i][j] = rows[i][j] - ScaledValue{factor * pivot.value, cln::abs(factor) * pivot.scale};
      }
      rows[i][column] = {precise(0), rows[i][column].scale};
    }
  }
  return true;
}

}  // namespace

bool are_sums_independent(const SizedSystem& system, const std::string& routine) {
  const Routine* of = system.program.routine(routine);
  if (of == nullptr) return false;
  std::set<std::string> declared;
  std::set<std::string> names;
  collect_sums(*of, of->body, false, declared, names);
  SymbolicMachine machine(system.program);
  Elements elements(system, machine);
  for (const Argument& argument : of->arguments) elements.set(argument);
  machine.run(routine);
  const Substitution meaning = meaning_of(machine);
  std::vector<Expression> sums;
  for (const std::string& name : names) {
    const std::optional<Expression> sum = machine.local(name);
    if (!sum) return false;
    sums.push_back(substitute(*sum, meaning));
  }
  // One point is enough: the rank is at least that almost everywhere.
  std::map<std::string, Precise> point;
  for (const Expression& sum : sums) {
    for (const std::string& name : symbols(sum)) {
      const auto number = static_cast<long>(point.size());
      point.try_emplace(name, precise(Rational(7 * number % 23 + 5, number % 11 + 17)));
    }
  }
  const Substitution none;
  PreciseValues values(point, none);
  return std::ranges::all_of(elements.thirds, [&](const std::vector<std::string>& third) {
    Rows rows;
    for (const Expression& sum : sums) {
      std::vector<ScaledValue>& row = rows.emplace_back();
      for (const std::string& name : third) {
        const auto slope = values.scaled(derivative(sum, Expression::symbol(name)));
        if (!slope) return false;
        row.push_back(*slope);
      }
    }
    return !rows.empty() && !rows.front().empty() && has_full_rank(std::move(rows));
  });
}

}  // namespace hamgen
