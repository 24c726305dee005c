#include "generator/program/runge_kutta_routine.hpp"

#include <fmt/format.h>

#include "generator/program/routine_builder.hpp"

namespace hamgen {

namespace {

// sum row_j f_j of what is not zero.
template <class Slope>
Expression combination(const std::vector<Expression>& row, const Slope& slope) {
  std::vector<Expression> terms;
  for (std::size_t j = 0; j < row.size(); ++j) {
    const Rational number = numeric_value(row[j]);
    if (number != 0) terms.push_back(Expression(number) * slope(j));
  }
  return Expression::sum(std::move(terms));
}

class ExplicitRoutine {
 public:
  ExplicitRoutine(const Environment& environment, const StageTable& table)
      : environment_(environment),
        table_(table),
        n_(environment.degrees_of_freedom),
        b_({.name = "solve",
            .remark = {"dz = Z - z for one step from z + carry."},
            .result = {.type = "StepReport", .object = "report"},
            .arguments = arguments(environment)}) {}

  Routine build() {
    add_state();
    if (table_.weight.size() > 1) declare("y");
    for (std::size_t i = 0; i < table_.weight.size(); ++i) add_stage(i);
    add_result();
    return b_.take();
  }

 private:
  static std::vector<Argument> arguments(const Environment& environment) {
    std::vector<Argument> list = {parameters_argument(),
                                  {.name = "h"},
                                  state_argument("z"),
                                  state_argument("carry"),
                                  state_argument("dz", true)};
    if (environment.arrays)
      list.insert(list.end() - 1, {.name = "start", .record = "Start", .changes = true});
    return list;
  }
  // Of a large system the arrays are not on the stack.
  [[nodiscard]] Place array(const std::string& name) const {
    return environment_.arrays ? Place{"start", name} : Place{name};
  }
  void add_state() {
    if (environment_.arrays) return read_state(b_, b_.body(), environment_, "z", array("x"), true);
    std::vector<Expression> components;
    for (int i = 0; i < 2 * n_; ++i) components.push_back(b_.at(environment_.place("z", i)));
    b_.body().push_back({Array{"x", {2 * n_}, std::move(components)}});
  }
  void declare(const std::string& name) {
    if (!environment_.arrays) b_.body().push_back({Array{name, {2 * n_}}});
  }
  Expression element(const std::string& name, const AffineIndex& index) {
    const Place whole = array(name);
    return b_.at(whole.object, whole.field, {index});
  }

  void add_stage(std::size_t i) {
    const Expression sum = combination(
        table_.coupling[i], [&](std::size_t j) { return element(explicit_slope(j), affine("k")); });
    declare(explicit_slope(i));
    if (!sum.is_zero()) {
      const Expression from = element("x", affine("k"));
      Body move{{Assign{element("y", affine("k")).name(), from + step_size() * sum}}};
      b_.body().push_back(for_each(counting("k", 2 * n_), std::move(move)));
    }
    b_.body().push_back({Call{
        "vector_field", {{"par"}, array(sum.is_zero() ? "x" : "y"), array(explicit_slope(i))}}});
  }

  // dz = carry + h sum b_j f_j at a place of them, of f at another.
  void add_increment(Body& body, Return& end, const Place& dz, const Place& carry,
                     const AffineIndex& of_slopes) {
    const std::string name = b_.at(dz).name();
    const Expression small = b_.at(carry);
    const Expression slope = combination(
        table_.weight, [&](std::size_t j) { return element(explicit_slope(j), of_slopes); });
    body.push_back({Assign{name, small + step_size() * slope}});
    end.finite.push_back(name);
  }
  void add_result() {
    Return end;
    if (environment_.arrays) {
      Body each;
      for (const char* half : {"q", "p"}) {
        add_increment(each, end, {"dz", half, {affine("j")}}, {"carry", half, {affine("j")}},
                      affine("j", half[0] == 'q' ? 0 : n_));
      }
      end.ranges = {counting("j", n_)};
      b_.body().push_back(for_each(counting("j", n_), std::move(each)));
    } else {
      for (int i = 0; i < 2 * n_; ++i) {
        add_increment(b_.body(), end, environment_.place("dz", i), environment_.place("carry", i),
                      affine(i));
      }
    }
    b_.body().push_back({std::move(end)});
  }

  const Environment& environment_;
  const StageTable& table_;
  int n_;
  RoutineBuilder b_;
};

}  // namespace

void read_state(RoutineBuilder& b, Body& body, const Environment& environment,
                const std::string& state, const Place& array, bool arrays) {
  const int n = environment.degrees_of_freedom;
  const auto element = [&](const AffineIndex& index) {
    return b.at(array.object, array.field, {index}).name();
  };
  if (arrays) {
    Body each;
    each.push_back({Assign{element(affine("j")), b.at(state, "q", {affine("j")})}});
    each.push_back({Assign{element(affine("j", n)), b.at(state, "p", {affine("j")})}});
    body.push_back(for_each(counting("j", n), std::move(each)));
    return;
  }
  for (int i = 0; i < 2 * n; ++i) {
    body.push_back({Assign{element(affine(i)), b.at(environment.place(state, i))}});
  }
}

std::string explicit_slope(std::size_t stage) { return fmt::format("f_{}", stage + 1); }

void add_explicit_runge_kutta(Program& code, const Environment& environment,
                              const StageTable& table) {
  if (environment.arrays) {
    Record start{.name = "Start", .fields = {}, .remark = {"What a step works with."}};
    const auto add = [&](const std::string& name, const char* remark) {
      start.fields.push_back(
          {.name = name, .sizes = {2 * environment.degrees_of_freedom}, .remark = remark});
    };
    add("x", "z");
    if (table.weight.size() > 1) add("y", "a stage");
    for (std::size_t i = 0; i < table.weight.size(); ++i) add(explicit_slope(i), "J grad H there");
    code.records.push_back(std::move(start));
  }
  code.routines.push_back(ExplicitRoutine(environment, table).build());
}

}  // namespace hamgen
