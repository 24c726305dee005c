// THE LIST of schemes that have a name.  To add one, add it to the table of its kind; to add a
// kind, add a file and its line in all_schemes.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

[[nodiscard]] std::span<const Scheme> all_schemes();
[[nodiscard]] const Scheme* find_scheme(std::string_view name);
// The name of the scheme that an unknown name may stand for, or "".
[[nodiscard]] std::string scheme_meant_by(const std::string& name);

// One of the list, or none.
struct SchemeWish {
  const Scheme* scheme = nullptr;
  // Throws UsageError for a name that is not in the list, with the nearest that is.
  [[nodiscard]] static SchemeWish read(const std::string& name);
};

// Members that take an option instead of a name, because they depend on the system: rows for
// people, without a method.
[[nodiscard]] std::vector<Scheme> members_by_option();

// The tables.
[[nodiscard]] std::vector<Scheme> named_members();  // family.cpp
[[nodiscard]] std::vector<Scheme> splittings();
[[nodiscard]] std::vector<Scheme> compositions();  // of the implicit midpoint, to be replaced
[[nodiscard]] std::vector<Scheme> gauss_methods();
[[nodiscard]] std::vector<Scheme> runge_kutta_methods();

// A composition's coefficients used with the Stormer-Verlet step instead of a member's.
[[nodiscard]] Scheme with_verlet(const Scheme& composition);

// For how many degrees of freedom a member of the system has entries of C: in loops all share those
// of one.
[[nodiscard]] int entries_for(const Mechanics& mechanics);
// The scheme for one system: a member gets its degrees of freedom.  Throws UsageError, with an
// alternative, if the scheme needs what the system does not have.
[[nodiscard]] Scheme for_system(const Scheme& scheme, const Mechanics& mechanics);
// The composition with this member for its base, which must be symmetric: else a UsageError.
[[nodiscard]] Scheme compose(const Scheme& composition, const Scheme& base);

// The collocation method with these distinct nodes in [0, 1], to 70 digits.
[[nodiscard]] RungeKutta collocation(const std::vector<Rational>& nodes);
[[nodiscard]] std::vector<Rational> gauss_nodes(int stages);

}  // namespace hamgen
