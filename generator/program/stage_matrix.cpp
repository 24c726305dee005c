#include "generator/program/stage_matrix.hpp"

namespace hamgen {

std::vector<Field> StageMatrix::fields() const {
  if (!is_packed()) return {};
  return {{.name = "packed", .sizes = {size()}, .remark = "lack, of stages"}};
}

Routine StageMatrix::differentiate() const {
  const std::string derivative = second_order_ ? "1 + twice h b V''" : "1 - coupling h b J H''";
  RoutineBuilder b({.name = "differentiate",
                    .remark = {derivative + ", the derivative of what the stages lack, with the "
                                            "Hessian at their mean."},
                    .arguments = with_start(false)});
  const int components = second_order_ ? n_ : dimension_;
  b.body().push_back({Array{"mean", {dimension_}}});
  Expression sum(0);
  for (int m = 0; m < stages_; ++m) sum += of_start(b, "value", row_of(m));
  Body mean{
      {Assign{b.at("mean", "", {affine("j")}).name(), sum * Expression(Rational(1, stages_))}}};
  b.body().push_back(for_each(counting("j", components), std::move(mean)));
  b.body().push_back({Array{"values", {dimension_, dimension_}}});
  b.body().push_back({Call{.routine = "hessian", .arguments = {{"par"}, {"mean"}, {"values"}}}});
  const Place matrix{"start", "matrix"};
  b.body().push_back({Clear{matrix}});
  Body one{{Put{matrix, affine("j"), affine("j"), Expression(1)}}};
  b.body().push_back(for_each(counting("j", size()), std::move(one)));
  Body entries;
  const Expression coupling = entry(b, second_order_ ? "twice" : "coupling", affine("m"));
  const Expression scaled = b.at("k", "scaled", {affine("m")});
  const Expression weight = b.let(entries, "weight", coupling * scaled);
  Body each;
  second_order_ ? add_block_of_coordinates(b, weight, each) : add_blocks(b, weight, each);
  Body columns;
  columns.push_back(for_each(counting("c", components), std::move(each)));
  entries.push_back(for_each(counting("j", n_), std::move(columns)));
  Body pairs;
  pairs.push_back(for_each(counting("m", stages_), std::move(entries)));
  b.body().push_back(for_each(counting("i", stages_), std::move(pairs)));
  return b.take();
}

// Rows of coordinates have J H'' = H_p.., those of momenta -H_q...
void StageMatrix::add_blocks(RoutineBuilder& b, const Expression& weight, Body& each) const {
  const Place matrix{"start", "matrix"};
  const StageLayout packed = layout_.without_room();
  const AffineIndex column = packed.index("m", 0, "c", 0);
  each.push_back({Put{matrix, packed.index("i", 0, "j", 0), column,
                      -weight * b.at("values", "", {affine("j", n_), affine("c")})}});
  each.push_back({Put{matrix, packed.index("i", 0, "j", n_), column,
                      weight * b.at("values", "", {affine("j"), affine("c")})}});
}

void StageMatrix::add_block_of_coordinates(RoutineBuilder& b, const Expression& weight,
                                           Body& each) const {
  const StageLayout packed = layout_.without_room();
  Expression entry = weight * b.at("values", "", {affine("j"), affine("c")});
  if (!second_order_->unit_mobility) entry = entry * b.at("k", "mobility", {affine("j")});
  each.push_back({Put{
      {"start", "matrix"}, packed.index("i", 0, "j", 0), packed.index("m", 0, "c", 0), entry}});
}

void StageMatrix::add_elimination(RoutineBuilder& b, Body& body) const {
  const Place matrix{"start", "matrix"};
  if (!is_packed()) {
    body.push_back({SolveFactorised{matrix, {"start", "lack"}}});
    return;
  }
  const StageLayout packed = layout_.without_room();
  const std::string here = of_start(b, "packed", packed.index("i", 0, "j", 0)).name();
  const std::string there = of_start(b, "lack", row()).name();
  const auto copy = [&](const std::string& to, const std::string& from) {
    Body each{{Assign{to, b.local(from)}}};
    Body stages;
    stages.push_back(for_each(counting("i", stages_), std::move(each)));
    const int components = second_order_ ? n_ : dimension_;
    body.push_back(for_each(counting("j", components), std::move(stages)));
  };
  copy(here, there);
  body.push_back({SolveFactorised{matrix, {"start", "packed"}}});
  copy(there, here);
}

}  // namespace hamgen
