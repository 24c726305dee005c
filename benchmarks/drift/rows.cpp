#include "benchmarks/drift/rows.hpp"

#include <fmt/format.h>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen::drift {

std::string oscillator() {
  return "system oscillator\ncoordinate q\nmomentum p\nparameter w = 1.3\n"
         "H = p^2/2 + w^2*q^2/2\n";
}

std::string chain(int n) {
  return fmt::format(
      "system chain\nsize N = {}\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
      "momentum p[1..N]\nparameter k = 1.3\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, k*(q[i+1] - q[i])^2/2)\n",
      n);
}

// In a constant force: its gradient is no linear function.  The midpoint rule keeps H.
std::string pushed_chain(int n) {
  return fmt::format(
      "system chain\nsize N = {}\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
      "momentum p[1..N]\nparameter k = 1.3\nparameter f = 0.02\n"
      "H = sum(i = 1..N, p[i]^2/2 - f*q[i]) + sum(i = 0..N, k*(q[i+1] - q[i])^2/2)\n",
      n);
}

std::string beating_ring(int n, const std::string& coupling) {
  return fmt::format(
      "system ring\nsize N = {0}\ncoordinate q[1..N] periodic\nmomentum p[1..N] periodic\n"
      "H = sum(i = 1..N, (q[i]^2 + p[i]^2)^2/4 + {1}*q[i]*q[i+1] + {1}*p[i]*p[i+1])\n"
      "invariant A = sum(i = 1..N, q[i]^2 + p[i]^2)\n",
      n, coupling);
}

std::string list_of(int n, const std::string& value) {
  std::string text = "[";
  for (int i = 0; i < n; ++i) text += (i == 0 ? "" : ", ") + value;
  return text + "]";
}

namespace {

// Springs of strength `strength` of their index i, a parameter that is declared so.
std::string soft_chain_with(int n, const std::string& parameter, const std::string& strength) {
  return fmt::format(
      "system chain\nsize N = {}\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
      "momentum p[1..N]\nparameter {}\nparameter a = 0\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, {}*(q[i+1] - q[i])^2/2 + a*(q[i+1] - "
      "q[i])^3/3)\n",
      n, parameter, strength);
}

// With a constant of its own for each spring.
std::string uneven_chain(int n, const std::string& k) {
  return soft_chain_with(n, "k[0..N] = " + list_of(n + 1, k), "k[i]");
}

}  // namespace

std::string soft_chain(int n, const std::string& k) { return soft_chain_with(n, "k = " + k, "k"); }

std::string ring(int n) {
  return fmt::format(
      "system ring\nsize N = {}\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
      "parameter k = 1/3\nparameter b = 0.1\n"
      "H = sum(i = 1..N, p[i]^2/3.4 + k*(q[i+1] - q[i])^2/2 + b*q[i]^2 + 0.3*q[i]^2)\n",
      n);
}

std::string kepler() {
  return "system kepler\ncoordinate q1, q2\nmomentum p1, p2\nlet r = sqrt(q1^2 + q2^2)\n"
         "H = (p1^2 + p2^2)/2 - 1/r\ninvariant L = q1*p2 - q2*p1\n";
}

std::string planar_bodies(int n) {
  return fmt::format(
      "system bodies\nsize N = {}\ncoordinate x[1..N], y[1..N]\nmomentum px[1..N], py[1..N]\n"
      "H = sum(i = 1..N, (px[i]^2 + py[i]^2)/2)"
      " + sum(i = 1..N, j = 1..i-1, sqrt(1 + (x[i] - x[j])^2 + (y[i] - y[j])^2))\n"
      "invariant L = sum(i = 1..N, x[i]*py[i] - y[i]*px[i])\n",
      n);
}

namespace {

// A grid folded into one array: neighbours at the distances 1 and 16, too wide for a band.
std::string sheet() {
  return "system sheet\nsize N = 256\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
         "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/5 + (q[i+1] - q[i])^2/2 + (q[i+16] - q[i])^2/3)\n";
}

std::string all_pairs(int n) {
  return fmt::format(
      "system pairs\nsize N = {}\ncoordinate q[1..N]\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/5 + i*q[i]^2/70)"
      " + sum(i = 1..N, j = 1..i-1, (q[i] - q[j])^2/50)\n",
      n);
}

// Masses of no power of two, a product of coordinate and momentum: nothing is separable.
std::string gyroscope() {
  return "system gyroscope\ncoordinate x, y\nmomentum px, py\nparameter b = 0.7\n"
         "H = (px + b*y)^2/6 + (py - b*x)^2/14 + x^2/2 + 0.65*y^2\n";
}

// In a frame that turns, where coordinates and momenta are coupled in every element; that it is
// linear nobody knows.
std::string turning_chain(int n) {
  return fmt::format(
      "system chain\nsize N = {}\ncoordinate x[1..N] with x[0] = 0, x[N+1] = 0\n"
      "coordinate y[1..N] with y[0] = 0, y[N+1] = 0\nmomentum u[1..N], v[1..N]\n"
      "parameter k = 1.3\nparameter w = 0.7\nparameter a = 0\n"
      "H = sum(i = 1..N, (u[i]^2 + v[i]^2)/2 - w*(x[i]*v[i] - y[i]*u[i]) + x[i]^2/3 + y[i]^2/3)"
      " + sum(i = 0..N, k*((x[i+1] - x[i])^2 + (y[i+1] - y[i])^2)/2 + a*(x[i+1] - x[i])^3/3)\n",
      n);
}

// An oscillator beside a body it knows nothing of: a linear block in a nonlinear H.
std::string oscillator_and_bodies() {
  return "system pair\ncoordinate x, y, u\nmomentum px, py, pu\nparameter w = 1.3\n"
         "H = (px^2 + py^2)/2 + sqrt(1 + x^2 + y^2) + pu^2/2 + w^2*u^2/2\n"
         "invariant I = pu^2 + w^2*u^2\n";
}

constexpr const char* kEllipse = R"(const double c = std::cos(0.1 + s), d = std::sin(0.1 + s);
    z[0] = 0.4 * c; z[1] = 0.4 * d; z[2] = -2 * d; z[3] = 2 * c;)";
// Bodies that turn round their centre, which rests: else they would go where rounding is coarse.
constexpr const char* kDisk = R"(const int n = size / 4;
    for (double& value : z) value = uniform();
    for (int i = 0; i < n; ++i) {
      z[2 * n + i] -= z[n + i];
      z[3 * n + i] += z[i];
    }
    for (int array = 0; array < 4; ++array) {
      double mean = 0;
      for (int i = 0; i < n; ++i) mean += z[array * n + i] / n;
      for (int i = 0; i < n; ++i) z[array * n + i] -= mean;
    })";

struct Problem {
  std::string name, model;
  Conserved conserved = Conserved::form;
  double h = 0.1;
  std::string start = Row().start;
};

void add(std::vector<Row>& rows, const Problem& problem, const std::string& name,
         const Request& request, bool is_exempt = false) {
  rows.push_back({.name = name,
                  .problem = problem.name,
                  .model = problem.model,
                  .request = request,
                  .conserved = problem.conserved,
                  .h = problem.h,
                  .start = problem.start,
                  .is_exempt = is_exempt});
}

// Every scheme that has a name.
void add_schemes(std::vector<Row>& rows, const Problem& problem) {
  for (const Scheme& scheme : all_schemes()) {
    const auto* tableau = std::get_if<RungeKutta>(&scheme.method);
    add(rows, problem, scheme.name, {.scheme = scheme.name},
        tableau != nullptr && tableau->is_explicit());
  }
}

void add_members(std::vector<Row>& rows, const Problem& problem, int size) {
  add(rows, problem, "midpoint", {});
  add(rows, problem, "midpoint, fixed point", {.solver = "fixed-point"});
  add(rows, problem, "alpha = 3/10", {.alpha = "3/10"});
  add(rows, problem, "alpha = 3/10, fixed point", {.alpha = "3/10", .solver = "fixed-point"});
  add(rows, problem, "alpha = 3/10, beta, gamma",
      {.alpha = "3/10", .beta = "1/7", .gamma = "-1/9"});
  add(rows, problem, "beta = h/7, gamma = -h/9", {.beta = "h/7", .gamma = "-h/9"});
  add(rows, problem, "sweeps:3", {.solver = "sweeps:3"}, true);
  if (size <= 4) add(rows, problem, "order 4", {.order = 4});
}

}  // namespace

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  const Problem one{.name = "oscillator", .model = oscillator(), .h = 0.2};
  add_schemes(rows, one);
  add_members(rows, one, 1);
  add(rows, one, "order 6", {.order = 6});
  add(rows, one, "locally exact", {.gauge = "locally-exact"});
  const Problem stiff{.name = "oscillator, h w = 130", .model = oscillator(), .h = 100};
  add(rows, stiff, "midpoint", {});
  add(rows, stiff, "gauss-4", {.scheme = "gauss-4"});

  const Problem large{.name = "oscillator, h w = 1.3", .model = oscillator(), .h = 1};
  add(rows, large, "midpoint", {});
  add(rows, large, "gauss-4", {.scheme = "gauss-4"});

  const Problem orbit{.name = "Kepler, L",
                      .model = kepler(),
                      .conserved = Conserved::invariant,
                      .h = 0.01,
                      .start = kEllipse};
  add_schemes(rows, orbit);
  add_members(rows, orbit, 2);

  const Problem orbit_at_large{.name = "Kepler, L, h = 0.1",
                               .model = kepler(),
                               .conserved = Conserved::invariant,
                               .h = 0.1,
                               .start = kEllipse};
  add_members(rows, orbit_at_large, 2);

  const Problem two{.name = "chain of 2, closed form", .model = chain(2)};
  add_members(rows, two, 2);
  add(rows, two, "locally exact", {.gauge = "locally-exact"});
  const Problem gyro{.name = "gyroscope", .model = gyroscope()};
  add_members(rows, gyro, 2);
  add(rows, gyro, "symplectic-euler-a", {.scheme = "symplectic-euler-a"});
  add(rows, gyro, "yoshida-4", {.scheme = "yoshida-4"});
  add(rows, gyro, "gauss-6", {.scheme = "gauss-6"});
  const Problem mixed{.name = "oscillator beside a body",
                      .model = oscillator_and_bodies(),
                      .conserved = Conserved::invariant};
  add(rows, mixed, "midpoint", {});
  const Problem six{.name = "chain of 6, elimination", .model = chain(6)};
  add_members(rows, six, 6);
  for (const char* scheme : {"gauss-4", "gauss-6", "gauss-16"}) {
    add(rows, six, scheme, {.scheme = scheme});
  }
  const Problem soft{.name = "chain of 6, Newton", .model = soft_chain(6)};
  add_members(rows, soft, 6);
  const Problem six_at_large{.name = "chain of 6, h = 0.3", .model = chain(6), .h = 0.3};
  add_members(rows, six_at_large, 6);
  for (const char* scheme : {"gauss-4", "gauss-6", "gauss-8"}) {
    add(rows, six_at_large, scheme, {.scheme = scheme});
    add(rows, six_at_large, std::string(scheme) + ", Newton",
        {.scheme = scheme, .solver = "newton"});
  }
  // h omega is 2.3 for the fastest.
  const Problem six_at_one{.name = "chain of 6, h = 1", .model = chain(6), .h = 1};
  add(rows, six_at_one, "midpoint", {});
  add(rows, six_at_one, "gauss-4", {.scheme = "gauss-4"});
  add(rows, six_at_one, "gauss-8", {.scheme = "gauss-8"});
  const Problem six_at_half{.name = "chain of 6, h = 0.7", .model = chain(6), .h = 0.7};
  add(rows, six_at_half, "symplectic-euler-a", {.scheme = "symplectic-euler-a"});
  add(rows, six_at_half, "stormer-verlet", {.scheme = "stormer-verlet"});
  const Problem six_at_five{.name = "chain of 6, h = 5", .model = chain(6), .h = 5};
  add(rows, six_at_five, "midpoint", {});
  for (const int n : {1, 3, 6, 25}) {
    const Problem soft_at_one{
        .name = fmt::format("soft chain of {}, h = 1", n), .model = soft_chain(n), .h = 1};
    add(rows, soft_at_one, "midpoint", {});
  }
  const Problem soft_at_odd{.name = "soft chain of 2, h = 1.3", .model = soft_chain(2), .h = 1.3};
  add(rows, soft_at_odd, "midpoint", {});
  for (const int n : {3, 6, 25}) {
    const Problem soft_at_two{
        .name = fmt::format("soft chain of {}, h = 2", n), .model = soft_chain(n), .h = 2};
    add(rows, soft_at_two, "midpoint", {});
  }
  // Constants whose products have patterns that do most harm.
  for (const int n : {2, 3, 25}) {
    const std::string chain = fmt::format("soft chain of {}, k = ", n);
    const Problem of_force{.name = chain + "0.9, h = 2", .model = soft_chain(n, "0.9"), .h = 2};
    add(rows, of_force, "midpoint", {});
    const Problem of_flow{.name = chain + "1, h = 1.8", .model = soft_chain(n, "1"), .h = 1.8};
    add(rows, of_flow, "midpoint", {});
  }
  const Problem soft_at_five{.name = "soft chain of 6, h = 5", .model = soft_chain(6), .h = 5};
  add(rows, soft_at_five, "midpoint", {});
  const Problem band_at_one{.name = "chain of 25, loops, h = 1", .model = chain(25), .h = 1};
  add(rows, band_at_one, "midpoint", {});
  const Problem band_at_half{.name = "chain of 25, loops, h = 0.7", .model = chain(25), .h = 0.7};
  add(rows, band_at_half, "symplectic-euler-a", {.scheme = "symplectic-euler-a"});
  add(rows, band_at_half, "stormer-verlet", {.scheme = "stormer-verlet"});
  for (const auto& [h, text] : {std::pair(0.3, "0.3"), std::pair(1.0, "1")}) {
    for (const int n : {6, 25}) {
      const Problem pushed{.name = fmt::format("pushed chain of {}, h = {}", n, text),
                           .model = pushed_chain(n),
                           .conserved = Conserved::energy,
                           .h = h};
      add(rows, pushed, "midpoint", {});
      if (n == 25 && h < 1.0) add(rows, pushed, "midpoint, fixed point", {.solver = "fixed-point"});
    }
  }
  const Problem pairs_at_one{
      .name = "all pairs of 30, loops, h = 1", .model = all_pairs(30), .h = 1};
  add(rows, pairs_at_one, "midpoint", {});
  const Problem thirty{.name = "chain of 30, Eigen", .model = chain(30)};
  add(rows, thirty, "midpoint", {.alpha = list_of(30, "1/2")});

  const Problem band{.name = "chain of 25, loops, band", .model = chain(25)};
  add_members(rows, band, 25);
  for (const char* scheme :
       {"symplectic-euler-a", "symplectic-euler-b", "stormer-verlet", "blanes-moan-6", "yoshida-4",
        "yoshida-4-verlet", "gauss-4", "gauss-8"}) {
    add(rows, band, scheme, {.scheme = scheme});
  }
  // The compiler of the model does not know that it is linear: the fixed point, and Newton behind
  // it.
  // Where k is a simple fraction the rounding of k times a difference is a pattern, and one that is
  // the gradient of nothing; where it is none there is no pattern.
  for (const auto& [k, h] :
       {std::pair("1.3", 0.1), std::pair("1.3", 0.01), std::pair("1.3", 0.3),
        std::pair("1.2718281828459045", 0.1), std::pair("1.2718281828459045", 0.3)}) {
    const Problem soft_band{.name = fmt::format("soft chain of 25, k = {:.4}, h = {}", k, h),
                            .model = soft_chain(25, k),
                            .h = h};
    add(rows, soft_band, "midpoint", {});
    add(rows, soft_band, "midpoint, fixed point", {.solver = "fixed-point"});
    add(rows, soft_band, "midpoint, Newton", {.solver = "newton"});
    add(rows, soft_band, "alpha = 3/10", {.alpha = "3/10"});
  }
  // Where momenta are not torn out: not separable, or of a higher order.
  for (const double h : {0.1, 0.3, 1.0}) {
    const Problem turning{.name = fmt::format("turning chain of 13, loops, h = {}", h),
                          .model = turning_chain(13),
                          .h = h};
    const bool contracts = h < 1;
    contracts ? add_members(rows, turning, 26) : add(rows, turning, "midpoint", {});
    add(rows, turning, "midpoint, Newton", {.solver = "newton"});
    const Problem raised{.name = fmt::format("soft chain of 25, order 4, h = {}", h),
                         .model = soft_chain(25),
                         .h = h};
    add(rows, raised, "order 4", {.order = 4});
    if (contracts) {
      add(rows, raised, "order 4, fixed point", {.order = 4, .solver = "fixed-point"});
    }
    add(rows, raised, "order 4, Newton", {.order = 4, .solver = "newton"});
  }
  for (const int n : {4, 30}) {
    const Problem beating{.name = fmt::format("beating ring of {}", n),
                          .model = beating_ring(n),
                          .conserved = Conserved::invariant};
    add(rows, beating, "midpoint", {});
    for (const char* solver : {"fixed-point", "newton"}) {
      add(rows, beating, fmt::format("midpoint, {}", solver), {.solver = solver});
      add(rows, beating, fmt::format("gauss-4, {}", solver),
          {.scheme = "gauss-4", .solver = solver});
    }
  }
  const Problem coupled{.name = "beating ring of 30, c = 1/5, h = 0.3",
                        .model = beating_ring(30, "1/5"),
                        .conserved = Conserved::invariant,
                        .h = 0.3};
  add(rows, coupled, "midpoint", {});
  add(rows, coupled, "midpoint, fixed-point", {.solver = "fixed-point"});
  add(rows, coupled, "midpoint, newton", {.solver = "newton"});
  for (const auto& [k, h] : {std::pair("1", 1.8), std::pair("1.3", 0.1), std::pair("0.9", 2.0)}) {
    const Problem uneven{.name = fmt::format("uneven chain of 25, k = {}, h = {}", k, h),
                         .model = uneven_chain(25, k),
                         .h = h};
    add(rows, uneven, "midpoint, Newton", {.solver = "newton"});
  }
  // Of constants in forces, of which none is a short binary fraction.
  const Problem round{.name = "ring of 30, h = 0.3", .model = ring(30), .h = 0.3};
  add(rows, round, "midpoint, fixed point", {.solver = "fixed-point"});
  add(rows, round, "alpha = 3/10, fixed point", {.alpha = "3/10", .solver = "fixed-point"});
  for (const char* solver : {"fixed-point", "newton"})
    add(rows, round, fmt::format("gauss-4, {}", solver), {.scheme = "gauss-4", .solver = solver});
  const Problem small{.name = "ring of 4, h = 0.3", .model = ring(4), .h = 0.3};
  add_members(rows, small, 4);
  for (const char* scheme : {"gauss-4", "gauss-8"}) add(rows, small, scheme, {.scheme = scheme});
  const Problem dense{.name = "all pairs of 30, loops, dense", .model = all_pairs(30)};
  add_members(rows, dense, 30);
  const Problem sparse{.name = "sheet of 256, loops, sparse", .model = sheet()};
  add(rows, sparse, "midpoint", {});
  const Problem bodies{.name = "13 bodies, loops, L",
                       .model = planar_bodies(13),
                       .conserved = Conserved::invariant,
                       .h = 0.05,
                       .start = kDisk};
  add_members(rows, bodies, 26);
  for (const char* scheme : {"symplectic-euler-a", "stormer-verlet", "yoshida-4", "gauss-4"}) {
    add(rows, bodies, scheme, {.scheme = scheme});
  }
  const Problem bodies_at_large{.name = "13 bodies, loops, L, h = 0.2",
                                .model = planar_bodies(13),
                                .conserved = Conserved::invariant,
                                .h = 0.2,
                                .start = kDisk};
  add(rows, bodies_at_large, "midpoint", {});
  add(rows, bodies_at_large, "midpoint, Newton", {.solver = "newton"});
  add(rows, bodies_at_large, "stormer-verlet", {.scheme = "stormer-verlet"});
  return rows;
}

}  // namespace hamgen::drift
