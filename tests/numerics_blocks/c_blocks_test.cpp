// The blocks in C do what those in C++ do, bit for bit.  (That they are C the tests of headers in C
// show, which compile them as it.)
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wuseless-cast"
#pragma GCC diagnostic ignored "-Wunused-function"

namespace hamgen::numerics_blocks_test {
namespace {

namespace c_of_float {
using Real = float;
using of_float::epsilon, of_float::largest, of_float::magnitude;
#include "tests/numerics_blocks/c_blocks.inc"
}  // namespace c_of_float

namespace c_of_double {
using Real = double;
using of_double::epsilon, of_double::largest, of_double::magnitude;
#include "tests/numerics_blocks/c_blocks.inc"
}  // namespace c_of_double

namespace c_of_long_double {
using Real = long double;
using of_long_double::epsilon, of_long_double::largest, of_long_double::magnitude;
#include "tests/numerics_blocks/c_blocks.inc"
}  // namespace c_of_long_double

template <class InCpp, class InC>
struct Pair {
  using Cpp = InCpp;
  using C = InC;
};

// Numbers of very different sizes, some of them equal, and some that are nothing.
template <class Real>
class Sizes {
 public:
  Real next() {
    Real value = static_cast<Real>(numbers_.next()) / 3;
    const int power = static_cast<int>(numbers_.next() * 40);
    for (int i = 0; i < power; ++i) value = value / 2;
    for (int i = 0; i > power; --i) value = value * 2;
    return value;
  }
  Real size() {
    const Real value = next();
    return value < 0 ? -value : value;
  }

 private:
  Numbers numbers_;
};

template <class Blocks>
class CBlock : public ::testing::Test {};
using Scalars = ::testing::Types<Pair<of_float::Blocks, c_of_float::CBlocks>,
                                 Pair<of_double::Blocks, c_of_double::CBlocks>,
                                 Pair<of_long_double::Blocks, c_of_long_double::CBlocks>>;
TYPED_TEST_SUITE(CBlock, Scalars);

TYPED_TEST(CBlock, SumsLoseTheSame) {
  using Cpp = typename TypeParam::Cpp;
  using C = typename TypeParam::C;
  using Real = typename Cpp::Scalar;
  Sizes<Real> sizes;
  int lost = 0;
  for (int i = 0; i < 5000; ++i) {
    const Real x = sizes.next();
    const Real y = sizes.next();
    const Real rest = y * Cpp::unit;
    Real value[2] = {x, x};
    Real carry[2] = {};
    Cpp::add(value[0], carry[0], y);
    C::sum(value[1], carry[1], y);
    EXPECT_EQ(value[0], value[1]);
    EXPECT_EQ(carry[0], carry[1]);
    lost += carry[0] != 0 ? 1 : 0;
    Cpp::add_all(value[0], carry[0], x, rest);
    C::sum_with_rest(value[1], carry[1], x, rest);
    EXPECT_EQ(value[0], value[1]);
    EXPECT_EQ(carry[0], carry[1]);
    Cpp::collected(value[0], carry[0], y);
    C::collected(value[1], carry[1], y);
    EXPECT_EQ(value[0], value[1]);
    EXPECT_EQ(carry[0], carry[1]);
    EXPECT_EQ(Cpp::lost_of_product(x, y), C::lost_of_product(x, y));
    EXPECT_EQ(Cpp::lost_of_difference(x, y), C::lost_of_difference(x, y));
  }
  EXPECT_GT(lost, 1000);
}

// Steps whose increments shrink by what chance says, of three unknowns that are as different, with
// ways and without.
template <class Pair, int Power>
void expect_rules_answer_alike() {
  using Cpp = typename Pair::Cpp;
  using C = typename Pair::C;
  using Real = typename Cpp::Scalar;
  Sizes<Real> sizes;
  Numbers chance;
  typename Cpp::template NewtonOfMany<Power, 3> in_cpp;
  typename C::Rule in_c(Power);
  std::vector<int> answers(3);
  for (int step = 0; step < 30000; ++step) {
    const bool predicted = chance.next() > 0;
    in_cpp.begin(predicted);
    in_c.begin(predicted);
    Real moved[3], length[3], way[3];
    for (int j = 0; j < 3; ++j) {
      length[j] = 1 + sizes.size();
      moved[j] = length[j] * static_cast<Real>(chance.next() * chance.next() / 1000);
      if (moved[j] < 0) moved[j] = -moved[j];
      way[j] = chance.next() > -0.5 ? length[j] * static_cast<Real>(1 + chance.next()) /
                                          (chance.next() > 0 ? 4096 : 200)
                                    : 0;
    }
    const bool ways = chance.next() > 0;
    const bool single = chance.next() > 0.5;
    const Real shrinks =
        static_cast<Real>(1 + chance.next()) / (chance.next() > 0 ? 100000 : Real(1.5));
    int answer = 0;
    for (int iteration = 1; answer == 0; ++iteration) {
      if (single) {
        answer = static_cast<int>(in_cpp(moved[0], length[0], iteration));
        ASSERT_EQ(answer, in_c(moved[0], length[0], iteration)) << step << " " << iteration;
      } else {
        const Real* given = ways ? way : length;
        answer = static_cast<int>(in_cpp.of_each(moved, length, given, 3, iteration));
        ASSERT_EQ(answer, in_c.of_each(moved, length, given, 3, iteration))
            << step << " " << iteration;
      }
      ASSERT_EQ(in_cpp.contraction, in_c.of.contraction);
      ASSERT_EQ(in_cpp.previous, in_c.of.previous);
      ASSERT_EQ(in_cpp.unchecked, in_c.of.unchecked);
      if (iteration > 1) {
        ASSERT_EQ(in_cpp.grown, in_c.of.grown);
      }
      for (int j = 0; j < 3; ++j) ASSERT_EQ(in_cpp.unit[j], in_c.of.unit[j]);
      for (Real& each : moved) each *= shrinks;
    }
    ++answers[static_cast<std::size_t>(answer)];
    const Real bend = sizes.size() * (chance.next() > 0 ? Cpp::unit : Real(1) / 1024);
    // What is known of contractions lets half of the steps end with their first increment.
    if (chance.next() > 0) in_cpp.contraction = in_c.of.contraction = Cpp::unit;
    in_cpp.motion.move = in_c.of.move = way[0] + way[1] + way[2];
    in_cpp.motion.bend = in_c.of.bend = bend;
  }
  EXPECT_GT(answers[1], 1000);  // done
  EXPECT_GT(answers[2], 100);   // failed
}
TYPED_TEST(CBlock, RulesAnswerAlike) { expect_rules_answer_alike<TypeParam, 2>(); }
TYPED_TEST(CBlock, RulesOfApproximateMatricesAnswerAlike) {
  expect_rules_answer_alike<TypeParam, 1>();
}

// An orbit whose degree is chosen anew many times, and what is seen of its motion.
TYPED_TEST(CBlock, HistoriesPredictAlike) {
  using Cpp = typename TypeParam::Cpp;
  using C = typename TypeParam::C;
  using Real = typename Cpp::Scalar;
  typename Cpp::template Past<3> in_cpp;
  typename C::Past in_c;
  typename Cpp::template NewtonOfMany<2, 3> rule;
  typename C::Rule rule_in_c(2);
  Numbers noise;
  // As if known from a first iteration: much larger, smaller and far smaller than what comes.
  for (const int i : {0, 1, 2}) rule.unit[i] = rule_in_c.of.unit[i] = i == 0 ? Real(1) / 64 : 64;
  Real x = 1;
  Real y = 0;
  bool moved = false;
  for (int step = 0; step < 400; ++step) {
    const Real turn = step < 200 ? Real(1) / 16 : Real(1) / 4;
    x += turn * y;
    y -= turn * x;
    const Real solution[3] = {x, y, x * y + static_cast<Real>(noise.next()) / 1000000};
    rule.watch(in_cpp, solution, 0, 3);
    in_c.watch(rule_in_c, solution);
    ASSERT_EQ(rule.motion.move, rule_in_c.of.move) << step;
    ASSERT_EQ(rule.motion.bend, rule_in_c.of.bend) << step;
    for (int i = 0; i < 3; ++i) ASSERT_EQ(rule.unit[i], rule_in_c.of.unit[i]) << step;
    ASSERT_EQ(rule.unchecked, rule_in_c.of.unchecked) << step;
    moved = moved || rule.motion.bend > 0;
    in_cpp.record(solution);
    in_c.record(solution);
    Real next[3] = {};
    Real next_in_c[3] = {};
    in_cpp.extrapolate(next);
    in_c.extrapolate(next_in_c);
    for (int i = 0; i < 3; ++i) ASSERT_EQ(next[i], next_in_c[i]) << step;
    ASSERT_EQ(in_cpp.best, in_c.of.best);
    ASSERT_EQ(in_cpp.known, in_c.of.known);
  }
  EXPECT_TRUE(moved);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test

#pragma GCC diagnostic pop
