// What a scheme of THE LIST asks of a system.
#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/all_schemes.hpp"

namespace hamgen {

namespace {

// dT/dp polynomial and d2T/dp2 free of the momenta.  A kernel of momenta alone has no other part of
// the state.
bool is_quadratic_in_momenta(const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  for (int i = n; !mechanics.keeps_sums() && i < 2 * n; ++i) {
    const std::set<std::string> beyond =
        non_polynomial_symbols(mechanics.gradient[static_cast<std::size_t>(i)]);
    for (int j = n; j < 2 * n; ++j) {
      if (beyond.contains(mechanics.variable(j).name())) return false;
    }
  }
  for (const auto& [place, value] : mechanics.hessian) {
    if (place.first < n) continue;
    for (int i = n; i < 2 * n; ++i) {
      if (depends_on(value, mechanics.variable(i).name())) return false;
    }
  }
  for (const Kernel& kernel : mechanics.kernels) {
    if (!uses_momenta(kernel)) continue;
    if (kernel.sum || !is_polynomial(kernel)) return false;
    for (const auto& [place, value] : kernel.hessian) {
      for (const Slot& slot : kernel.slots) {
        if (depends_on(value, slot.symbol)) return false;
      }
    }
  }
  return true;
}

// A scheme of the same order that takes the system.
std::string alternative(const Scheme& scheme) {
  const std::string suffix = "-verlet";
  const std::string gauss = fmt::format("gauss-{}", scheme.order + scheme.order % 2);
  if (!scheme.name.ends_with(suffix)) return gauss;
  const std::string composition = scheme.name.substr(0, scheme.name.size() - suffix.size());
  return find_scheme(composition) == nullptr ? gauss : composition + " or " + gauss;
}

}  // namespace

int entries_for(const Mechanics& mechanics) {
  return mechanics.keeps_sums() ? 1 : mechanics.degrees_of_freedom;
}

Scheme for_system(const Scheme& scheme, const Mechanics& mechanics) {
  if (const auto* member = std::get_if<Member>(&scheme.method)) {
    const auto [alpha, beta, gamma] = uniform_parameters(*member).value();
    return family_member(entries_for(mechanics), {{alpha}}, {{beta}}, {{gamma}});
  }
  if (std::holds_alternative<Splitting>(scheme.method)) {
    if (!mechanics.is_separable()) {
      throw UsageError(
          fmt::format("--scheme {} needs a separable H = T(p) + V(q), and the H of {} "
                      "mixes coordinates and momenta\nhelp: --scheme {} takes any H",
                      scheme.name, mechanics.name, alternative(scheme)));
    }
    if (scheme.needs.find("quadratic") != std::string::npos &&
        !is_quadratic_in_momenta(mechanics)) {
      throw UsageError(
          fmt::format("--scheme {} needs a T(p) that is quadratic in p, and that of {} "
                      "is not\nhelp: --scheme blanes-moan-{} takes any separable H",
                      scheme.name, mechanics.name, scheme.order));
    }
  }
  return scheme;
}

Scheme compose(const Scheme& composition, const Scheme& base) {
  if (!base.symplectic) {
    throw UsageError(
        fmt::format("--scheme {} composes a symplectic member, and that of {} is not\n"
                    "help: C has to lie in sp(2n), C J + J C^T = 0",
                    composition.name, base.description));
  }
  if (!base.symmetric) {
    throw UsageError(
        fmt::format("--scheme {} composes a symmetric member, and that of {} is not\n"
                    "help: alpha = 1/2 with beta and gamma zero or odd in h, such as "
                    "--beta h/7",
                    composition.name, base.description));
  }
  Scheme scheme = composition;
  auto& method = std::get<Composition>(scheme.method);
  method.base = base.member();
  scheme.description = fmt::format("{} substeps of {}", method.substeps.size(), base.description);
  return scheme;
}

}  // namespace hamgen
