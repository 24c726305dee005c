// Models that the tests of the command use.
#pragma once

#include <string_view>

namespace hamgen::app_test {

inline constexpr std::string_view pendulum = R"(system pendulum
coordinate q [rad]   # angle from the downward vertical
momentum p
parameter eps = 0.03 [1/s^2]   # strength of gravity
H = p^2/2 - eps*cos(q)
scene swing {
  q = 3.1
  p = 0
  h = 0.1
  steps = 1000
}
)";

// Its scene has neither a step size nor steps.
inline constexpr std::string_view without_steps = R"(system no_steps
coordinate q
momentum p
H = p^2/2 - cos(q)
scene start {
  q = 1
}
)";

// Two separate parts and an invariant; no scene.
inline constexpr std::string_view two_oscillators = R"(system two_oscillators
coordinate x, y
momentum px, py
parameter w = 2
H = (px^2 + x^2)/2 + (py^2 + w^2*y^2)/2
invariant first = (px^2 + x^2)/2
)";

// Ends in finite time: q(t)^2 = 1 - 2 t^2 reaches the singular q = 0 at t = 0.7071.
inline constexpr std::string_view collapse = R"(system collapse
coordinate q
momentum p
H = p^2/2 - 1/q^2
scene fall {
  q = 1
  h = 0.01
  steps = 1000
}
)";

inline constexpr std::string_view chain = R"(system chain
size N = 3
coordinate q[1..N] with q[0] = 0, q[N+1] = 0
momentum p[1..N]
H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^4/4)
scene bump {
  q[i] = sin(pi*i/(N+1))
  h = 0.05
  steps = 200
}
)";

}  // namespace hamgen::app_test
