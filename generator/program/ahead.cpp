#include "generator/program/ahead.hpp"

#include <algorithm>
#include <set>

#include "generator/base/diagnostic.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

using Symbols = std::set<std::string>;

const Solve& only_solve(const LoweredStep& lowered) {
  for (const Stage& stage : lowered.stages) {
    if (stage.solve) return *stage.solve;
  }
  internal_error("derivatives ahead of no solve");
}

bool reads_only(const Expression& value, const Symbols& known) {
  return std::ranges::includes(known, symbols(value));
}

// What is known where the unknowns are.
Symbols known_at_a_point(const Environment& environment, const LoweredStep& lowered) {
  Symbols known = {"pi"};
  for (const Quantity& parameter : environment.parameters) known.insert(parameter.name);
  // Coefficients that are free of h: derivatives of H are.
  for (const Statement& s : lowered.coefficients) {
    if (reads_only(s.value, known)) known.insert(s.name);
  }
  for (const LoopVariable& v : only_solve(lowered).variables) known.insert(v.name);
  return known;
}

// What is read of the solve's body by itself and by what comes after it.
Symbols read_of(const LoweredStep& lowered, const std::vector<Statement>& body) {
  Symbols read = used_symbols(body);
  for (const LoopVariable& v : only_solve(lowered).variables) collect_symbols(v.correction, read);
  for (const Stage& stage : lowered.stages) read.merge(used_symbols(stage.after));
  for (const auto* list : {&lowered.increments, &lowered.rests}) {
    for (const Expression& e : *list) collect_symbols(e, read);
  }
  return read;
}

}  // namespace

SplitBody split_body(const Environment& environment, const LoweredStep& lowered) {
  SplitBody split;
  Symbols known = known_at_a_point(environment, lowered);
  for (const Statement& s : only_solve(lowered).body) {
    const bool of_point = reads_only(s.value, known);
    if (of_point) known.insert(s.name);
    (of_point ? split.of_point : split.rest).push_back(s);
  }
  const Symbols read = read_of(lowered, split.rest);
  for (const Statement& s : split.of_point) {
    if (read.contains(s.name)) split.wanted.push_back(s.name);
  }
  return split;
}

DerivativesAhead derivatives_ahead(const Environment& environment, const LoweredStep& lowered,
                                   const CoefficientPlaces& coefficients) {
  const SplitBody split = split_body(environment, lowered);
  const std::vector<LoopVariable>& unknowns = only_solve(lowered).variables;
  DerivativesAhead ahead{
      .record = {.name = "Derivatives",
                 .fields = {{.name = "point", .sizes = {static_cast<int>(unknowns.size())}},
                            {.name = "ready",
                             .remark = "are the others those at the point?",
                             .values = {0},
                             .type = "bool"}},
                 .remark = {"Derivatives of H, and what they consist of, at a point."}},
      .routine = {.name = "derivatives",
                  .remark = {"Those at at.point."},
                  .arguments = {parameters_argument()},
                  .places = coefficients}};
  Routine& routine = ahead.routine;
  const Symbols used = used_symbols(split.of_point);
  const bool takes_coefficients = std::ranges::any_of(
      coefficients, [&](const auto& entry) { return used.contains(entry.first); });
  if (takes_coefficients) routine.arguments.push_back({.name = "k", .record = "Coefficients"});
  routine.arguments.push_back({.name = "at", .record = "Derivatives", .changes = true});
  environment.bind_parameters(routine);
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    const Place element{"at", "point", {{.constant = static_cast<long>(j), .factors = {}}}};
    const std::string symbol = to_text(element);
    routine.places[symbol] = element;
    ahead.point.push_back(element);
    routine.body.push_back({Let{unknowns[j].name, Expression::symbol(symbol, kRankOfVariable)}});
  }
  append(routine.body, split.of_point);
  Names names;
  for (const std::string& symbol : split.wanted) {
    const Place place{"at", names.local(symbol)};
    ahead.record.fields.push_back({.name = place.field});
    ahead.places[symbol] = place;
    routine.places[to_text(place)] = place;
    routine.body.push_back({Assign{to_text(place), Expression::symbol(symbol, kRankOfTemporary)}});
  }
  return ahead;
}

Call call_of(const Routine& derivatives) {
  Call call{.routine = derivatives.name, .arguments = {}};
  for (const Argument& argument : derivatives.arguments) call.arguments.push_back({argument.name});
  return call;
}

}  // namespace hamgen
