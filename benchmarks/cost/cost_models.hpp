// Models of the cost table that are not among the shipped ones.
#pragma once

namespace hamgen::cost_table {

inline constexpr const char* kBodies = R"(system bodies
size N = 50
coordinate x[1..N], y[1..N], z[1..N]
momentum px[1..N], py[1..N], pz[1..N]
H = sum(i = 1..N, (px[i]^2 + py[i]^2 + pz[i]^2)/2) - sum(i = 1..N, j = 1..i-1,
      1/sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + (z[i] - z[j])^2 + 1/100))/N
scene disk {
  x[i] = cos(2.4*i)*sqrt(i/N)
  y[i] = sin(2.4*i)*sqrt(i/N)
  z[i] = sin(17*i)/4
  px[i] = -sin(2.4*i)/2
  py[i] = cos(2.4*i)/2
  h = 1/1000
  steps = 2000
}
)";

inline constexpr const char* kMeanField = R"(system mean_field
size N = 200
coordinate q[1..N]
momentum p[1..N]
let C = sum(i = 1..N, cos(q[i]))
let S = sum(i = 1..N, sin(q[i]))
H = sum(i = 1..N, p[i]^2/2) - (C^2 + S^2)/(2*N)
scene half {
  q[i] = 2*i/N
  p[i] = cos(3*i)
  h = 1/10
  steps = 1000
}
)";

}  // namespace hamgen::cost_table
