// Runge-Kutta methods that are not symplectic: baselines.
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/coefficients.hpp"

namespace hamgen {

std::vector<Scheme> runge_kutta_methods() {
  const Expression half = ratio(1, 2);
  return {{.name = "explicit-euler",
           .description = "Z = z + h J grad H(z), what not to use: energies grow",
           .order = 1,
           .symplectic = false,
           .source = "Euler 1768; HLW I.1.2",
           .method = RungeKutta{.a = {{0}}, .b = {1}, .c = {0}}},
          {.name = "rk4",
           .description = "the classical method of Runge and Kutta, explicit",
           .order = 4,
           .symplectic = false,
           .source = "Kutta 1901; HLW II.1.1",
           .method = RungeKutta{.a = {{0, 0, 0, 0}, {half, 0, 0, 0}, {0, half, 0, 0}, {0, 0, 1, 0}},
                                .b = {ratio(1, 6), ratio(1, 3), ratio(1, 3), ratio(1, 6)},
                                .c = {0, half, half, 1}}}};
}

}  // namespace hamgen
