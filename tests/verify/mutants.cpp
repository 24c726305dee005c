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

Program program_of(const Mechanics& mechanics, const Scheme& scheme, const std::string& solver) {
  return build_program(plan_solve(discretise(mechanics, scheme), solver));
}

void for_each_expression(Program& program, const std::function<void(Expression&)>& visit) {
  auto statements = [&](std::vector<Statement>& list) {
    for (Statement& s : list) visit(s.value);
  };
  auto expressions = [&](std::vector<Expression>& list) {
    for (Expression& e : list) visit(e);
  };
  statements(program.coefficients);
  for (Stage& stage : program.stages) {
    statements(stage.before);
    if (stage.solve) {
      statements(stage.solve->body);
      expressions(stage.solve->residual);
      for (auto& row : stage.solve->matrix) expressions(row);
      for (LoopVariable& v : stage.solve->variables) {
        for (Expression* e : {&v.cold, &v.next, &v.correction}) visit(*e);
      }
      expressions(stage.solve->gradient);
    }
    statements(stage.after);
  }
  expressions(program.increments);
  expressions(program.rests);
  for (Evaluation* evaluation :
       {&program.energy, &program.gradient, &program.invariants, &program.potential_gradient,
        &program.kinetic_gradient, &program.vector_field, &program.hessian,
        &program.modified_energies}) {
    statements(evaluation->statements);
    expressions(evaluation->results);
  }
  if (program.linearisation) {
    statements(program.linearisation->once);
    for (Linearisation::Stage& stage : program.linearisation->stages) {
      statements(stage.before);
      if (!stage.solve) continue;
      for (auto& row : stage.solve->matrix) expressions(row);
      expressions(stage.solve->right_side);
    }
    expressions(program.linearisation->results);
  }
  for (Substep& substep : program.sequence.substeps) visit(substep.length);
  for (auto& row : program.sequence.stages.coupling) expressions(row);
  expressions(program.sequence.stages.weight);
}

namespace {

// An expression with one node changed: all ways of a kind.
using Change = std::function<std::vector<Expression>(const Expression&)>;

Expression rebuilt(const Expression& e, std::vector<Expression> operands) {
  switch (e.kind()) {
    case Kind::sum:
      return Expression::sum(std::move(operands));
    case Kind::product:
      return Expression::product(std::move(operands));
    case Kind::power:
      return Expression::power(operands[0], operands[1]);
    case Kind::function:
      return Expression::apply(e.name(), std::move(operands));
    default:
      return e;
  }
}

std::vector<Expression> changed_somewhere(const Expression& e, const Change& change) {
  std::vector<Expression> result = change(e);
  std::vector<Expression> operands(e.operands().begin(), e.operands().end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Expression kept = operands[i];
    for (const Expression& other : changed_somewhere(kept, change)) {
      operands[i] = other;
      result.push_back(rebuilt(e, operands));
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
           result.push_back(rebuilt(e, rest));
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

// The program's results in double at one point: an oracle that shares nothing with the proof. Empty
// if a value is used before it is computed.
class Interpreter {
 public:
  std::optional<std::vector<double>> operator()(Program program) {
    try {
      run(program.coefficients);
      for (const Stage& stage : program.stages) {
        run(stage.before);
        if (stage.solve) {
          run(stage.solve->body);
          for (const Expression& e : stage.solve->residual) results_.push_back(value(e));
          for (const auto& row : stage.solve->matrix) {
            for (const Expression& e : row) results_.push_back(value(e));
          }
          for (const LoopVariable& v : stage.solve->variables) {
            for (const Expression& e : {v.cold, v.next, v.correction}) results_.push_back(value(e));
          }
          for (const Expression& e : stage.solve->gradient) results_.push_back(value(e));
        }
        run(stage.after);
      }
      // What is large and what is small make one increment.
      for (std::size_t i = 0; i < program.increments.size(); ++i) {
        const double rest = program.rests.empty() ? 0.0 : value(program.rests[i]);
        results_.push_back(value(program.increments[i]) + rest);
      }
      for (const Evaluation* e :
           {&program.energy, &program.gradient, &program.invariants, &program.potential_gradient,
            &program.kinetic_gradient, &program.vector_field, &program.hessian,
            &program.modified_energies}) {
        run(e->statements);
        for (const Expression& result : e->results) results_.push_back(value(result));
      }
      if (program.linearisation) run(*program.linearisation);
      for (const Substep& substep : program.sequence.substeps) {
        results_.push_back(static_cast<double>(substep.kind));
        results_.push_back(value(substep.length));
      }
      for (const auto& row : program.sequence.stages.coupling) {
        for (const Expression& e : row) results_.push_back(value(e));
      }
      for (const Expression& e : program.sequence.stages.weight) results_.push_back(value(e));
    } catch (const std::out_of_range&) {
      return std::nullopt;
    }
    return results_;
  }

 private:
  void run(const Linearisation& linearisation) {
    run(linearisation.once);
    for (const Linearisation::Stage& stage : linearisation.stages) {
      run(stage.before);
      if (!stage.solve) continue;
      for (const auto& row : stage.solve->matrix) {
        for (const Expression& e : row) results_.push_back(value(e));
      }
      for (const Expression& e : stage.solve->right_side) results_.push_back(value(e));
    }
    for (const Expression& e : linearisation.results) results_.push_back(value(e));
  }
  void run(const std::vector<Statement>& statements) {
    std::set<std::string> rounded;
    for (std::size_t i = 0; i < statements.size(); ++i) {
      pending_.insert(statements[i].name);
      const Expression& error = statements[i].value;
      if (error.kind() != Kind::function || error.name() != kProductError) continue;
      const Expression product = error.operands()[0] * error.operands()[1];
      for (std::size_t j = i; j-- > 0;) {
        if (statements[j].value != product) continue;
        rounded.insert(statements[j].name);
        break;
      }
    }
    for (const Statement& s : statements) {
      values_[s.name] = value(s.value) * (rounded.contains(s.name) ? 1 - kLost : 1);
      pending_.erase(s.name);
    }
  }
  double symbol(const std::string& name) {
    if (pending_.contains(name)) throw std::out_of_range(name);
    // Free symbols: some number from 1/2 to 3/2 that depends on the name.
    const double spread = static_cast<double>(std::hash<std::string>{}(name) % 1000) / 1000;
    return values_.try_emplace(name, name == "h" ? 0.1 : 0.5 + spread).first->second;
  }
  double value(const Expression& e) {
    std::vector<double> x;
    for (const Expression& operand : e.operands()) x.push_back(value(operand));
    switch (e.kind()) {
      case Kind::number:
        return e.number().get_d();
      case Kind::symbol:
        return symbol(e.name());
      case Kind::sum:
        return std::accumulate(x.begin(), x.end(), 0.0);
      case Kind::product:
        return std::accumulate(x.begin(), x.end(), 1.0, std::multiplies<>());
      case Kind::power:
        return std::pow(x[0], x[1]);
      case Kind::function:
        if (e.name() == kProductError) return kLost * x[0] * x[1];
        return e.name() == "sin" ? std::sin(x[0]) : std::cos(x[0]);
    }
    return 0;
  }
  // Of a product that comes with its error, a part: the two of them are the product.
  static constexpr double kLost = 0.1;
  std::map<std::string, double> values_;
  std::set<std::string> pending_;
  std::vector<double> results_;
};

}  // namespace

bool computes_the_same(const Program& a, const Program& b) {
  const auto of_a = Interpreter()(a);
  const auto of_b = Interpreter()(b);
  if (!of_a || !of_b || of_a->size() != of_b->size()) return false;
  for (std::size_t i = 0; i < of_a->size(); ++i) {
    // Rounding errors stay below 1e-12; a mutation moves a value by at least 1e-3 of one of its
    // terms.
    if (!(std::abs((*of_a)[i] - (*of_b)[i]) <= 1e-12 * (1 + std::abs((*of_a)[i])))) return false;
  }
  return true;
}

std::vector<Mutant> mutants_of(const Program& original) {
  std::vector<Mutant> mutants;
  std::set<std::string> known;
  std::vector<Expression> all;
  Program copy = original;
  for_each_expression(copy, [&](Expression& e) {
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
        if (variants[v] == all[place]) continue;
        Program mutant = original;
        std::size_t now = 0;
        for_each_expression(mutant, [&](Expression& e) {
          if (now++ == place) e = variants[v];
        });
        mutants.push_back({mutation.name, to_text(all[place]) + " -> " + to_text(variants[v]),
                           std::move(mutant)});
      }
    }
  }
  return mutants;
}

std::vector<Mutant> mutants_of_sequence(const Program& original) {
  std::vector<Mutant> mutants;
  auto change = [&](const std::string& kind, auto alter) {
    Program mutant = original;
    alter(mutant.sequence);
    mutants.push_back({kind, "", std::move(mutant)});
  };
  const std::vector<Substep>& substeps = original.sequence.substeps;
  for (std::size_t i = 0; i < substeps.size(); ++i) {
    change("substep left out", [i](Sequence& s) {
      s.substeps.erase(s.substeps.begin() + static_cast<std::ptrdiff_t>(i));
    });
    change("substep repeated", [i](Sequence& s) {
      const Substep again = s.substeps[i];
      s.substeps.insert(s.substeps.begin() + static_cast<std::ptrdiff_t>(i), again);
    });
    change("substeps exchanged",
           [i](Sequence& s) { std::swap(s.substeps[i], s.substeps[(i + 1) % s.substeps.size()]); });
    change("kick for drift", [i](Sequence& s) {
      SubstepKind& kind = s.substeps[i].kind;
      kind = kind == SubstepKind::kick ? SubstepKind::drift : SubstepKind::kick;
    });
  }
  const std::size_t stages = original.sequence.stages.weight.size();
  for (std::size_t i = 0; i < stages; ++i) {
    change("stage left out", [i](Sequence& s) {
      s.stages.weight.erase(s.stages.weight.begin() + static_cast<std::ptrdiff_t>(i));
    });
    change("rows exchanged", [i, stages](Sequence& s) {
      std::swap(s.stages.coupling[i], s.stages.coupling[(i + 1) % stages]);
    });
    change("tableau transposed", [i, stages](Sequence& s) {
      std::swap(s.stages.coupling[i][(i + 1) % stages], s.stages.coupling[(i + 1) % stages][i]);
    });
  }
  return mutants;
}

}  // namespace hamgen::verify_test
