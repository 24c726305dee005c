#include "generator/interpreter/interpreter.hpp"

#include <algorithm>
#include <limits>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

using Quad = numerics_of_quad::Real;

template <class Real>
bool is_finite(const std::vector<Real>& numbers) {
  return std::ranges::all_of(numbers, [](Real x) { return x - x == 0; });
}

}  // namespace

template <class Real>
Interpreter<Real>::Interpreter(Program code, std::vector<Real> parameters, Real h,
                               const std::vector<Real>& state)
    : code_(std::make_unique<const Program>(std::move(code))) {
  for (const Routine& routine : code_->routines) {
    machines_[routine.name] = std::make_unique<Machine<Real>>(routine, *code_, machines_);
  }
  if (code_->routine("solve") == nullptr) internal_error("a step that cannot be interpreted");
  parameters_.numbers = std::move(parameters);
  h_ = h;
  z_ = make_object<Real>(*code_->record("State"), *code_);
  carry_ = make_object<Real>(*code_->record("State"), *code_);
  z_.numbers = state;
  for (const Rational& length : code_->substeps) {
    Substep& substep = substeps_.emplace_back();
    substep.h = h * nearest_number<Real>(length);
    if (const auto prepare = machines_.find("prepare"); prepare != machines_.end()) {
      prepare->second->run({given(parameters_), {&substep.h, nullptr}});
      substep.k.numbers = prepare->second->result().numbers;
      substep.k.flags = prepare->second->result().flags;
    }
    forget(substep);
  }
}

template <class Real>
void Interpreter<Real>::forget(Substep& substep) {
  if (const Record* start = code_->record("Start"))
    substep.start = make_object<Real>(*start, *code_);
  if (code_->unknowns > 0) substep.history = make_history<Real>(code_->unknowns);
}

template <class Real>
void Interpreter<Real>::reset(const std::vector<Real>& state, const std::vector<Real>& carry) {
  z_.numbers = state;
  carry_.numbers = carry;
  for (Substep& substep : substeps_) forget(substep);
}

template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::solve(Substep& substep, Object<Real>& dz,
                                                            Object<Real>& rest) {
  std::vector<Given<Real>> arguments;
  for (const Argument& argument : code_->routine("solve")->arguments) {
    const std::string& name = argument.name;
    if (name == "h") {
      arguments.push_back({&substep.h, nullptr});
    } else {
      arguments.push_back(given(name == "par"     ? parameters_
                                : name == "k"     ? substep.k
                                : name == "z"     ? z_
                                : name == "carry" ? carry_
                                : name == "start" ? substep.start
                                : name == "rest"  ? rest
                                                  : dz));
    }
  }
  const MachineReport<Real> report = machines_.at("solve")->run(arguments);
  return {report.converged, report.iterations, report.increment};
}

// As Propagator does it.
template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::substep(std::size_t i) {
  Substep& substep = substeps_.at(i);
  Object<Real> dz = make_object<Real>(*code_->record("State"), *code_);
  Object<Real> rest = make_object<Real>(*code_->record("State"), *code_);
  const bool extrapolates = code_->unknowns > 0;
  // start.value is what its numbers begin with.
  const auto value = [&] {
    return std::span(substep.start.numbers).first(static_cast<std::size_t>(code_->unknowns));
  };
  bool known = code_->retries && substep.start.flags.at("known") != 0;
  if (extrapolates) {
    known = substep.history->known();
    substep.start.flags["known"] = known ? 1 : 0;
    if (known) substep.history->extrapolate(value());
  }
  Report report = solve(substep, dz, rest);
  if (!report.converged && known) {
    const long long wasted = report.iterations;
    if (extrapolates) substep.start = make_object<Real>(*code_->record("Start"), *code_);
    report = solve(substep, dz, rest);
    report.iterations += wasted;
  }
  if (!report.converged) return report;
  if (extrapolates) {
    for (const RuleOfNewton& rule : code_->rules) {
      substep.start.rules.at(rule.name)->watch(*substep.history, value(), rule.first, rule.count);
    }
    substep.history->record(value());
  }
  for (std::size_t k = 0; k < z_.numbers.size(); ++k) {
    if (!code_->has_carry()) {
      z_.numbers[k] += dz.numbers[k];
    } else if (code_->has_rest()) {
      NumericsOf<Real>::add_rest(z_.numbers[k], carry_.numbers[k], dz.numbers[k], rest.numbers[k]);
    } else {
      NumericsOf<Real>::add_small(z_.numbers[k], carry_.numbers[k], dz.numbers[k]);
    }
  }
  return report;
}

template <class Real>
std::vector<Real> Interpreter<Real>::remembered(std::size_t substep,
                                                const std::string& field) const {
  const Record* start = code_->record("Start");
  if (start == nullptr) return {};
  const auto it = std::ranges::find(start->fields, field, &Field::name);
  if (it == start->fields.end()) return {};
  const auto first = substeps_.at(substep).start.numbers.begin() + offset_of(*start, field);
  return {first, first + product(it->sizes)};
}

template <class Real>
typename Interpreter<Real>::Report Interpreter<Real>::step() {
  const std::vector<Real> state = z_.numbers;
  const std::vector<Real> carry = carry_.numbers;
  Report total;
  for (std::size_t i = 0; i < substeps_.size(); ++i) {
    const Report report = substep(i);
    total.iterations += report.iterations;
    total.increment = report.increment;
    const bool ends = code_->unchecked && !is_finite(z_.numbers);
    if (ends) total.increment = Real(std::numeric_limits<double>::infinity());
    if (report.converged && !ends) continue;
    z_.numbers = state;
    carry_.numbers = carry;
    // Those before have seen a step that will not be.
    if (substeps_.size() > 1) std::ranges::for_each(substeps_, [this](Substep& s) { forget(s); });
    return total;
  }
  total.converged = true;
  return total;
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
