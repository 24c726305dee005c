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
    const long at = layout.lanes > 0 ? j * layout.room() + i : i * layout.stages + j;
    row.push_back(machine.value(of_k(table, at)));
  }
  return row;
}

// Where the iterations begin: at the polynomial that has the slopes of the step before, or at z.
Identities start_identities(const StepUnderProof& step, const RungeKutta& tableau, bool known) {
  Claims claims(step, {"vector_field", "vector_fields", "hessian"});
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
    claims.add_count("the number of unknowns", trace.starts.size(), nth(layout.count()));
    if (std::ssize(trace.starts) != layout.count()) return claims.take();
    for (long i = 0; i < layout.room(); ++i) {
      for (long j = 0; j < layout.dimension; ++j) {
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

// k.coupling is a_ij / b_j, k.scaled is h b_i.
Identities tableau_identities(const StepUnderProof& step, const RungeKutta& tableau) {
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
// converges, and not to what.
Identities implicit_identities(const StepUnderProof& step) {
  Claims claims(step, {"vector_field", "vector_fields", "hessian"});
  SymbolicMachine& machine = claims.machine();
  const StageLayout& layout = *step.code.stages;
  const StageLayout packed = layout.without_room();
  const long stages = layout.stages;
  std::vector<std::vector<Expression>> coupling;
  std::vector<Expression> scaled;
  for (long i = 0; i < stages; ++i) coupling.push_back(row_of(machine, layout, "coupling", i));
  for (long i = 0; i < stages; ++i) scaled.push_back(machine.value(of_k("scaled", i)));
  machine.run("solve");
  // h b_m f(Y_m) where an iteration evaluates.
  const auto slope = [&](const IterationTrace& trace, long m, long j) -> Expression {
    const std::vector<Expression>& all = trace.unknowns;
    for (const CallTrace& call : machine.calls) {
      if (call.routine == "vector_fields" && call.input == all)
        return scaled[nth(m)] * call.output[nth(layout.at(m, j))];
      const auto first = all.begin() + layout.at(m, 0);
      if (call.routine == "vector_field" &&
          std::ranges::equal(call.input, std::span(first, nth(layout.dimension))))
        return scaled[nth(m)] * call.output[nth(j)];
    }
    return Expression::symbol("nothing at stage " + std::to_string(m + 1));
  };
  claims.add_count("the number of iterations", machine.iterations.empty() ? 0 : 1, 1);
  if (machine.iterations.empty()) return claims.take();
  std::size_t system = 0;
  for (const IterationTrace& trace : machine.iterations) {
    claims.add_count("the number of stages", trace.unknowns.size(), nth(layout.count()));
    if (trace.unknowns.size() != nth(layout.count())) return claims.take();
    const bool newton = trace.rule != Rule::fixed_point;
    if (newton && system == machine.systems.size()) break;
    const EliminatedSystem* solved = newton ? &machine.systems[system++] : nullptr;
    for (long i = 0; i < stages; ++i) {
      for (long j = 0; j < layout.dimension; ++j) {
        const auto component = static_cast<int>(j);
        const std::size_t row = nth(layout.at(i, j));
        const std::size_t line = nth(packed.at(i, j));
        Expression lack =
            step.mechanics.variable(component) + step.carry(component) - trace.unknowns[row];
        for (long m = 0; m < stages; ++m) lack += coupling[nth(i)][nth(m)] * slope(trace, m, j);
        claims.add(fmt::format("what stage {} lacks of {}", i + 1, step.name(component)),
                   solved != nullptr ? solved->right_side.at(line) : trace.corrections[row], lack);
        if (solved == nullptr) continue;
        claims.add(fmt::format("the increment of stage {}, {}", i + 1, step.name(component)),
                   trace.corrections[row], solved->solution.at(line));
      }
    }
    if (solved == nullptr) continue;
    // 1 - coupling h b J H'' at the mean.
    const auto hessian = std::ranges::find(machine.calls, "hessian", &CallTrace::routine);
    claims.add_count("the number of Hessians", hessian == machine.calls.end() ? 0 : 1, 1);
    if (hessian == machine.calls.end()) break;
    for (long j = 0; j < layout.dimension; ++j) {
      Expression sum(0);
      for (long m = 0; m < stages; ++m) sum += trace.unknowns[nth(layout.at(m, j))];
      claims.add("the mean of the stages", hessian->input[nth(j)],
                 sum * Expression(Rational(1, stages)));
    }
    for (long i = 0; i < stages; ++i) {
      for (long m = 0; m < stages; ++m) {
        add_block(claims, step, *solved, {i, m}, coupling[nth(i)][nth(m)] * scaled[nth(m)],
                  hessian->output);
      }
    }
  }
  const IterationTrace& last = machine.iterations.back();
  claims.add_count("the number of components refined", last.changes.size(), nth(layout.count()));
  if (last.changes.size() != nth(layout.count())) return claims.take();
  for (long j = 0; j < layout.dimension; ++j) {
    const auto i = static_cast<int>(j);
    Expression sum = step.carry(i);
    for (long m = 0; m < stages; ++m) sum += slope(last, m, j) + last.changes[nth(layout.at(m, j))];
    claims.add("the increment of " + step.name(i), step.increment(machine, i), sum);
  }
  return claims.take();
}

}  // namespace

std::vector<Identities> runge_kutta_identities(const StepUnderProof& step,
                                               const RungeKutta& tableau) {
  if (tableau.is_explicit()) return {explicit_identities(step, tableau)};
  return {tableau_identities(step, tableau), start_identities(step, tableau, false),
          start_identities(step, tableau, true), implicit_identities(step)};
}

}  // namespace hamgen
