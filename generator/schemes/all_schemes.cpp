#include "generator/schemes/all_schemes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"

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

// What else schemes are called.
struct OtherName {
  std::string_view name, scheme;
};
constexpr OtherName kOtherNames[] = {{"verlet", "stormer-verlet"},
                                     {"velocity-verlet", "stormer-verlet"},
                                     {"leapfrog", "stormer-verlet"},
                                     {"leap-frog", "stormer-verlet"},
                                     {"kick-drift-kick", "stormer-verlet"},
                                     {"kdk", "stormer-verlet"},
                                     {"drift-kick-drift", "position-verlet"},
                                     {"dkd", "position-verlet"},
                                     {"midpoint", "implicit-midpoint"},
                                     {"symplectic-euler", "symplectic-euler-a"},
                                     {"runge-kutta", "rk4"},
                                     {"runge-kutta-4", "rk4"}};

}  // namespace

std::span<const Scheme> all_schemes() {
  static const std::vector<Scheme> list = the_list();
  return list;
}

const Scheme* find_scheme(std::string_view name) {
  const auto it = std::ranges::find(all_schemes(), name, &Scheme::name);
  return it == all_schemes().end() ? nullptr : &*it;
}

std::string scheme_meant_by(const std::string& name) {
  const auto other = std::ranges::find(kOtherNames, name, &OtherName::name);
  if (other != std::end(kOtherNames)) return std::string(other->scheme);
  std::vector<std::string> names;
  for (const Scheme& scheme : all_schemes()) names.push_back(scheme.name);
  return nearest(name, names);
}

SchemeWish SchemeWish::read(const std::string& name) {
  if (name.empty()) return {};
  if (const Scheme* scheme = find_scheme(name)) return {scheme};
  const std::string near = scheme_meant_by(name);
  throw UsageError(fmt::format("unknown scheme '{}'{}; see `hamgen list schemes`", name,
                               near.empty() ? "" : ", did you mean '" + near + "'?"));
}

std::vector<Scheme> members_by_option() {
  std::vector<Scheme> list = {
      {.name = "--alpha A --beta B --gamma C",
       .description = "any member; order 2 and symmetric where C is odd in h",
       .source = "Jimenez-Perez, Vilotte, Romanowicz 2015"},
      {.name = "--gauge locally-exact",
       .description = "the member that is exact on the linear part at --reference",
       .order = 2,
       .symmetric = true,
       .needs = "any H with H'' at the reference",
       .source = "after Cieslinski 2013, there with a moving point"}};
  for (int order = 3; order <= kHighestOrder; ++order) {
    const bool even = order % 2 == 0;
    list.push_back({.name = fmt::format("--order {}", order),
                    .description = fmt::format("a member{}, by its generating function; one solve",
                                               even ? "" : " that is not symmetric"),
                    .order = order,
                    .symmetric = even,
                    .needs = "any H of few degrees of freedom",
                    .source = "Feng, Wu, Qin, Wang 1989; HLW VI.5.4"});
  }
  return list;
}

}  // namespace hamgen
