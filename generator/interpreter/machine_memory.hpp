// What a routine does with what its run keeps from step to step.
#pragma once

#include "generator/interpreter/machine_iterations.hpp"

namespace hamgen {

template <class Real>
class MachineMemory : public MachineIterations<Real> {
 protected:
  using Base = MachineIterations<Real>;
  using Base::address;
  using Base::Base;
  using Base::code_;
  using Base::index_of;
  using Base::m_;
  using Base::object;
  using Base::span;
  using Base::whole;
  using typename Base::Step;
  using typename Base::Whole;

  // Its numbers stay where they are: the frames of other routines point to them.
  static void renew(Object<Real>& object, Object<Real> fresh) {
    if (object.numbers.size() == fresh.numbers.size()) {
      std::ranges::copy(fresh.numbers, object.numbers.begin());
      fresh.numbers = std::move(object.numbers);
    }
    object = std::move(fresh);
  }
  void begin_anew(int index, const Record& record) const {
    renew(object(index), make_object<Real>(record, code_));
    m_.frame.objects[static_cast<std::size_t>(index)] = object(index).numbers.data();
  }

  Step operator()(const Use& use) {
    const std::vector<Place>& given = use.arguments;
    if (use.action.empty()) return added(use);
    const int first = index_of(given[0].object);
    if (use.action == "watch") {
      return [this, first, use, past = index_of(given[1].object), values = whole(given[2])] {
        const auto number = [&](std::size_t i) {
          return static_cast<int>(use.arguments[i].indices.front().constant);
        };
        object(first)
            .rules.at(use.arguments[0].field)
            ->watch(*object(past).history, span(values), number(3), number(4));
        return true;
      };
    }
    return [this, first, action = use.action, values = whole(given[1])] {
      AnyHistory<Real>& history = *object(first).history;
      if (action == "record") history.record(span(values));
      if (action == "extrapolate") history.extrapolate(span(values));
      if (action == "extrapolate_twice") history.extrapolate_twice(span(values));
      return true;
    };
  }

  Step operator()(const Forget& forget) {
    const bool all = forget.each > 0;
    return [this, forget, all, target = index_of(forget.what.object)] {
      if (all) {
        for (Object<Real>& each : m_.memory->fields.at(forget.what.object.substr(5)))
          begin(each, forget);
      } else {
        begin(object(target), forget);
      }
      return true;
    };
  }

  Step operator()(const Declare& locals) {
    std::vector<int> targets;
    for (const std::string& name : locals.objects) targets.push_back(index_of(name));
    return [this, targets, record = code_.record(locals.record)] {
      for (const int target : targets) begin_anew(target, *record);
      return true;
    };
  }
  Step operator()(const Note& note) {
    return [this, to = index_of(note.name), from = index_of(note.from.object), note] {
      object(to).flags[""] = object(from).flags.at(note.from.field);
      return true;
    };
  }
  Step operator()(const Count& count) {
    if (!count.by) return [] { return true; };  // steps are not counted here
    return [this, to = index_of(count.count.object), by = index_of(count.by->object), count] {
      object(to).flags.at(count.count.field) += object(by).flags.at(count.by->field);
      return true;
    };
  }
  Step operator()(const Ask& ask) {
    return [this, to = index_of(ask.flag.object), from = index_of(ask.count.object), ask] {
      object(to).flags.at(ask.flag.field) = object(from).history->known() ? 1 : 0;
      return true;
    };
  }
  // Of many steps: they are taken one by one here.
  Step operator()(const Break&) { internal_error("no loop"); }
  Step operator()(const RequireFinite&) { internal_error("no loop"); }
  void keep_report(int index, const MachineReport<Real>& report) const {
    if (index == 0) return;
    Object<Real>& kept = object(index);
    kept.flags["converged"] = report.converged ? 1 : 0;
    kept.flags["iterations"] = static_cast<int>(report.iterations);
    kept.numbers.at(0) = report.increment;
  }

 private:
  // two_sum or two_sum_with_rest.
  Step added(const Use& use) {
    std::vector<Address> at;
    for (const Place& place : use.arguments) at.push_back(address(place));
    return [this, at] {
      const auto number = [&](std::size_t i) -> Real& { return m_.frame.at(at[i]); };
      if (at.size() == 3) {
        NumericsOf<Real>::add_small(number(0), number(1), number(2));
      } else {
        NumericsOf<Real>::add_rest(number(0), number(1), number(2), number(3));
      }
      return true;
    };
  }

  void begin(Object<Real>& target, const Forget& forget) const {
    const std::string& field = forget.what.field;
    if (forget.type == "History") {
      target.history = Blocks<Real>::history(code_.unknowns);
    } else if (forget.type == "bool") {
      target.flags.at(field) = 0;
    } else {
      Object<Real> fresh = make_object<Real>(*code_.record("Start"), code_);
      if (field.empty()) {
        renew(target, std::move(fresh));
      } else {
        target.rules.at(field) = std::move(fresh.rules.at(field));
      }
    }
  }
};

}  // namespace hamgen
