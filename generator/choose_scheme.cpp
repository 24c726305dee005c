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
  if (request.gauge->matrix && !request.reference.empty())
    throw UsageError(
        "--reference says where --gauge locally-exact is exact; a matrix has no point");
  if (!request.alpha.empty() || !request.beta.empty() || !request.gamma.empty()) {
    throw UsageError("give either --gauge or --alpha, --beta, --gamma");
  }
}

// The member of the request.
Scheme requested_member(const Model& model, const Mechanics& mechanics, const Request& request) {
  if (request.gauge->matrix) return gauge_member(model, *request.gauge->matrix);
  if (request.gauge->locally_exact) {
    return locally_exact_member(mechanics, read_reference(model, request.reference));
  }
  return family_member(entries_for(mechanics), gauge_block(model, *request.alpha),
                       gauge_block(model, *request.beta), gauge_block(model, *request.gamma));
}

Scheme scheme_of_own_order(const Model& model, const Mechanics& mechanics, const Request& request) {
  if (request.scheme.empty()) return requested_member(model, mechanics, request);
  const Scheme& named = *request.scheme->scheme;
  if (std::holds_alternative<Composition>(named.method)) {
    return compose(named, requested_member(model, mechanics, request));
  }
  if (request.names_member())
    throw UsageError("give either --scheme or --alpha, --beta, --gamma, --gauge");
  return for_system(named, mechanics);
}

}  // namespace

void require_few_coupled(const Model& model, const Request& request) {
  if (request.gauge.empty() || !request.gauge->locally_exact) return;
  const std::vector<std::string> q = element_names(model.coordinates);
  const std::vector<std::string> p = element_names(model.momenta);
  if (q.size() <= static_cast<std::size_t>(kMostWrittenOut)) return;
  require_sparse_row(written_out_hamiltonian(model), q, p,
                     read_reference(model, request.reference));
}

Scheme choose_scheme(const Model& model, const Mechanics& mechanics, const Request& request) {
  check_gauge(request);
  Scheme scheme = scheme_of_own_order(model, mechanics, request);
  if (request.order == 0) return scheme;
  return raise_order(std::move(scheme), request.order);
}

}  // namespace hamgen
