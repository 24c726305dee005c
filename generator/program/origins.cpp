#include "generator/program/origins.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <ranges>

#include "generator/equations/step_equations.hpp"

namespace hamgen {

namespace {

using Terms = std::set<int>;

// The name without the stars that tell later values of it.
std::string plain(const std::string& name) {
  return name.substr(0, name.find_last_not_of('*') + 1);
}

// What an instruction gives a value, and the value; empty for other kinds.
struct Definition {
  std::string name;
  const Expression* value = nullptr;
};
Definition definition_of(const Instruction& instruction) {
  if (const auto* let = std::get_if<Let>(&instruction.value)) return {let->symbol, &let->value};
  if (const auto* set = std::get_if<Assign>(&instruction.value)) return {set->symbol, &set->value};
  if (const auto* sum = std::get_if<Accumulate>(&instruction.value)) {
    return {sum->symbol, &sum->value};
  }
  if (const auto* sum = std::get_if<Collect>(&instruction.value)) return {sum->symbol, &sum->value};
  return {};
}

void for_each_instruction(Body& body, const std::function<void(Instruction&)>& use) {
  for (Instruction& instruction : body) {
    use(instruction);
    for (Body* inner : inner_bodies(instruction)) for_each_instruction(*inner, use);
  }
}

// --- how often ----------------------------------------------------------------------------------

bool repeats(const Instruction& instruction) {
  return std::holds_alternative<Iterate>(instruction.value) ||
         std::holds_alternative<IterateArray>(instruction.value) ||
         std::holds_alternative<Refine>(instruction.value) ||
         std::holds_alternative<RefineArray>(instruction.value) ||
         std::holds_alternative<Sweep>(instruction.value);
}

// A routine that is called from both is the iteration's.
void set_section(Program& code, Body& body, When when) {
  for (Instruction& instruction : body) {
    instruction.origin.when = std::max(instruction.origin.when, when);
    std::set<std::string> called;
    if (const auto* call = std::get_if<Call>(&instruction.value)) called = {call->routine};
    if (const auto* two = std::get_if<Alternate>(&instruction.value)) {
      called = {two->first.routine, two->second.routine};
    }
    for (Routine& routine : code.routines) {
      if (called.contains(routine.name)) set_section(code, routine.body, when);
    }
    const When inside = repeats(instruction) ? When::iteration : when;
    for (Body* inner : inner_bodies(instruction)) set_section(code, *inner, inside);
  }
}

// Of coefficients: the step size's, if they or a matrix they stand in depend on h.
void set_sections_of_coefficients(Routine& prepare) {
  std::set<std::string> of_step_size = {"h"};
  for_each_instruction(prepare.body, [&](Instruction& instruction) {
    std::set<std::string> used;
    collect_symbols({instruction}, used);
    std::string name = definition_of(instruction).name;
    if (const auto* put = std::get_if<Put>(&instruction.value)) name = put->matrix.object;
    if (const auto* invert = std::get_if<Invert>(&instruction.value)) used.insert(invert->matrix);
    const bool depends =
        std::ranges::any_of(used, [&](const std::string& s) { return of_step_size.contains(s); });
    instruction.origin.when = depends ? When::step_size : When::run;
    if (depends && !name.empty()) of_step_size.insert(name);
  });
}

// --- which terms --------------------------------------------------------------------------------

class TermTracer {
 public:
  TermTracer(const Environment& environment, const StepEquations& equations)
      : environment_(environment), equations_(equations) {
    const int size = 2 * equations.mechanics.degrees_of_freedom;
    for (int i = 0; i < size; ++i) {
      sources_[equations.gradient_symbol(i).name()] = terms_with(i, i);
      stages_.insert(equations.stage(i).name());
      for (int j = i; j < size; ++j) {
        const Expression second = equations.hessian_symbol(i, j);
        if (!second.is_zero()) sources_[second.name()] = terms_with(i, j);
      }
    }
  }

  void trace(Routine& routine) {
    std::vector<Instruction*> all;
    std::set<std::string> moved = stages_;
    for_each_instruction(routine.body, [&](Instruction& instruction) {
      all.push_back(&instruction);
      if (const auto* iterate = std::get_if<Iterate>(&instruction.value)) {
        for (const Unknown& u : iterate->unknowns) moved.merge(symbols(u.correction));
      }
    });
    const std::map<std::string, Terms> results = results_of(routine);
    std::map<std::string, Terms> known = known_at_a_point(routine);
    for (Instruction* instruction : all) forward(*instruction, moved, results, known);
    std::map<std::string, Terms> wanted;
    for (Instruction* instruction : all | std::views::reverse) {
      backward(*instruction, moved, wanted);
    }
  }

 private:
  [[nodiscard]] Terms terms_with(int i, int j) const {
    Terms terms;
    const std::vector<EnergyTerm>& all = equations_.mechanics.terms;
    const auto& variables = equations_.mechanics.variables;
    for (std::size_t t = 0; t < all.size(); ++t) {
      if (all[t].variables.contains(variables.name(static_cast<std::size_t>(i))) &&
          all[t].variables.contains(variables.name(static_cast<std::size_t>(j)))) {
        terms.insert(static_cast<int>(t));
      }
    }
    return terms;
  }

  // The increment of a variable is h times a derivative by the other one of its pair.
  [[nodiscard]] std::map<std::string, Terms> results_of(const Routine& routine) const {
    std::map<std::string, Terms> results;
    const int n = environment_.degrees_of_freedom;
    for (const auto& [symbol, place] : routine.places) {
      for (int i = 0; i < 2 * n; ++i) {
        for (const char* object : {"dz", "rest"}) {
          if (place != environment_.place(object, i)) continue;
          results[symbol] = terms_with(i < n ? i + n : i - n, i < n ? i + n : i - n);
        }
      }
    }
    return results;
  }

  // Derivatives that another routine evaluates.
  [[nodiscard]] std::map<std::string, Terms> known_at_a_point(const Routine& routine) const {
    std::map<std::string, Terms> known;
    for (const auto& [symbol, place] : routine.places) {
      const auto source = sources_.find(symbol);
      if (place.object == "at" && source != sources_.end()) known.insert(*source);
    }
    return known;
  }

  void forward(Instruction& instruction, const std::set<std::string>& moved,
               const std::map<std::string, Terms>& results,
               std::map<std::string, Terms>& known) const {
    const auto [name, value] = definition_of(instruction);
    if (value == nullptr) return;
    Terms& terms = instruction.origin.terms;
    if (const auto source = sources_.find(plain(name)); source != sources_.end()) {
      terms = source->second;
    } else if (const auto result = results.find(name); result != results.end()) {
      terms = result->second;
    } else {
      for (const std::string& symbol : symbols(*value)) {
        if (const auto it = known.find(symbol); it != known.end()) {
          terms.insert(it->second.begin(), it->second.end());
        }
      }
    }
    if (stages_.contains(plain(name))) instruction.origin.stage = plain(name);
    if (!moved.contains(plain(name))) known[name] = terms;
  }

  void backward(Instruction& instruction, const std::set<std::string>& moved,
                std::map<std::string, Terms>& wanted) const {
    const auto [name, value] = definition_of(instruction);
    if (value == nullptr || value->kind() == Kind::symbol) return;
    Terms& terms = instruction.origin.terms;
    const auto it = wanted.find(name);
    const bool is_ingredient = terms.empty() && it != wanted.end();
    if (is_ingredient) terms = it->second;
    if (!is_ingredient && !sources_.contains(plain(name))) return;
    for (const std::string& symbol : symbols(*value)) {
      if (!moved.contains(plain(symbol))) wanted[symbol].insert(terms.begin(), terms.end());
    }
  }

  const Environment& environment_;
  const StepEquations& equations_;
  std::map<std::string, Terms> sources_;
  std::set<std::string> stages_;
};

}  // namespace

void trace_origins(Program& code, const Environment& environment, const StepEquations& equations) {
  for (Routine& routine : code.routines) {
    if (routine.name == "prepare") set_sections_of_coefficients(routine);
    if (routine.name == "solve") set_section(code, routine.body, When::step);
  }
  if (equations.function || equations.mechanics.keeps_sums() || !equations.scheme.has_member()) {
    return;
  }
  TermTracer tracer(environment, equations);
  for (Routine& routine : code.routines) {
    if (routine.name == "solve" || routine.name == "derivatives") tracer.trace(routine);
  }
}

}  // namespace hamgen
