#include "benchmarks/drift/measure.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "benchmarks/emitted_program.hpp"
#include "generator/base/source_text.hpp"

namespace hamgen::drift {

namespace {

constexpr int kParts = 16;  // of a run

// What the emitted headers know by these names: rounded, exact, scalar, h, quantity, start, steps,
// starts, seconds, lanes.  Numbers of a batch are in memory one after another, lane by lane.
constexpr const char* kProgram = R"(
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <vector>

using Number = {scalar};
using Quad = __float128;
constexpr int lanes = {lanes};
constexpr int size = sizeof(rounded::State) / sizeof(Number) / lanes;
static_assert(sizeof(exact::State) == size * sizeof(Quad));

static std::uint64_t seed = 0;
static double uniform() {{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (seed >> 11) * 0x1p-52 - 1;
}}

static exact::Parameters exact_parameters(const rounded::Parameters& par) {{
  exact::Parameters result;
  constexpr int count = sizeof(rounded::Parameters) / sizeof(Number) / lanes;
  Number values[count * lanes + 1];
  Quad wide[count + 1];
  std::memcpy(values, &par, count * lanes * sizeof(Number));
  for (int i = 0; i < count; ++i) wide[i] = values[i * lanes];
  std::memcpy(static_cast<void*>(&result), wide, count * sizeof(Quad));
  return result;
}}

static Quad conserved(const exact::Parameters& par, Quad h, const Quad (&z)[size]) {{
  exact::State state;
  std::memcpy(static_cast<void*>(&state), z, sizeof z);
  {quantity}
}}

static Quad conserved(const exact::Parameters& par, Number h, const rounded::Propagator& run,
                      int lane) {{
  Number hi[size * lanes], lo[size * lanes];
  std::memcpy(hi, &run.state(), sizeof hi);
  std::memcpy(lo, &run.carry(), sizeof lo);
  Quad z[size];
  for (int i = 0; i < size; ++i) z[i] = Quad(hi[i * lanes + lane]) + lo[i * lanes + lane];
  return conserved(par, Quad(h), z);
}}

static void put_start(int s, int lane, Number (&all)[size * lanes]) {{
  seed = 7919u * s + 13;
  for (int i = 0; i < 10; ++i) uniform();
  double z[size];
  {start}
  for (int i = 0; i < size; ++i) all[i * lanes + lane] = z[i];
}}

static bool is_true(bool all_done) {{ return all_done; }}
template <class Mask>
static bool is_true(const Mask& mask) {{
  for (int lane = 0; lane < lanes; ++lane) {{
    if (!mask[lane]) return false;
  }}
  return true;
}}

static double now() {{
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}}

int main() {{
  const Number h = {h};
  const long long steps = {steps};
  const rounded::Parameters par;
  const exact::Parameters exact_par = exact_parameters(par);
  double running = 0;
  for (int s = 0; s < {starts} && (s < 4 || running < {seconds}); s += lanes) {{
    Number z[size * lanes];
    for (int lane = 0; lane < lanes; ++lane) put_start(s + lane, lane, z);
    rounded::State state;
    std::memcpy(static_cast<void*>(&state), z, sizeof z);
    const auto made = std::make_unique<rounded::Propagator>(par, h, state);
    rounded::Propagator& run = *made;
    Quad before[lanes];
    for (int lane = 0; lane < lanes; ++lane) before[lane] = conserved(exact_par, h, run, lane);
    double errors[lanes][{parts}];
    for (int part = 0; part < {parts}; ++part) {{
      const double begin = now();
      if (!is_true(run.advance(steps).converged)) return 1;
      running += now() - begin;
      for (int lane = 0; lane < lanes; ++lane) {{
        const Quad change = conserved(exact_par, h, run, lane) - before[lane];
        errors[lane][part] = double(change / (before[lane] < 0 ? -before[lane] : before[lane]));
      }}
    }}
    for (int lane = 0; lane < lanes && s + lane < {starts}; ++lane) {{
      for (const double error : errors[lane]) std::printf("%.17g ", error);
      std::printf("%.17g\n", running);
    }}
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

// What the starts' errors after each of their parts say of random walks: of starts that have no
// rate of their own the mean change of a part has, from start to start, the variance that the
// changes of one start have over their number.
void compare_starts(const std::vector<std::vector<double>>& errors, Result& result) {
  double between = 0.0;
  double within = 0.0;
  for (const std::vector<double>& error : errors) {
    const double rate = error.back() / kParts;
    between += rate * rate / result.starts;
    double last = 0.0;
    for (const double now : error) {
      const double off = now - last - rate;
      within += off * off / (result.starts * (kParts - 1.0));
      last = now;
    }
  }
  if (!(within > 0.0)) return;
  const boost::math::fisher_f_distribution<double> by_chance(result.starts,
                                                             result.starts * (kParts - 1.0));
  result.chance = boost::math::cdf(boost::math::complement(by_chance, kParts * between / within));
  const double steps = static_cast<double>(result.steps) / kParts;
  result.own_rate = std::sqrt(std::max(0.0, between - within / kParts)) / (result.unit * steps);
}

}  // namespace

double Result::units() const { return mean / (unit * static_cast<double>(steps)); }

bool Result::drifts() const {
  const bool of_all = !(std::abs(mean) <= 4 * standard_error) && !(std::abs(units()) <= 1e-4);
  // 4 standard errors of a normal distribution.
  const bool of_each = own_rate > 1e-4 && chance < 6.3e-5;
  return of_all || of_each;
}

Result measure(const Row& row, const Length& length, const Edit& edit,
               const std::vector<std::string>& flags) {
  Request request = row.request;
  if (length.lanes > 1) request.batch = length.lanes;
  const std::string rounded = emitted_header(row.model, request, row.scalar, "rounded");
  const std::size_t invariants =
      read_request(make_source("drift.ham", row.model), row.request).invariants.size();
  const long long part = std::max<long long>(length.steps / kParts, 1);
  const std::string program =
      fmt::format("constexpr int exact_invariants = {};\n", std::max<std::size_t>(invariants, 1)) +
      fmt::format(fmt::runtime(kProgram), fmt::arg("quantity", quantity_text(row.conserved)),
                  fmt::arg("scalar", row.scalar), fmt::arg("h", row.h), fmt::arg("steps", part),
                  fmt::arg("parts", kParts), fmt::arg("starts", length.starts),
                  fmt::arg("seconds", length.seconds), fmt::arg("lanes", length.lanes),
                  fmt::arg("start", row.start));
  std::istringstream output(
      output_of_program({{"rounded.hpp", edit ? edit(rounded) : rounded},
                         {"exact.hpp", emitted_header(row.model, row.request, "quad", "exact")}},
                        program, flags));
  Result result{.steps = part * kParts, .solver = solver_of(rounded)};
  if (row.scalar == "float") result.unit = std::numeric_limits<float>::epsilon();
  std::vector<std::vector<double>> errors;
  double squares = 0.0;
  double running = 0.0;
  for (std::vector<double> error(kParts);; errors.push_back(error), ++result.starts) {
    for (double& value : error) output >> value;
    if (!(output >> running)) break;
    result.mean += error.back();
    squares += error.back() * error.back();
  }
  if (result.starts < 2) throw std::runtime_error("too few starts");
  result.mean /= result.starts;
  const double variance = std::max(0.0, squares / result.starts - result.mean * result.mean);
  result.standard_error = std::sqrt(variance / (result.starts - 1));
  result.nanoseconds = 1e9 * running / (static_cast<double>(result.steps) * result.starts);
  compare_starts(errors, result);
  return result;
}

}  // namespace hamgen::drift
