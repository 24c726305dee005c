#include "generator/schemes/all_schemes.hpp"

#include <algorithm>
#include <array>

namespace hamgen {

namespace {

constexpr std::array kSchemes = {
    NamedScheme{"implicit-midpoint", 2, true, "any H", "zbar = (z + Z)/2",
                "Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.5", "1/2", "0", "0"},
    NamedScheme{"symplectic-euler-a", 1, false, "any H", "H at (q, P); explicit for separable H",
                "Jimenez-Perez, Vilotte, Romanowicz 2015; HLW I.1.2", "0", "0", "0"},
    NamedScheme{"symplectic-euler-b", 1, false, "any H", "H at (Q, p); explicit for separable H",
                "Jimenez-Perez, Vilotte, Romanowicz 2015; HLW I.1.2", "1", "0", "0"},
};

}  // namespace

std::span<const NamedScheme> all_schemes() { return kSchemes; }

const NamedScheme* find_scheme(std::string_view name) {
  const auto it = std::ranges::find(kSchemes, name, &NamedScheme::name);
  return it == kSchemes.end() ? nullptr : &*it;
}

}  // namespace hamgen
