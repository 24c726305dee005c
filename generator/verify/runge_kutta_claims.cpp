// Runge-Kutta methods: stages and sums, with the vector field as a function of which nothing is
// known.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/algebra/exact.hpp"
#include "generator/verify/stage_claims.hpp"

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

}  // namespace

std::vector<Identities> runge_kutta_identities(const StepUnderProof& step,
                                               const Derivatives& derivatives,
                                               const RungeKutta& tableau) {
  if (tableau.is_explicit()) return {explicit_identities(step, tableau)};
  std::vector<Identities> parts = {
      tableau_identities(step, derivatives, tableau), start_identities(step, tableau, false),
      start_identities(step, tableau, true), implicit_stages_identities(step, derivatives)};
  if (step.code.routine("eliminate_momenta") != nullptr)
    parts.push_back(elimination_identities(step));
  return parts;
}

}  // namespace hamgen
