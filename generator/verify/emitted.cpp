#include "generator/verify/emitted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include "generator/mechanics/modified_hamiltonian.hpp"
#include "generator/verify/growth.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

bool is_raised(const Scheme& scheme) {
  return scheme.is_member() && scheme.member().generating_order > 0;
}

// Ht, cut off after each of its powers of h.
std::vector<Expression> modified_energies(const Mechanics& mechanics, const Member& member,
                                          const std::vector<int>& powers) {
  const std::vector<Expression> terms =
      modified_hamiltonian(mechanics, member.c, member.generating_order, powers.back() + 1);
  std::vector<Expression> sums;
  for (const int last : powers) {
    std::vector<Expression> sum;
    for (int j = 0; j <= last; ++j) {
      const auto place = static_cast<std::size_t>(j);
      sum.push_back(Expression::power(step_size(), Expression(j)) * terms[place]);
    }
    sums.push_back(Expression::sum(std::move(sum)));
  }
  return sums;
}

// Those that depend on q come first.
std::vector<Expression> turned(const std::vector<Expression>& gradient) {
  const auto middle = gradient.begin() + std::ssize(gradient) / 2;
  std::vector<Expression> field(middle, gradient.end());
  for (auto it = gradient.begin(); it != middle; ++it) field.push_back(-*it);
  return field;
}

std::vector<Expression> dense(const Derivatives& derivatives, int size) {
  std::vector<Expression> entries;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) entries.push_back(derivatives.second(i, j));
  }
  return entries;
}

// What the routines return that are functions of the state.
class Functions {
 public:
  Functions(const StepUnderProof& step, const Derivatives& derivatives)
      : step_(step), derivatives_(derivatives), n_(step.mechanics.degrees_of_freedom) {}

  std::vector<Identities> run(const Expression& hamiltonian) {
    add("energy", "", "the energy", {hamiltonian});
    const std::vector<Expression>& gradient = derivatives_.gradient();
    const auto middle = gradient.begin() + n_;
    const std::vector<Expression> by_q(gradient.begin(), middle);
    const std::vector<Expression> by_p(middle, gradient.end());
    const bool loops = step_.mechanics.keeps_sums();
    if (!loops) add("gradient", "values", "component of the gradient", gradient);
    if (loops) add_whole_gradient(by_q, by_p);
    if (has("potential_gradient")) {
      add("potential_gradient", loops ? "dq" : "values", "component of dV/dq", by_q);
      add("kinetic_gradient", loops ? "dp" : "values", "component of dT/dp", by_p);
    }
    if (has("masses")) {
      std::vector<Expression> masses;
      for (int i = n_; i < 2 * n_; ++i) masses.push_back(derivatives_.second(i, i));
      add("masses", "dp", "second derivative of T", masses);
    }
    if (has("vector_field")) {
      add("vector_field", loops ? "f" : "values", "component of J grad H", turned(gradient));
    }
    if (has("vector_fields"))
      add_stages("vector_fields", "component at all stages of J grad H", turned(gradient));
    if (has("forces")) {
      std::vector<Expression> forces(static_cast<std::size_t>(n_));
      for (const Expression& each : by_q) forces.push_back(-each);
      add_stages("forces", "component at all stages of -dH/dq", forces);
    }
    if (is_called("hessian"))
      add("hessian", "values", "second derivative", dense(derivatives_, 2 * n_));
    return std::move(parts_);
  }

 private:
  [[nodiscard]] bool has(const char* routine) const {
    return step_.code.routine(routine) != nullptr;
  }
  [[nodiscard]] bool is_called(const char* routine) const {
    return std::ranges::any_of(step_.code.routines, [&](const Routine& other) {
      return called_routines(other.body).contains(routine);
    });
  }
  void add(const char* routine, const char* array, const char* what,
           const std::vector<Expression>& expected) {
    parts_.push_back(values_identities(step_, routine, array, what, expected));
  }
  // Given the same state at all stages, the routine has the same values at them; and as each number
  // is computed from those of its own stage alone, it is this function at every stage.
  void add_stages(const char* routine, const char* what, const std::vector<Expression>& field) {
    const StageLayout& layout = *step_.code.stages;
    std::vector<Expression> expected(static_cast<std::size_t>(layout.count()));
    for (long i = 0; i < layout.room(); ++i) {
      for (long j = 0; j < layout.dimension; ++j)
        expected[static_cast<std::size_t>(layout.at(i, j))] = field[static_cast<std::size_t>(j)];
    }
    add(routine, "values", what, expected);
    long mixed = 0;
    for (const std::string& name : callees(step_.code, routine))
      mixed += mixed_stages(*step_.code.routine(name), layout);
    parts_.back().claims.push_back(
        {"numbers that are of two stages", Expression(mixed), Expression(0)});
  }
  // Loops that are not over all stages, and elements of arrays in them that are not those of the
  // stage that the loop is at.
  static long mixed_stages(const Routine& routine, const StageLayout& layout) {
    long mixed = 0;
    std::string stage;
    for (const Instruction& instruction : routine.body) {
      const auto* loop = std::get_if<For>(&instruction.value);
      if (loop == nullptr) continue;
      const AffineIndex last{layout.room() - 1, {}};
      const bool all = loop->range.lower == AffineIndex{} && loop->range.upper == last;
      if (!all || (!stage.empty() && stage != loop->range.index)) ++mixed;
      stage = loop->range.index;
    }
    return mixed + std::ranges::count_if(routine.places, [&](const auto& bound) {
             const Place& place = bound.second;
             if (place.indices.empty() || place.object.empty() || place.object == "par")
               return false;
             AffineIndex index = place.indices.back();
             const bool of_stage = place.indices.size() == 1 && index.factors.contains(stage) &&
                                   index.factors.at(stage) == 1 &&
                                   index.constant % layout.room() == 0;
             index.factors.erase(stage);
             return !of_stage || std::ranges::any_of(index.factors, [&](const auto& factor) {
               return factor.second % layout.room() != 0;
             });
           });
  }
  void add_whole_gradient(const std::vector<Expression>& by_q,
                          const std::vector<Expression>& by_p) {
    add("gradient", "dq", "component of dH/dq", by_q);
    add("gradient", "dp", "component of dH/dp", by_p);
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  int n_;
  std::vector<Identities> parts_;
};

// What was read.
std::string scope(const Scheme& scheme, const Program& code, bool loops) {
  std::string text;
  if (std::holds_alternative<Composition>(scheme.method)) {
    text = fmt::format("the step that is composed and its {} substeps", code.substeps.size());
  } else if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    text = fmt::format("the kicks, the drifts and their {} substeps",
                       splitting->kicks.size() + splitting->drifts.size());
  } else if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    text = fmt::format("`J grad H` and the tableau of {} stages", tableau->b.size());
  }
  if (loops) return ": every element of all loops" + (text.empty() ? "" : ", " + text);
  return text.empty() ? "" : ": H, " + text;
}

// Of the model's own names: "bar(q)" and the like have their corners from these.
bool is_of_model(const Corner& corner) {
  return std::ranges::all_of(symbols(corner.function), [](const std::string& name) {
    return name.find_first_of("(#=") == std::string::npos;
  });
}

void add_corners(const std::vector<Corner>& more, std::vector<Corner>& all) {
  for (const Corner& corner : more) {
    if (!is_of_model(corner)) continue;
    const auto same = [&](const Corner& known) { return known.function == corner.function; };
    if (std::ranges::none_of(all, same)) all.push_back(corner);
  }
}

// And of the events.
std::vector<Identities> invariant_identities(const StepUnderProof& step) {
  std::vector<Expression> invariants;
  std::vector<Expression> events;
  for (const NamedExpression& each : step.mechanics.invariants)
    (each.is_event() ? events : invariants).push_back(each.value);
  std::vector<Identities> parts;
  if (!invariants.empty())
    parts.push_back(values_identities(step, "invariants", "values", "invariant", invariants));
  if (!events.empty())
    parts.push_back(values_identities(step, "events", "values", "event", events));
  return parts;
}

std::vector<Identities> all_identities(const StepUnderProof& step, const SolvePlan& plan,
                                       const Derivatives& derivatives,
                                       const Expression& hamiltonian) {
  const Scheme& scheme = step.scheme;
  const bool loops = step.mechanics.keeps_sums();
  std::vector<Identities> parts = Functions(step, derivatives).run(hamiltonian);
  const auto add = [&](std::vector<Identities> more) {
    std::ranges::move(more, std::back_inserter(parts));
  };
  const Derivatives of_step =
      is_raised(scheme) ? Derivatives(written_out_function(plan.equations)) : derivatives;
  if (loops && is_raised(scheme)) {
    const auto middle = of_step.gradient().begin() + step.mechanics.degrees_of_freedom;
    const char* routine = "generating_gradient";
    parts.push_back(values_identities(step, routine, "dq", "component of dK/dq",
                                      {of_step.gradient().begin(), middle}));
    parts.push_back(values_identities(step, routine, "dp", "component of dK/dp",
                                      {middle, of_step.gradient().end()}));
  }
  if (scheme.has_member() && loops) {
    add(loop_hessian_identities(step, of_step, scheme.member()));
    add(loop_member_identities(step, of_step, scheme.member(), plan.sweeps));
  } else if (scheme.has_member()) {
    parts.push_back(member_identities(step, of_step, scheme.member(), plan.sweeps));
    if (step.code.routine("derivatives") != nullptr) parts.push_back(ready_identities(step));
    if (!plan.sweeps && step.code.routine("tangent") != nullptr) {
      parts.push_back(tangent_identities(step, of_step, scheme.member()));
    }
  }
  add(method_identities(step, derivatives));
  if (!step.code.facts.modified_powers.empty()) {
    parts.push_back(values_identities(
        step, "modified_energies", "values", "modified energy",
        modified_energies(step.mechanics, scheme.member(), step.code.facts.modified_powers)));
  }
  add(invariant_identities(step));
  return parts;
}

void add(const Decision& more, Decision& total) {
  total.claims += more.claims;
  total.by_algebra += more.by_algebra;
  total.points = std::max(total.points, more.points);
  add_corners(more.corners, total.corners);
  total.verdict = both(total.verdict, more.verdict);
}

// All of these, or the first that fails.
Decision decide_all(const std::vector<Identities>& parts, const Surroundings& around) {
  Decision total{.verdict = Verdict::proved, .witness = {}, .corners = {}};
  for (const Identities& part : parts) {
    const Decision decision = decide(part, around);
    add(decision, total);
    if (holds(decision.verdict)) continue;
    total.verdict = decision.verdict;
    total.witness = decision.witness;
    break;
  }
  return total;
}

// Of a system in loops that is too large to look at every element.
Finding prove_longer(const StepUnderProof& step, const SolvePlan& plan,
                     const std::optional<Expression>& hamiltonian, const Surroundings& around,
                     const std::optional<SmallerSystems>& smaller) {
  const std::string property = kProgram;
  std::vector<Identities> parts = kernel_identities(step.mechanics, hamiltonian);
  if (plan.equations.function)
    std::ranges::move(kernel_identities(plan.equations.mechanics, {}), std::back_inserter(parts));
  std::ranges::move(invariant_identities(step), std::back_inserter(parts));
  Decision total = decide_all(parts, around);
  if (!holds(total.verdict)) return {property, total.verdict, total.witness};
  if (!smaller) {
    return {property, Verdict::tested,
            to_text(total) +
                ": the summands of all loops and their derivatives, that they sum up to H; the "
                "routines are not looked at, with so many elements and no size to make smaller"};
  }
  std::vector<const SizedSystem*> systems = {&smaller->first, &smaller->second};
  if (smaller->third) systems.push_back(&*smaller->third);
  for (const SizedSystem* system : systems) {
    const StepUnderProof small(system->mechanics, system->scheme, system->program);
    const Derivatives derivatives(system->mechanics, system->hamiltonian);
    const Decision decision =
        decide_all(all_identities(small, system->plan, derivatives, system->hamiltonian),
                   system->around.centres.empty() ? around : system->around);
    if (!holds(decision.verdict)) {
      return {property, decision.verdict,
              fmt::format("at {} = {}: {}", smaller->constant, system->size, decision.witness)};
    }
    add(decision, total);
  }
  const std::string sizes = sizes_text(*smaller);
  const auto why = why_not_inherited(step.mechanics, plan, step.code, *smaller);
  const std::string rest =
      why ? "here only the summands, their derivatives and that they sum up to H: " + *why
          : "more elements repeat the inner ones";
  return {property, why ? both(total.verdict, Verdict::tested) : total.verdict,
          fmt::format("{}{}, at {}; {}", to_text(total), scope(step.scheme, step.code, true), sizes,
                      rest)};
}

Finding prove_every_element(const StepUnderProof& step, const SolvePlan& plan,
                            const Expression& hamiltonian, const Surroundings& around) {
  const Derivatives derivatives(step.mechanics, hamiltonian);
  const Decision total = decide_all(all_identities(step, plan, derivatives, hamiltonian), around);
  if (!holds(total.verdict)) return {kProgram, total.verdict, total.witness};
  return {kProgram, total.verdict,
          to_text(total) + scope(step.scheme, step.code, step.mechanics.keeps_sums())};
}

}  // namespace

Finding prove_emitted(const Mechanics& mechanics, const Scheme& scheme, const SolvePlan& plan,
                      const Program& program, const std::optional<Expression>& hamiltonian,
                      const Surroundings& around, std::optional<Decision> of_k,
                      const std::optional<SmallerSystems>& smaller) {
  const StepUnderProof step(mechanics, scheme, program);
  const bool is_long = mechanics.keeps_sums() && mechanics.degrees_of_freedom > kMostLookedAt;
  Finding found = is_long ? prove_longer(step, plan, hamiltonian, around, smaller)
                          : prove_every_element(step, plan, *hamiltonian, around);
  if (!is_raised(scheme) || !holds(found.verdict)) return found;
  if (!of_k) of_k = decide_raised(mechanics, plan, program, hamiltonian, around, smaller);
  if (!holds(of_k->verdict)) return {kProgram, of_k->verdict, of_k->witness};
  return {
      kProgram, both(found.verdict, of_k->verdict),
      fmt::format("{}{} with K in place of H; grad K has a symmetric Jacobian and its step is "
                  "the flow up to h^{}, at {} points to 1e-30",
                  found.detail, is_long ? "," : "", plan.equations.function->order, of_k->points)};
}

}  // namespace hamgen
