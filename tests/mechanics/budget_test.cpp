// Small files that would keep the symbolic stage busy for hours: read at once, or refused with
// their place when so much was counted.  No clock decides.
#include "generator/base/budget.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "generator/language/read_model.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {
namespace {

constexpr auto terms = static_cast<std::size_t>(Resource::terms);
constexpr auto work = static_cast<std::size_t>(Resource::work);
constexpr auto nodes = static_cast<std::size_t>(Resource::nodes);

const std::string pair = "coordinate q\nmomentum p\n";

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

// "f(1)*f(2)*...*f(n)" with f of the number.
template <class Factor>
std::string product(int n, const Factor& factor) {
  std::string result;
  for (int i = 1; i <= n; ++i) result += (i == 1 ? "" : "*") + factor(i);
  return result;
}

std::string chain(int n) {
  std::string text = pair + "let a0 = q\n";
  for (int i = 1; i <= n; ++i) text += fmt::format("let a{} = sin(a{} + q)\n", i, i - 1);
  return text + fmt::format("H = p^2/2 + a{}\n", n);
}

std::string arrays(int n) {
  return fmt::format("size N = {}\ncoordinate q[1..N]\nmomentum p[1..N]\n", n);
}

// The first line of what is said of the model up to the text of its step, without the file's name.
std::string budget_said_of(const std::string& text) {
  try {
    check_step(make_source("m.ham", text), {});
  } catch (const ModelError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("\nhelp: "), std::string::npos) << said;
    return said.substr(6, said.find('\n') - 6);
  }
  return "accepted";
}

const std::string too_much_work = "error: this takes more than 50 million steps of algebra";
const std::string too_many_terms = "error: this is written out more than 1000000 times";

struct Case {
  std::string name;
  std::string text;
  std::string said;
  double most_work;  // counted of what is accepted
};

std::vector<Case> cases() {
  const auto one_plus = [](int i) { return fmt::format("(1 + q/{})", i); };
  const auto element = [](int i) { return fmt::format("q[{}]", i); };
  const auto power_sum = [](int k) { return fmt::format("sum(i = 1..N, q[i]^{})", k); };
  const auto reciprocal = [](int i) { return fmt::format("(1 + q^{})^(-1)", i); };
  const std::string kinetic = "H = sum(i = 1..N, p[i]^2/2) + ";
  const std::string pairs = "sum(i = 1..N-1, j = i+1..N, exp(q[j] - q[i]))";
  return {
      {"product_of_40", pair + "H = p^2/2 + " + product(40, one_plus), "accepted", 5e6},
      {"product_of_300", pair + "H = p^2/2 + " + product(300, one_plus), "3:13: " + too_much_work,
       0},
      {"product_of_199_reciprocals", pair + "H = p^2/2 + " + product(199, reciprocal),
       "3:13: " + too_much_work, 0},
      {"product_of_300_variables", arrays(300) + kinetic + product(300, element),
       "4:5: " + too_much_work, 0},
      {"product_of_29_sums", arrays(40) + kinetic + product(29, power_sum), "accepted", 2e7},
      {"chain_of_50", chain(50), "accepted", 2e6},
      {"chain_of_200", chain(200), "accepted", 2e7},
      {"chain_of_2000", chain(2000), "2004:13: " + too_much_work, 0},
      {"nested_sin_199", pair + "H = p^2/2 + " + repeated("sin(", 199) + "q" + repeated(")", 199),
       "accepted", 3e7},
      {"two_sums_multiplied", arrays(200) + kinetic + "sum(i = 1..N, cos(q[i]))*" + pairs,
       "accepted", 2e7},
      {"dense_hessian", arrays(1000) + kinetic + "exp(sum(i = 1..N, q[i]^2))", "accepted", 2e7},
      {"nested_ranges",
       pair + "H = p^2/2 + sum(a=1..100, b=1..100, c=1..100, d=1..100, e=1..100, f=1..100, q^2)",
       "3:77: " + too_many_terms, 0},
      {"double_sum_of_a_million", pair + "H = p^2/2 + sum(i=1..1001, j=1..1001, q^2/(i+j))",
       "3:39: " + too_many_terms, 0},
      {"harmonic_sum", pair + "H = p^2/2 + sum(i=1..1000000, q/i)",
       "3:31: error: this constant has more than 20000 digits", 0},
      {"hidden_power_tower",
       pair + "let a = 1/3 + q - q\nlet b = a^1000\nlet c = b^1000\nH = p^2/2 + c^1000*q",
       "5:9: error: this constant has more than 20000 digits", 0},
      {"hidden_coefficient", pair + "let a = (q/3 + q - q)^1000\nlet b = a^1000\nH = p^2/2 + b",
       "4:9: error: this constant has more than 20000 digits", 0},
  };
}

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

class Budgets : public testing::TestWithParam<Case> {};

TEST_P(Budgets, AreKeptOrSaidToBePassed) {
  EXPECT_EQ(budget_said_of(GetParam().text), GetParam().said);
  if (GetParam().said == "accepted") {
    EXPECT_LE(spent()[work], GetParam().most_work);
  }
  // What was counted last may have passed the limit, but nothing after it was done.
  for (const std::size_t each : {terms, work, nodes})
    EXPECT_LT(spent()[each], 1.1 * Budget::limits()[each]);
}

INSTANTIATE_TEST_SUITE_P(Formulas, Budgets, testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

// Twice the formula may not be four times the work where nothing multiplies.
TEST(BudgetGrowth, IsLinearInWhatIsLinear) {
  const auto work_of = [](int n) {
    std::string text;
    std::string energy;
    for (int i = 0; i < n; ++i) {
      text += fmt::format("coordinate q{0}\nmomentum p{0}\n", i);
      energy += fmt::format("{0}p{1}^2/2 + q{1}^4", i == 0 ? "" : " + ", i);
    }
    EXPECT_EQ(budget_said_of(text + "H = " + energy), "accepted");
    return spent()[work];
  };
  EXPECT_LT(work_of(200), 3 * work_of(100));
}

// 20,000 scenes are read one by one, and 20,000 settings of one name are not compared in pairs.
TEST(BudgetGrowth, ScenesAreReadInLinearTime) {
  std::string text = pair + "H = p^2/2 + q^2/2\n";
  for (int i = 0; i < 20000; ++i)
    text += fmt::format("scene s{0} {{ q = {0}; h = 0.1; steps = 10 }}\n", i);
  EXPECT_EQ(read_model(make_source("m.ham", text)).scenes.size(), 20000u);
  const std::string twice =
      pair + "H = p^2/2 + q^2/2\nscene s { h = 0.1\n" + repeated("q = 1\n", 20000) + "}\n";
  try {
    static_cast<void>(read_model(make_source("m.ham", twice)));
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_EQ(error.diagnostics().size(), 19999u);
  }
}

// No model that is shipped takes a tenth of any limit.
TEST(ShippedModels, AreFarFromTheBudget) {
  const std::filesystem::path folder = std::filesystem::path(HAMGEN_SOURCE_DIR) / "hamiltonians";
  Amounts largest{};
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".ham") continue;
    ++count;
    check_step(read_source(entry.path()), {});
    for (const std::size_t each : {terms, work, nodes}) {
      EXPECT_LT(spent()[each], Budget::limits()[each] / 10) << entry.path() << ' ' << each;
      largest[each] = std::max(largest[each], spent()[each]);
    }
  }
  EXPECT_GT(count, 15);
  EXPECT_GT(largest[work], 1000);  // it is counted at all
  EXPECT_GT(largest[nodes], 1000);
  RecordProperty("work", fmt::format("{:.0f}", largest[work]));
}

}  // namespace
}  // namespace hamgen
