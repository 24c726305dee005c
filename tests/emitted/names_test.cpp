// Names that mean something in C++ or in the emitted code, as names of a user's quantities.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "tests/emitted/compiled.hpp"

namespace hamgen::emitted_test {
namespace {

const std::vector<std::string> hostile = {
    "double",     "h_",       "z",          "par",          "dz",        "State",     "Real",
    "I",          "int",      "class",      "std",          "k",         "x",         "n",
    "i",          "report",   "start",      "length",       "size",      "scale",     "verdict",
    "iteration",  "carry_",   "z_",         "step",         "solve",     "energy",    "prepare",
    "add",        "gradient", "Parameters", "Propagator",   "History",   "Start",     "Verdict",
    "t1",         "c1",       "q_bar",      "H_q",          "delta_q",   "R_q",       "q_new",
    "values",     "sum",      "E1",         "Coefficients", "namespace", "M_PI",      "and",
    "E",          "NAN",      "errno",      "main",         "template",  "hessian",   "masses",
    "hamgen_run", "create",   "state",      "steps",        "known",     "magnitude", "unknowns",
    "advance",    "lambda",   "gamma",      "beta",         "alpha",     "float128",  "EOF",
    "y0",         "j1",       "predicted",  "best",         "value",     "increment", "rule_0",
    "d_p_d_q",    "entry_1",  "put",        "drift_",       "cos_",      "column",    "pow_"};

// A model that the language accepts, or nothing if it refuses the name.
std::string header(const std::string& text, const Request& request, const std::string& space) {
  Request named = request;
  named.name_space = "names_" + space;
  try {
    return without_pragma(generate(make_source("hostile.ham", text), named).at(0).text);
  } catch (const ModelError&) {
    return {};
  }
}

// The names the language lets a user have.
std::vector<std::string> accepted_names() {
  std::vector<std::string> names;
  for (const std::string& name : hostile) {
    if (!header("system hostile\ncoordinate " + name + "\nmomentum p_\nH = p_^2\n", {}, "x")
             .empty()) {
      names.push_back(name);
    }
  }
  return names;
}

// In turn every name is a coordinate, a momentum and a parameter.
std::string written_out(const Request& request) {
  const std::vector<std::string> names = accepted_names();
  std::string units;
  for (std::size_t i = 0; i < names.size(); i += 2) {
    auto name = [&](std::size_t k) { return names[(i + k) % names.size()]; };
    const std::string q1 = name(0), q2 = name(1), p1 = name(2), p2 = name(3), a = name(4),
                      b = name(5);
    units += "#line 1 \"" + q1 + "_" + q2 + "_" + p1 + "_" + p2 + "_" + a + "_" + b + ".hpp\"\n";
    units += header("system hostile\ncoordinate " + q1 + ", " + q2 + "\nmomentum " + p1 + ", " +
                        p2 + "\nparameter " + a + " = 2\nparameter " + b + " = 3\nH = " + p1 +
                        "^2*(1 + " + q2 + "^2)^0.3 + " + a + "*" + p2 + "^2 - " + b + "*cos(" + q1 +
                        " - " + q2 + ")\n",
                    request, "n" + std::to_string(i));
  }
  return units;
}

std::string in_loops(const Request& request) {
  const std::vector<std::string> names = accepted_names();
  std::string units;
  for (std::size_t k = 0; k < names.size(); ++k) {
    auto name = [&](std::size_t j) { return names[(k + j) % names.size()]; };
    const std::string q = name(0), p = name(1), a = name(2), i = name(3);
    const std::string next = q + "[" + i + "+1] - " + q + "[" + i + "]";
    units += "#line 1 \"" + q + "_" + p + "_" + a + "_" + i + ".hpp\"\n";
    units += header("system hostile\ncoordinate " + q + "[1..40] periodic\nmomentum " + p +
                        "[1..40]\nparameter " + a + " = 2\nH = sum(" + i + " = 1..40, " + p + "[" +
                        i + "]^2/2 - " + a + "*cos(" + next + "))\n",
                    request, "n" + std::to_string(k));
  }
  return units;
}

TEST(HostileNames, AreMostlyAllowed) { EXPECT_GT(accepted_names().size(), 60u); }

TEST(HostileNames, GiveCodeThatCompilesForNewton) {
  EXPECT_EQ(messages("g++", written_out({})), "");
}

TEST(HostileNames, GiveCodeThatCompilesForAnExplicitStep) {
  EXPECT_EQ(messages("g++", written_out({.alpha = "0"})), "");
}

TEST(HostileNames, GiveCodeThatCompilesForSweepsAndForAFixedPoint) {
  EXPECT_EQ(messages("g++", written_out({.solver = "sweeps:2"})), "");
  EXPECT_EQ(messages("g++", written_out({.solver = "fixed-point"})), "");
}

// rule_2, vector_2 and so on are all taken for what the emitted functions number themselves.
TEST(HostileNames, NextToNumberedOnesAreFound) {
  const std::string text = header(
      "system numbered\ncoordinate rule, vector, matrix_\nmomentum product, vector_, matrix\n"
      "H = (product^2 + vector_^2 + matrix^2)/2 + rule^4/4 + cos(vector - rule) + matrix_^2\n",
      {}, "numbered");
  ASSERT_NE(text, "");
  EXPECT_EQ(messages("g++", text), "");
}

// The state's elements in what takes no parameters: `par` there is not the record of these.
TEST(HostileNames, InInvariantsAreNotThoseOfArguments) {
  const std::string text = header(
      "system rotor\ncoordinate q, r\nmomentum par, pr\nparameter w = 2\n"
      "H = (par^2 + pr^2)/2\ninvariant L = q*pr - r*par\n",
      {}, "rotor");
  ASSERT_NE(text, "");
  for (const std::string& compiler : compilers()) EXPECT_EQ(messages(compiler, text), "");
}

TEST(HostileNames, GiveCodeThatCompilesInC) {
  for (const char* alpha : {"", "0"}) {
    const std::string text = written_out({.alpha = alpha, .format = "c-header"});
    EXPECT_GT(text.size(), 100000u);
    EXPECT_EQ(messages("gcc", text, {"-x", "c", "-std=c11", "-Wall"}), "") << alpha;
  }
}

TEST(HostileNames, GiveCodeThatCompilesForLoops) { EXPECT_EQ(messages("g++", in_loops({})), ""); }

TEST(HostileNames, GiveCodeThatCompilesForExplicitLoops) {
  EXPECT_EQ(messages("g++", in_loops({.alpha = "0"})), "");
}

TEST(HostileNames, OfTheSystemGiveNamespacesThatCompile) {
  for (const char* name : {"double", "std", "namespace", "State", "Real", "h", "hamgen", "main"}) {
    const std::string text =
        "system " + std::string(name) + "\ncoordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";
    std::string code;
    try {
      code = generate(make_source("hostile.ham", text), {}).at(0).text;
    } catch (const ModelError&) {
      continue;
    }
    EXPECT_EQ(messages("g++", without_pragma(code)), "") << name;
  }
}

TEST(HostileNames, OfCoordinatesInPluginsCompile) {
  for (const std::string name :
       {"state", "run", "plugin", "create", "parameters", "z", "par", "values"}) {
    const std::string text = "system hostile\ncoordinate " + name + "\nmomentum p\nparameter " +
                             name + "0 = 1\nH = p^2/2 - " + name + "0*cos(" + name +
                             ")\ninvariant energy2 = p^2\n";
    std::string code;
    try {
      code = generate_plugin(make_source("hostile.ham", text), {}).text;
    } catch (const ModelError&) {
      continue;
    }
    EXPECT_EQ(messages("g++", code, {"-std=c++20", "-Wall"}), "") << name;
  }
}

TEST(HostileNames, ACommentOrUnitOfTheUsersStaysAComment) {
  const std::string text =
      "system hostile\ncoordinate q [m */ s]   # ends with a backslash \\\n"
      "momentum p   # */ #error no\nparameter g = 1   # ?\?/ \"\n"
      "H = p^2/2 - g*cos(q)   # trailing \\\n";
  const std::string code =
      generate(make_source("dir\\\n/ho*/stile.ham", text), {.command = "a \\\n#error b"})
          .at(0)
          .text;
  EXPECT_EQ(messages("g++", without_pragma(code)), "");
}

// Two underscores in a name are the language's own.
TEST(Names, OfElementsHaveNoTwoUnderscores) {
  const std::string text =
      "coordinate x[1..2]\nmomentum u[1..2]\nH = sum(i=1..2, u[i]^2/2 + x[i]^4/4) + x[1]*x[2]/3\n";
  for (const Request& request :
       {Request{.alpha = "0", .beta = "h/7"}, Request{.alpha = "2/3", .gamma = "-h/5"}}) {
    const std::string all = header(text, request, "two");
    EXPECT_NE(all.find("_times_"), std::string::npos);
    for (std::size_t at = all.find("__"); at != std::string::npos; at = all.find("__", at + 2)) {
      const auto is_letter = [&](std::size_t i) {
        return std::isalnum(static_cast<unsigned char>(all[i])) != 0;
      };
      EXPECT_FALSE(is_letter(at - 1) && is_letter(at + 2)) << all.substr(at - 20, 60);
    }
  }
}

}  // namespace
}  // namespace hamgen::emitted_test
