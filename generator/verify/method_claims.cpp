// Splittings, compositions and Runge-Kutta methods: a step calls the gradient, of which nothing is
// known here but that it is a function, at the points where the scheme wants it, and adds up what
// it returns with the scheme's coefficients.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

// Numbers of a method are roots or zeros of polynomials, given by 70 digits: 60 of them make a
// number the exact one.
Expression recognised(const Expression& emitted, const Expression& exact) {
  if (!emitted.is_number()) return emitted;
  Rational difference = emitted.number() - numeric_value(exact);
  if (difference < 0) difference = -difference;
  Integer digits;
  mpz_ui_pow_ui(digits.get_mpz_t(), 10, 60);
  return difference * Rational(digits) < 1 ? exact : emitted;
}

class Claims {
 public:
  explicit Claims(const StepUnderProof& step, std::set<std::string> opaque = {})
      : step_(step), machine_(step.machine(std::move(opaque))) {}

  void add(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }
  void add_number(std::string what, const Expression& emitted, const Expression& exact) {
    add(std::move(what), recognised(emitted, exact), exact);
  }
  void add_count(std::string what, std::size_t emitted, std::size_t expected) {
    add(std::move(what), Expression(static_cast<long>(emitted)),
        Expression(static_cast<long>(expected)));
  }
  [[nodiscard]] SymbolicMachine& machine() { return machine_; }
  Identities take() {
    identities_.emitted = machine_.definitions();
    return std::move(identities_);
  }

 private:
  const StepUnderProof& step_;
  SymbolicMachine machine_;
  Identities identities_;
};

// Definitions in terms of what is free.
Substitution meaning_of(const SymbolicMachine& machine) {
  Substitution meaning;
  for (const Statement& s : machine.definitions()) meaning[s.name] = substitute(s.value, meaning);
  return meaning;
}
Expression written_out(const SymbolicMachine& machine, const Expression& e) {
  return substitute(e, meaning_of(machine));
}

Place of_k(const std::string& field, long i) { return {"k", field, {{i, {}}}}; }
Place of_start(const std::string& field, long i) { return {"start", field, {{i, {}}}}; }

// --- splittings ----------------------------------------------------------------------------------

struct ExactSubstep {
  bool kick = true;
  long place = 0;  // in the list of its kind
  Expression length;
};

std::vector<ExactSubstep> substeps_of(const Splitting& splitting) {
  std::vector<ExactSubstep> result;
  std::size_t kick = 0;
  std::size_t drift = 0;
  for (bool kicks = splitting.kick_first;
       kick < splitting.kicks.size() || drift < splitting.drifts.size(); kicks = !kicks) {
    if (kicks && kick < splitting.kicks.size()) {
      result.push_back({true, static_cast<long>(kick), splitting.kicks[kick]});
      ++kick;
    } else if (!kicks && drift < splitting.drifts.size()) {
      result.push_back({false, static_cast<long>(drift), splitting.drifts[drift]});
      ++drift;
    }
  }
  return result;
}

// k.kick and k.drift are h times the numbers of the scheme.
Identities lengths_identities(const StepUnderProof& step,
                              const std::vector<ExactSubstep>& substeps) {
  Claims claims(step);
  claims.machine().run("prepare");
  const Expression one(1);
  for (const ExactSubstep& substep : substeps) {
    const char* field = substep.kick ? "kick" : "drift";
    const Expression emitted =
        written_out(claims.machine(), claims.machine().value(of_k(field, substep.place)));
    claims.add_number(fmt::format("the length of {} {}", field, substep.place + 1),
                      emitted / step_size(), substep.length);
  }
  return claims.take();
}

// Kicks p -= b h dV/dq and drifts q += a h dT/dp in their order.  `known`: the first gradient is
// remembered of the step before, and is that at z.
Identities splitting_identities(const StepUnderProof& step, const Derivatives* derivatives,
                                const std::vector<ExactSubstep>& substeps, bool known) {
  Claims claims(step, {"potential_gradient", "kinetic_gradient"});
  SymbolicMachine& machine = claims.machine();
  const int n = step.mechanics.degrees_of_freedom;
  const bool closed = step.code.record("Start") != nullptr;
  std::vector<Expression> remembered;
  if (known) machine.set_flag({"start", "known"}, true);
  for (int j = 0; closed && j < n; ++j) remembered.push_back(machine.value(of_start("value", j)));
  const auto length = [&](const ExactSubstep& substep) {
    return machine.value(of_k(substep.kick ? "kick" : "drift", substep.place));
  };
  std::vector<Expression> lengths;
  for (const ExactSubstep& substep : substeps) lengths.push_back(length(substep));
  machine.run("solve");
  std::vector<Expression> at;
  std::vector<Expression> sum;
  for (int i = 0; i < 2 * n; ++i) {
    at.push_back(step.mechanics.variable(i));
    sum.push_back(step.carry(i));
  }
  claims.add_count("the number of evaluations", machine.calls.size(),
                   substeps.size() - (known ? 1 : 0));
  std::size_t call = 0;
  const std::vector<Expression>* last = nullptr;
  for (std::size_t s = 0; s < substeps.size(); ++s) {
    const bool kick = substeps[s].kick;
    const int from = kick ? 0 : n;
    const int to = kick ? n : 0;
    if (known && s == 0) {
      last = &remembered;
    } else {
      if (call == machine.calls.size()) break;
      const CallTrace& trace = machine.calls[call++];
      claims.add_count(fmt::format("the gradient of substep {}", s + 1),
                       trace.routine == "potential_gradient" ? 1 : 0, kick ? 1 : 0);
      for (int i = 0; i < n; ++i) {
        claims.add(fmt::format("where substep {} evaluates, {}", s + 1, step.name(from + i)),
                   step.component(trace.input, from + i, from),
                   at[static_cast<std::size_t>(from + i)]);
      }
      last = &trace.output;
    }
    for (int i = 0; i < n; ++i) {
      if (derivatives != nullptr && derivatives->first(from + i).is_zero()) continue;
      const auto place = static_cast<std::size_t>(to + i);
      const Expression change = lengths[s] * last->at(static_cast<std::size_t>(i));
      sum[place] = sum[place] + (kick ? -change : change);
      at[place] = step.mechanics.variable(to + i) + sum[place];
    }
  }
  for (int i = 0; i < 2 * n; ++i) {
    claims.add("the increment of " + step.name(i), step.increment(machine, i),
               sum[static_cast<std::size_t>(i)]);
  }
  for (int j = 0; closed && last != nullptr && j < n; ++j) {
    const int from = substeps.front().kick ? 0 : n;
    if (derivatives != nullptr && derivatives->first(from + j).is_zero()) continue;
    claims.add("what is remembered for " + step.name(from + j), machine.value(of_start("value", j)),
               last->at(static_cast<std::size_t>(j)));
  }
  return claims.take();
}

// --- Runge-Kutta methods -------------------------------------------------------------------------

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
        return integer_power(numeric_value(e), exponent).value();
      };
      for (long j = 0; j < stages; ++j) {
        const auto place = static_cast<std::size_t>(j);
        const Expression entry = ahead(i, j);
        if (!entry.is_number()) return claims.add("a number of k.ahead", entry, Expression(0));
        sum += entry.number() * numeric_value(tableau.b[place]) * power(tableau.c[place], r);
      }
      const Expression end = Expression(1) + tableau.c[static_cast<std::size_t>(i)];
      const Rational exact = (power(end, r + 1) - 1) / Rational(r + 1);
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
  std::size_t system = 0;
  for (const IterationTrace& trace : machine.iterations) {
    claims.add_count("the number of stages", trace.unknowns.size(), at(stages * dimension));
    if (trace.unknowns.size() != at(stages * dimension)) return claims.take();
    const bool newton = trace.rule != Rule::fixed_point;
    if (newton && system == machine.systems.size()) break;
    const EliminatedSystem* solved = newton ? &machine.systems[system++] : nullptr;
    for (long i = 0; i < stages; ++i) {
      for (long j = 0; j < dimension; ++j) {
        const std::size_t row = at(i * dimension + j);
        Expression lack = step.mechanics.variable(static_cast<int>(j)) +
                          step.carry(static_cast<int>(j)) - trace.unknowns[row];
        for (long m = 0; m < stages; ++m) lack += coupling[at(i * stages + m)] * slope(trace, m, j);
        claims.add(fmt::format("what stage {} lacks of {}", i + 1, step.name(static_cast<int>(j))),
                   solved != nullptr ? solved->right_side.at(row) : trace.corrections[row], lack);
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

Identities composition_identities(const StepUnderProof& step, const Composition& composition) {
  Claims claims(step);
  claims.add_count("the number of substeps", step.code.substeps.size(),
                   composition.substeps.size());
  const std::size_t count = std::min(step.code.substeps.size(), composition.substeps.size());
  for (std::size_t i = 0; i < count; ++i) {
    claims.add_number(fmt::format("the length of substep {}", i + 1),
                      Expression(step.code.substeps[i]), composition.substeps[i]);
  }
  return claims.take();
}

}  // namespace

std::vector<Identities> method_identities(const StepUnderProof& step,
                                          const Derivatives& derivatives) {
  const Method& method = step.scheme.method;
  // Loops do not leave out what vanishes.
  const Derivatives* zeros = step.mechanics.keeps_sums() ? nullptr : &derivatives;
  if (const auto* splitting = std::get_if<Splitting>(&method)) {
    const std::vector<ExactSubstep> substeps = substeps_of(*splitting);
    std::vector<Identities> parts = {lengths_identities(step, substeps),
                                     splitting_identities(step, zeros, substeps, false)};
    if (step.code.record("Start") != nullptr)
      parts.push_back(splitting_identities(step, zeros, substeps, true));
    return parts;
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&method)) {
    if (tableau->is_explicit()) return {explicit_identities(step, *tableau)};
    return {tableau_identities(step, *tableau), start_identities(step, *tableau, false),
            start_identities(step, *tableau, true), implicit_identities(step, *tableau)};
  }
  if (const auto* composition = std::get_if<Composition>(&method)) {
    return {composition_identities(step, *composition)};
  }
  return {};
}

}  // namespace hamgen
