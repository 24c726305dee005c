#include "generator/schemes/all_schemes.hpp"

#include <algorithm>

namespace hamgen {

namespace {

std::vector<Scheme> the_list() {
  std::vector<Scheme> list = named_members();
  auto add = [&list](std::vector<Scheme> schemes) {
    list.insert(list.end(), schemes.begin(), schemes.end());
  };
  add(splittings());
  for (const Scheme& scheme : compositions()) add({scheme, with_verlet(scheme)});
  add(gauss_methods());
  add(runge_kutta_methods());
  return list;
}

}  // namespace

std::span<const Scheme> all_schemes() {
  static const std::vector<Scheme> list = the_list();
  return list;
}

const Scheme* find_scheme(std::string_view name) {
  const auto it = std::ranges::find(all_schemes(), name, &Scheme::name);
  return it == all_schemes().end() ? nullptr : &*it;
}

}  // namespace hamgen
