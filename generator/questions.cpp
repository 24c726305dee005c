// What is asked of a model and its method without a step.
#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/choose_sums.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/modified_terms.hpp"
#include "generator/program/names.hpp"
#include "generator/read_request.hpp"
#include "generator/stages.hpp"
#include "generator/verify/model_text.hpp"

namespace hamgen {

std::vector<Expression> modified_hamiltonian(const SourceText& source, const Request& request,
                                             int count) {
  require_solved_step(request);
  const Model model = read_request(source, request);
  const Mechanics mechanics = derive(model, false);
  return modified_terms(mechanics, choose_scheme(model, mechanics, request), count);
}

std::vector<LinearPoint> linear_points(const SourceText& source, const Request& request,
                                       const SceneValues& scene) {
  const Model model = read_request(source, request);
  constexpr long most = 600;  // the symmetric eigenvalue problem takes the third power
  if (hamgen::degrees_of_freedom(model) > most) return {};
  constexpr long most_collective = 100;  // a function of sums has a full second derivative
  if (hamgen::degrees_of_freedom(model) > most_collective && !derive(model).sums.empty()) return {};
  std::optional<Mechanics> written_out;
  try {
    written_out = derive(model, false);
  } catch (const ModelError&) {  // which it is for its length alone: the model was derived in loops
    return {};
  }
  const Mechanics& mechanics = *written_out;
  std::map<std::string, Rational> point;
  const auto add = [&point](const std::vector<std::string>& names,
                            const std::vector<Rational>& values) {
    for (std::size_t i = 0; i < names.size(); ++i) point[names[i]] = values[i];
  };
  add(element_names(model.coordinates), scene.q);
  add(element_names(model.momenta), scene.p);
  add(element_names(model.parameters), scene.parameters);
  return linear_points(mechanics, choose_scheme(model, mechanics, request), point, scene.h.value());
}

ProofCertificate certificate_of(const SourceText& source, const Request& request,
                                const Proof& proof) {
  const Stages stages = run_stages(source, request);
  if (stages.plan.sweeps)
    throw UsageError("--certificate: sweeps leave the step unsolved\nhelp: drop --solver sweeps");
  if (is_something_left_out(stages)) {
    throw UsageError("--certificate: the scene leaves a part of the system out\nhelp: add --whole");
  }
  const auto is_proved = [&](const std::string& property) {
    const auto found = std::ranges::find(proof, property, &Finding::property);
    return found != proof.end() && found->verdict == Verdict::proved;
  };
  Mechanics mechanics = stages.system.mechanics;
  Scheme scheme = stages.equations.scheme;
  if (mechanics.keeps_sums()) {
    require_certified_size(mechanics);
    mechanics = derive(stages.folded.model, false);
    scheme = choose_scheme(stages.model, mechanics, request);
  }
  std::vector<NamedExpression> invariants;
  for (const NamedExpression& invariant : mechanics.invariants) {
    if (is_proved(invariant.name + " invariant")) invariants.push_back(invariant);
  }
  return make_certificate(mechanics, scheme, is_proved("symmetric"), invariants);
}

std::vector<Corner> corners_of_hamiltonian(const SourceText& source, const Request& request) {
  return corners_of_hamiltonian(derive(read_request(source, request)));
}

std::string point_beyond_text(const SourceText& source, const Request& request) {
  const Model model = read_request(source, request);
  return point_beyond_text(model, derive(model, may_keep_sums(request)));
}

Scheme request_scheme(const SourceText& source, const Request& request) {
  const Model model = read_request(source, request);
  require_few_coupled(model, request);
  Scheme scheme = choose_scheme(model, derive_for(request, model, may_keep_sums(request)), request);
  const auto n = static_cast<int>(degrees_of_freedom(model));
  if (auto* member = std::get_if<Member>(&scheme.method)) {
    *member = of_all(*member, n);
  } else if (auto* composition = std::get_if<Composition>(&scheme.method)) {
    composition->base = of_all(composition->base, n);
  }
  return scheme;
}

}  // namespace hamgen
