// Several emitted headers in one program: what they share, and what they must not.
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

const std::string root = HAMGEN_SOURCE_DIR;

const std::string chain =
    "system chain\nsize N = 30\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 - cos(q[i+1] - q[i]))\n";
// Coordinates with the names of the emitted code's own objects.
const std::string named =
    "system named\ncoordinate z, dz\nmomentum par, k\nparameter carry = 2\n"
    "H = par^2/2 + k^2/2 - carry*cos(z - dz) + z^2/2\n";

// A folder of files that are compiled and linked as a program.
class Project {
 public:
  void add(const std::string& name, const std::string& text) {
    const std::filesystem::path path = directory_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    if (name.ends_with(".cpp")) sources_.push_back(path.string());
  }
  // What `hamgen generate` writes, into a folder.
  void generate_into(const std::string& folder, const SourceText& model, const Request& request) {
    for (const OutputFile& file : emit(model, request)) {
      add((std::filesystem::path(folder) / file.path).string(), file.text);
    }
  }
  // What the program prints, or what the compiler says.
  [[nodiscard]] std::string run() const {
    const std::string program = (directory_.path() / "program").string();
    std::vector<std::string> command{"g++"};
    for (const std::string& flag : strict_flags()) command.push_back(flag);
    command.insert(command.end(), {"-O1", "-o", program});
    command.insert(command.end(), sources_.begin(), sources_.end());
    command.emplace_back("-lquadmath");
    const runtime::ProcessResult compiled = run_process(command);
    if (!compiled.succeeded() || !compiled.output.empty()) return compiled.output;
    const runtime::ProcessResult ran = run_process({program});
    return ran.succeeded() ? ran.output : "failed:\n" + ran.output;
  }

 private:
  static runtime::ProcessResult run_process(const std::vector<std::string>& command) {
    return runtime::run_process(
        {.command = command, .time_limit = std::chrono::minutes(20), .output_limit = 1 << 20});
  }
  runtime::TemporaryDirectory directory_ = runtime::private_directory();
  std::vector<std::string> sources_;
};

SourceText pendulum() { return read_source(root + "/hamiltonians/pendulum.ham"); }

// Methods, members, scalars and sizes of one system side by side.  The second unit has another
// chain of the same name, which the linker must not take for the first.
TEST(Shape, ManyHeadersMeetInOneProgramAndShareTheirSystem) {
  Project project;
  project.generate_into("midpoint", pendulum(), {});
  project.generate_into("gauss", pendulum(), {.scheme = "gauss-4", .support = "shared"});
  project.generate_into("verlet", pendulum(), {.scheme = "stormer-verlet", .support = "shared"});
  project.generate_into("three_tenths", pendulum(), {.alpha = "3/10"});
  project.generate_into("two_fifths", pendulum(), {.alpha = "2/5"});
  project.generate_into("free", pendulum(), {.alpha = "alpha"});
  project.generate_into("quad", pendulum(), {.scalar = "quad"});
  project.generate_into("chain", make_source("chain.ham", chain), {});
  project.generate_into("composed", make_source("chain.ham", chain), {.scheme = "yoshida-4"});
  project.generate_into("chain_of_40", make_source("chain.ham", chain), {.sizes = {{"N", 40}}});
  project.generate_into("named", make_source("named.ham", named), {});
  project.generate_into("first", make_source("m.ham", chain), {.name_space = "m"});
  project.generate_into("second", make_source("m.ham", chain),
                        {.name_space = "m", .sizes = {{"N", 35}}});
  project.add("main.cpp", R"(#include <cstdio>
#include <cstring>
#include <type_traits>

#include "chain/chain.hpp"
#include "chain_of_40/chain.hpp"
#include "composed/chain.hpp"
#include "first/m.hpp"
#include "free/pendulum.hpp"
#include "gauss/pendulum.hpp"
#include "midpoint/pendulum.hpp"
#include "named/named.hpp"
#include "quad/pendulum.hpp"
#include "three_tenths/pendulum.hpp"
#include "two_fifths/pendulum.hpp"
#include "verlet/pendulum.hpp"

int size_of_the_other();

// A run, then from its end with another method, and that anew from the start.
template <class First, class Second, class Parameters, class State>
void meet(const char* name, const Parameters& par, const State& start) {
  First first(par, 0.1, start);
  if (!first.advance(10).converged) std::printf("%s: failed\n", name);
  Second second(par, 0.05, first.state());
  if (!second.advance(20).converged) std::printf("%s: failed\n", name);
  if (!(first.time() > 0.999 && first.time() < 1.001 && second.time() > 0.999 &&
        second.time() < 1.001 && second.h() < 0.051))
    std::printf("%s: time\n", name);
  State again = second.state();
  second.reset(first.state());
  if (second.time() > 0) std::printf("%s: time after reset\n", name);
  if (!second.advance(20).converged) std::printf("%s: failed\n", name);
  if (std::memcmp(&again, &second.state(), sizeof again) != 0) std::printf("%s: reset\n", name);
}

int main() {
  using namespace pendulum;
  const Parameters par;
  const State start{1.0, 0.0};
  meet<implicit_midpoint::Propagator, gauss_4::Propagator>("gauss", par, start);
  meet<gauss_4::Propagator, stormer_verlet::Propagator>("verlet", par, start);
  meet<member_alpha_3_10::Propagator, member_alpha_2_5::Propagator>("members", par, start);
  meet<member_alpha_2_5::Propagator, implicit_midpoint::Propagator>("midpoint", par, start);
  static_assert(std::is_same_v<implicit_midpoint::StepReport, gauss_4::StepReport>);

  // A method with a parameter of its own: at 3/10 it is that member.
  member_alpha_alpha::Parameters free;
  static_assert(std::is_base_of_v<Parameters, member_alpha_alpha::Parameters>);
  free.alpha = 0.3;
  State a = start;
  State b = start;
  if (!member_alpha_alpha::step(free, 0.1, a).converged) return 1;
  if (!member_alpha_3_10::step(par, 0.1, b).converged) return 1;
  std::printf("%d %d\n", std::abs(a.q - b.q) < 1e-15, std::abs(a.p - b.p) < 1e-15);
  double slope[2];
  gradient(free, a, slope);
  std::printf("%d\n", slope[1] == a.p && energy(par, a) == energy(free, a));

  pendulum::quad::State wide;
  wide.q = 1;
  if (!pendulum::quad::implicit_midpoint::step({}, 0.1, wide).converged) return 1;
  State narrow{1.0, 0.0};
  if (!implicit_midpoint::step({}, 0.1, narrow).converged) return 1;
  std::printf("%d\n", std::abs(static_cast<double>(wide.q) - narrow.q) < 1e-15);

  chain::State ring;
  ring.q[3] = 1;
  meet<chain::implicit_midpoint::Propagator, chain::yoshida_4::Propagator>("chain", chain::Parameters(), ring);
  double forces[60];
  chain::gradient({}, ring, forces);
  std::printf("%d %d\n", forces[3] == 2 * std::sin(1.0), chain::N_40::n);
  std::printf("%d %d\n", m::n, size_of_the_other());

  named::State own;
  own.z = 0.5, own.dz = 0.25, own.par = 1, own.k = 2;
  named::implicit_midpoint::Propagator propagator({}, 0.1, own);
  if (!propagator.advance(3).converged || !named::implicit_midpoint::step({}, 0.1, own).converged) return 1;
  std::printf("%d\n", propagator.state().z > own.z && propagator.parameters().carry == 2);
}
)");
  project.add("other.cpp", R"(#include "midpoint/pendulum.hpp"
#include "second/m.hpp"
int size_of_the_other();
int size_of_the_other() {
  m::State z;
  m::Propagator propagator({}, 0.1, z);
  pendulum::State one{1.0, 0.0};
  return propagator.step().converged && pendulum::implicit_midpoint::step({}, 0.1, one).converged
             ? static_cast<int>(sizeof z / sizeof(m::Real) / 2)
             : 0;
}
)");
  EXPECT_EQ(project.run(), "1 1\n1\n1\n1 40\n30 35\n1\n");
}

// What is not the same must not be taken for it: the compiler says what to do.
TEST(Shape, AnotherSystemOrMethodOfTheSameNameIsAnError) {
  const auto header = [](const std::string& text, const Request& request) {
    return without_pragma(emit(make_source("m.ham", text), request).at(0).text);
  };
  const std::string first = header(chain, {});
  const std::string other = header(chain + "invariant total = sum(i = 1..N, p[i])\n", {});
  const std::string tangent = header(chain, {.tangent = true});
  EXPECT_EQ(messages("g++", first + first), "");
  EXPECT_NE(messages("g++", first + other).find("another system of this name is included before"),
            std::string::npos);
  EXPECT_NE(messages("g++", first + tangent).find("another method of this name is included before"),
            std::string::npos);
  EXPECT_EQ(messages("g++", first + header(chain, {.name_space = "chain::other", .tangent = true})),
            "");
}

// Where an element has another number than in the model.
TEST(Shape, AnArrayTellsItsElements) {
  const std::string text =
      emit(make_source("m.ham",
                       "coordinate q\nmomentum p\nparameter A[1..5] = [1, 2, 3, 4, 5]\n"
                       "parameter m[1..3] = [1, 2, 3]  # masses\n"
                       "parameter c[0..2] = [1, 2, 3]\nH = p^2/2 + A[3]*q^2/2 + A[5]*q^4"
                       " + (m[1] + m[2]*q + m[3]*q^3)/(c[0] + c[1] + c[2])\n"),
           {})
          .at(0)
          .text;
  for (const char* words : {"A[2] = {3.0, 5.0};", "// A[3], A[5]\n", "// m[1..3]: masses\n"})
    EXPECT_NE(text.find(words), std::string::npos) << words;
  EXPECT_EQ(text.find("// c["), std::string::npos);
}

TEST(Shape, TheSystemComesFirstThenTheFixedBlocksThenTheMethod) {
  const std::string text = emit(pendulum(), {}).at(0).text;
  std::size_t last = 0;
  for (const char* part :
       {"//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2",
        "namespace pendulum {", "struct Parameters", "struct State", "Real energy(",
        "void gradient(", "struct NewtonRule", "namespace pendulum::implicit_midpoint {",
        "StepReport solve(", "StepReport step(", "class Propagator"}) {
    const std::size_t at = text.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    EXPECT_GT(at, last) << part;
    last = at;
  }
  EXPECT_EQ(text.find("maybe_unused"), std::string::npos);
}

TEST(Shape, AQuantityKeepsItsNameAndTheArgumentMakesWay) {
  const std::string text = emit(make_source("named.ham", named), {}).at(0).text;
  for (const char* part : {"  const Real z = z_.z;\n", "  const Real k = z_.k;\n", "par_.carry",
                           "k_.c1", "  dz_.z = par_bar * k_.c", "  rest.z = rest_moving_z + "})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
}

TEST(Shape, SharedBlocksLeaveTheHeader) {
  const OutputFiles files = emit(pendulum(), {.support = "shared"});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[1].path, "hamgen_support.hpp");
  EXPECT_EQ(files[0].text.find("struct NewtonRule"), std::string::npos);
  EXPECT_NE(files[1].text.find("struct NewtonRule"), std::string::npos);
  EXPECT_EQ(emit(pendulum(), {.scheme = "gauss-4", .support = "shared"})[1], files[1]);
  EXPECT_THROW(static_cast<void>(emit(pendulum(), {.support = "none"})), UsageError);
  EXPECT_THROW(static_cast<void>(emit(pendulum(), {.format = "cpp-plugin", .support = "shared"})),
               UsageError);
}

}  // namespace
}  // namespace hamgen::emitted_test
