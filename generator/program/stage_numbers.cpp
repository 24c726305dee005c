#include "generator/program/stage_numbers.hpp"

#include <fmt/format.h>

#include "generator/program/arithmetic.hpp"
#include "generator/program/linear_terms.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/program/state_rounding.hpp"

namespace hamgen {

namespace {

using Row = std::vector<Rational>;
using Rows = std::vector<Row>;

Row values_of(const std::vector<Expression>& row) {
  Row values;
  for (const Expression& e : row) values.push_back(numeric_value(e));
  return values;
}

// Multiplies a polynomial, coefficients of 1, x, ..., by (x - node) / width.
Row times_linear(const Row& polynomial, const Rational& node, const Rational& width) {
  Row result(polynomial.size() + 1);
  for (std::size_t k = 0; k < polynomial.size(); ++k) {
    result[k] -= polynomial[k] * node / width;
    result[k + 1] += polynomial[k] / width;
  }
  return result;
}

// Integral from 1 to x.
Rational integral_from_one(const Row& polynomial, const Rational& x) {
  Rational sum(0);
  Rational power(1);
  for (std::size_t k = 0; k < polynomial.size(); ++k) {
    power *= x;
    sum += polynomial[k] * (power - 1) / Rational(static_cast<long>(k) + 1);
  }
  return sum;
}

// Row i: with the polynomial that has the slopes f_j at the nodes c_j of the last step, the
// increment from its end to the node 1 + c_i, per L_j = h b_j f_j.
Rows extrapolation(const Row& b, const Row& c) {
  const std::size_t s = b.size();
  Rows result(s, Row(s));
  for (std::size_t j = 0; j < s; ++j) {
    Row lagrange{Rational(1)};
    for (std::size_t k = 0; k < s; ++k) {
      if (k != j) lagrange = times_linear(lagrange, c[k], c[j] - c[k]);
    }
    for (std::size_t i = 0; i < s; ++i) {
      result[i][j] = integral_from_one(lagrange, 1 + c[i]) / b[j];
    }
  }
  return result;
}

class StageNumbers {
 public:
  StageNumbers(const Environment& environment, const LoweredStep& lowered)
      : table_(lowered.sequence.stages),
        nodes_(std::get<RungeKutta>(lowered.plan.equations.scheme.method).c),
        order_(lowered.second_order),
        in_loops_(environment.arrays),
        in_parts_(has_linear_forces(lowered.plan.equations.mechanics)),
        beside_(stages_rounded_beside(lowered)),
        layout_(*lowered.stage_layout),
        stages_(layout_.stages),
        b_({.name = "prepare",
            .result = {.type = "Coefficients", .object = "k"},
            .arguments = {parameters_argument(), {.name = "h"}}}) {
    environment.bind_parameters(b_.routine());
  }

  Coefficients build() {
    add_coupling();
    const Rows ahead = extrapolation(values_of(table_.weight), values_of(nodes_));
    for (int i = 0; i < stages_; ++i) {
      for (int j = 0; j < stages_; ++j) {
        assign("ahead", {i, j}, ahead[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
      }
    }
    add_scaled();
    if (order_) add_second_order();
    for (const NamedWeight& weight : rounding())
      b_.body().push_back({Assign{b_.at("k", weight.name).name(), weight.value}});
    return {.record = {.name = "Coefficients",
                       .fields = fields(),
                       .remark = {"The numbers of the method, and the step."}},
            .prepare = b_.take(),
            .places = {}};
  }

 private:
  [[nodiscard]] std::vector<NamedWeight> rounding() const {
    return beside_ ? beside_->coefficients() : std::vector<NamedWeight>();
  }
  void add_coupling() {
    const std::size_t remark = b_.body().size();
    for (int i = 0; i < stages_; ++i) {
      assign("coupling", {i, i}, Rational(1, 2));
      for (int j = i + 1; j < stages_; ++j) {
        const Rational upper = value(i, j);
        const Rational lower = value(j, i);
        // The larger one is rounded; 1 minus it then is exact.
        const bool up = upper >= lower;
        assign("coupling", up ? std::pair(i, j) : std::pair(j, i), up ? upper : lower);
        const Expression larger = entry("coupling", up ? std::pair(i, j) : std::pair(j, i));
        assign("coupling", up ? std::pair(j, i) : std::pair(i, j), Expression(1) - larger);
      }
    }
    b_.body()[remark].remark = {
        "The step is symplectic because coupling[i][j] + coupling[j][i] = 1.  Written like this "
        "the",
        "sum is 1 exactly: rounded coefficients too give a symplectic step, and no drift in the",
        "energy."};
  }

  // The same from both ends, with the sum h: the middle takes what rounding lost.
  void add_scaled() {
    const std::size_t remark = b_.body().size();
    Expression half = step_size() * Expression(Rational(1, 2));
    if (stages_ > 1) half = b_.let(b_.body(), "half(0)", half);
    for (int i = 0; i < stages_ / 2; ++i) {
      const bool last = stages_ % 2 == 0 && i == stages_ / 2 - 1;
      const Expression weight(numeric_value(table_.weight[static_cast<std::size_t>(i)]));
      const Expression scaled = b_.at("k", "scaled", {affine(i)});
      b_.body().push_back({Assign{scaled.name(), last ? half : weight * step_size()}});
      b_.body().push_back({Assign{b_.at("k", "scaled", {affine(stages_ - 1 - i)}).name(), scaled}});
      if (!last) half = b_.let(b_.body(), fmt::format("half({})", i + 1), half - scaled);
    }
    if (stages_ % 2 == 1) {
      b_.body().push_back(
          {Assign{b_.at("k", "scaled", {affine(stages_ / 2)}).name(), Expression(2) * half}});
    }
    b_.body()[remark].remark = {
        "h b_i, the same from both ends, with the sum h: the middle takes what rounding lost."};
    for (int i = 0; in_parts_ && i < stages_; ++i) {
      const Expression scaled = b_.at("k", "scaled", {affine(i)});
      b_.body().push_back(
          {Assign{b_.at("k", "scaled_high", {affine(i)}).name(), kHighPart * scaled}});
    }
  }

  [[nodiscard]] std::vector<Field> fields() const {
    const std::vector<int> square = {stages_, layout_.room()};
    const bool turned = layout_.by_component();
    std::vector<Field> list = {
        {.name = "coupling",
         .sizes = square,
         .remark = turned ? "[j][i]: a_ij / b_j" : "a_ij / b_j"},
        {.name = "ahead", .sizes = square, .remark = "from L_j of a step to Y_i - z of the next"},
        {.name = "scaled", .sizes = {layout_.room()}, .remark = "h b_i"}};
    if (in_parts_) {
      list.push_back({.name = "scaled_high",
                      .sizes = {layout_.room()},
                      .remark = "most of h b_i, and no simple fractions"});
    }
    for (const NamedWeight& weight : rounding())
      list.push_back({.name = weight.name, .remark = weight.remark});
    if (!order_) return list;
    list.push_back({.name = "twice", .sizes = square, .remark = "[j][i]: h sum_m a_im a_mj / b_j"});
    list.push_back({.name = "node", .sizes = {layout_.room()}, .remark = "h c_i"});
    if (!order_->unit_mobility)
      list.push_back(
          {.name = "mobility", .sizes = {layout_.dimension / 2}, .remark = "d^2 H/dp^2"});
    return list;
  }

  void add_second_order() {
    for (int i = 0; i < stages_; ++i) {
      for (int j = 0; j < stages_; ++j) {
        Rational sum(0);
        for (int m = 0; m < stages_; ++m)
          sum +=
              value(i, m) * numeric_value(table_.weight[static_cast<std::size_t>(m)]) * value(m, j);
        assign("twice", {i, j}, Expression(sum) * step_size());
      }
    }
    for (int i = 0; i < stages_; ++i) {
      const Expression node(numeric_value(nodes_[static_cast<std::size_t>(i)]));
      b_.body().push_back({Assign{b_.at("k", "node", {affine(i)}).name(), node * step_size()}});
    }
    if (order_->unit_mobility) return;
    if (in_loops_) {
      b_.body().push_back({Call{.routine = "masses", .arguments = {{"par"}, {"k", "mobility"}}}});
      return;
    }
    for (std::size_t j = 0; j < order_->mobility.size(); ++j)
      b_.body().push_back({Assign{b_.at("k", "mobility", {affine(static_cast<long>(j))}).name(),
                                  order_->mobility[j]}});
  }

  [[nodiscard]] Rational value(int i, int j) const {
    return numeric_value(table_.coupling[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
  }
  Expression entry(const char* table, std::pair<int, int> at) {
    if (layout_.by_component()) std::swap(at.first, at.second);
    return b_.at("k", table, {affine(at.first), affine(at.second)});
  }
  void assign(const char* table, std::pair<int, int> at, const Expression& value) {
    b_.body().push_back({Assign{entry(table, at).name(), value}});
  }

  const StageTable& table_;
  const std::vector<Expression>& nodes_;
  const std::optional<SecondOrder>& order_;
  bool in_loops_;
  bool in_parts_;
  std::optional<StateRounding> beside_;
  StageLayout layout_;
  int stages_;
  RoutineBuilder b_;
};

}  // namespace

Coefficients stage_coefficients(const Environment& environment, const LoweredStep& lowered) {
  return StageNumbers(environment, lowered).build();
}

}  // namespace hamgen
