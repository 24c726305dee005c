#include "generator/interpreter/interpreter.hpp"

#include <algorithm>
#include <limits>

#include "generator/program/propagator.hpp"

namespace hamgen {

namespace {

using Quad = numerics_of_quad::Real;

template <class Real>
bool is_finite(const std::vector<Real>& numbers) {
  return std::ranges::all_of(numbers, [](Real x) { return x - x == 0; });
}

// And the routines that take a step, with the records they work on.
Program with_steps(Program code) {
  Propagator propagator = propagator_of(code);
  code.records.push_back(std::move(propagator.record));
  code.records.push_back(step_report());
  for (Routine& routine : propagator.routines) {
    const bool one_step = routine.name == "substep" || routine.name == "step";
    if (one_step) code.routines.push_back(std::move(routine));
  }
  return code;
}

}  // namespace

template <class Real>
Interpreter<Real>::Interpreter(Program code, std::vector<Real> parameters, Real h,
                               const std::vector<Real>& state)
    : code_(std::make_unique<const Program>(with_steps(std::move(code)))) {
  for (const Routine& routine : code_->routines) {
    machines_[routine.name] = std::make_unique<Machine<Real>>(routine, *code_, machines_);
    machines_[routine.name]->remember(memory_);
  }
  parameters_.numbers = std::move(parameters);
  h_ = h;
  for (const Field& field : code_->record("Propagator")->fields) {
    auto& objects = memory_.fields[field.name];
    objects.resize(field.sizes.empty() ? 1 : static_cast<std::size_t>(field.sizes[0]));
    const Record* record = code_->record(field.type);
    for (Object<Real>& object : objects) {
      if (record != nullptr) object = make_object<Real>(*record, *code_);
    }
  }
  kept("par").numbers = parameters_.numbers;
  kept("h").numbers = {h};
  kept("z").numbers = state;
  // Sums that are plain leave nothing.
  memory_.fields["carry"].resize(1);
  kept("carry").numbers.resize(state.size());
  for (std::size_t i = 0; i < substeps(); ++i) {
    Real length_of = length(i);
    if (substeps() > 1) kept("lengths", i).numbers = {length_of};
    if (const auto prepare = machines_.find("prepare"); prepare != machines_.end()) {
      prepare->second->run({given(parameters_), {&length_of, nullptr}});
      kept("k", i).numbers = prepare->second->result().numbers;
      kept("k", i).flags = prepare->second->result().flags;
    }
  }
  forget();
}

template <class Real>
Real Interpreter<Real>::length(std::size_t substep) const {
  return h_ * nearest_number<Real>(code_->substeps.at(substep));
}

template <class Real>
void Interpreter<Real>::forget() {
  for (std::size_t i = 0; i < substeps(); ++i) {
    if (const Record* start = code_->record("Start"))
      kept("start", i) = make_object<Real>(*start, *code_);
    if (const Record* at = code_->record("Derivatives"))
      kept("at", i) = make_object<Real>(*at, *code_);
    if (code_->unknowns > 0) kept("history", i).history = Blocks<Real>::history(code_->unknowns);
  }
}

template <class Real>
void Interpreter<Real>::reset(const std::vector<Real>& state, const std::vector<Real>& carry) {
  kept("z").numbers = state;
  kept("carry").numbers = carry;
  forget();
}

template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::run(
    const std::string& routine, const std::vector<Given<Real>>& arguments) {
  const MachineReport<Real> report = machines_.at(routine)->run(arguments);
  return {report.converged, report.iterations, report.increment};
}

template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::substep(std::size_t i) {
  if (substeps() == 1) return run("step", {});
  memory_.substep = i;
  return run("substep", {{}, given(kept("z")), given(kept("carry"))});
}

template <class Real>
std::vector<Real> Interpreter<Real>::remembered(std::size_t substep,
                                                const std::string& field) const {
  const Record* start = code_->record("Start");
  if (start == nullptr) return {};
  const auto it = std::ranges::find(start->fields, field, &Field::name);
  if (it == start->fields.end()) return {};
  const auto& numbers = memory_.fields.at("start").at(substep).numbers;
  const auto first = numbers.begin() + offset_of(*start, field);
  return {first, first + product(it->sizes)};
}

template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::step() {
  const std::vector<Real> state = kept("z").numbers;
  const std::vector<Real> carry = kept("carry").numbers;
  Report report = run("step", {});
  if (!code_->unchecked || is_finite(kept("z").numbers)) return report;
  kept("z").numbers = state;
  kept("carry").numbers = carry;
  report.converged = false;
  report.increment = Real(std::numeric_limits<double>::infinity());
  return report;
}

template <class Real>
Real Interpreter<Real>::energy(const std::vector<Real>& state) {
  Object<Real> z;
  z.numbers = state;
  return machines_.at("energy")->run({given(parameters_), given(z)}).value;
}

template <class Real>
std::vector<Real> Interpreter<Real>::values(const std::string& routine,
                                            const std::vector<Real>& state) {
  Object<Real> z;
  z.numbers = state;
  const std::vector<Argument>& arguments = code_->routine(routine)->arguments;
  const std::size_t half = state.size() / 2;
  Object<Real> result;
  std::vector<Given<Real>> list;
  // Of a system in loops the arrays q and p, and dq and dp one after the other.
  result.numbers.resize(std::max(static_cast<std::size_t>(arguments.back().sizes.front()),
                                 arguments.back().name == "dp" ? state.size() : 0));
  for (const Argument& argument : arguments) {
    const std::string& name = argument.name;
    if (name == "par") {
      list.push_back(given(parameters_));
    } else if (name == "h") {
      list.push_back({&h_, nullptr});
    } else if (name == "z" || name == "q") {
      list.push_back(given(z));
    } else if (name == "p") {
      list.push_back({z.numbers.data() + half, &z});
    } else {
      list.push_back({result.numbers.data() + (name == "dp" ? half : 0), &result});
    }
  }
  machines_.at(routine)->run(list);
  return result.numbers;
}

template class Interpreter<float>;
template class Interpreter<double>;
template class Interpreter<long double>;
template class Interpreter<Quad>;

}  // namespace hamgen
