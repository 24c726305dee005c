// Numbers a scalar has no room for, values that are not there: refused by name, never inf, 0 or
// nan.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

std::string oscillator(const std::string& before, const std::string& potential) {
  return "system one\ncoordinate q\nmomentum p\n" + before + "H = p^2/2 + " + potential +
         "\nscene s {\n  q = 1\n  h = 0.1\n  steps = 10\n}\n";
}

TEST(Range, OfFloatIsRespectedByConstantsOfTheModel) {
  const Scratch scratch;
  const std::string constant = scratch.write("constant.ham", oscillator("", "1e40*q^2"));
  const std::string parameter =
      scratch.write("parameter.ham", oscillator("parameter a = 1e39\n", "a*q^2"));
  for (const char* command : {"check", "generate", "run"}) {
    for (const std::string& model : {constant, parameter}) {
      const Result refused = hamgen({command, model, "--scalar", "float"});
      EXPECT_NE(refused.status, 0) << command;
      EXPECT_LT(refused.status, 4) << command << refused.err;
      EXPECT_TRUE(contains(refused.err, "outside the range of float")) << refused.err;
      EXPECT_TRUE(contains(refused.err, "or --scalar double")) << refused.err;
      EXPECT_EQ(hamgen({command, model}).status, 0) << command;
    }
  }
  EXPECT_TRUE(contains(hamgen({"generate", parameter, "--scalar", "float"}).err,
                       ":4:15: error: the default of 'a' is 1e39, outside"));
  const Result member = hamgen({"generate", scratch.write("p.ham", std::string(pendulum)),
                                "--scalar", "float", "--beta", "1e40*h"});
  EXPECT_EQ(member.status, 2) << member.err;
}

TEST(Range, OfFloatIsRespectedByTheValuesOfARun) {
  const Scratch scratch;
  const std::string model = scratch.write("fine.ham", oscillator("parameter a = 1\n", "a*q^2/2"));
  for (const auto& [option, value] :
       {std::pair{"--h", "1e-60"}, std::pair{"--set", "a=1e-46"}, std::pair{"--set", "a=1e39"},
        std::pair{"--initial", "q=1e40"}}) {
    const Result refused = hamgen({"run", model, "--scalar", "float", option, value});
    EXPECT_EQ(refused.status, 2) << option << " " << value << refused.err;
    EXPECT_TRUE(contains(refused.err, "outside the range of float")) << refused.err;
  }
  EXPECT_EQ(hamgen({"run", model, "--scalar", "float", "--quiet", "--h", "1e-40"}).status, 0);
}

// What derivation and normalisation make of constants that are each in range.
TEST(Range, HoldsForConstantsThatCombine) {
  const Scratch scratch;
  for (const char* potential :
       {"(1e200*q)^2", "q^2/1e-320/8", "q^2*2^1000*2^1000", "(1e-200*q)^2"}) {
    const std::string model = scratch.write("combine.ham", oscillator("", potential));
    for (const char* command : {"check", "generate", "run"}) {
      const Result refused = hamgen({command, model});
      EXPECT_EQ(refused.status, 3) << command << " " << potential << refused.err;
      EXPECT_TRUE(contains(refused.err, "combine.ham:4:5: error: the step needs the constant"))
          << refused.err;
    }
    EXPECT_EQ(hamgen({"check", model, "--scalar", "long-double"}).status, 0) << potential;
  }
}

TEST(Undefined, InvariantsAreSaidToBeAndNeverPrintedAsNan) {
  const Scratch scratch;
  const std::string model =
      scratch.write("undefined.ham", oscillator("invariant N = p/(q - 1)\n", "q^2/2"));
  const Result run = hamgen({"run", model, "--json"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "N is not defined at the initial state")) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  EXPECT_TRUE(result["invariants"]["N"]["initial"].is_null());
  const Result text = hamgen({"verify", model, "--measure"});
  EXPECT_TRUE(contains(text.out + text.err, "not defined at the initial state"))
      << text.out << text.err;
  const Result json = hamgen({"verify", model, "--measure", "--json"});
  for (const Result* each : {&run, &text, &json}) {
    for (const char* word : {" nan", "-nan"}) {  // not "resonances"
      EXPECT_FALSE(contains(each->out, word)) << each->out;
      EXPECT_FALSE(contains(each->err, word)) << each->err;
    }
  }
}

TEST(Arguments, ThatAreEmptyAreRefused) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"generate", model, "--alpha", ""},
        {"generate", model, "-o", ""},
        {"generate", model, "--namespace", ""},
        {"run", model, "--beta", ""},
        {"run", ""}}) {
    const Result refused = hamgen(words);
    EXPECT_EQ(refused.status, 2) << words[words.size() - 2] << refused.err;
    EXPECT_TRUE(contains(refused.err, "empty word after " + words[words.size() - 2]))
        << refused.err;
  }
}

TEST(Arguments, ThatSetANameTwiceAreRefused) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string large = scratch.write("chain.ham", chain);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", model, "--initial", "q=1,q=2"},
        {"run", model, "--initial", "q=1", "--initial", "p=0,q=1"},
        {"run", model, "--set", "eps=1", "--set", "eps=2"},
        {"check", large, "--set", "N=4", "--set", "N=5"},
        {"run", large, "--initial", "q[2]=1,q[ 2 ]=2"},
        {"run", model, "--gauge", "locally-exact", "--reference", "q=1,q=2"}}) {
    const Result refused = hamgen(words);
    EXPECT_EQ(refused.status, 2) << words.back() << refused.err;
    EXPECT_TRUE(contains(refused.err, "is set twice")) << refused.err;
  }
  EXPECT_EQ(hamgen({"run", large, "--quiet", "--initial", "q=[1,0,0],q[2]=2"}).status, 0);
}

}  // namespace
}  // namespace hamgen::app_test
