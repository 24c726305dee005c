#include "generator/verify/linear_parts.hpp"

#include <algorithm>

namespace hamgen {

namespace {

// S with every entry changed by some units of `digits`, symmetrically.
ExactMatrix perturbed(ExactMatrix s, const Rational& digits, std::size_t number) {
  for (std::size_t i = 0; i < s.size; ++i) {
    for (std::size_t j = i; j < s.size; ++j) {
      const auto units = static_cast<long>((3 * i + 5 * j + 7 * number * (i + j + 1)) % 11) - 5;
      s(i, j) *= 1 + digits * units;
      s(j, i) = s(i, j);
    }
  }
  return s;
}

ExactMatrix rounded(ExactMatrix m) {
  constexpr unsigned long bits = 256;
  for (Rational& x : m.entries) {
    Integer scaled = x.get_num() << bits;
    mpz_fdiv_q(scaled.get_mpz_t(), scaled.get_mpz_t(), x.get_den_mpz_t());
    x = Rational(scaled, Integer(1) << bits);
    x.canonicalize();
  }
  return m;
}

// Of these degrees of freedom alone.
LinearPart restricted(const Scheme& scheme, const ExactMatrix& s,
                      const std::vector<std::size_t>& members) {
  const std::size_t n = s.size / 2;
  const std::size_t m = members.size();
  std::vector<std::size_t> places = members;
  for (const std::size_t i : members) places.push_back(n + i);
  LinearPart part{scheme, ExactMatrix::zero(2 * m)};
  SparseMatrix c;
  for (std::size_t i = 0; i < 2 * m; ++i) {
    for (std::size_t j = 0; j < 2 * m; ++j) {
      part.s(i, j) = s(places[i], places[j]);
      if (!scheme.has_member()) continue;
      const auto it =
          scheme.member().c.find({static_cast<int>(places[i]), static_cast<int>(places[j])});
      if (it != scheme.member().c.end())
        c.emplace(std::pair(static_cast<int>(i), static_cast<int>(j)), it->second);
    }
  }
  const auto restrict = [&](Member& member) {
    member.degrees_of_freedom = static_cast<int>(m);
    member.c = c;
  };
  if (auto* composition = std::get_if<Composition>(&part.scheme.method)) {
    restrict(composition->base);
  } else if (auto* member = std::get_if<Member>(&part.scheme.method)) {
    restrict(*member);
  }
  return part;
}

}  // namespace

std::vector<LinearPart> parts_of(const Scheme& scheme, const ExactMatrix& s) {
  const std::size_t n = s.size / 2;
  std::vector<std::size_t> group(n);
  for (std::size_t i = 0; i < n; ++i) group[i] = i;
  const auto couple = [&](std::size_t i, std::size_t j) {
    const std::size_t from = group[j % n];
    for (std::size_t& g : group) {
      if (g == from) g = group[i % n];
    }
  };
  for (std::size_t i = 0; i < s.size; ++i) {
    for (std::size_t j = 0; j < s.size; ++j) {
      if (s(i, j) != 0) couple(i, j);
    }
  }
  if (scheme.has_member()) {
    for (const auto& [place, entry] : scheme.member().c)
      couple(static_cast<std::size_t>(place.first), static_cast<std::size_t>(place.second));
  }
  std::vector<LinearPart> parts;
  for (std::size_t first = 0; first < n; ++first) {
    std::vector<std::size_t> members;
    for (std::size_t i = first; i < n; ++i) {
      if (group[i] == group[first]) members.push_back(i);
    }
    if (std::ranges::find(group, group[first]) - group.begin() !=
        static_cast<std::ptrdiff_t>(first))
      continue;
    parts.push_back(restricted(scheme, s, members));
  }
  return parts;
}

Powers powers_at(const RationalStep& step, const Rational& h, const ExactMatrix& s,
                 int free_motions, bool exact, const char* digits) {
  const auto at = [&](const ExactMatrix& near) {
    ExactMatrix m = step.matrix(h, near);
    if (m.size == 0) return Powers::undecided;
    // What is rounded already need not be carried with all digits.
    if (!exact) m = rounded(std::move(m));
    return powers_of(m, free_motions, exact);
  };
  const Powers found = at(s);
  if (exact) return found;
  for (std::size_t number = 1; number <= 3; ++number) {
    if (at(perturbed(s, *parse_decimal(digits), number)) != found) return Powers::undecided;
  }
  return found;
}

}  // namespace hamgen
