#include "generator/schemes/scheme.hpp"

#include "generator/base/diagnostic.hpp"

namespace hamgen {

bool RungeKutta::is_explicit() const {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = i; j < a[i].size(); ++j) {
      if (!a[i][j].is_zero()) return false;
    }
  }
  return true;
}

bool Scheme::has_member() const {
  return is_member() || std::holds_alternative<Composition>(method);
}

const Member& Scheme::member() const {
  if (const auto* composition = std::get_if<Composition>(&method)) return composition->base;
  if (const auto* member = std::get_if<Member>(&method)) return *member;
  internal_error("the scheme " + name + " is not made of members");
}

}  // namespace hamgen
