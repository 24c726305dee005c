#include "generator/interpreter/machine.hpp"

#include <algorithm>

#include "generator/interpreter/machine_compiler.hpp"

namespace hamgen {

template <class Real>
Machine<Real>::Machine(const Routine& routine, const Program& code, const Others& others) {
  const auto compiler = std::make_shared<MachineCompiler<Real>>(state_, routine, code, others);
  steps_ = compiler->compile();
  compiler_ = compiler;
  for (std::size_t i = 1 + state_.arguments.size(); i < state_.shapes.size(); ++i) {
    const bool kept =
        std::ranges::any_of(state_.kept, [&](const auto& of_run) { return of_run.index == i; });
    if (kept) continue;
    state_.own[i] = std::make_unique<Object<Real>>();
    if (state_.shapes[i].record != nullptr)
      *state_.own[i] = make_object<Real>(*state_.shapes[i].record, code);
    if (state_.shapes[i].record == nullptr) {
      state_.own[i]->numbers.resize(static_cast<std::size_t>(product(state_.shapes[i].sizes)));
    }
    state_.objects[i] = state_.own[i].get();
    state_.frame.objects[i] = state_.own[i]->numbers.data();
  }
  if (const auto pi = state_.local_index.find("pi"); pi != state_.local_index.end()) {
    state_.locals[static_cast<std::size_t>(pi->second)] = nearest_number<Real>(
        *parse_decimal("3.14159265358979323846264338327950288419716939937510"));
  }
  state_.frame.objects[0] = state_.locals.data();
}

template <class Real>
Machine<Real>::~Machine() = default;

template <class Real>
MachineReport<Real> Machine<Real>::run(const std::vector<Given<Real>>& arguments) {
  for (std::size_t i = 0; i < state_.arguments.size(); ++i) {
    state_.objects[1 + i] = arguments[i].object;
    state_.frame.objects[1 + i] = arguments[i].numbers;
    if (arguments[i].matrix != nullptr) state_.matrices[state_.arguments[i]] = arguments[i].matrix;
  }
  for (const auto& kept : state_.kept) {
    Object<Real>& object =
        state_.memory->fields.at(kept.field).at(kept.of_substep ? state_.memory->substep : 0);
    state_.objects[kept.index] = &object;
    state_.frame.objects[kept.index] = object.numbers.data();
  }
  state_.report = {};
  state_.iteration = 0;
  for (const auto& step : steps_) {
    if (!step()) break;
  }
  return state_.report;
}

template <class Real>
const Object<Real>& Machine<Real>::result() const {
  return *state_.own.back();
}

template class Machine<float>;
template class Machine<double>;
template class Machine<long double>;
template class Machine<numerics_of_quad::Real>;

}  // namespace hamgen
