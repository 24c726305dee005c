#include "tests/verify/mutants.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "generator/equations/step_equations.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen::verify_test {

Mechanics mechanics_of(const std::string& text) {
  return derive(read_model(make_source("case.ham", "system case\n" + text)));
}

LoweredStep lowered_of(const Mechanics& mechanics, const Scheme& scheme, const std::string& solver,
                       bool lanes) {
  return lower_step(plan_solve(discretise(mechanics, scheme), solver), {.stages_in_lanes = lanes});
}

namespace {

using Visit = std::function<void(Expression&)>;

struct Visitor {
  const Visit& visit;

  void body(Body& body) const {
    for (Instruction& instruction : body) std::visit(*this, instruction.value);
  }
  void unknowns(std::vector<Unknown>& list) const {
    for (Unknown& unknown : list) {
      visit(unknown.start);
      visit(unknown.correction);
    }
  }
  void operator()(Let& let) const { visit(let.value); }
  void operator()(Array& array) const {
    for (Expression& e : array.values) visit(e);
  }
  void operator()(Assign& assign) const { visit(assign.value); }
  void operator()(Collect& sum) const { visit(sum.value); }
  void operator()(Accumulate& sum) const { visit(sum.value); }
  void operator()(Put& put) const { visit(put.value); }
  void operator()(For& loop) const { body(loop.body); }
  void operator()(Scope& scope) const { body(scope.body); }
  void operator()(If& branch) const { body(branch.then); }
  void operator()(Alternate& alternate) const { body(alternate.between); }
  void operator()(Iterate& iterate) const {
    unknowns(iterate.unknowns);
    body(iterate.body);
  }
  void operator()(IterateArray& iterate) const { body(iterate.body); }
  // What it evaluates is what the iteration before it evaluates.
  void operator()(Refine& refine) const {
    for (Expression& e : refine.gradient) visit(e);
  }
  void operator()(RefineArray&) const {}
  void operator()(Sweep& sweep) const {
    unknowns(sweep.unknowns);
    body(sweep.body);
  }
  void operator()(Return& end) const {
    if (end.value) visit(*end.value);
  }
  template <class Other>
  void operator()(Other&) const {}
};

}  // namespace

void for_each_expression(Program& code, const std::function<void(Expression&)>& visit) {
  for (Routine& routine : code.routines) Visitor{visit}.body(routine.body);
}

namespace {

// An expression with one node changed: all ways of a kind.
using Change = std::function<std::vector<Expression>(const Expression&)>;

std::vector<Expression> changed_somewhere(const Expression& e, const Change& change) {
  std::vector<Expression> result = change(e);
  std::vector<Expression> operands(e.operands().begin(), e.operands().end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Expression kept = operands[i];
    for (const Expression& other : changed_somewhere(kept, change)) {
      operands[i] = other;
      result.push_back(with_operands(e, operands));
    }
    operands[i] = kept;
  }
  return result;
}

struct Mutation {
  std::string name;
  Change change;
};

std::string exchanged(std::string name) {
  // x and px, q1 and p1 and the names made of them change places.
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == 'q') {
      name[i] = 'p';
    } else if (name[i] == 'p' && i + 1 < name.size() &&
               (name[i + 1] == 'x' || name[i + 1] == 'y')) {
      name.erase(i, 1);
    } else if (name[i] == 'x' || name[i] == 'y') {
      name.insert(i++, "p");
    } else if (name[i] == 'p') {
      name[i] = 'q';
    }
  }
  return name;
}

std::vector<Mutation> mutations(const std::set<std::string>& known) {
  using List = std::vector<Expression>;
  return {
      {"sign", [](const Expression& e) { return e.is_zero() ? List{} : List{-e}; }},
      {"coefficient",
       [](const Expression& e) {
         return e.is_number() && !e.is_zero() ? List{e * Expression(Rational(1001, 1000))} : List{};
       }},
      {"dropped operand",
       [](const Expression& e) {
         List result;
         if (e.kind() != Kind::sum && e.kind() != Kind::product) return result;
         for (std::size_t i = 0; i < e.operands().size(); ++i) {
           List rest(e.operands().begin(), e.operands().end());
           rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
           result.push_back(with_operands(e, rest));
         }
         return result;
       }},
      {"wrong power",
       [](const Expression& e) {
         if (e.kind() != Kind::power) return List{};
         return List{Expression::power(e.operands()[0], e.operands()[1] + Expression(1))};
       }},
      {"q and p exchanged",
       [known](const Expression& e) {
         if (e.kind() != Kind::symbol) return List{};
         const std::string other = exchanged(e.name());
         return other != e.name() && known.contains(other) ? List{Expression::symbol(other)}
                                                           : List{};
       }},
      {"another function",
       [](const Expression& e) {
         if (e.kind() != Kind::function) return List{};
         return List{Expression::apply(e.name() == "sin" ? "cos" : "sin", {e.operands()[0]})};
       }},
  };
}

}  // namespace

std::vector<Mutant> mutants_of(const Program& original, Some some,
                               const std::set<std::string>& routines) {
  std::vector<Mutant> mutants;
  std::set<std::string> known;
  std::vector<Expression> all;
  const auto for_each = [&](Program& code, const std::function<void(Expression&)>& visit) {
    for (Routine& routine : code.routines) {
      if (routines.empty() || routines.contains(routine.name)) Visitor{visit}.body(routine.body);
    }
  };
  Program copy = original;
  for_each(copy, [&](Expression& e) {
    collect_symbols(e, known);
    all.push_back(e);
  });
  const std::size_t places = all.size();
  std::size_t kind = 0;
  for (const Mutation& mutation : mutations(known)) {
    ++kind;
    for (std::size_t place = 0; place < places; ++place) {
      if ((place + kind) % (1 + places / 12) != 0) continue;
      const std::vector<Expression> variants = changed_somewhere(all[place], mutation.change);
      for (std::size_t v = 0; v < variants.size(); v += 1 + variants.size() / 2) {
        if (variants[v] == all[place] || some.first++ % some.every != 0) continue;
        Program mutant = original;
        std::size_t now = 0;
        for_each(mutant, [&](Expression& e) {
          if (now++ == place) e = variants[v];
        });
        mutants.push_back({mutation.name, to_text(all[place]) + " -> " + to_text(variants[v]),
                           std::move(mutant)});
      }
    }
  }
  return mutants;
}

namespace {

// Every body, with the routine it belongs to.
void for_each_body(Program& code, const std::function<void(const Routine&, Body&)>& use) {
  const std::function<void(const Routine&, Body&)> visit = [&](const Routine& routine, Body& body) {
    use(routine, body);
    for (Instruction& instruction : body) {
      for (const Body* inner : inner_bodies(instruction)) {
        // A refinement evaluates what the iteration before it does.
        const bool again = std::holds_alternative<Refine>(instruction.value) ||
                           std::holds_alternative<RefineArray>(instruction.value);
        if (!again) visit(routine, const_cast<Body&>(*inner));
      }
    }
  };
  for (Routine& routine : code.routines) visit(routine, routine.body);
}

bool computes(const Instruction& instruction) {
  const auto& node = instruction.value;
  return std::holds_alternative<Assign>(node) || std::holds_alternative<Accumulate>(node) ||
         std::holds_alternative<Collect>(node) || std::holds_alternative<CollectStages>(node) ||
         std::holds_alternative<Put>(node) || std::holds_alternative<For>(node) ||
         std::holds_alternative<Call>(node) || std::holds_alternative<Clear>(node);
}

}  // namespace

std::vector<Mutant> mutants_of_structure(const Program& original, Some some,
                                         const std::set<std::string>& routines) {
  std::vector<Mutant> mutants;
  const auto for_each_chosen = [&](Program& code, const auto& use) {
    for_each_body(code, [&](const Routine& routine, Body& body) {
      if (routines.empty() || routines.contains(routine.name)) use(routine, body);
    });
  };
  const auto change = [&](const std::string& kind, const auto& alter) {
    if (some.first++ % some.every != 0) return;
    Program mutant = original;
    const std::string what = alter(mutant);
    if (!what.empty()) mutants.push_back({kind, what, std::move(mutant)});
  };
  const std::size_t substeps = routines.empty() ? original.substeps.size() : 0;
  for (std::size_t i = 0; substeps > 1 && i < substeps; ++i) {
    change("substep left out", [i](Program& code) {
      code.substeps.erase(code.substeps.begin() + static_cast<std::ptrdiff_t>(i));
      return std::to_string(i);
    });
    change("substeps exchanged", [i, substeps](Program& code) {
      std::swap(code.substeps[i], code.substeps[(i + 1) % substeps]);
      return std::to_string(i);
    });
  }
  std::size_t bodies = 0;
  Program copy = original;
  for_each_chosen(copy, [&](const Routine&, Body& body) { bodies += body.size(); });
  const std::size_t stride = routines.empty() ? 1 + bodies / 24 : 1;
  for (std::size_t place = 0; place < bodies; place += stride) {
    const auto at_place = [&](const std::string& kind, const auto& alter) {
      change(kind, [&](Program& code) {
        std::size_t now = 0;
        std::string what;
        for_each_chosen(code, [&](const Routine& routine, Body& body) {
          const std::size_t first = now;
          now += body.size();
          if (place < first || place >= now || !what.empty()) return;
          if (alter(body, place - first)) what = routine.name + " " + std::to_string(place - first);
        });
        return what;
      });
    };
    at_place("instruction left out", [](Body& body, std::size_t i) {
      if (!computes(body[i])) return false;
      body.erase(body.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    });
    at_place("range too short", [](Body& body, std::size_t i) {
      auto* loop = std::get_if<For>(&body[i].value);
      if (loop == nullptr) return false;
      loop->range.upper.constant -= 1;
      return true;
    });
    at_place("range begins late", [](Body& body, std::size_t i) {
      auto* loop = std::get_if<For>(&body[i].value);
      if (loop == nullptr) return false;
      loop->range.lower.constant += 1;
      return true;
    });
    at_place("neighbour in the matrix", [](Body& body, std::size_t i) {
      auto* put = std::get_if<Put>(&body[i].value);
      if (put == nullptr) return false;
      put->column.constant += 1;
      return true;
    });
  }
  return mutants;
}

}  // namespace hamgen::verify_test
