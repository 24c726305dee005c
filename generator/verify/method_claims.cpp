// Splittings, compositions and Runge-Kutta methods: a step calls the gradient, of which nothing is
// known here but that it is a function, at the points where the scheme wants it, and adds up what
// it returns with the scheme's coefficients.
#include <fmt/format.h>

#include <algorithm>

#include "generator/verify/claim_list.hpp"

namespace hamgen {

namespace {

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

// The state with these values in it.
Substitution at_state(const StepUnderProof& step, const std::vector<Expression>& values) {
  Substitution result;
  for (std::size_t i = 0; i < values.size(); ++i)
    result.emplace(step.mechanics.variable(static_cast<int>(i)).name(), values[i]);
  return result;
}

// Kicks p -= b h dV/dq and drifts q += a h dT/dp in their order.  `known`: the first gradient is
// remembered of the step before, and is that at z.  Where solve calls nothing for dT/dp, it has to
// have taken the function itself.  `zeros`: what vanishes is left out.
Identities splitting_identities(const StepUnderProof& step, const Derivatives& derivatives,
                                bool zeros, const std::vector<ExactSubstep>& substeps, bool known) {
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
  const bool local =
      !called_routines(step.code.routine("solve")->body).contains("kinetic_gradient");
  const auto is_called = [local](const ExactSubstep& each) { return each.kick || !local; };
  const auto calls = static_cast<std::size_t>(std::ranges::count_if(substeps, is_called));
  claims.add_count("the number of evaluations", machine.calls.size(), calls - (known ? 1 : 0));
  std::vector<Expression> velocity;
  std::size_t call = 0;
  const std::vector<Expression>* last = nullptr;
  for (std::size_t s = 0; s < substeps.size(); ++s) {
    const bool kick = substeps[s].kick;
    const int from = kick ? 0 : n;
    const int to = kick ? n : 0;
    if (known && s == 0) {
      last = &remembered;
    } else if (!is_called(substeps[s])) {
      velocity.clear();
      const Substitution point = at_state(step, at);
      for (int i = 0; i < n; ++i) {
        velocity.push_back(substitute(derivatives.first(n + i), point));
      }
      last = &velocity;
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
      if (zeros && derivatives.first(from + i).is_zero()) continue;
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
    if (zeros && derivatives.first(from + j).is_zero()) continue;
    claims.add("what is remembered for " + step.name(from + j), machine.value(of_start("value", j)),
               last->at(static_cast<std::size_t>(j)));
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
  const bool zeros = !step.mechanics.keeps_sums();
  if (const auto* splitting = std::get_if<Splitting>(&method)) {
    const std::vector<ExactSubstep> substeps = substeps_of(*splitting);
    std::vector<Identities> parts = {
        lengths_identities(step, substeps),
        splitting_identities(step, derivatives, zeros, substeps, false)};
    if (step.code.record("Start") != nullptr)
      parts.push_back(splitting_identities(step, derivatives, zeros, substeps, true));
    return parts;
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&method)) {
    return runge_kutta_identities(step, derivatives, *tableau);
  }
  if (const auto* composition = std::get_if<Composition>(&method)) {
    return {composition_identities(step, *composition)};
  }
  return {};
}

}  // namespace hamgen
