#include "generator/program/runge_kutta_routine.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

class ExplicitRoutine {
 public:
  ExplicitRoutine(const Environment& environment, const StageTable& table)
      : environment_(environment),
        table_(table),
        size_(2 * environment.degrees_of_freedom),
        all_{"k", {0, {}}, {size_ - 1, {}}} {}

  Routine build() {
    routine_ = {.name = "solve",
                .remark = {"dz = Z - z for one step from z + carry."},
                .result = {.type = "StepReport", .object = "report"},
                .arguments = {parameters_argument(),
                              {.name = "h"},
                              state_argument("z"),
                              state_argument("carry"),
                              state_argument("dz", true)}};
    Body& body = routine_.body;
    std::vector<Expression> components;
    for (int i = 0; i < size_; ++i) components.push_back(environment_.bind_state(routine_, "z", i));
    body.push_back({Array{"x", {size_}, std::move(components)}});
    if (table_.weight.size() > 1) body.push_back({Array{"y", {size_}}});
    for (std::size_t i = 0; i < table_.weight.size(); ++i) add_stage(body, i);
    Return end;
    for (int i = 0; i < size_; ++i) {
      const Expression dz = environment_.bind_state(routine_, "dz", i);
      const Expression carry = environment_.bind_state(routine_, "carry", i);
      const Expression slope = combination(
          table_.weight, [&](std::size_t j) { return bind_element(routine_, slope_name(j), {i}); });
      body.push_back({Assign{dz.name(), carry + step_size() * slope}});
      end.finite.push_back(dz.name());
    }
    body.push_back({std::move(end)});
    return std::move(routine_);
  }

 private:
  static std::string slope_name(std::size_t stage) { return fmt::format("f_{}", stage + 1); }

  // sum row_j f_j of what is not zero.
  template <class Slope>
  static Expression combination(const std::vector<Expression>& row, const Slope& slope) {
    std::vector<Expression> terms;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const Rational number = numeric_value(row[j]);
      if (number != 0) terms.push_back(Expression(number) * slope(j));
    }
    return Expression::sum(std::move(terms));
  }

  // An element of an array that the loop over all components runs through.
  Expression running(const std::string& array) {
    const std::string symbol = array + "(k)";
    routine_.places.insert_or_assign(symbol, Place{array, "", {{0, {{"k", 1}}}}});
    return Expression::symbol(symbol, kRankOfTemporary);
  }

  void add_stage(Body& body, std::size_t i) {
    const Expression sum =
        combination(table_.coupling[i], [&](std::size_t j) { return running(slope_name(j)); });
    body.push_back({Array{slope_name(i), {size_}}});
    if (!sum.is_zero()) {
      Body move{{Assign{running("y").name(), running("x") + step_size() * sum}}};
      body.push_back({For{all_, std::move(move)}});
    }
    body.push_back({Call{"vector_field", {{"par"}, {sum.is_zero() ? "x" : "y"}, {slope_name(i)}}}});
  }

  const Environment& environment_;
  const StageTable& table_;
  int size_;
  KernelRange all_;
  Routine routine_;
};

}  // namespace

Routine explicit_runge_kutta_routine(const Environment& environment, const StageTable& table) {
  return ExplicitRoutine(environment, table).build();
}

}  // namespace hamgen
