// Stages against the mathematics they come from.
#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
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
  const bool folded = !stages.folded.folding.left_out.empty();
  const Model model = folded ? with_free_parameters(stages.model) : stages.model;
  DerivedFormulas derived{.hamiltonian = written_out_hamiltonian(model)};
  if (!folded && !mechanics.keeps_sums()) {
    derived.gradient = mechanics.gradient;
    derived.invariants = mechanics.invariants;
  } else if (!folded && mechanics.degrees_of_freedom <= kMostLookedAt) {
    derived.gradient = Derivatives(mechanics, derived.hamiltonian).gradient();
  }
  return prove_model_read(model, mechanics, derived, around);
}

// With fewer elements, of which every formula is what it is in the large system.
SizedSystem sized_system(const SourceText& source, Request request, const Size& constant, long size,
                         bool reads = true) {
  request.sizes[constant.name] = size;
  request.numbers_of_sizes[constant.name] = constant.value;
  if (request.scene) {
    SceneValues values = scene_values(read_request(source, request), request.scene->asked);
    values.observe = request.scene->values.observe;
    values.formulas = request.scene->values.formulas;
    values.watched = request.scene->values.watched;
    request.scene->values = std::move(values);
  }
  Stages stages = run_stages(source, request);
  Expression hamiltonian = written_out_hamiltonian(stages);
  Surroundings around = surroundings_of(stages.model);
  Finding read = reads ? prove_front_end(stages, around) : Finding();
  return {size,
          std::move(stages.system.mechanics),
          std::move(stages.equations.scheme),
          std::move(stages.plan),
          std::move(stages.program),
          std::move(hamiltonian),
          std::move(read),
          std::move(around)};
}

// So few elements are enough for neighbours of neighbours; what reaches farther asks for more.
constexpr long kFewElements = 8;
// How much longer the smaller systems are made for what the loops reach than loops are unasked.
constexpr long kMostTimesLonger = 4;

// The least size at which a system stays loops without being asked to.
long least_size_in_loops(const Mechanics& large, long size) {
  return kMostWrittenOut * size / large.degrees_of_freedom + 1;
}

// Of a large system in loops: its largest size made so small, or what the loops reach if that is
// more, and the next sizes, in loops too.  Empty where the model has no such sizes: a list of
// values fits one of them only.
std::optional<SmallerSystems> systems_of_size(const SourceText& source, Request request,
                                              const Stages& stages, const Size& largest,
                                              long size) {
  const Mechanics& mechanics = stages.system.mechanics;
  const long most = kMostTimesLonger * least_size_in_loops(mechanics, largest.value);
  const bool may_choose = request.solver.empty();
  request.in_loops = true;
  const auto made = [&](long elements) {
    SmallerSystems smaller{largest.name, largest.value,
                           sized_system(source, request, largest, elements),
                           sized_system(source, request, largest, elements + 1)};
    if (sums_over_pairs(mechanics))
      smaller.third = sized_system(source, request, largest, elements + 2, false);
    return smaller;
  };
  if (largest.value <= size + 2) return {};
  try {
    SmallerSystems smaller = made(size);
    // Where Newton's matrix is too large the larger system is left without it.
    if (may_choose && smaller.first.program.routines.size() > stages.program.routines.size()) {
      request.solver = "fixed-point";
      smaller = made(size);
    }
    const long reached = least_size_of_loops(mechanics, stages.plan, stages.program, smaller);
    if (reached > size && reached <= most && reached + 2 < largest.value) smaller = made(reached);
    const bool in_loops =
        smaller.first.mechanics.keeps_sums() && smaller.second.mechanics.keeps_sums();
    return in_loops ? std::optional(std::move(smaller)) : std::nullopt;
  } catch (const ModelError&) {
    return {};
  } catch (const UsageError&) {
    return {};
  }
}

// Those that the large system is a longer one of, as few elements as show it; else those at the
// least size at which it stays loops, for fewer elements may be planned otherwise.
std::optional<SmallerSystems> smaller_systems(const SourceText& source, const Request& request,
                                              const Stages& stages) {
  const Mechanics& mechanics = stages.system.mechanics;
  if (!mechanics.keeps_sums() || mechanics.degrees_of_freedom <= kMostLookedAt) return {};
  const auto largest = std::ranges::max_element(stages.model.sizes, {}, &Size::value);
  if (largest == stages.model.sizes.end()) return {};
  std::optional<SmallerSystems> found;
  for (const long few : {kFewElements, least_size_in_loops(mechanics, largest->value)}) {
    const long size = std::max(few, least_size_of_order(stages.equations));
    auto next = systems_of_size(source, request, stages, *largest, size);
    if (!next) continue;
    found = std::move(next);
    if (!why_not_inherited(mechanics, stages.plan, stages.program, *found)) break;
  }
  return found;
}

// Of a model that is a longer one of those that were read.
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
  const Mechanics& mechanics = stages.system.mechanics;
  const std::optional<SmallerSystems> smaller = smaller_systems(source, request, stages);
  // Then nothing of it need be written out.
  const bool inherits = smaller &&
                        (mechanics.invariants.empty() || says_nothing_of_invariants(mechanics)) &&
                        !why_not_inherited(mechanics, stages.plan, stages.program, *smaller);
  Surroundings around = smaller ? smaller->first.around : surroundings_of(stages.model);
  if (scene) around.centres.insert(around.centres.begin(), centre_of(stages.model, *scene));
  const bool is_too_long = !inherits && instances_of_loops(mechanics) > kMostInstances;
  std::optional<Expression> hamiltonian;
  if (!inherits && !is_too_long) hamiltonian = written_out_hamiltonian(stages);
  Proof proof = verify(mechanics, stages.equations.scheme, stages.plan, stages.program, hamiltonian,
                       around, smaller);
  if (is_too_long) {
    proof.push_back({kModelRead, Verdict::not_decided,
                     fmt::format("more than {} summands; verify a smaller size", kMostInstances)});
  } else {
    proof.push_back(inherits ? read_at_smaller_sizes(*smaller) : prove_front_end(stages, around));
  }
  if (request.scene && is_something_left_out(stages))
    proof.push_back(
        prove_specialised(stages.model, stages.folded, stages.system, *request.scene, around));
  return proof;
}

}  // namespace hamgen
