#include "generator/program/kernel_routines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "generator/program/collective_loops.hpp"
#include "generator/program/first_loop.hpp"
#include "generator/program/gathered_kernel.hpp"
#include "generator/program/kernel_evaluation.hpp"
#include "generator/program/lower.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/names.hpp"
#include "generator/program/split_constants.hpp"

namespace hamgen {

namespace {

class KernelRoutine {
 public:
  KernelRoutine(const Environment& environment, const Mechanics& mechanics, Part part)
      : mechanics_(mechanics), n_(environment.degrees_of_freedom), part_(part) {
    routine_.arguments.push_back(parameters_argument());
    environment.bind_parameters(routine_);
  }
  // Goes on in a routine that somebody else has begun.
  KernelRoutine(const Environment& environment, const Mechanics& mechanics, Part part,
                Routine begun, const Place& q, const Place& p)
      : mechanics_(mechanics),
        n_(environment.degrees_of_freedom),
        part_(part),
        q_(q),
        p_(p),
        routine_(std::move(begun)) {
    environment.bind_parameters(routine_);
  }

  Routine energy() {
    routine_.name = "energy";
    routine_.remark = {energy_remark(mechanics_)};
    routine_.result = {.type = "Real"};
    routine_.arguments.push_back(state_argument("z"));
    q_ = {"z", "q"};
    p_ = {"z", "p"};
    const std::string sum = "(sum)";
    routine_.body.push_back({Let{sum, Expression(0), true}});
    add_sums();
    add_kernels([&](const Kernel& kernel, Body& body) {
      if (kernel.sum) return;
      for (const Expression& value : load(kernel, {kernel.value}, body)) {
        body.push_back({Accumulate{sum, value}});
      }
    });
    const Evaluation rest = evaluate_apart({mechanics_.of_sums}, "part");
    append(routine_.body, rest.statements);
    const Expression total = Expression::symbol(sum, kRankOfTemporary) + rest.results.front();
    routine_.body.push_back({Return{.value = total}});
    return std::move(routine_);
  }

  Routine gradient(std::string name, bool in_parts) {
    routine_.name = std::move(name);
    routine_.remark = {part_ == Part::potential ? "dq[i] = dH/dq_i."
                       : part_ == Part::kinetic ? "dp[i] = dH/dp_i."
                                                : "dq[i] = dH/dq_i, dp[i] = dH/dp_i."};
    add_state();
    add_slopes_of_sums();
    for (const Kernel& kernel : weighted_kernels(mechanics_)) {
      for (Kernel& part : gathered(kernel)) kernels_.push_back(std::move(part));
    }
    std::erase_if(kernels_, [&](const Kernel& kernel) { return !belongs(kernel); });
    if (in_parts && part_ != Part::kinetic)
      append(routine_.body, split_constants(kernels_, mechanics_));
    const std::array begins = {first_loop(kernels_, false, n_), first_loop(kernels_, true, n_)};
    add_target("dq", part_ != Part::kinetic, begins[0]);
    add_target("dp", part_ != Part::potential, begins[1]);
    add_kernels([&](const Kernel& kernel, Body& body) {
      std::vector<Expression> values;
      std::vector<const Slot*> slots;
      for (std::size_t i = 0; i < kernel.slots.size(); ++i) {
        if (kernel.gradient[i].is_zero()) continue;
        values.push_back(kernel.gradient[i]);
        slots.push_back(&kernel.slots[i]);
      }
      const std::vector<Expression> results = load(kernel, values, body);
      std::set<std::string> begun;
      for (std::size_t i = 0; i < results.size(); ++i) {
        const std::string slope = slope_of(*slots[i]);
        const std::optional<FirstLoop>& begin = begins.at(slots[i]->is_momentum ? 1 : 0);
        if (is_outside(kernel, *slots[i])) {
          sum_up(slope, results[i], body);
        } else if (begin && begin->kernel == &kernel && begun.insert(slope).second) {
          body.push_back({Assign{slope, results[i]}});
        } else {
          body.push_back({Accumulate{slope, results[i]}});
        }
      }
    });
    return std::move(routine_);
  }

  Routine generating_gradient() {
    routine_.arguments.push_back({.name = "h"});
    Routine result = gradient("generating_gradient", false);
    result.remark = {"dq[i] = dK/dq_i, dp[i] = dK/dp_i of the K(z, h) that stands in for H."};
    return result;
  }

  Routine masses() {
    routine_.name = "masses";
    routine_.remark = {"dp[i] = d2H/dp_i^2, which is constant."};
    add_target("dp", true, {});
    add_kernels([&](const Kernel& kernel, Body& body) {
      std::vector<Expression> values;
      std::vector<std::string> targets;
      for (const auto& [slots, value] : kernel.hessian) {
        values.push_back(value);
        targets.push_back(slope_of(kernel.slots[slots.first]));
      }
      const std::vector<Expression> results = load(kernel, values, body);
      for (std::size_t i = 0; i < results.size(); ++i) {
        body.push_back({Accumulate{targets[i], results[i]}});
      }
    });
    return std::move(routine_);
  }

  Routine entries(const UseEntry& use) {
    add_kernels([&](const Kernel& kernel, Body& body) {
      std::vector<Expression> values;
      for (const auto& [slots, value] : kernel.hessian) values.push_back(value);
      const std::vector<Expression> results = load(kernel, values, body);
      std::size_t k = 0;
      int named = 0;
      for (const auto& [slots, value] : kernel.hessian) {
        const Expression result = results[k++];
        const StateElement row = element_of(kernel.slots[slots.first]);
        const StateElement column = element_of(kernel.slots[slots.second]);
        const std::string symbol = fmt::format("entry({})", named + 1);
        const Expression entry =
            is_trivial(result) ? result : Expression::symbol(symbol, kRankOfTemporary);
        Body used;
        use(routine_, used, {row, column, entry});
        if (slots.first != slots.second) use(routine_, used, {column, row, entry});
        std::set<std::string> read;
        collect_symbols(used, read);
        if (read.contains(symbol)) {
          body.push_back({Let{symbol, result}});
          ++named;
        }
        for (Instruction& instruction : used) {
          const auto* sum = std::get_if<Accumulate>(&instruction.value);
          if (sum != nullptr && stands_still(kernel, sum->symbol)) {
            sum_up(sum->symbol, sum->value, body);
          } else {
            body.push_back(std::move(instruction));
          }
        }
      }
    });
    return std::move(routine_);
  }

 private:
  // What H is a function of, as far as it belongs to the part: which of the sums that are.
  std::set<std::size_t> add_sums() {
    std::set<std::size_t> used;
    for (const Kernel& kernel : mechanics_.kernels) {
      if (!kernel.sum || !belongs(kernel)) continue;
      used.insert(*kernel.sum);
      const auto beside = [&](const Kernel& other) { return run_beside(kernel, other); };
      if (std::ranges::none_of(kernels_, beside)) kernels_.push_back(kernel);
    }
    for (const std::size_t k : used)
      routine_.body.push_back({Let{mechanics_.sums[k].name, Expression(0), true}});
    if (!used.empty())
      add_kernels([&](const Kernel& kernel, Body& body) { sum_beside(kernel, body); });
    kernels_.clear();
    return used;
  }
  void sum_beside(const Kernel& kernel, Body& body) {
    std::vector<Expression> values;
    std::vector<std::string> sums;
    for (const Kernel& each : mechanics_.kernels) {
      if (!run_beside(each, kernel)) continue;
      values.push_back(each.value);
      sums.push_back(mechanics_.sums[*each.sum].name);
    }
    const std::vector<Expression> results = load(kernel, values, body);
    for (std::size_t i = 0; i < results.size(); ++i)
      body.push_back({Accumulate{sums[i], results[i]}});
  }
  // They are factors in all loops.
  void add_slopes_of_sums() {
    const std::set<std::size_t> used = add_sums();
    std::vector<Expression> slopes;
    for (const std::size_t k : used) slopes.push_back(mechanics_.sums[k].slope_value);
    const Evaluation evaluation = evaluate_apart(slopes, "part");
    append(routine_.body, evaluation.statements);
    auto value = evaluation.results.begin();
    for (const std::size_t k : used)
      routine_.body.push_back({Let{mechanics_.sums[k].slope, *value++}});
  }

  // The arrays of the state that the part reads.
  void add_state() {
    if (part_ != Part::kinetic) {
      routine_.arguments.push_back({.name = "q", .sizes = {n_}, .decays = true});
    }
    if (part_ != Part::potential) {
      routine_.arguments.push_back({.name = "p", .sizes = {n_}, .decays = true});
    }
  }

  // An array that is summed up, zero to begin with where no loop begins with its values.
  void add_target(const std::string& name, bool wanted, const std::optional<FirstLoop>& begin) {
    if (!wanted) return;
    routine_.arguments.push_back({.name = name, .sizes = {n_}, .changes = true, .decays = true});
    add_zeros(routine_, name, begin ? begin->covered : Elements(), n_);
  }

  std::string bind(const std::string& symbol, Place place) {
    routine_.places.insert_or_assign(symbol, std::move(place));
    return symbol;
  }

  [[nodiscard]] AffineIndex position(const Slot& slot) const {
    AffineIndex result = renamed(routine_, slot.position);
    if (slot.is_momentum) result.constant -= n_;
    return result;
  }

  [[nodiscard]] StateElement element_of(const Slot& slot) const {
    return {slot.is_momentum, position(slot)};
  }
  // Where an element of the state stands.
  [[nodiscard]] Place element(const Slot& slot) const {
    Place place = slot.is_momentum ? p_ : q_;
    AffineIndex index = position(slot);
    if (!place.indices.empty()) index.constant += place.indices.front().constant;
    place.indices = {index};
    return place;
  }
  std::string slope_of(const Slot& slot) {
    const char* array = slot.is_momentum ? "dp" : "dq";
    return bind(fmt::format("{}({})", array, to_text(position(slot))),
                {.object = array, .indices = {position(slot)}});
  }

  [[nodiscard]] bool belongs(const Kernel& kernel) const {
    return part_ == Part::all || uses_momenta(kernel) == (part_ == Part::kinetic);
  }

  // Does the innermost loop leave the slot where it is?
  [[nodiscard]] static bool is_outside(const Kernel& kernel, const Slot& slot) {
    return !kernel.ranges.empty() && !slot.position.factors.contains(kernel.ranges.back().index);
  }

  // Is it an element that the innermost loop leaves where it is?
  [[nodiscard]] bool stands_still(const Kernel& kernel, const std::string& element) const {
    if (kernel.ranges.empty()) return false;
    const std::string index = loop_index(routine_, kernel.ranges.back().index);
    return std::ranges::none_of(routine_.places.at(element).indices, [&](const AffineIndex& each) {
      return each.factors.contains(index);
    });
  }
  // An element that stands still in the innermost loop is summed up in a local around that.
  void sum_up(const std::string& element, const Expression& value, Body& body) {
    const std::string sum = fmt::format("sum of {}", element);
    const bool is_new = std::ranges::none_of(before_, [&](const Instruction& instruction) {
      const auto* let = std::get_if<Let>(&instruction.value);
      return let != nullptr && let->symbol == sum;
    });
    if (is_new) {
      before_.push_back({Let{sum, Expression(0), true}});
      after_.push_back({Accumulate{element, Expression::symbol(sum, kRankOfTemporary)}});
    }
    body.push_back({Accumulate{sum, value}});
  }

  // Loads what the values read and computes them together.
  std::vector<Expression> load(const Kernel& kernel, const std::vector<Expression>& values,
                               Body& body) {
    std::set<std::string> used;
    for (const Expression& value : values) collect_symbols(value, used);
    Substitution indices;
    for (const KernelRange& range : kernel.ranges) {
      const std::string index = loop_index(routine_, range.index);
      const std::string symbol = "index(" + index + ")";
      bind(symbol, {.object = {}, .indices = {{0, {{index, 1}}}}});
      indices.emplace(range.index, Expression::symbol(symbol, kRankOfParameter));
    }
    for (const ParameterSlot& slot : kernel.parameters) {
      bind(slot.symbol, {.object = "par",
                         .field = member_identifier(slot.parameter),
                         .indices = {renamed(routine_, slot.position)}});
    }
    std::set<std::string> loaded;
    for (const Slot& slot : kernel.slots) {
      if (!used.contains(slot.symbol) || !loaded.insert(slot.symbol).second) continue;
      const Place place = element(slot);
      const std::string source = bind("at " + to_text(place), place);
      Body& where = is_fixed(kernel, slot) ? before_ : body;
      where.push_back({Let{slot.symbol, Expression::symbol(source, kRankOfTemporary)}});
    }
    const KernelEvaluation evaluation = evaluate(kernel, values, indices);
    append(before_, evaluation.before);
    append(body, evaluation.statements);
    return evaluation.results;
  }

  // Loops first, then single instances, each in a scope of its own if there are several in the
  // routine.
  template <class Add>
  void add_kernels(const Add& add) {
    std::vector<Body> single;
    for (const Kernel& kernel : kernels_.empty() ? mechanics_.kernels : kernels_) {
      if (!belongs(kernel)) continue;
      Body body;
      before_.clear();
      add(kernel, body);
      if (body.empty()) continue;
      for (Instruction& instruction : body) instruction.origin.terms = kernel.terms;
      if (kernel.ranges.empty()) {
        single.push_back(std::move(body));
        continue;
      }
      for (auto range = kernel.ranges.rbegin(); range != kernel.ranges.rend(); ++range) {
        Body outer = std::exchange(before_, {});
        outer.push_back({For{{loop_index(routine_, range->index), renamed(routine_, range->lower),
                              renamed(routine_, range->upper)},
                             std::move(body)}});
        std::ranges::move(std::exchange(after_, {}), std::back_inserter(outer));
        for (Instruction& instruction : outer) {
          if (!std::holds_alternative<For>(instruction.value))
            instruction.origin.terms = kernel.terms;
        }
        body = std::move(outer);
      }
      if (body.size() == 1) {
        routine_.body.push_back(std::move(body.front()));
      } else {
        routine_.body.push_back({Scope{std::move(body)}});
      }
    }
    for (Body& body : single) {
      if (single.size() > 1 || std::exchange(has_instance_, true)) {
        routine_.body.push_back({Scope{std::move(body)}});
      } else {
        for (Instruction& instruction : body) routine_.body.push_back(std::move(instruction));
      }
    }
  }

  const Mechanics& mechanics_;
  std::vector<Kernel> kernels_;  // other ones that are summed instead
  int n_;
  Part part_;
  Place q_{"q"}, p_{"p"};  // the arrays of the state
  Body before_, after_;    // of the innermost loop
  bool has_instance_ = false;
  Routine routine_;
};

}  // namespace

Routine kernel_energy(const Environment& environment, const Mechanics& mechanics) {
  return KernelRoutine(environment, mechanics, Part::all).energy();
}

Routine kernel_gradient(const Environment& environment, const Mechanics& mechanics,
                        std::string name, Part part, bool in_parts) {
  return KernelRoutine(environment, mechanics, part).gradient(std::move(name), in_parts);
}

Routine kernel_generating_gradient(const Environment& environment, const Mechanics& mechanics) {
  return KernelRoutine(environment, mechanics, Part::all).generating_gradient();
}

Routine kernel_masses(const Environment& environment, const Mechanics& mechanics) {
  return KernelRoutine(environment, mechanics, Part::kinetic).masses();
}

Routine kernel_entries(const Environment& environment, const Mechanics& mechanics, Part part,
                       Routine begun, const Place& q, const Place& p, const UseEntry& use) {
  return KernelRoutine(environment, mechanics, part, std::move(begun), q, p).entries(use);
}

}  // namespace hamgen
