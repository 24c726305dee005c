// Headers of a batch: a lane is bit for bit the trajectory alone, whatever goes on beside it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "generator/base/diagnostic.hpp"
#include "tests/emitted/batch_cases.hpp"

namespace hamgen::emitted_test {
namespace {

struct Instructions {
  const char* name;
  std::vector<std::string> flags;
  bool there;
};

std::vector<Instructions> instructions() {
  std::vector<Instructions> all = {{"portable", {"-ffp-contract=off"}, true}};
#if defined __x86_64__
  all.push_back({"avx2",
                 {"-ffp-contract=off", "-mavx2", "-mfma", "-O2"},
                 __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0});
  all.push_back(
      {"avx512",
       {"-ffp-contract=off", "-mavx512f", "-mavx512dq", "-O2"},
       __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0});
#endif
  return all;
}

class BatchLanes : public testing::TestWithParam<BatchCase> {};
INSTANTIATE_TEST_SUITE_P(Explicit, BatchLanes, testing::ValuesIn(explicit_cases()),
                         [](const auto& instance) { return instance.param.name; });
INSTANTIATE_TEST_SUITE_P(Implicit, BatchLanes, testing::ValuesIn(implicit_cases()),
                         [](const auto& instance) { return instance.param.name; });
INSTANTIATE_TEST_SUITE_P(Iterated, BatchLanes, testing::ValuesIn(iterated_cases()),
                         [](const auto& instance) { return instance.param.name; });
class ExplicitBatch : public testing::TestWithParam<BatchCase> {};
INSTANTIATE_TEST_SUITE_P(Cases, ExplicitBatch, testing::ValuesIn(explicit_cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(BatchLanes, AreBitForBitTheTrajectoryAloneWhateverTheWidthAndTheInstructions) {
  const std::vector<int>& widths = GetParam().widths;
  const std::string program = batch_program(GetParam(), widths, "");
  std::vector<std::string> alone;
  for (const Instructions& set : instructions()) {
    if (!set.there) continue;
    const std::vector<std::string> lines = batch_lines(run_program(program, set.flags));
    ASSERT_EQ(lines.size(), 8 * widths.size());
    if (alone.empty()) alone.assign(lines.begin(), lines.begin() + 8);
    EXPECT_EQ(failed_lines(alone), GetParam().failing);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(lines[i], alone[i % 8]) << set.name << ", width " << widths[i / 8];
    }
  }
}

// All of them, and if one is refused in lanes then for a reason that it has alone, too.
class BatchSweep : public testing::TestWithParam<BatchCase> {};
INSTANTIATE_TEST_SUITE_P(Schemes, BatchSweep, testing::ValuesIn(swept_cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(BatchSweep, IsBitForBitTheTrajectoryAlone) {
  const BatchCase& test = GetParam();
  try {
    static_cast<void>(emit(make_source("m.ham", test.model), test.request));
  } catch (const UsageError& error) {
    GTEST_SKIP() << error.what();
  }
  const std::vector<std::string> lines =
      batch_lines(run_program(batch_program(test, test.widths, ""), {"-ffp-contract=off", "-O0"}));
  ASSERT_EQ(lines.size(), 8 * test.widths.size());
  EXPECT_LT(failed_lines(lines), static_cast<long>(lines.size()));
  for (std::size_t i = 8; i < lines.size(); ++i) EXPECT_EQ(lines[i], lines[i % 8]);
}

// With functions of the library it is the header of one trajectory, if no step of it is decided by
// an iteration: the state, and the last good one of those that fail.
TEST_P(ExplicitBatch, IsBitForBitTheHeaderOfOneTrajectoryWithFunctionsOfTheLibrary) {
  const BatchCase& test = GetParam();
  Request request = test.request;
  request.name_space = "one::method";
  const std::string one =
      without_pragma(emit(make_source(test.name + ".ham", test.model), request)[0].text);
  std::string program = batch_program(test, {4}, "libm");
  const std::string alone = fmt::format(
      R"(  for (int i = 0; i < 8; ++i) {{
    one::method::Propagator method(one::Parameters(), {}, one::State{{starts[i].q, starts[i].p}});
    const bool runs = method.advance({}).converged;
    double cq = 0, cp = 0;
    {}
    print(i, runs, method.time(), method.state().q, method.state().p, cq, cp);
    print_other(&cq, 0);
  }}
}}
)",
      test.h, test.steps,
      request.plain_sums ? "" : "cq = method.carry().q; cp = method.carry().p;");
  program.replace(program.rfind("}"), 1, alone);
  const std::vector<std::string> lines = batch_lines(run_program(one + program));
  ASSERT_EQ(lines.size(), 16u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(lines[i], lines[i + 8]);
}

// An iteration ends within some units of rounding of h |p| < 1, in both headers at others: 200
// steps of 5e-16 or less, of which the phase of an orbit makes up to t = 40 times as much: 4e-12.
TEST(BatchHeader, AgreesWithTheHeaderOfOneTrajectoryToRoundingWhereItIterates) {
  const BatchCase test = implicit_cases()[0];
  Request request = test.request;
  request.name_space = "one::method";
  const std::string text = without_pragma(emit(make_source("l.ham", test.model), request)[0].text) +
                           batch_header(test, 4, "libm") + R"(
#include <cstdio>
int main() {
  const double q[] = {1, 0.5, 1.5, 0.7}, p[] = {0, 1, 0.5, 0.7};
  lanes4::State z;
  for (int i = 0; i < 4; ++i) { z.q.set(i, q[i]); z.p.set(i, p[i]); }
  lanes4::method::Propagator lanes(lanes4::Parameters(), 0.2, z);
  lanes.advance(200);
  double worst = 0;
  for (int i = 0; i < 4; ++i) {
    one::method::Propagator alone(one::Parameters(), 0.2, one::State{q[i], p[i]});
    if (!alone.advance(200).converged || !lanes.running()[i]) std::puts("failed");
    worst = std::fmax(worst, std::fabs(alone.state().q - lanes.state().q[i]));
    worst = std::fmax(worst, std::fabs(alone.state().p - lanes.state().p[i]));
  }
  std::printf("%s %g\n", worst < 4e-12 ? "agree" : "differ by", worst);
}
)";
  const std::string said = run_program(text);
  EXPECT_TRUE(said.starts_with("agree")) << said;
}

// Parameters and step sizes differ from lane to lane; a propagator begins anew.
TEST(BatchHeader, HasParametersAndStepSizesOfEachLane) {
  const BatchCase test = explicit_cases()[0];
  std::string text = batch_header(test, 1, "") + batch_header(test, 4, "") + R"(
#include <cstdio>
template <class Pack>
void differ(Pack& pack, const double* values, int first, int W) {
  for (int lane = 0; lane < W; ++lane) pack.set(lane, values[first + lane]);
}
template <class Propagator, class Parameters, class State, class Real>
void run() {
  constexpr int W = Propagator::lanes;
  const double a[] = {0.1, 1.0 / 3, -0.7, 5}, h[] = {0.1, -0.2, 0.01, 0.3}, q[] = {0.1, 2, 0.3, -0.4};
  for (int i = 0; i < 4; i += W) {
    Parameters parameters;
    Real length;
    State z;
    differ(parameters.a, a, i, W);
    differ(length, h, i, W);
    differ(z.q, q, i, W);
    State other;
    other.p = 0.25;
    Propagator method(parameters, length, other);
    method.advance(3);
    method.reset(z);
    method.advance(100);
    auto stepped = z;
    const auto report = step(parameters, length, stepped);
    for (int lane = 0; lane < W; ++lane) {
      std::printf("%d t=%a q=%a p=%a H=%a step %d %a\n", i + lane, method.time()[lane],
                  method.state().q[lane], method.state().p[lane],
                  energy(parameters, method.state())[lane], int(report.converged[lane]),
                  stepped.q[lane]);
    }
  }
}
int main() {
  {
    using namespace lanes1;
    using method::step;
    run<method::Propagator, Parameters, State, Real>();
  }
  run<lanes4::method::Propagator, lanes4::Parameters, lanes4::State, lanes4::Real>();
}
)";
  text.replace(text.find("template <class Pack>\nvoid"), 0,
               "using lanes1::method::step;\nusing lanes4::method::step;\n");
  const std::vector<std::string> lines = batch_lines(run_program(text));
  ASSERT_EQ(lines.size(), 8u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(lines[i], lines[i + 4]);
  EXPECT_NE(lines[0].substr(2), lines[1].substr(2));
}

std::string refusal(Request request, const std::string& model = functions_model()) {
  try {
    (void)emit(make_source("cubic.ham", model), request);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BatchHeader, IsRefusedWithAWayOutWhereThereAreNoLanes) {
  Request request;
  request.scheme = "stormer-verlet";
  request.batch = 3;
  EXPECT_TRUE(refusal(request).starts_with("--batch 3: not 1, 2, 4, ..., 256\nhelp: "));
  request.batch = 512;
  EXPECT_TRUE(refusal(request).starts_with("--batch 512: not 1, 2, 4, ..., 256\nhelp: "));
  request.batch = 8;
  try {
    request.math = "fast";
    ADD_FAILURE() << "--math fast is there";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "--math fast: there are own and libm");
  }
  request.math = "libm";
  request.scalar = "quad";
  EXPECT_EQ(refusal(request), "--batch: lanes are of double numbers\nhelp: drop --scalar");
  request.scalar = "";
  request.support = "shared";
  EXPECT_TRUE(refusal(request).starts_with("--batch: its fixed parts are in the header itself\n"));
  request.support = "";
  request.tangent = true;
  EXPECT_EQ(refusal(request), "--batch: there is no tangent map in lanes\nhelp: drop --tangent");
  request.tangent = false;
  request.format = "cpp-plugin";
  EXPECT_EQ(refusal(request),
            "--batch: a plugin has no lanes\nhelp: --format cpp-header or cmake-package");
  request.format = "c-header";
  EXPECT_TRUE(refusal(request).starts_with("--format c-header: there are no lanes in C\nhelp: "));
  request.format = "cmake-package";
  EXPECT_EQ(refusal(request), "accepted");
  request.batch = 0;
  EXPECT_TRUE(refusal(request).starts_with(
      "--math: is of the elementary functions of a batch, and of stages"));
}

// Its namespaces meet those of the header of one trajectory in one program.
TEST(BatchHeader, StandsBesideTheHeaderOfOneTrajectoryAndOtherWidths) {
  std::string text;
  for (const int lanes : {0, 2, 8}) {
    Request request;
    request.scheme = "stormer-verlet";
    request.batch = lanes;
    text += without_pragma(emit(make_source("f.ham", functions_model()), request)[0].text);
  }
  text += "functions::batch_8::State z; functions::State one; functions::batch_2::State two;\n";
  for (const std::string& compiler : compilers()) EXPECT_EQ(messages(compiler, text), "");
}

TEST(BatchHeader, TakesNoNameFromTheUser) {
  const std::string model =
      "system lanes\ncoordinate any, select, lane_sin\nmomentum moving, Mask, part\n"
      "parameter running = 1\nparameter require_finite = 2\n"
      "H = (moving^2 + Mask^2 + part^2)*(1 + any^2)/2 + running*sin(select) "
      "+ require_finite*any^2*exp(lane_sin)\n";
  const std::string iterated =
      "system lanes\ncoordinate tried, found, turn\nmomentum Turn, Iteration, library\n"
      "parameter collect_lanes = 1\n"
      "H = (Turn^2 + Iteration^2 + library^2)/2 + collect_lanes*sin(tried*found)*cos(turn)\n";
  Request newton;
  newton.solver = "newton";
  Request libm = newton;
  libm.math = "libm";
  Request fixed_point;
  fixed_point.solver = "fixed-point";
  Request gauss;
  gauss.scheme = "gauss-4";
  for (const auto& [request, text] :
       {std::pair(newton, model), std::pair(libm, model), std::pair(fixed_point, iterated),
        std::pair(gauss, iterated)}) {
    Request lanes = request;
    lanes.batch = 2;
    const std::string header = emit(make_source("lanes.ham", text), lanes)[0].text;
    EXPECT_EQ(messages("g++", without_pragma(header)), "");
  }
}

// Of every kind of iteration and matrix, for every compiler.
TEST(BatchHeader, OfIterationsCompilesWithoutAWarning) {
  std::string text;
  for (const BatchCase& test : iterated_cases()) {
    Request request = test.request;
    request.batch = 4;
    request.name_space = test.name + "::method";
    text += without_pragma(emit(make_source("m.ham", test.model), request)[0].text);
  }
  for (const std::string& compiler : compilers()) EXPECT_EQ(messages(compiler, text), "");
}

TEST(BatchHeader, GivesNewtonAsManyStepsAsOneTrajectoryDoes) {
  const SourceText chain =
      make_source("chain.ham",
                  "system chain\nsize N = 40\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\n"
                  "momentum p[1..N]\n"
                  "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^4/4)\n");
  const std::string one = emit(chain, {})[0].text;
  const std::string lanes = emit(chain, {.batch = 4})[0].text;
  EXPECT_NE(one.find("start.patience = 32;"), std::string::npos);
  EXPECT_NE(lanes.find("start.patience = select(start.turn.lanes, Real(32), start.patience);"),
            std::string::npos);
}

TEST(BatchHeader, SaysThatItsTextIsProved) {
  Request request;
  request.scheme = "stormer-verlet";
  request.batch = 2;
  request.require = "emitted-code";
  const std::string text = generate(make_source("f.ham", functions_model()), request)[0].text;
  EXPECT_NE(text.find("//   proved    symplectic, symmetric, order 2, emitted code\n"),
            std::string::npos);
}

}  // namespace
}  // namespace hamgen::emitted_test
