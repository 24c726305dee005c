// Stages against the mathematics they come from.
#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/stages.hpp"
#include "generator/verify/derivatives.hpp"
#include "generator/verify/model_text.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/specialised.hpp"

namespace hamgen {

namespace {

// What the front end has read; a scene's own values are put in later, and proved by "specialised".
Finding prove_front_end(const Stages& stages, const Surroundings& around) {
  const Mechanics& mechanics = stages.system.given;
  DerivedFormulas derived{.hamiltonian = written_out_hamiltonian(stages.model)};
  const bool folded = !stages.folded.folding.left_out.empty();
  if (!folded && !mechanics.keeps_sums()) {
    derived.gradient = mechanics.gradient;
    derived.invariants = mechanics.invariants;
  } else if (!folded && mechanics.degrees_of_freedom <= kMostLookedAt) {
    derived.gradient = Derivatives(mechanics, derived.hamiltonian).gradient();
  }
  return prove_model_read(stages.model, mechanics, derived, around);
}

SizedSystem sized_system(const SourceText& source, Request request, const std::string& constant,
                         long size) {
  request.sizes[constant] = size;
  if (request.scene) {
    SceneValues values = scene_values(read_request(source, request), request.scene->asked);
    values.observe = request.scene->values.observe;
    values.formulas = request.scene->values.formulas;
    values.watched = request.scene->values.watched;
    request.scene->values = std::move(values);
  }
  Stages stages = run_stages(source, request);
  Expression hamiltonian = written_out_hamiltonian(stages);
  Finding read = prove_front_end(stages, surroundings_of(stages.model));
  return {size,
          std::move(stages.system.mechanics),
          std::move(stages.equations.scheme),
          std::move(stages.plan),
          std::move(stages.program),
          std::move(hamiltonian),
          std::move(read)};
}

// Of a large system in loops: its largest size as small as loops are made of, and the next one.
// Empty where the model has no such sizes: a list of values fits one of them only.
std::optional<SmallerSystems> smaller_systems(const SourceText& source, const Request& request,
                                              const Stages& stages) {
  if (!stages.system.mechanics.keeps_sums() ||
      stages.system.mechanics.degrees_of_freedom <= kMostLookedAt)
    return {};
  const auto largest = std::ranges::max_element(stages.model.sizes, {}, &Size::value);
  constexpr long size = kMostWrittenOut + 1;
  if (largest == stages.model.sizes.end() || largest->value <= size + 1) return {};
  const auto made_by = [&](const Request& wish) {
    return SmallerSystems{largest->name, largest->value,
                          sized_system(source, wish, largest->name, size),
                          sized_system(source, wish, largest->name, size + 1)};
  };
  try {
    SmallerSystems smaller = made_by(request);
    // Where Newton's matrix is too large the larger system is left without it.
    if (request.solver.empty() &&
        smaller.first.program.routines.size() > stages.program.routines.size()) {
      Request without_matrix = request;
      without_matrix.solver = "fixed-point";
      smaller = made_by(without_matrix);
    }
    const bool in_loops =
        smaller.first.mechanics.keeps_sums() && smaller.second.mechanics.keeps_sums();
    return in_loops ? std::optional(std::move(smaller)) : std::nullopt;
  } catch (const ModelError&) {
    return {};
  } catch (const UsageError&) {
    return {};
  }
}

// Of a model that is a longer one of two that were read.
Finding read_at_smaller_sizes(const SmallerSystems& smaller) {
  Finding read = smaller.first.read;
  if (holds(read.verdict) && !holds(smaller.second.read.verdict)) read = smaller.second.read;
  read.detail += fmt::format(", at {0} = {1} and {0} = {2}; more elements repeat the inner ones",
                             smaller.constant, smaller.first.size, smaller.second.size);
  return read;
}

}  // namespace

Proof prove(const SourceText& source, const Request& request, const Stages& stages,
            const std::optional<SceneValues>& scene) {
  Surroundings around = surroundings_of(stages.model);
  if (scene) around.centres.insert(around.centres.begin(), centre_of(stages.model, *scene));
  const Mechanics& mechanics = stages.system.mechanics;
  const std::optional<SmallerSystems> smaller = smaller_systems(source, request, stages);
  // Then nothing of it need be written out.
  const bool inherits = smaller && mechanics.invariants.empty() &&
                        !why_not_inherited(mechanics, stages.program, *smaller);
  std::optional<Expression> hamiltonian;
  if (!inherits) hamiltonian = written_out_hamiltonian(stages);
  Proof proof = verify(mechanics, stages.equations.scheme, stages.plan, stages.program, hamiltonian,
                       around, smaller);
  proof.push_back(inherits ? read_at_smaller_sizes(*smaller) : prove_front_end(stages, around));
  if (request.scene && is_something_left_out(stages))
    proof.push_back(
        prove_specialised(stages.model, stages.folded, stages.system, *request.scene, around));
  return proof;
}

}  // namespace hamgen
