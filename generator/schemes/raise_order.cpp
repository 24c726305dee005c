#include <fmt/format.h>

#include "generator/base/diagnostic.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

Scheme raise_order(Scheme scheme, int order) {
  if (order == scheme.order) return scheme;
  auto* member = std::get_if<Member>(&scheme.method);
  if (member == nullptr) {
    throw UsageError(
        fmt::format("--order {}: {} has order {}, and only the members of the family can be "
                    "raised; the coefficients of a composition are those for a member of order 2\n"
                    "help: leave --scheme out, or name a member of the family",
                    order, scheme.name, scheme.order));
  }
  if (!scheme.symplectic) {
    throw UsageError(
        fmt::format("--order {}: {} is not symplectic and has no generating function\n"
                    "help: C has to lie in sp(2n), C J + J C^T = 0",
                    order, scheme.description));
  }
  if (order < scheme.order || order > kHighestOrder) {
    throw UsageError(
        fmt::format("--order {}: this member has order {}; it can be raised to at most {}", order,
                    scheme.order, kHighestOrder));
  }
  if (scheme.symmetric && order % 2 != 0) {
    throw UsageError(fmt::format(
        "--order {}: a symmetric member has an even order\nhelp: --order {}", order, order + 1));
  }
  member->generating_order = order;
  scheme.order = order;
  scheme.name += fmt::format("-order-{}", order);
  return scheme;
}

}  // namespace hamgen
