// Runge-Kutta methods: stages and sums, with the vector field as a function of which nothing is
// known.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

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

// Where the iterations begin: at the polynomial that has the slopes of the step before, or at z.
Identities start_identities(const StepUnderProof& step, const RungeKutta& tableau, bool known) {
  Claims claims(step, {"vector_field", "hessian"});
  SymbolicMachine& machine = claims.machine();
  machine.skip("differentiate");
  const auto stages = static_cast<long>(tableau.b.size());
  const long dimension = step.size();
  std::vector<Expression> slopes;
  std::vector<Expression> ahead;
  for (long i = 0; i < stages * dimension; ++i) {
    slopes.push_back(machine.value(of_start("slope", i)));
  }
  for (long i = 0; i < stages * stages; ++i) ahead.push_back(machine.value(of_k("ahead", i)));
  machine.set_flag({"start", "known"}, known);
  machine.run("solve");
  bool first = true;
  for (const IterationTrace& trace : machine.iterations) {
    for (long row = 0; row < std::ssize(trace.starts); ++row) {
      const long j = row % dimension;
      Expression expected = step.mechanics.variable(static_cast<int>(j));
      for (long m = 0; known && first && m < stages; ++m) {
        expected += ahead[static_cast<std::size_t>(row / dimension * stages + m)] *
                    slopes[static_cast<std::size_t>(m * dimension + j)];
      }
      claims.add(fmt::format("the start of stage {}, {}", row / dimension + 1,
                             step.name(static_cast<int>(j))),
                 trace.starts[static_cast<std::size_t>(row)], expected);
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
  const auto value = [&](const std::string& field, long i) {
    return written_out(machine, machine.value(of_k(field, i)));
  };
  const auto stages = static_cast<long>(tableau.b.size());
  for (long i = 0; i < stages; ++i) {
    const auto row = static_cast<std::size_t>(i);
    claims.add_number(fmt::format("the weight b_{}", i + 1),
                      substitute(value("scaled", i), {{"h", Expression(1)}}), tableau.b[row]);
    claims.add(fmt::format("h in the weight b_{}", i + 1), value("scaled", i),
               step_size() * substitute(value("scaled", i), {{"h", Expression(1)}}));
    for (long j = 0; j < stages; ++j) {
      const auto column = static_cast<std::size_t>(j);
      const Expression exact = tableau.a[row][column] / tableau.b[column];
      claims.add_number(fmt::format("the coefficient a_{},{}", i + 1, j + 1),
                        value("coupling", i * stages + j), exact);
    }
  }
  add_extrapolation(claims, tableau,
                    [&](long i, long j) { return value("ahead", i * stages + j); });
  return claims.take();
}

// Rows and columns of two stages in 1 - coupling h b J H''.  Of entries that are as they should be
// as they stand the first is claimed for all.
void add_block(Claims& claims, const StepUnderProof& step, const EliminatedSystem& system,
               std::pair<long, long> stages, const Expression& weight,
               const std::vector<Expression>& hessian) {
  const Substitution meaning = meaning_of(claims.machine());
  const long dimension = step.size();
  const long n = dimension / 2;
  for (long j = 0; j < dimension; ++j) {
    for (long c = 0; c < dimension; ++c) {
      const std::pair place(stages.first * dimension + j, stages.second * dimension + c);
      const auto entry = system.matrix.find(place);
      const Expression emitted =
          entry == system.matrix.end() ? Expression(0) : substitute(entry->second, meaning);
      const Expression& second =
          hessian[static_cast<std::size_t>((j < n ? j + n : j - n) * dimension + c)];
      const Expression unit(place.first == place.second ? 1 : 0);
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
Identities implicit_identities(const StepUnderProof& step, const RungeKutta& tableau) {
  Claims claims(step, {"vector_field", "hessian"});
  SymbolicMachine& machine = claims.machine();
  const auto stages = static_cast<long>(tableau.b.size());
  const long dimension = step.size();
  std::vector<Expression> coupling;
  std::vector<Expression> scaled;
  for (long i = 0; i < stages * stages; ++i) coupling.push_back(machine.value(of_k("coupling", i)));
  for (long i = 0; i < stages; ++i) scaled.push_back(machine.value(of_k("scaled", i)));
  machine.run("solve");
  const auto at = [](long i) { return static_cast<std::size_t>(i); };
  // h b_m f(Y_m) where an iteration evaluates.
  const auto slope = [&](const IterationTrace& trace, long m, long j) -> Expression {
    const auto first = trace.unknowns.begin() + m * dimension;
    const std::vector<Expression> point(first, first + dimension);
    for (const CallTrace& call : machine.calls) {
      if (call.routine == "vector_field" && call.input == point)
        return scaled[at(m)] * call.output[at(j)];
    }
    return Expression::symbol("nothing at stage " + std::to_string(m + 1));
  };
  claims.add_count("the number of iterations", machine.iterations.empty() ? 0 : 1, 1);
  if (machine.iterations.empty()) return claims.take();
  const bool follows = step.code.routine("follow") != nullptr;
  std::size_t system = 0;
  for (const IterationTrace& trace : machine.iterations) {
    claims.add_count("the number of stages", trace.unknowns.size(), at(stages * dimension));
    if (trace.unknowns.size() != at(stages * dimension)) return claims.take();
    const bool newton = trace.rule != Rule::fixed_point;
    if (newton && system == machine.systems.size()) break;
    const EliminatedSystem* solved = newton ? &machine.systems[system++] : nullptr;
    const auto lack_of = [&](long i, long j) {
      Expression lack = step.mechanics.variable(static_cast<int>(j)) +
                        step.carry(static_cast<int>(j)) - trace.unknowns[at(i * dimension + j)];
      for (long m = 0; m < stages; ++m) lack += coupling[at(i * stages + m)] * slope(trace, m, j);
      return lack;
    };
    // Of a fixed point: what the coordinates move by because the momenta do.  A triangular matrix
    // with the diagonal 1 takes one to the other, so that both vanish where the equations hold.
    const auto followed = [&](long i, long j) {
      Expression sum(0);
      const long n = dimension / 2;
      if (solved != nullptr || !follows || j >= n) return sum;
      for (long m = 0; m < stages; ++m) {
        Expression velocity(0);
        for (long c = n; c < dimension; ++c) {
          const Expression entry =
              step.mechanics.second_derivative(static_cast<int>(j + n), static_cast<int>(c));
          if (!entry.is_zero()) velocity += entry * lack_of(m, c);
        }
        sum += coupling[at(i * stages + m)] * scaled[at(m)] * velocity;
      }
      return sum;
    };
    for (long i = 0; i < stages; ++i) {
      for (long j = 0; j < dimension; ++j) {
        const std::size_t row = at(i * dimension + j);
        claims.add(fmt::format("what stage {} lacks of {}", i + 1, step.name(static_cast<int>(j))),
                   solved != nullptr ? solved->right_side.at(row) : trace.corrections[row],
                   lack_of(i, j) + followed(i, j));
        if (solved == nullptr) continue;
        claims.add(
            fmt::format("the increment of stage {}, {}", i + 1, step.name(static_cast<int>(j))),
            trace.corrections[row], solved->solution.at(row));
      }
    }
    if (solved == nullptr) continue;
    // 1 - coupling h b J H'' at the mean.
    const auto hessian = std::ranges::find(machine.calls, "hessian", &CallTrace::routine);
    claims.add_count("the number of Hessians", hessian == machine.calls.end() ? 0 : 1, 1);
    if (hessian == machine.calls.end()) break;
    for (long j = 0; j < dimension; ++j) {
      Expression sum(0);
      for (long m = 0; m < stages; ++m) sum += trace.unknowns[at(m * dimension + j)];
      claims.add("the mean of the stages", hessian->input[at(j)],
                 sum * Expression(Rational(1, stages)));
    }
    for (long i = 0; i < stages; ++i) {
      for (long m = 0; m < stages; ++m) {
        add_block(claims, step, *solved, {i, m}, coupling[at(i * stages + m)] * scaled[at(m)],
                  hessian->output);
      }
    }
  }
  const IterationTrace& last = machine.iterations.back();
  claims.add_count("the number of components refined", last.changes.size(), at(stages * dimension));
  if (last.changes.size() != at(stages * dimension)) return claims.take();
  for (long j = 0; j < dimension; ++j) {
    const auto i = static_cast<int>(j);
    Expression sum = step.carry(i);
    for (long m = 0; m < stages; ++m)
      sum += slope(last, m, j) + last.changes[at(m * dimension + j)];
    claims.add("the increment of " + step.name(i), step.increment(machine, i), sum);
  }
  return claims.take();
}

}  // namespace

std::vector<Identities> runge_kutta_identities(const StepUnderProof& step,
                                               const RungeKutta& tableau) {
  if (tableau.is_explicit()) return {explicit_identities(step, tableau)};
  return {tableau_identities(step, tableau), start_identities(step, tableau, false),
          start_identities(step, tableau, true), implicit_identities(step, tableau)};
}

}  // namespace hamgen
