#include "app/studies/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

template <class Real>
ExactSum parts_of(const runtime::Wide& value) {
  Real rest = static_cast<Real>(value.hi) + static_cast<Real>(value.lo);
  ExactSum parts{};
  for (double& part : parts) {
    part = static_cast<double>(rest);
    rest -= static_cast<Real>(part);
  }
  return parts;
}

ExactSum sum_of(const Rational& value) {
  const TripleDouble triple = to_triple(value);
  return {triple.hi, triple.lo, triple.lower, 0.0};
}

// Parameters as the plugin has them; those that it does not use, or that are folded, as the model.
StepNumbers numbers_of(const CertifyRequest& request) {
  StepNumbers numbers;
  numbers.scalar_digits = request.library->plugin().scalar_digits;
  const std::vector<std::string> names = element_names(request.plugin->model.parameters);
  for (std::size_t i = 0; i < names.size(); ++i)
    numbers.values[names[i]] = sum_of(request.scene->parameters[i]);
  for (std::size_t i = 0; i < request.plugin->parameter_names.size(); ++i) {
    const bool is_energy =
        request.plugin->needs_energy_parameter && i + 1 == request.plugin->parameter_names.size();
    numbers.values[is_energy ? "E0" : request.plugin->parameter_names[i]] =
        in_scalar(request.start->parameters[i], numbers.scalar_digits);
  }
  for (const auto& [name, other] : request.plugin->same) {
    if (const auto it = numbers.values.find(other); it != numbers.values.end())
      numbers.values[name] = it->second;
  }
  numbers.values["h"] = in_scalar(request.start->h, numbers.scalar_digits);
  return numbers;
}

std::vector<ExactSum> exact_state(const runtime::Integrator& integrator) {
  const std::vector<runtime::Wide> z = integrator.state();
  const std::vector<runtime::Wide> carry = integrator.carry();
  std::vector<ExactSum> result;
  for (std::size_t i = 0; i < z.size(); ++i)
    result.push_back({z[i].hi, z[i].lo, carry[i].hi, carry[i].lo});
  return result;
}

ModelState model_state_of(const PluginSource& plugin, const SceneValues& scene) {
  ModelState state;
  for (const StateMap::Sum& sum : plugin.state.model) {
    if (!sum.known) internal_error("a certificate of a step that does not move all variables");
    state.factors.push_back(sum.of);
    state.constant.push_back(value_at_start(sum, scene));
  }
  return state;
}

// Unknowns that are solved for in a step.
long unknowns_of(const Scheme& scheme, long degrees_of_freedom) {
  if (const auto* stages = std::get_if<RungeKutta>(&scheme.method))
    return 2 * degrees_of_freedom * static_cast<long>(stages->b.size());
  if (const auto* composition = std::get_if<Composition>(&scheme.method))
    return 2 * degrees_of_freedom * static_cast<long>(composition->substeps.size());
  return 2 * degrees_of_freedom;
}

// So many steps take some seconds: the work of one grows with the square of its unknowns.
long chosen_distance(const Scheme& scheme, long degrees_of_freedom, long steps) {
  const double unknowns = static_cast<double>(unknowns_of(scheme, degrees_of_freedom));
  const double samples = std::clamp(2e5 / (unknowns * unknowns), 20.0, 20000.0);
  return std::max(1L, static_cast<long>(std::ceil(static_cast<double>(steps) / samples)));
}

void add(Certificate& certificate, const StepDistance& found, long step,
         const std::vector<std::string>& names) {
  if (!found.failure.empty()) {
    if (certificate.failed++ > 0) return;
    certificate.first_failed = step;
    certificate.failure = found.failure;
    return;
  }
  const bool first = certificate.certified++ == 0;
  if (first || found.radius < certificate.radius) certificate.radius = found.radius;
  if (!first && !(found.units > certificate.units)) return;
  certificate.units = found.units;
  certificate.worst_step = step;
  certificate.worst_component = names[found.component];
}

}  // namespace

ExactSum in_scalar(const runtime::Wide& value, int scalar_digits) {
  switch (scalar_digits) {
    case 24:
      return parts_of<float>(value);
    case 64:
      return parts_of<long double>(value);
    case 113:
      return parts_of<__float128>(value);
    default:
      return parts_of<double>(value);
  }
}

void require_certifiable(const Request& method, const Model& model, const Scheme& scheme) {
  if (method.solver->kind == SolverWish::Kind::sweeps)
    throw UsageError(
        fmt::format("--solver {} leaves the step unsolved: there is no exact map that it is "
                    "near to\nhelp: drop --solver",
                    method.solver.text()));
  StepCertifier::require_possible(model, scheme);
}

Certificate certify(const CertifyRequest& request) {
  const Model& model = request.plugin->model;
  StepCertifier certifier(model, *request.scheme, numbers_of(request),
                          model_state_of(*request.plugin, *request.scene));
  std::vector<std::string> names = element_names(model.coordinates);
  const std::vector<std::string> momenta = element_names(model.momenta);
  names.insert(names.end(), momenta.begin(), momenta.end());

  const long steps = *request.scene->steps;
  Certificate certificate{.method = request.plugin->scheme_name,
                          .symplectic = request.scheme->symplectic};
  certificate.every = request.every > 0
                          ? request.every
                          : chosen_distance(*request.scheme, degrees_of_freedom(model), steps);
  certificate.epsilon = std::ldexp(1.0, 1 - request.library->plugin().scalar_digits);
  Work work(request.on_progress, "certify", steps, true);
  runtime::Integrator integrator(request.library, *request.start);
  const auto advance = [&](long count) {
    const runtime::Report report = integrator.advance(count, false);
    certificate.steps += static_cast<long>(report.steps_done);
    if (report.status != runtime::Status::done) certificate.ended = runtime::to_text(report.status);
    return report.status == runtime::Status::done;
  };
  while (certificate.steps < steps) {
    if (is_stopped(request.stop)) {
      certificate.ended = runtime::to_text(runtime::Status::stopped);
      break;
    }
    const std::vector<ExactSum> before = exact_state(integrator);
    if (!advance(1)) break;
    const StepDistance found = certifier.distance(before, exact_state(integrator));
    certificate.solves = certificate.solves || found.radius > 0.0;
    add(certificate, found, certificate.steps, names);
    const long rest = std::min(certificate.every - 1, steps - certificate.steps);
    if (rest > 0 && !advance(rest)) break;
    work.tell(certificate.steps);
  }
  return certificate;
}

}  // namespace hamgen::app
