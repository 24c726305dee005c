// From definitions to statements: constants hoisted, repeated subexpressions named, powers made
// products and square roots.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/program/lowered_step.hpp"

namespace hamgen {

// Where code runs.  Sections are ordered; a loop's body is the only one that runs many times.
struct Section {
  bool is_loop = false;
};

struct WantedValue {
  std::string name;
  Expression value;
  int section = 0;  // where it is wanted; it moves up if it depends on less
  // Of `yes` a number of its own, though it is a multiple of another; of `apart` one that has
  // nothing to do with others of the same value, be it a number that the algebra knows.
  enum class Keep { no, yes, apart } keep = Keep::no;
};

class Lowering {
 public:
  explicit Lowering(std::vector<Section> sections);

  // Declares a symbol that exists from a section on (state, parameters, loop variables).
  void declare(const std::string& name, int section);
  // Adds definitions whose values are wanted; results are rewritten in place by `run`.
  using Keep = WantedValue::Keep;
  void define(std::string name, Expression value, int section, Keep keep = Keep::no);
  // An expression evaluated in a section but not named (increments, residuals).
  std::size_t want(Expression value, int section);

  // Rewrites everything.  Definitions nobody uses, directly or not, are dropped.
  void run();
  [[nodiscard]] const std::vector<Statement>& statements(int section) const;
  [[nodiscard]] const Expression& wanted(std::size_t handle) const;

 private:
  struct Want {
    Expression value;
    int section = 0;
    Expression result;
  };
  void drop_unused();
  void inline_trivial();
  void count(const Expression& e);
  [[nodiscard]] int level(const Expression& e);
  [[nodiscard]] int place(const Expression& e, int section);
  [[nodiscard]] Expression rewrite(const Expression& e, int section);
  [[nodiscard]] Expression rewrite_operands(const Expression& e, int section);
  [[nodiscard]] Expression rewrite_power(const Expression& base, const Rational& exponent,
                                         int section);
  [[nodiscard]] Expression temporary(const Expression& value, const Expression& key, int section);

  std::vector<Section> sections_;
  std::vector<WantedValue> definitions_;
  std::vector<Want> wants_;
  std::map<std::string, int> levels_;
  std::map<const void*, int> level_cache_;
  std::vector<Expression> keep_alive_;
  ExpressionMap<int> uses_;
  ExpressionMap<Expression> named_;
  Substitution aliases_;  // definitions that turned out to be another value's name
  std::vector<std::vector<Statement>> output_;
  int next_ = 0;
};

// Is it as cheap as a name: a symbol, a number, or one of them with a sign?
[[nodiscard]] bool is_trivial(const Expression& e);

}  // namespace hamgen
