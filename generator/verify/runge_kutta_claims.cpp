// Runge-Kutta methods: stages and sums, with the vector field as a function of which nothing is
// known.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>

#include "generator/algebra/exact.hpp"
#include "generator/verify/claim_list.hpp"

namespace hamgen {

namespace {

Expression rounded(const Expression& exact) { return Expression(numeric_value(exact)); }

Identities explicit_identities(const StepUnderProof& step, const RungeKutta& tableau) {
  Claims claims(step, {"vector_field"});
  SymbolicMachine& machine = claims.machine();
  machine.run("solve");
  const std::size_t stages = tableau.b.size();
  claims.add_count("the number of stages", machine.calls.size(), stages);
  if (machine.calls.size() != stages) return claims.take();
  const auto combination = [&](const std::vector<Expression>& row, std::size_t i) {
    Expression sum(0);
    for (std::size_t j = 0; j < stages; ++j) sum += rounded(row[j]) * machine.calls[j].output.at(i);
    return step_size() * sum;
  };
  for (int i = 0; i < step.size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    for (std::size_t s = 0; s < stages; ++s) {
      claims.add(fmt::format("stage {}, {}", s + 1, step.name(i)), machine.calls[s].input.at(place),
                 step.mechanics.variable(i) + combination(tableau.a[s], place));
    }
    claims.add("the increment of " + step.name(i), step.increment(machine, i),
               step.carry(i) + combination(tableau.b, place));
  }
  return claims.take();
}

std::size_t nth(long i) { return static_cast<std::size_t>(i); }

// Row i of a table of the method, of stage i.
std::vector<Expression> row_of(SymbolicMachine& machine, const StageLayout& layout,
                               const std::string& table, long i) {
  std::vector<Expression> row;
  for (long j = 0; j < layout.stages; ++j) {
    const long at = layout.by_component() ? j * layout.room() + i : i * layout.stages + j;
    row.push_back(machine.value(of_k(table, at)));
  }
  return row;
}

bool has_mobility(const StepUnderProof& step) {
  const std::vector<Field>& fields = step.code.record("Coefficients")->fields;
  return std::ranges::find(fields, "mobility", &Field::name) != fields.end();
}

// All that a stage has, or its coordinates where the momenta are eliminated.
long components_of(const IterationTrace& trace, const StageLayout& layout) {
  const bool half = 2 * std::ssize(trace.unknowns) == layout.count() && layout.by_component();
  return half ? layout.dimension / 2 : layout.dimension;
}

// Where the iterations begin: at the polynomial that has the slopes of the step before, or at z.
Identities start_identities(const StepUnderProof& step, const RungeKutta& tableau, bool known) {
  Claims claims(step, {"vector_field", "vector_fields", "forces", "hessian"});
  SymbolicMachine& machine = claims.machine();
  machine.skip("differentiate");
  const StageLayout& layout = *step.code.stages;
  claims.add_count("the number of stages", static_cast<std::size_t>(layout.stages),
                   tableau.b.size());
  std::vector<Expression> slopes;
  std::vector<std::vector<Expression>> ahead;
  for (long i = 0; i < layout.count(); ++i) slopes.push_back(machine.value(of_start("slope", i)));
  for (long i = 0; i < layout.room(); ++i) ahead.push_back(row_of(machine, layout, "ahead", i));
  machine.set_flag({"start", "known"}, known);
  machine.run("solve");
  bool first = true;
  for (const IterationTrace& trace : machine.iterations) {
    const long components = components_of(trace, layout);
    claims.add_count("the number of unknowns", trace.starts.size(),
                     nth(components * layout.room()));
    if (std::ssize(trace.starts) != components * layout.room()) return claims.take();
    for (long i = 0; i < layout.room(); ++i) {
      for (long j = 0; j < components; ++j) {
        Expression expected = step.mechanics.variable(static_cast<int>(j));
        for (long m = 0; known && first && m < layout.stages; ++m)
          expected += ahead[nth(i)][nth(m)] * slopes[nth(layout.at(m, j))];
        claims.add(fmt::format("the start of stage {}, {}", i + 1, step.name(static_cast<int>(j))),
                   trace.starts[nth(layout.at(i, j))], expected);
      }
    }
    first = false;
  }
  return claims.take();
}

// k.ahead takes slopes c^r to the integral of x^r from 1 to 1 + c_i, which determines it.
void add_extrapolation(Claims& claims, const RungeKutta& tableau,
                       const std::function<Expression(long, long)>& ahead) {
  const auto stages = static_cast<long>(tableau.b.size());
  for (long i = 0; i < stages; ++i) {
    for (long r = 0; r < stages; ++r) {
      Rational sum(0);
      const auto power = [](const Expression& e, long exponent) {
        return hamgen::integer_power(numeric_value(e), exponent).value();
      };
      for (long j = 0; j < stages; ++j) {
        const auto place = static_cast<std::size_t>(j);
        const Expression entry = ahead(i, j);
        if (!entry.is_number()) return claims.add("a number of k.ahead", entry, Expression(0));
        Rational term = entry.number();
        term *= numeric_value(tableau.b[place]);
        term *= power(tableau.c[place], r);
        sum += term;
      }
      const Expression end = Expression(1) + tableau.c[static_cast<std::size_t>(i)];
      Rational exact = power(end, r + 1);
      exact -= 1;
      exact /= Rational(r + 1);
      claims.add_number(fmt::format("the extrapolation of degree {} to stage {}", r, i + 1),
                        Expression(sum), Expression(exact));
    }
  }
}

// What the momenta are eliminated with: k.twice is h (A A)_ij / b_j, k.node h c_i.
void add_second_order(Claims& claims, const StepUnderProof& step, const Derivatives& derivatives,
                      const RungeKutta& tableau,
                      const std::vector<std::vector<Expression>>& twice) {
  SymbolicMachine& machine = claims.machine();
  const StageLayout& layout = *step.code.stages;
  const auto per_step = [&](const std::string& what, const Expression& emitted,
                            const Expression& exact) {
    const Expression plain = substitute(emitted, {{"h", Expression(1)}});
    claims.add_number(what, plain, exact);
    claims.add("h in " + what, emitted, step_size() * plain);
  };
  for (long i = 0; i < layout.room(); ++i) {
    const Expression node = written_out(machine, machine.value(of_k("node", i)));
    const bool is_stage = i < layout.stages;
    per_step(fmt::format("the node c_{}", i + 1), node,
             is_stage ? tableau.c[nth(i)] : Expression(0));
    for (long j = 0; j < layout.stages; ++j) {
      Rational sum(0);
      for (long m = 0; is_stage && m < layout.stages; ++m)
        sum += numeric_value(tableau.a[nth(i)][nth(m)]) * numeric_value(tableau.a[nth(m)][nth(j)]);
      per_step(fmt::format("the square of the coefficients {}, {}", i + 1, j + 1),
               twice[nth(i)][nth(j)], Expression(Rational(sum / numeric_value(tableau.b[nth(j)]))));
    }
  }
  const int n = layout.dimension / 2;
  for (int j = 0; j < n && has_mobility(step); ++j) {
    claims.add("the mobility of " + step.name(j),
               written_out(machine, machine.value(of_k("mobility", j))),
               derivatives.second(n + j, n + j));
  }
}

// k.coupling is a_ij / b_j, k.scaled is h b_i.
Identities tableau_identities(const StepUnderProof& step, const Derivatives& derivatives,
                              const RungeKutta& tableau) {
  Claims claims(step);
  SymbolicMachine& machine = claims.machine();
  machine.run("prepare");
  const StageLayout& layout = *step.code.stages;
  const auto rows = [&](const std::string& table) {
    std::vector<std::vector<Expression>> result;
    for (long i = 0; i < layout.room(); ++i) {
      result.push_back(row_of(machine, layout, table, i));
      for (Expression& entry : result.back()) entry = written_out(machine, entry);
    }
    return result;
  };
  const std::vector<std::vector<Expression>> coupling = rows("coupling");
  const std::vector<std::vector<Expression>> ahead = rows("ahead");
  for (long i = 0; i < layout.room(); ++i) {
    const auto row = nth(i);
    const Expression weight = written_out(machine, machine.value(of_k("scaled", i)));
    if (i >= layout.stages) {
      // Of no stage: nothing is taken of it, and it takes nothing.
      claims.add("the weight of what is no stage", weight, Expression(0));
      for (const auto* table : {&coupling, &ahead}) {
        for (const Expression& entry : (*table)[row])
          claims.add("a coefficient of what is no stage", entry, Expression(0));
      }
      continue;
    }
    const Expression plain = substitute(weight, {{"h", Expression(1)}});
    claims.add_number(fmt::format("the weight b_{}", i + 1), plain, tableau.b[row]);
    claims.add(fmt::format("h in the weight b_{}", i + 1), weight, step_size() * plain);
    for (long j = 0; j < layout.stages; ++j) {
      const auto column = nth(j);
      const Expression exact = tableau.a[row][column] / tableau.b[column];
      claims.add_number(fmt::format("the coefficient a_{},{}", i + 1, j + 1), coupling[row][column],
                        exact);
    }
  }
  add_extrapolation(claims, tableau, [&](long i, long j) { return ahead[nth(i)][nth(j)]; });
  if (step.code.routine("forces") != nullptr)
    add_second_order(claims, step, derivatives, tableau, rows("twice"));
  return claims.take();
}

// Rows and columns of two stages in 1 - coupling h b J H''.  Of entries that are as they should be
// as they stand the first is claimed for all.
void add_block(Claims& claims, const StepUnderProof& step, const EliminatedSystem& system,
               std::pair<long, long> stages, const Expression& weight,
               const std::vector<Expression>& hessian) {
  const Substitution meaning = meaning_of(claims.machine());
  const StageLayout layout = step.code.stages->without_room();
  const long dimension = step.size();
  const long n = dimension / 2;
  for (long j = 0; j < dimension; ++j) {
    for (long c = 0; c < dimension; ++c) {
      const std::pair at(layout.at(stages.first, j), layout.at(stages.second, c));
      const auto entry = system.matrix.find(at);
      const Expression emitted =
          entry == system.matrix.end() ? Expression(0) : substitute(entry->second, meaning);
      const Expression& second =
          hessian[static_cast<std::size_t>((j < n ? j + n : j - n) * dimension + c)];
      const Expression unit(at.first == at.second ? 1 : 0);
      const Expression expected = j < n ? unit - weight * second : unit + weight * second;
      if (emitted != expected || j + c == 0)
        claims.add("an entry of Newton's matrix", emitted, expected);
    }
  }
}

// The stages Y_i are free.  What they lack is z + carry + sum_j coupling_ij L_j - Y_i with
// L_j = h b_j f(Y_j), and the step adds up the L_j, with what the rounded stages lack of the exact
// ones.  Newton's matrix is that of one Hessian for all stages, which decides how fast it
// converges, and not to what; and so do the momenta that are eliminated.
class ImplicitStages {
 public:
  ImplicitStages(const StepUnderProof& step, const Derivatives& derivatives)
      : step_(step),
        derivatives_(derivatives),
        layout_(*step.code.stages),
        packed_(layout_.without_room()),
        n_(layout_.dimension / 2),
        claims_(step, {"vector_field", "vector_fields", "forces", "hessian"}),
        machine_(claims_.machine()) {
    for (long i = 0; i < layout_.stages; ++i) {
      coupling_.push_back(row_of(machine_, layout_, "coupling", i));
      scaled_.push_back(machine_.value(of_k("scaled", i)));
    }
    machine_.skip("eliminate_momenta");  // which has claims of its own
    machine_.run("solve");
  }

  Identities run() {
    claims_.add_count("the number of iterations", machine_.iterations.empty() ? 0 : 1, 1);
    if (machine_.iterations.empty()) return claims_.take();
    std::size_t system = 0;
    for (const IterationTrace& trace : machine_.iterations) {
      const long components = components_of(trace, layout_);
      claims_.add_count("the number of stages", trace.unknowns.size(),
                        nth(layout_.room() * components));
      if (std::ssize(trace.unknowns) != layout_.room() * components) return claims_.take();
      if (components == n_) {
        add_coordinates(trace);
        continue;
      }
      const bool newton = trace.rule != Rule::fixed_point;
      if (newton && system == machine_.systems.size()) break;
      const EliminatedSystem* solved = newton ? &machine_.systems[system++] : nullptr;
      add_lack(trace.unknowns, trace.corrections, solved);
      if (solved == nullptr) continue;
      for (long i = 0; i < layout_.stages; ++i) {
        for (long j = 0; j < layout_.dimension; ++j)
          claims_.add(fmt::format("the increment of stage {}, {}", i + 1, name(j)),
                      trace.corrections[nth(layout_.at(i, j))],
                      solved->solution.at(nth(packed_.at(i, j))));
      }
      if (!add_matrix(trace, *solved)) break;
    }
    const bool eliminates = system < machine_.systems.size();
    add_end(eliminates ? &machine_.systems.back() : nullptr);
    return claims_.take();
  }

 private:
  [[nodiscard]] const std::string& name(long j) const { return step_.name(static_cast<int>(j)); }
  [[nodiscard]] Expression variable(long j) const {
    return step_.mechanics.variable(static_cast<int>(j));
  }

  // h b_m f(Y_m) where the stages are these.
  Expression slope(const std::vector<Expression>& all, long m, long j) const {
    for (const CallTrace& call : machine_.calls) {
      if (call.routine == "vector_fields" && call.input == all)
        return scaled_[nth(m)] * call.output[nth(layout_.at(m, j))];
      if (call.routine != "vector_field") continue;
      const auto first = all.begin() + layout_.at(m, 0);
      if (std::ranges::equal(call.input, std::span(first, nth(layout_.dimension))))
        return scaled_[nth(m)] * call.output[nth(j)];
    }
    return Expression::symbol("nothing at stage " + std::to_string(m + 1));
  }
  // h b_m times the force on coordinate j at stage m, where the coordinates are these.
  Expression force(const std::vector<Expression>& coordinates, long m, long j) const {
    for (const CallTrace& call : machine_.calls) {
      if (call.routine != "forces") continue;
      if (std::ranges::equal(std::span(call.input.begin(), coordinates.size()), coordinates))
        return scaled_[nth(m)] * call.output[nth(layout_.at(m, n_ + j))];
    }
    return Expression::symbol("no force at stage " + std::to_string(m + 1));
  }

  // What the stages lack, or what a matrix is multiplied with that contracts better.
  void add_lack(const std::vector<Expression>& stages, const std::vector<Expression>& lacks,
                const EliminatedSystem* solved) {
    for (long i = 0; i < layout_.stages; ++i) {
      for (long j = 0; j < layout_.dimension; ++j) {
        const std::size_t row = nth(layout_.at(i, j));
        Expression lack = variable(j) + step_.carry(static_cast<int>(j)) - stages[row];
        for (long m = 0; m < layout_.stages; ++m)
          lack += coupling_[nth(i)][nth(m)] * slope(stages, m, j);
        claims_.add(fmt::format("what stage {} lacks of {}", i + 1, name(j)),
                    solved != nullptr ? solved->right_side.at(nth(packed_.at(i, j))) : lacks[row],
                    lack);
      }
    }
  }

  // Of q + h c dH/dp(p) + (h A)^2 times the accelerations, which the exact coordinates are but for
  // the carry.
  void add_coordinates(const IterationTrace& trace) {
    for (long i = 0; i < layout_.stages; ++i) {
      const Expression node = machine_.value(of_k("node", i));
      const std::vector<Expression> twice = row_of(machine_, layout_, "twice", i);
      for (long j = 0; j < n_; ++j) {
        const std::size_t row = nth(layout_.at(i, j));
        Expression pushed(0);
        for (long m = 0; m < layout_.stages; ++m)
          pushed += twice[nth(m)] * force(trace.unknowns, m, j);
        claims_.add(fmt::format("what coordinate {} of stage {} lacks", name(j), i + 1),
                    trace.corrections[row],
                    variable(j) + node * derivatives_.first(static_cast<int>(n_ + j)) +
                        mobility(machine_, j) * pushed - trace.unknowns[row]);
      }
    }
    if (trace.refined_at.empty()) return;
    for (long i = 0; i < layout_.stages; ++i) {
      for (long j = 0; j < n_; ++j) {
        Expression momentum = variable(n_ + j) + step_.carry(static_cast<int>(n_ + j));
        for (long m = 0; m < layout_.stages; ++m)
          momentum += coupling_[nth(i)][nth(m)] * force(trace.unknowns, m, j);
        claims_.add(fmt::format("the momentum of stage {}, {}", i + 1, name(n_ + j)),
                    trace.refined_at[nth(layout_.at(i, n_ + j))], momentum);
      }
    }
  }
  Expression mobility(SymbolicMachine& machine, long j) const {
    return has_mobility(step_) ? machine.value(of_k("mobility", j)) : Expression(1);
  }

  // 1 - coupling h b J H'' at the mean.
  bool add_matrix(const IterationTrace& trace, const EliminatedSystem& solved) {
    const auto hessian = std::ranges::find(machine_.calls, "hessian", &CallTrace::routine);
    claims_.add_count("the number of Hessians", hessian == machine_.calls.end() ? 0 : 1, 1);
    if (hessian == machine_.calls.end()) return false;
    for (long j = 0; j < layout_.dimension; ++j) {
      Expression sum(0);
      for (long m = 0; m < layout_.stages; ++m) sum += trace.unknowns[nth(layout_.at(m, j))];
      claims_.add("the mean of the stages", hessian->input[nth(j)],
                  sum * Expression(Rational(1, layout_.stages)));
    }
    for (long i = 0; i < layout_.stages; ++i) {
      for (long m = 0; m < layout_.stages; ++m) {
        add_block(claims_, step_, solved, {i, m}, coupling_[nth(i)][nth(m)] * scaled_[nth(m)],
                  hessian->output);
      }
    }
    return true;
  }

  // What is refined, and the sum.
  void add_end(const EliminatedSystem* solved) {
    const IterationTrace& last = machine_.iterations.back();
    claims_.add_count("the number of components refined", last.changes.size(),
                      nth(layout_.count()));
    claims_.add_count("the number of unknowns refined", last.refined_at.size(),
                      nth(layout_.count()));
    if (std::ssize(last.changes) != layout_.count() ||
        std::ssize(last.refined_at) != layout_.count())
      return;
    add_lack(last.refined_at, last.refined_lack, solved);
    for (long j = 0; j < layout_.dimension; ++j) {
      const auto i = static_cast<int>(j);
      Expression sum = step_.carry(i);
      for (long m = 0; m < layout_.stages; ++m)
        sum += slope(last.refined_at, m, j) + last.changes[nth(layout_.at(m, j))];
      claims_.add("the increment of " + step_.name(i), step_.increment(machine_, i), sum);
    }
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const StageLayout& layout_;
  StageLayout packed_;
  long n_;
  Claims claims_;
  SymbolicMachine& machine_;
  std::vector<std::vector<Expression>> coupling_;
  std::vector<Expression> scaled_;
};

// What the coordinates lack and what they get with what the momenta lack.
Identities elimination_identities(const StepUnderProof& step) {
  Claims claims(step);
  SymbolicMachine& machine = claims.machine();
  const StageLayout& layout = *step.code.stages;
  const long n = layout.dimension / 2;
  std::vector<Expression> lack;
  for (long i = 0; i < layout.count(); ++i) lack.push_back(machine.value(of_start("lack", i)));
  machine.run("eliminate_momenta");
  for (long i = 0; i < layout.stages; ++i) {
    const std::vector<Expression> coupling = row_of(machine, layout, "coupling", i);
    for (long j = 0; j < layout.dimension; ++j) {
      const Expression emitted = machine.value(of_start("lack", layout.at(i, j)));
      Expression expected = lack[nth(layout.at(i, j))];
      for (long m = 0; j < n && m < layout.stages; ++m) {
        const Expression mobility =
            has_mobility(step) ? machine.value(of_k("mobility", j)) : Expression(1);
        expected += mobility * coupling[nth(m)] * machine.value(of_k("scaled", m)) *
                    lack[nth(layout.at(m, n + j))];
      }
      claims.add(
          fmt::format("the elimination at stage {}, {}", i + 1, step.name(static_cast<int>(j))),
          emitted, expected);
    }
  }
  return claims.take();
}

}  // namespace

std::vector<Identities> runge_kutta_identities(const StepUnderProof& step,
                                               const Derivatives& derivatives,
                                               const RungeKutta& tableau) {
  if (tableau.is_explicit()) return {explicit_identities(step, tableau)};
  std::vector<Identities> parts = {
      tableau_identities(step, derivatives, tableau), start_identities(step, tableau, false),
      start_identities(step, tableau, true), ImplicitStages(step, derivatives).run()};
  if (step.code.routine("eliminate_momenta") != nullptr)
    parts.push_back(elimination_identities(step));
  return parts;
}

}  // namespace hamgen
