// What builds the routines of loops by hand: their elements as symbols.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/code.hpp"

namespace hamgen {

// constant, or constant + factor * index.
[[nodiscard]] inline AffineIndex affine(long constant) {
  return {.constant = constant, .factors = {}};
}
[[nodiscard]] inline AffineIndex affine(const std::string& index, long constant = 0,
                                        long factor = 1) {
  return {.constant = constant, .factors = {{index, factor}}};
}
// index = 0..count - 1
[[nodiscard]] inline KernelRange counting(const std::string& index, long count) {
  return {.index = index, .lower = {}, .upper = affine(count - 1)};
}
[[nodiscard]] inline Instruction for_each(KernelRange range, Body body) {
  return {For{std::move(range), std::move(body)}};
}
// So many at once; 0: one after the other.
[[nodiscard]] inline Instruction in_lanes(KernelRange range, int lanes, Body body) {
  return {For{std::move(range), std::move(body), lanes}};
}

// An element by a symbol that is no name of the model, in a routine that has locals of such names.
inline Expression at_apart(Routine& routine, const Place& place, int rank = kRankOfTemporary) {
  const std::string symbol = "at " + to_text(place);
  routine.places.insert_or_assign(symbol, place);
  return Expression::symbol(symbol, rank);
}

// Binds elements to symbols.  Sums and products are written in the order in which their symbols
// came: two that are new are bound in two statements, or by `product`, for C++ leaves the order of
// operands open.
class RoutineBuilder {
 public:
  explicit RoutineBuilder(Routine routine) : routine_(std::move(routine)) {}

  // The element of a field of an object, or without a field of the object itself.
  Expression at(const std::string& object, const std::string& field,
                std::vector<AffineIndex> indices = {}) {
    return at(Place{object, field, std::move(indices)});
  }
  Expression at(const Place& place) {
    const std::string symbol = to_text(place);
    const auto known =
        ranks_.try_emplace(symbol, kRankOfVariable + static_cast<int>(ranks_.size()));
    routine_.places.insert_or_assign(symbol, place);
    return Expression::symbol(symbol, known.first->second);
  }
  Expression product(const Place& first, const Place& second) {
    const Expression factor = at(first);
    return factor * at(second);
  }
  Expression local(const std::string& name) {
    const auto known = ranks_.try_emplace(name, kRankOfVariable + static_cast<int>(ranks_.size()));
    return Expression::symbol(name, known.first->second);
  }
  // A local with this value.
  Expression let(Body& body, const std::string& name, const Expression& value) {
    body.push_back({Let{name, value}});
    return local(name);
  }
  [[nodiscard]] Body& body() { return routine_.body; }
  [[nodiscard]] Routine& routine() { return routine_; }
  [[nodiscard]] Routine take() { return std::move(routine_); }

 private:
  Routine routine_;
  std::map<std::string, int> ranks_;
};

}  // namespace hamgen
