#include "tests/emitted/batch_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <sstream>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen::emitted_test {

namespace {

// The steps of a cubic well run away on one side of its barrier, sooner or later.
const char* const kCubic =
    "system cubic\ncoordinate q\nmomentum p\nparameter a = 1/3\n"
    "H = p^2/2 + q^2/2 - a*q^3\n";
const Starts kCubicStarts = {{0.1, 0.2}, {1.5, 0}, {-0.3, 0.4}, {1.001, 0},
                             {0.9, 0.1}, {3, 1},   {0, 0},      {0.5, -0.3}};
const char* const kFunctions =
    "system functions\ncoordinate q\nmomentum p\nparameter a = 1/2\n"
    "H = p^2/2 + exp(a*q) - q - cos(3*q) + sqrt(1 + q^2) + a*q^2\n";
const char* const kLogarithm =
    "system logarithm\ncoordinate q\nmomentum p\nH = p^2/2 - log(q) + q^(5/2)/7\n";
const Starts kLogarithmStarts = {{1, 0},    {0.5, 1},   {-1, 0},      {2, -3},
                                 {0.01, 0}, {1.5, 0.5}, {1e-300, -1}, {0.7, 0.7}};

// Newton's iteration: of size 1, of 2 without a separable H, with a matrix, and in substeps. Beyond
// q = 2 there is no force: some lanes begin there, some come there, from a prediction too.
const char* const kMixed =
    "system mixed\ncoordinate q\nmomentum p\nparameter a = 1/2\n"
    "H = (1 + q^2)*(1 + p^2)/2 + a*sin(q)*p - sqrt(2 - q)*(2 - q)/2\n";
const Starts kMixedStarts = {{0.1, 0.2}, {1.9, 1.5},  {-0.3, 0.4}, {2.5, 0},
                             {1, 3},     {0.9, -2.6}, {0, 0},      {0.5, -0.3}};
const char* const kCoupled =
    "system coupled\ncoordinate q, r, s\nmomentum p, u, v\nparameter a = 1/2\n"
    "H = (p^2 + u^2*(1 + q^2) + v^2)/2 + a*(q - r)^4 + sqrt(1 + q^2 + s^2) + (q^2 + r^2)/2 "
    "- a*sin(p*v)/2 - cos(s*q) - sqrt(2 - q)*(2 - q)/4\n";

// Fixed points, stages, and systems in loops: chains whose first particle is plucked so hard in
// some lanes that it goes where there is no force.
const char* const kChain =
    "system chain\nsize N = 26\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
    "momentum p[1..N]\nparameter a = 1/4\n"
    "H = sum(i = 1..N, p[i]^2/2 + q[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 "
    "- a*sqrt(3 - q[i+1] + q[i])*(q[i+1] - q[i]))\n";
const char* const kRing =
    "system ring\nsize N = 26\ncoordinate q[1..N] periodic\nmomentum p[1..N]\nparameter a = 1/4\n"
    "H = sum(i = 1..N, p[i]^2*(1 + a*q[i]^2)/2 + q[i]^4/4 - sqrt(3 - q[i]) + cos(q[i+1] - q[i]))"
    "\n";
const char* const kField =
    "system field\nsize N = 26\ncoordinate q[1..N], f\nmomentum p[1..N], J\nparameter a = 1/4\n"
    "H = sum(i = 1..N, p[i]^2*(1 + a*q[i]^2)/2 + q[i]^4/4 - sqrt(3 - q[i])) + J^2/2"
    " - (2 + sin(J))*sum(i = 1..N, cos(q[i] - f))/8\n";
const Starts kPlucked = {{0.1, 0.2}, {1.5, 0.5}, {-0.3, 0.4}, {4, 0},
                         {1, 9},     {0.9, -12}, {0, 0},      {2.5, 2.5}};

BatchCase in_loops(const std::string& name, const char* model, const Request& request, double h,
                   int failing) {
  return {name, model, request, h, 100, kPlucked, failing, {1, 4}, "q[0]", "p[0]"};
}

const char* const kPrintBatch = R"(
#include <cstdio>
#include <memory>
struct Start { double q, p; };
void print(int i, bool running, double time, double q, double p, double cq, double cp) {
  std::printf("%d %s t=%a q=%a p=%a carry %a %a", i, running ? "runs" : "failed", time, q, p, cq, cp);
}
void print_other(const double* numbers, int count) {
  // The sign of NaN is anyone's.
  for (int i = 0; i < count; ++i) {
    numbers[i] == numbers[i] ? std::printf(" %a", numbers[i]) : std::printf(" nan");
  }
  std::printf("\n");
}
template <class T>
auto carried(const T& method, int lane, bool q, int) -> decltype(static_cast<void>(method.carry()), double()) {
  return q ? method.carry().Q[lane] : method.carry().P[lane];
}
template <class T>
double carried(const T&, int, bool, long) {
  return 0;
}
template <class Propagator, class Parameters, class State>
void run(const Start* starts, int count, double h, int steps, bool compare_reports) {
  constexpr int W = Propagator::lanes;
  for (int i = 0; i < count; i += W) {
    const auto z = std::make_unique<State>();
    for (int lane = 0; lane < W; ++lane) {
      z->Q.set(lane, starts[i + lane].q);
      z->P.set(lane, starts[i + lane].p);
    }
    const auto kept = std::make_unique<Propagator>(Parameters(), h, *z);
    Propagator& method = *kept;
    const auto report = method.advance(steps);
    for (int lane = 0; lane < W; ++lane) {
      if (report.converged[lane] != method.running()[lane]) std::printf("another report\n");
      print(i + lane, method.running()[lane], method.time()[lane], method.state().Q[lane],
            method.state().P[lane], carried(method, lane, true, 0), carried(method, lane, false, 0));
      const double other[] = {report.iterations[lane], report.increment[lane]};
      print_other(other, compare_reports ? 2 : 0);
    }
  }
}
)";

std::string starts_text(const BatchCase& test) {
  std::string text = "const Start starts[] = {";
  for (const auto& [q, p] : test.starts) text += fmt::format("{{{}, {}}}, ", q, p);
  return text + "};\n";
}

}  // namespace

void PrintTo(const BatchCase& test, std::ostream* out) { *out << test.name; }

const char* functions_model() { return kFunctions; }

std::vector<BatchCase> explicit_cases() {
  Request verlet;
  verlet.scheme = "stormer-verlet";
  Request yoshida;
  yoshida.scheme = "yoshida-4-verlet";
  Request euler;
  euler.scheme = "symplectic-euler-b";
  euler.plain_sums = true;
  return {{"Verlet", kCubic, verlet, 0.1, 200, kCubicStarts, 4},
          {"Composition", kLogarithm, yoshida, 0.05, 200, kLogarithmStarts, 4},
          {"PlainSums", kFunctions, euler, 0.05, 200, kCubicStarts, 0}};
}

std::vector<BatchCase> implicit_cases() {
  Request newton;
  newton.solver = "newton";
  Request composed = newton;
  composed.scheme = "yoshida-4";
  composed.plain_sums = true;
  Request member = newton;
  member.alpha = "3/10";
  return {{"Newton", kLogarithm, newton, 0.2, 200, kLogarithmStarts, 3, {1, 8}},
          {"NewtonOfTwo", kMixed, newton, 0.05, 200, kMixedStarts, 4},
          {"NewtonWithAMatrix", kCoupled, member, 0.05, 150, kMixedStarts, 2},
          {"NewtonInSubsteps", kMixed, composed, 0.05, 100, kMixedStarts, 4}};
}

std::vector<BatchCase> iterated_cases() {
  Request fixed_point;
  fixed_point.solver = "fixed-point";
  Request gauss;
  gauss.scheme = "gauss-4";
  Request gauss_newton;
  gauss_newton.scheme = "gauss-6";
  gauss_newton.solver = "newton";
  Request gauss_fixed = fixed_point;
  gauss_fixed.scheme = "gauss-8";
  Request newton;
  newton.solver = "newton";
  Request composed;
  composed.scheme = "suzuki-4";
  Request raised;
  raised.order = 4;
  return {{"FixedPoint", kMixed, fixed_point, 0.05, 100, kMixedStarts, 4, {1, 4}},
          {"FixedPointOfThree", kCoupled, fixed_point, 0.05, 100, kMixedStarts, 2},
          {"Gauss", kMixed, gauss, 0.2, 100, kMixedStarts, 4, {1, 4}},
          {"GaussOfSecondOrder", kCubic, gauss, 0.3, 100, kCubicStarts, 4},
          {"GaussByNewton", kCoupled, gauss_newton, 0.1, 100, kMixedStarts, 3},
          {"GaussByFixedPoint", kLogarithm, gauss_fixed, 0.1, 100, kLogarithmStarts, 4},
          in_loops("Chain", kChain, {}, 0.6, 3),
          in_loops("ChainByNewton", kChain, newton, 0.2, 3),
          in_loops("ChainByFixedPoint", kChain, fixed_point, 0.2, 3),
          in_loops("ChainByGauss", kChain, gauss, 0.4, 3),
          in_loops("ChainInSubsteps", kChain, composed, 0.4, 3),
          in_loops("ChainOfOrderFour", kChain, raised, 0.4, 3),
          in_loops("Ring", kRing, {}, 0.2, 3),
          in_loops("RingByNewton", kRing, newton, 0.1, 3),
          in_loops("RingByFixedPoint", kRing, fixed_point, 0.1, 3),
          in_loops("FieldByNewton", kField, newton, 0.1, 3),
          in_loops("RingByGauss", kRing, gauss_newton, 0.2, 4)};
}

std::vector<BatchCase> swept_cases() {
  std::vector<BatchCase> cases;
  const auto add = [&](const std::string& scheme, const std::string& solver,
                       const std::string& name) {
    Request request;
    request.scheme = scheme;
    request.solver = solver;
    const std::vector<int> widths = {1, 4};
    cases.push_back({name + "_mixed", kMixed, request, 0.1, 40, kMixedStarts, 0, widths});
    cases.push_back({name + "_functions", kFunctions, request, 0.1, 40, kCubicStarts, 0, widths});
    cases.push_back(
        {name + "_chain", kChain, request, 0.2, 40, kPlucked, 0, widths, "q[0]", "p[0]"});
  };
  for (const Scheme& scheme : all_schemes()) {
    std::string name = scheme.name;
    std::ranges::replace(name, '-', '_');
    add(scheme.name, "", name);
  }
  for (const char* scheme :
       {"implicit-midpoint", "symplectic-euler-a", "mclachlan-4", "gauss-2", "gauss-10"}) {
    std::string name = scheme;
    std::ranges::replace(name, '-', '_');
    add(scheme, "newton", name + "_newton");
    add(scheme, "fixed-point", name + "_fixed_point");
  }
  return cases;
}

std::string batch_header(const BatchCase& test, int lanes, const std::string& math) {
  Request request = test.request;
  request.batch = lanes;
  request.math = math;
  request.name_space = fmt::format("lanes{}::method", lanes);
  return without_pragma(emit(make_source(test.name + ".ham", test.model), request)[0].text);
}

std::string batch_program(const BatchCase& test, const std::vector<int>& widths,
                          const std::string& math) {
  std::string headers;
  std::string calls;
  for (const int lanes : widths) {
    headers += batch_header(test, lanes, math);
    calls += fmt::format(
        "  run<lanes{0}::method::Propagator, lanes{0}::Parameters, lanes{0}::State>(starts, 8, "
        "{1}, {2}, {3});\n",
        lanes, test.h, test.steps, math != "libm");
  }
  return headers + fmt::format("#define Q {}\n#define P {}\n", test.q, test.p) + kPrintBatch +
         "int main() {\n" + starts_text(test) + calls + "}\n";
}

std::vector<std::string> batch_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

long failed_lines(const std::vector<std::string>& lines) {
  return std::ranges::count_if(lines, [](const auto& line) { return count(line, "failed") > 0; });
}

}  // namespace hamgen::emitted_test
