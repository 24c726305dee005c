#include "benchmarks/drift/measure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "benchmarks/emitted_program.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen::drift {

namespace {

// What the emitted headers know by these names: rounded, exact, h, quantity, start, steps, starts,
// seconds.
constexpr const char* kProgram = R"(
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

using Quad = __float128;
constexpr int size = sizeof(rounded::State) / sizeof(double);
static_assert(sizeof(exact::State) == size * sizeof(Quad));

static std::uint64_t seed = 0;
static double uniform() {{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (seed >> 11) * 0x1p-52 - 1;
}}

static exact::Parameters exact_parameters(const rounded::Parameters& par) {{
  exact::Parameters result;
  constexpr int count = sizeof(rounded::Parameters) / sizeof(double);
  double values[count + 1];
  Quad wide[count + 1];
  std::memcpy(values, &par, count * sizeof(double));
  for (int i = 0; i < count; ++i) wide[i] = values[i];
  std::memcpy(static_cast<void*>(&result), wide, count * sizeof(Quad));
  return result;
}}

static Quad conserved(const exact::Parameters& par, Quad h, const Quad (&z)[size]) {{
  exact::State state;
  std::memcpy(static_cast<void*>(&state), z, sizeof z);
  {quantity}
}}

static Quad conserved(const exact::Parameters& par, double h, const rounded::Propagator& run) {{
  double hi[size], lo[size];
  std::memcpy(hi, &run.state(), sizeof hi);
  std::memcpy(lo, &run.carry(), sizeof lo);
  Quad z[size];
  for (int i = 0; i < size; ++i) z[i] = Quad(hi[i]) + lo[i];
  return conserved(par, Quad(h), z);
}}

static double now() {{
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}}

int main() {{
  const double h = {h};
  const long long steps = {steps};
  const rounded::Parameters par;
  const exact::Parameters exact_par = exact_parameters(par);
  double running = 0;
  for (int s = 0; s < {starts} && (s < 4 || running < {seconds}); ++s) {{
    seed = 7919u * s + 13;
    for (int i = 0; i < 10; ++i) uniform();
    double z[size];
    {start}
    rounded::State state;
    std::memcpy(static_cast<void*>(&state), z, sizeof z);
    rounded::Propagator run(par, h, state);
    const Quad before = conserved(exact_par, h, run);
    double errors[2];
    for (double& error : errors) {{
      const double begin = now();
      if (!run.advance(steps / 2).converged) return 1;
      running += now() - begin;
      const Quad change = conserved(exact_par, h, run) - before;
      error = double(change / (before < 0 ? -before : before));
    }}
    std::printf("%.17g %.17g %.17g\n", errors[0], errors[1], running);
  }}
}}
)";

std::string quantity_text(Conserved conserved) {
  switch (conserved) {
    case Conserved::form:
      return R"(exact::State next = state;
  if (!exact::step(par, h, next).converged) return Quad(0) / 0;
  Quad Z[size];
  std::memcpy(Z, &next, sizeof Z);
  Quad sum = 0;
  for (int i = 0; i < size / 2; ++i) sum += z[i] * Z[size / 2 + i] - z[size / 2 + i] * Z[i];
  return sum;)";
    case Conserved::energy:
      return "return exact::energy(par, state);";
    case Conserved::invariant:
      return R"(Quad values[64];
  exact::invariants(par, state, *reinterpret_cast<Quad (*)[exact_invariants]>(values));
  return values[0];)";
  }
  return "";
}

std::string solver_of(const std::string& header) {
  const std::size_t begin = header.find("//   solve     ");
  if (begin == std::string::npos) return "";
  return header.substr(begin + 15, header.find('\n', begin) - begin - 15);
}

}  // namespace

double Result::units() const {
  return mean / (std::numeric_limits<double>::epsilon() * static_cast<double>(steps));
}

bool Result::drifts() const {
  return !(std::abs(mean) <= 4 * standard_error) && !(std::abs(units()) <= 1e-4);
}

Result measure(const Row& row, long long steps, int starts, double seconds, const Edit& edit) {
  const std::string rounded = emitted_header(row.model, row.request, "double", "rounded");
  const std::size_t invariants =
      read_request(make_source("drift.ham", row.model), row.request).invariants.size();
  const std::string program =
      fmt::format("constexpr int exact_invariants = {};\n", std::max<std::size_t>(invariants, 1)) +
      fmt::format(fmt::runtime(kProgram), fmt::arg("quantity", quantity_text(row.conserved)),
                  fmt::arg("h", row.h), fmt::arg("steps", steps), fmt::arg("starts", starts),
                  fmt::arg("seconds", seconds), fmt::arg("start", row.start));
  std::istringstream output(
      output_of_program({{"rounded.hpp", edit ? edit(rounded) : rounded},
                         {"exact.hpp", emitted_header(row.model, row.request, "quad", "exact")}},
                        program));
  Result result{.steps = steps / 2 * 2, .solver = solver_of(rounded)};
  double squares = 0.0;
  double running = 0.0;
  for (double half = 0.0, all = 0.0; output >> half >> all >> running; ++result.starts) {
    result.first_mean += half;
    result.mean += all;
    squares += all * all;
  }
  if (result.starts < 2) throw std::runtime_error("too few starts");
  result.first_mean /= result.starts;
  result.mean /= result.starts;
  const double variance = std::max(0.0, squares / result.starts - result.mean * result.mean);
  result.standard_error = std::sqrt(variance / (result.starts - 1));
  result.nanoseconds = 1e9 * running / (static_cast<double>(result.steps) * result.starts);
  return result;
}

}  // namespace hamgen::drift
