// What is proved of small systems whose H is a function of sums over all elements holds of large
// ones, if the sums take any value.
#include <gtest/gtest.h>

#include "generator/verify/independent_sums.hpp"
#include "tests/verify/evaluator.hpp"
#include "tests/verify/sized_system.hpp"

namespace hamgen {
namespace {

using verify_test::computes_the_same;
using verify_test::routines;
using verify_test::system_of;

const std::string kFree =
    "coordinate q[1..N] periodic\nmomentum p[1..N]\nparameter K = 1\n"
    "H = sum(i = 1..N, p[i]^2/2) + ";
const std::string kFreeRotators =
    kFree +
    "K*sum(i = 1..N, cos(q[i]))^2/50 + exp(sum(i = 1..N, sin(q[i]))/40)"
    " + sqrt(1 + sum(i = 1..N, p[i])^2)\n";

Finding finding_of(const std::string& text, const std::string& scheme, long size = 9) {
  const SizedSystem large = system_of(text, 60, scheme);
  const SmallerSystems smaller{"N", 60, system_of(text, size, scheme),
                               system_of(text, size + 1, scheme)};
  return prove_emitted(large.mechanics, large.scheme, large.plan, large.program, {}, {}, {},
                       smaller);
}

TEST(GrowthOfSums, ProvesAFunctionOfThem) {
  for (const char* scheme : {"implicit-midpoint", "gauss-4"}) {
    const Finding finding = finding_of(kFreeRotators, scheme);
    EXPECT_EQ(finding.verdict, Verdict::proved) << scheme << ": " << finding.detail;
  }
  // Beside neighbours, and of neighbours.
  const std::string chain =
      kFree + "sum(i = 1..N, (q[i+1] - q[i])^4) + sum(i = 1..N, q[i]*q[i+1])^2/9\n";
  const Finding finding = finding_of(chain, "implicit-midpoint", 45);
  EXPECT_EQ(finding.verdict, Verdict::proved) << finding.detail;
  // Beside an element and its neighbours there has to be a third that is free.
  const Finding shorter = finding_of(chain, "implicit-midpoint", 43);
  EXPECT_EQ(shorter.verdict, Verdict::tested);
  EXPECT_NE(shorter.detail.find("its loops reach 7 elements far"), std::string::npos)
      << shorter.detail;
}

TEST(GrowthOfSums, ProvesNoMutantOfIt) {
  for (const std::string scheme : {"implicit-midpoint", "gauss-4"}) {
    const SizedOutline first = routines(system_of(kFreeRotators, 9, scheme));
    const SizedOutline second = routines(system_of(kFreeRotators, 10, scheme));
    const SizedSystem large = system_of(kFreeRotators, 60, scheme);
    int mutants = 0;
    const auto refuse = [&](const std::vector<verify_test::Mutant>& list) {
      for (const verify_test::Mutant& mutant : list) {
        const auto why =
            why_not_longer({{first, second, {60, outline(mutant.code, {"invariants"})}}});
        EXPECT_TRUE(why || computes_the_same(large.program, mutant.code))
            << scheme << ", " << mutant.kind << ": " << mutant.description;
        ++mutants;
      }
    };
    refuse(verify_test::mutants_of(large.program));
    refuse(verify_test::mutants_of_structure(large.program));
    EXPECT_GE(mutants, 20) << scheme;
  }
}

// Sums that know each other may hide how many elements there are: sum(1) - 25 is 0 at N = 25.
TEST(GrowthOfSums, SumsThatDependOnEachOtherAreNotContinued) {
  const auto why = [](const std::string& sums) {
    const Finding finding = finding_of(kFree + sums + "\n", "implicit-midpoint", 30);
    EXPECT_EQ(finding.verdict, Verdict::tested) << sums << ": " << finding.detail;
    const std::size_t at = finding.detail.rfind(": ");
    return finding.detail.substr(at + 2);
  };
  const std::string depend = "the sums over all elements in energy depend on each other";
  EXPECT_EQ(why("exp(sum(i = 1..N, q[i])) + sum(i = 1..N, q[i] + 1)^2"), depend);
  EXPECT_EQ(why("exp(sum(i = 1..N, q[i+1] - q[i])) + sum(i = 1..N, q[i]^4)"), depend);
  EXPECT_EQ(why("exp(sum(i = 1..N, sin(q[i])^2)) + sum(i = 1..N, cos(q[i])^2)^2"), depend);
  EXPECT_EQ(why("exp(sum(i = 1..N, 1 + K)) + sum(i = 1..N, cos(q[i])^2)^2"), depend);
}

TEST(GrowthOfSums, AreIndependentWhereTheirJacobianHasFullRank) {
  const auto independent = [](const std::string& sums) {
    return are_sums_independent(system_of(kFree + sums + "\n", 25, "implicit-midpoint"),
                                "potential_gradient");
  };
  EXPECT_TRUE(independent("exp(sum(i = 1..N, cos(q[i]))) + sum(i = 1..N, sin(q[i]))^3"));
  EXPECT_TRUE(independent("exp(sum(i = 1..N, q[i]^2)) + sum(i = 1..N, q[i]*q[i+1])^3"));
  EXPECT_FALSE(
      independent("exp(sum(i = 1..N, q[i]^2)) + sum(i = 1..N, (q[i] + q[i+1])^2"
                  " - 2*q[i]*q[i+1])^3"));
  EXPECT_FALSE(are_sums_independent(system_of(kFreeRotators, 25, "implicit-midpoint"), "nothing"));
}

// Of events by hand: what reads a sum reads all of it, and it is the same for all that do.
class Events {
 public:
  explicit Events(long size) : size_(size) { add({.kind = Kind::routine, .text = "solve"}); }
  using Kind = CodeEvent::Kind;

  Events& declare() { return add({.kind = Kind::local, .text = "local 0"}); }
  Events& loop(const std::string& index) { return begin(index, size_ - 1); }
  Events& stages(const std::string& index) { return begin(index, 3); }
  Events& end() { return add({.kind = Kind::end}); }
  Events& sum() { return add({.kind = Kind::add, .text = "local 0"}); }
  Events& read() { return add({.kind = Kind::get, .text = "local 0"}); }
  Events& all() { return loop("i").sum().end(); }
  Events& use(const std::string& index) {
    loop(index).read().add({.kind = Kind::set, .text = "a."});
    add({.kind = Kind::element, .names = {index}, .numbers = {1, 0}});
    return end();
  }
  [[nodiscard]] SizedOutline take() const { return {size_, events_}; }

 private:
  Events& begin(const std::string& index, long last) {
    return add({.kind = Kind::loop, .text = index, .names = {}, .numbers = {0, last}});
  }
  Events& add(CodeEvent event) {
    events_.push_back(std::move(event));
    return *this;
  }

  long size_;
  std::vector<CodeEvent> events_;
};

template <class Write>
std::string why_not_by(const Write& write) {
  const auto of = [&](long size) {
    Events events(size);
    write(events);
    return events.take();
  };
  return why_not_longer({of(25), of(26), of(40)}).value_or("");
}

TEST(GrowthOfSums, AreReadWhenTheyAreWhole) {
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().all().use("j"); }), "");
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().all().all().use("j").use("k"); }), "");
  EXPECT_EQ(why_not_by([](Events& e) { e.stages("s").declare().all().use("j").end(); }), "");
  const std::string partial = "an instance of a loop reads what another one writes";
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().loop("i").sum().read().end(); }), partial);
  const std::string grows = "a sum over all elements grows after it was read";
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().loop("i").read().sum().end(); }), grows);
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().all().use("j").all(); }), grows);
  EXPECT_EQ(why_not_by([](Events& e) { e.declare().stages("s").all().use("j").end(); }),
            "a sum over all elements goes on from loop to loop");
}

}  // namespace
}  // namespace hamgen
