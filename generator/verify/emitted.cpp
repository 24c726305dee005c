#include "generator/verify/emitted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "generator/mechanics/modified_hamiltonian.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {

namespace {

bool is_raised(const Scheme& scheme) {
  return scheme.is_member() && scheme.member().generating_order > 0;
}

// dV/dq and dT/dp of a splitting.
Identities half_gradient(const Program& program, const Evaluation& half,
                         std::vector<Expression> expected) {
  Identities identities = identities_of(half, "component of a kick or drift", expected);
  identities.emitted.insert(identities.emitted.begin(), program.coefficients.begin(),
                            program.coefficients.end());
  return identities;
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

std::vector<Identities> straight_line_identities(const Mechanics& mechanics,
                                                 const Derivatives& derivatives,
                                                 const Scheme& scheme, const Program& program) {
  const std::vector<Expression>& gradient = derivatives.gradient();
  const auto middle = gradient.begin() + mechanics.degrees_of_freedom;
  std::vector<Identities> parts = {
      identities_of(program.energy, "the energy", {mechanics.energy}),
      identities_of(program.gradient, "component of the gradient", gradient)};
  if (scheme.has_member()) {
    const Derivatives of_step =
        is_raised(scheme) ? Derivatives(*program.plan.equations.function) : derivatives;
    parts.push_back(step_identities(mechanics, of_step, scheme.member(), program));
    if (program.linearisation) {
      parts.push_back(
          tangent_identities(mechanics, of_step, scheme.member(), *program.linearisation));
    }
  }
  if (std::holds_alternative<Splitting>(scheme.method)) {
    parts.push_back(half_gradient(program, program.potential_gradient, {gradient.begin(), middle}));
    parts.push_back(half_gradient(program, program.kinetic_gradient, {middle, gradient.end()}));
  }
  if (std::holds_alternative<RungeKutta>(scheme.method)) {
    std::vector<Expression> field(middle, gradient.end());
    for (auto it = gradient.begin(); it != middle; ++it) field.push_back(-*it);
    parts.push_back(identities_of(program.vector_field, "component of J grad H", field));
  }
  if (!program.modified_powers.empty()) {
    parts.push_back(
        identities_of(program.modified_energies, "modified energy",
                      modified_energies(mechanics, scheme.member(), program.modified_powers)));
  }
  if (!program.hessian_places.empty()) {
    std::vector<Expression> entries;
    for (const auto& [i, j] : program.hessian_places) entries.push_back(derivatives.second(i, j));
    parts.push_back(identities_of(program.hessian, "second derivative", entries));
  }
  return parts;
}

// What was read, and what was not.
std::string scope(const Scheme& scheme, const Sequence& sequence, bool loops) {
  std::string text;
  if (std::holds_alternative<Composition>(scheme.method)) {
    text = fmt::format("the step that is composed and its {} substeps", sequence.substeps.size());
  } else if (std::holds_alternative<Splitting>(scheme.method)) {
    text = fmt::format("the kicks, the drifts and their {} substeps", sequence.substeps.size());
  } else if (std::holds_alternative<RungeKutta>(scheme.method)) {
    text = fmt::format("J grad H and the tableau of {} stages", sequence.stages.weight.size());
  }
  if (!loops) return text.empty() ? "" : ": H, " + text;
  return ": the summands of all loops and their derivatives, that they sum up to H" +
         (text.empty() ? "" : ", " + text) + "; the solver around them only by measuring";
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

}  // namespace

Identities identities_of(const Evaluation& evaluation, const std::string& what,
                         const std::vector<Expression>& expected) {
  Identities identities{.emitted = evaluation.statements};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    identities.claims.push_back({expected.size() == 1 ? what : fmt::format("{} {}", what, i + 1),
                                 evaluation.results.at(i), expected[i]});
  }
  return identities;
}

Finding prove_emitted(const Mechanics& mechanics, const Scheme& scheme, const Program& program,
                      const Expression& hamiltonian, const Surroundings& around,
                      std::optional<Decision> of_k) {
  const std::string property = "emitted code";
  const bool loops = mechanics.keeps_sums();
  std::optional<Derivatives> derivatives;
  if (!loops) derivatives.emplace(mechanics);
  std::vector<Identities> parts =
      loops ? kernel_identities(mechanics, hamiltonian)
            : straight_line_identities(mechanics, *derivatives, scheme, program);
  parts.push_back(sequence_identities(scheme, program.sequence));
  std::vector<Expression> invariants;
  for (const NamedExpression& invariant : mechanics.invariants)
    invariants.push_back(invariant.value);
  parts.push_back(identities_of(program.invariants, "invariant", invariants));
  Decision total{.verdict = Verdict::proved};
  for (const Identities& part : parts) {
    const Decision decision = decide(part, around);
    total.claims += decision.claims;
    total.by_algebra += decision.by_algebra;
    total.points = std::max(total.points, decision.points);
    add_corners(decision.corners, total.corners);
    total.verdict = both(total.verdict, decision.verdict);
    if (!holds(decision.verdict)) return {property, decision.verdict, decision.witness};
  }
  const std::string detail = to_text(total) + scope(scheme, program.sequence, loops);
  // What stands around loops is the same text for every model and is not read.
  if (loops) total.verdict = both(total.verdict, Verdict::tested);
  if (!is_raised(scheme)) return {property, total.verdict, detail};
  const GeneratingFunction& function = *program.plan.equations.function;
  if (!of_k) of_k = decide_function(mechanics, *derivatives, scheme.member(), function, around);
  if (!holds(of_k->verdict)) return {property, of_k->verdict, of_k->witness};
  return {property, both(total.verdict, of_k->verdict),
          fmt::format("{} with K in place of H; grad K has a symmetric Jacobian and its step is "
                      "the flow up to h^{}, at {} points to 1e-30",
                      detail, function.order, of_k->points)};
}

}  // namespace hamgen
