#include "generator/choose_scheme.hpp"

#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/locally_exact.hpp"
#include "generator/schemes/read_gauge.hpp"

namespace hamgen {

namespace {

void check_gauge(const Request& request) {
  if (request.gauge.empty()) {
    if (request.reference.empty()) return;
    throw UsageError(
        "--reference says where --gauge locally-exact is exact, but there is no --gauge");
  }
  const bool is_matrix = request.gauge.starts_with('[');
  if (!is_matrix && request.gauge != "locally-exact") {
    throw UsageError(
        fmt::format("unknown gauge '{}'; there is locally-exact, and a matrix C is written "
                    "'[[a, b], [c, -a]]'",
                    request.gauge));
  }
  if (is_matrix && !request.reference.empty())
    throw UsageError(
        "--reference says where --gauge locally-exact is exact; a matrix has no point");
  if (!(request.alpha + request.beta + request.gamma).empty()) {
    throw UsageError("give either --gauge or --alpha, --beta, --gamma");
  }
}

// THE LIST's scheme of that name.
const Scheme& named_scheme(const std::string& name) {
  if (const Scheme* scheme = find_scheme(name)) return *scheme;
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.push_back(scheme.name);
  const std::string near = nearest(name, names);
  throw UsageError(fmt::format("unknown scheme '{}'{}; see `hamgen list schemes`", name,
                               near.empty() ? "" : ", did you mean '" + near + "'?"));
}

// The member of the request.
Scheme requested_member(const Model& model, const Mechanics& mechanics, const Request& request) {
  if (request.gauge.starts_with('[')) {
    return read_gauge_matrix(model, request.gauge);
  }
  if (!request.gauge.empty()) {
    return locally_exact_member(mechanics, read_reference(model, request.reference));
  }
  const std::string alpha = request.alpha.empty() ? "1/2" : request.alpha;
  const std::string beta = request.beta.empty() ? "0" : request.beta;
  const std::string gamma = request.gamma.empty() ? "0" : request.gamma;
  return family_member(mechanics.degrees_of_freedom, read_gauge_block(model, "alpha", alpha),
                       read_gauge_block(model, "beta", beta),
                       read_gauge_block(model, "gamma", gamma));
}

Scheme scheme_of_own_order(const Model& model, const Mechanics& mechanics, const Request& request) {
  if (request.scheme.empty()) return requested_member(model, mechanics, request);
  const Scheme& named = named_scheme(request.scheme);
  const bool has_parameters =
      !(request.alpha + request.beta + request.gamma + request.gauge).empty();
  if (std::holds_alternative<Composition>(named.method)) {
    return compose(named, requested_member(model, mechanics, request));
  }
  if (has_parameters) throw UsageError("give either --scheme or --alpha, --beta, --gamma, --gauge");
  return for_system(named, mechanics);
}

}  // namespace

Scheme choose_scheme(const Model& model, const Mechanics& mechanics, const Request& request) {
  check_gauge(request);
  Scheme scheme = scheme_of_own_order(model, mechanics, request);
  if (request.order == 0) return scheme;
  scheme = raise_order(std::move(scheme), request.order);
  if (mechanics.keeps_sums() && scheme.member().generating_order > 0) {
    throw UsageError(fmt::format(
        "--order {}: {} has {} degrees of freedom, more than the {} that are written out, and the "
        "generating function couples them all\nhelp: a composition of the same order keeps the "
        "sums as "
        "loops, see `hamgen list schemes`",
        request.order, mechanics.name, mechanics.degrees_of_freedom, kMostWrittenOut));
  }
  return scheme;
}

}  // namespace hamgen
