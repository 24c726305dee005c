// The proof that the emitted code is the mathematics: it holds for what is emitted, and notices
// what is not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "generator/equations/step_equations.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/program/program.hpp"
#include "generator/solvers/solve_plan.hpp"
#include "generator/verify/proof.hpp"

namespace hamgen {
namespace {

struct Case {
  std::string name;
  std::string text;  // of the model, without its first line
  std::string solver;
  Expression alpha, beta, gamma;
};

Expression half() { return Expression(Rational(1, 2)); }
Expression number(long over, long under) { return Expression(Rational(over, under)); }

Scheme scheme_of(const Case& c, int n) {
  return family_member(n, {{c.alpha}}, {{c.beta}}, {{c.gamma}});
}

Mechanics mechanics_of(const Case& c) {
  return derive(read_model(make_source("case.ham", "system case\n" + c.text)));
}

Program program_of(const Mechanics& mechanics, const Scheme& scheme, const std::string& solver) {
  return build_program(plan_solve(discretise(mechanics, scheme), solver));
}

const std::string kPendulum =
    "coordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n";
const std::string kHenonHeiles =
    "coordinate q1, q2\nmomentum p1, p2\n"
    "H = (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3\ninvariant Q = q1*p2\n";
const std::string kKepler =
    "coordinate x, y\nmomentum px, py\nparameter mu = 1\nH = (px^2 + py^2)/2 - mu/sqrt(x^2 + "
    "y^2)\n";
const std::string kProduct = "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n";
const std::string kSpring = "coordinate q\nmomentum p\nparameter w = 2\nH = p^2/2 + w^2*q^2/2\n";
const std::string kMagnetic =
    "coordinate x, y\nmomentum px, py\nparameter B = 1\n"
    "H = (px + B*y/2)^2/2 + (py - B*x/2)^2/2 + x^2*y^2\n";
const std::string kSuccessive =
    "coordinate q1, q2\nmomentum p1, p2\nH = q1*p1^3/3 + q2*p1*p2 + q1^2 + p1*p2^2\n";
const std::string kRing =
    "size N = 5\ncoordinate q[1..N] periodic\nmomentum p[1..N]\n"
    "H = sum(i = 1..N, p[i]^2/2 + (q[i+1] - q[i])^4/4 + q[i]^2/2)\n";

std::vector<Case> cases() {
  const Expression h = Expression::symbol("h", kRankOfStep);
  const Expression zero(0);
  return {
      {"explicit", kPendulum, "", zero, zero, zero},
      {"explicit, two degrees of freedom", kHenonHeiles, "", Expression(1), zero, zero},
      {"Newton of size 1", kPendulum, "", half(), number(1, 10) * h, number(-1, 12) * h},
      {"Newton of size 2", kHenonHeiles, "", half(), zero, zero},
      {"Newton of size 2 with roots", kKepler, "", number(2, 5), zero, zero},
      {"Newton of size 2, nothing torn", kProduct, "", half(), number(1, 5), number(1, 7)},
      {"dense Newton", kRing, "", half(), zero, zero},
      {"dense Newton, full gauge", kMagnetic, "", number(1, 3), number(1, 5), number(1, 7)},
      {"linear", kSpring, "", half(), zero, zero},
      {"quadratic", kProduct, "", zero, zero, zero},
      {"Newton, then linear", kSuccessive, "", zero, zero, zero},
      {"quadratic in q", kProduct, "", Expression(1), zero, zero},
      {"fixed point", kHenonHeiles, "fixed-point", half(), zero, zero},
      {"sweeps", kKepler, "sweeps:3", half(), number(1, 9), zero},
  };
}

// Every expression the program holds.
void for_each_expression(Program& program, const std::function<void(Expression&)>& visit) {
  auto statements = [&](std::vector<Statement>& list) {
    for (Statement& s : list) visit(s.value);
  };
  auto expressions = [&](std::vector<Expression>& list) {
    for (Expression& e : list) visit(e);
  };
  statements(program.coefficients);
  for (Stage& stage : program.stages) {
    statements(stage.before);
    if (stage.solve) {
      statements(stage.solve->body);
      expressions(stage.solve->residual);
      for (auto& row : stage.solve->matrix) expressions(row);
      for (LoopVariable& v : stage.solve->variables) {
        for (Expression* e : {&v.cold, &v.next, &v.correction}) visit(*e);
      }
    }
    statements(stage.after);
  }
  expressions(program.increments);
  for (Evaluation* evaluation : {&program.energy, &program.gradient, &program.invariants}) {
    statements(evaluation->statements);
    expressions(evaluation->results);
  }
}

// An expression with one node changed: all ways of a kind.
using Change = std::function<std::vector<Expression>(const Expression&)>;

Expression rebuilt(const Expression& e, std::vector<Expression> operands) {
  switch (e.kind()) {
    case Kind::sum:
      return Expression::sum(std::move(operands));
    case Kind::product:
      return Expression::product(std::move(operands));
    case Kind::power:
      return Expression::power(operands[0], operands[1]);
    case Kind::function:
      return Expression::apply(e.name(), std::move(operands));
    default:
      return e;
  }
}

std::vector<Expression> changed_somewhere(const Expression& e, const Change& change) {
  std::vector<Expression> result = change(e);
  std::vector<Expression> operands(e.operands().begin(), e.operands().end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Expression kept = operands[i];
    for (const Expression& other : changed_somewhere(kept, change)) {
      operands[i] = other;
      result.push_back(rebuilt(e, operands));
    }
    operands[i] = kept;
  }
  return result;
}

struct Mutation {
  std::string name;
  Change change;
};

std::string exchanged(std::string name) {
  // x and px, q1 and p1 and the names made of them change places.
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == 'q') {
      name[i] = 'p';
    } else if (name[i] == 'p' && i + 1 < name.size() &&
               (name[i + 1] == 'x' || name[i + 1] == 'y')) {
      name.erase(i, 1);
    } else if (name[i] == 'x' || name[i] == 'y') {
      name.insert(i++, "p");
    } else if (name[i] == 'p') {
      name[i] = 'q';
    }
  }
  return name;
}

std::vector<Mutation> mutations(const std::set<std::string>& known) {
  using List = std::vector<Expression>;
  return {
      {"sign", [](const Expression& e) { return e.is_zero() ? List{} : List{-e}; }},
      {"coefficient",
       [](const Expression& e) {
         return e.is_number() && !e.is_zero() ? List{e * number(1001, 1000)} : List{};
       }},
      {"dropped operand",
       [](const Expression& e) {
         List result;
         if (e.kind() != Kind::sum && e.kind() != Kind::product) return result;
         for (std::size_t i = 0; i < e.operands().size(); ++i) {
           List rest(e.operands().begin(), e.operands().end());
           rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
           result.push_back(rebuilt(e, rest));
         }
         return result;
       }},
      {"wrong power",
       [](const Expression& e) {
         if (e.kind() != Kind::power) return List{};
         return List{Expression::power(e.operands()[0], e.operands()[1] + Expression(1))};
       }},
      {"q and p exchanged",
       [known](const Expression& e) {
         if (e.kind() != Kind::symbol) return List{};
         const std::string other = exchanged(e.name());
         return other != e.name() && known.contains(other) ? List{Expression::symbol(other)}
                                                           : List{};
       }},
      {"another function",
       [](const Expression& e) {
         if (e.kind() != Kind::function) return List{};
         return List{Expression::apply(e.name() == "sin" ? "cos" : "sin", {e.operands()[0]})};
       }},
  };
}

// The program's results in double at one point: an oracle that shares nothing with the proof. Empty
// if a value is used before it is computed.
class Interpreter {
 public:
  std::optional<std::vector<double>> operator()(Program program) {
    try {
      run(program.coefficients);
      for (const Stage& stage : program.stages) {
        run(stage.before);
        if (stage.solve) {
          run(stage.solve->body);
          for (const Expression& e : stage.solve->residual) results_.push_back(value(e));
          for (const auto& row : stage.solve->matrix) {
            for (const Expression& e : row) results_.push_back(value(e));
          }
          for (const LoopVariable& v : stage.solve->variables) {
            for (const Expression& e : {v.cold, v.next, v.correction}) results_.push_back(value(e));
          }
        }
        run(stage.after);
      }
      for (const Expression& e : program.increments) results_.push_back(value(e));
      for (const Evaluation* e : {&program.energy, &program.gradient, &program.invariants}) {
        run(e->statements);
        for (const Expression& result : e->results) results_.push_back(value(result));
      }
    } catch (const std::out_of_range&) {
      return std::nullopt;
    }
    return results_;
  }

 private:
  void run(const std::vector<Statement>& statements) {
    for (const Statement& s : statements) pending_.insert(s.name);
    for (const Statement& s : statements) {
      values_[s.name] = value(s.value);
      pending_.erase(s.name);
    }
  }
  double symbol(const std::string& name) {
    if (pending_.contains(name)) throw std::out_of_range(name);
    // Free symbols: some number from 1/2 to 3/2 that depends on the name.
    const double spread = static_cast<double>(std::hash<std::string>{}(name) % 1000) / 1000;
    return values_.try_emplace(name, name == "h" ? 0.1 : 0.5 + spread).first->second;
  }
  double value(const Expression& e) {
    std::vector<double> x;
    for (const Expression& operand : e.operands()) x.push_back(value(operand));
    switch (e.kind()) {
      case Kind::number:
        return e.number().get_d();
      case Kind::symbol:
        return symbol(e.name());
      case Kind::sum:
        return std::accumulate(x.begin(), x.end(), 0.0);
      case Kind::product:
        return std::accumulate(x.begin(), x.end(), 1.0, std::multiplies<>());
      case Kind::power:
        return std::pow(x[0], x[1]);
      case Kind::function:
        return e.name() == "sin" ? std::sin(x[0]) : std::cos(x[0]);
    }
    return 0;
  }
  std::map<std::string, double> values_;
  std::set<std::string> pending_;
  std::vector<double> results_;
};

bool computes_the_same(const Program& a, const Program& b) {
  const auto of_a = Interpreter()(a);
  const auto of_b = Interpreter()(b);
  if (!of_a || !of_b) return false;
  for (std::size_t i = 0; i < of_a->size(); ++i) {
    // Rounding errors stay below 1e-12; a mutation moves a value by at least 1e-3 of one of its
    // terms.
    if (!(std::abs((*of_a)[i] - (*of_b)[i]) <= 1e-12 * (1 + std::abs((*of_a)[i])))) return false;
  }
  return true;
}

TEST(EmittedCode, IsTheMathematicsForEverySolver) {
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
    const Program program = program_of(mechanics, scheme, c.solver);
    const Finding finding = prove_emitted(mechanics, scheme, program, mechanics.energy);
    EXPECT_EQ(finding.verdict, Verdict::proved) << c.name << ": " << finding.detail;
  }
}

// A mutation may cancel, such as the sign of a factor that is squared later: those that compute the
// same by the interpreter must pass, all others be refuted.
TEST(EmittedCode, EveryMutationOfAProgramIsRefuted) {
  int mutants = 0;
  int equivalent = 0;
  std::map<std::string, int> by_kind;
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const Scheme scheme = scheme_of(c, mechanics.degrees_of_freedom);
    const Program original = program_of(mechanics, scheme, c.solver);
    std::set<std::string> known;
    int places = 0;
    Program copy = original;
    for_each_expression(copy, [&](Expression& e) {
      collect_symbols(e, known);
      ++places;
    });
    int of_case = 0;
    int kind = 0;
    for (const Mutation& mutation : mutations(known)) {
      ++kind;
      for (int place = 0; place < places; ++place) {
        int now = 0;
        std::vector<Expression> variants;
        for_each_expression(copy, [&](Expression& e) {
          if (now++ == place) variants = changed_somewhere(e, mutation.change);
        });
        // A handful of places, spread over the program, keeps the test short.
        if (variants.empty() || (place + kind) % (1 + places / 12) != 0) continue;
        for (std::size_t v = 0; v < variants.size(); v += 1 + variants.size() / 2) {
          Program mutant = original;
          now = 0;
          Expression before;
          for_each_expression(mutant, [&](Expression& e) {
            if (now++ != place) return;
            before = e;
            e = variants[v];
          });
          if (before == variants[v]) continue;
          const Finding finding = prove_emitted(mechanics, scheme, mutant, mechanics.energy);
          if (computes_the_same(original, mutant)) {
            EXPECT_EQ(finding.verdict, Verdict::proved) << c.name << ": " << to_text(before);
            ++equivalent;
            continue;
          }
          EXPECT_EQ(finding.verdict, Verdict::refuted)
              << c.name << ", " << mutation.name << ": " << to_text(before) << " -> "
              << to_text(variants[v]) << "\n"
              << finding.detail;
          ++mutants;
          ++of_case;
          ++by_kind[mutation.name];
        }
      }
    }
    EXPECT_GE(of_case, 8) << c.name;
  }
  RecordProperty("mutants", mutants);
  std::string counts;
  for (const auto& [name, count] : by_kind) counts += fmt::format(", {} {}", count, name);
  fmt::print("{} mutants{}; {} others compute the same\n", mutants, counts, equivalent);
  EXPECT_GE(mutants, 300);
  EXPECT_EQ(by_kind.size(), 6U);
}

TEST(EmittedCode, ParametersOfTheFamilyMayNotBeExchanged) {
  for (const Case& c : cases()) {
    const Mechanics mechanics = mechanics_of(c);
    const int n = mechanics.degrees_of_freedom;
    const Case straight{c.name, c.text, c.solver, number(1, 3), number(1, 5), number(1, 7)};
    Case swapped = straight;
    std::swap(swapped.beta, swapped.gamma);
    const Program program = program_of(mechanics, scheme_of(swapped, n), c.solver);
    EXPECT_EQ(prove_emitted(mechanics, scheme_of(swapped, n), program, mechanics.energy).verdict,
              Verdict::proved)
        << c.name;
    EXPECT_EQ(prove_emitted(mechanics, scheme_of(straight, n), program, mechanics.energy).verdict,
              Verdict::refuted)
        << c.name;
  }
}

// The derivatives are derived anew from H: a wrong one in the mechanics does not pass.
TEST(EmittedCode, WrongDerivativesOfTheMechanicsAreRefuted) {
  for (const Case& c : cases()) {
    Mechanics wrong = mechanics_of(c);
    wrong.gradient[0] = wrong.gradient[0] * Expression(2);
    const Scheme scheme = scheme_of(c, wrong.degrees_of_freedom);
    const Program first = program_of(wrong, scheme, c.solver);
    EXPECT_EQ(prove_emitted(wrong, scheme, first, wrong.energy).verdict, Verdict::refuted)
        << c.name;
    if (c.solver != "" || c.alpha.is_zero() || c.alpha.is_one()) continue;  // no Hessian in them
    wrong = mechanics_of(c);
    Expression& entry = wrong.hessian.begin()->second;
    entry = entry * Expression(2);
    const Program second = program_of(wrong, scheme, c.solver);
    EXPECT_EQ(prove_emitted(wrong, scheme, second, wrong.energy).verdict, Verdict::refuted)
        << c.name;
  }
}

TEST(EmittedCode, LoopsOverSumsAreReadToo) {
  const std::string text =
      "size N = 40\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\nparameter k = "
      "1\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, k*(q[i+1] - q[i])^4/4)\n";
  const Model model = read_model(make_source("chain.ham", "system chain\n" + text));
  Mechanics mechanics = derive(model);
  ASSERT_TRUE(mechanics.keeps_sums());
  const Expression hamiltonian = written_out_hamiltonian(model);
  const Scheme scheme = family_member(40, {{half()}}, {{Expression(0)}}, {{Expression(0)}});
  const Program program = program_of(mechanics, scheme, "");
  // Tested, not proved: the solver around the loops is not read.
  EXPECT_EQ(prove_emitted(mechanics, scheme, program, hamiltonian).verdict, Verdict::tested);
  Mechanics slope = mechanics;
  slope.kernels.back().gradient.front() += Expression(1);
  EXPECT_EQ(prove_emitted(slope, scheme, program, hamiltonian).verdict, Verdict::refuted);
  Mechanics shifted = mechanics;
  shifted.kernels.back().slots.front().position.constant += 1;
  EXPECT_EQ(prove_emitted(shifted, scheme, program, hamiltonian).verdict, Verdict::refuted);
}

}  // namespace
}  // namespace hamgen
