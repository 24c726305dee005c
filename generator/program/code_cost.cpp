#include "generator/program/code_cost.hpp"

#include <algorithm>

namespace hamgen {

namespace {

class CodeCost {
 public:
  explicit CodeCost(const Program& code) : code_(code) {}

  // Of the routine, the bodies of iterations by themselves.
  void run(const std::string& name) {
    const Routine* routine = code_.routine(name);
    if (routine != nullptr) visit(routine->body);
  }

  Cost once, iterated;

 private:
  void visit(const Body& body) {
    for (const Instruction& each : body)
      std::visit([this](const auto& node) { of(node); }, each.value);
  }

  void add(const Cost& more, long times = 1) {
    Cost& total = iterating_ ? iterated : once;
    const auto scaled = [&](long count) { return count * times * instances_; };
    total.additions += scaled(more.additions);
    total.multiplications += scaled(more.multiplications);
    total.divisions += scaled(more.divisions);
    total.functions += scaled(more.functions);
  }
  void add(const Expression& value) { add(cost({Statement{"", value}})); }
  static Cost sums(long count) { return {.additions = count}; }

  void of(const Let& let) { add(let.value); }
  void of(const Array& array) {
    for (const Expression& value : array.values) add(value);
  }
  void of(const Assign& assign) { add(assign.value); }
  void of(const Accumulate& sum) {
    add(sum.value);
    add(sums(1));
  }
  void of(const Collect& sum) {
    add(sum.value);
    add(sums(7));
  }
  void of(const CollectStages& sum) { add(sums(8L * sum.count)); }
  void of(const Put& put) {
    add(put.value);
    add(sums(1));
  }
  void of(const For& loop) {
    const long before = instances_;
    instances_ = 0;
    for_each_instance(ranges_, [&](const std::vector<long>& outer) {
      const long last = value_at(loop.range.upper, ranges_, outer);
      const long first = value_at(loop.range.lower, ranges_, outer);
      instances_ += last < first ? 0 : (last - first + 1) * calls_;
    });
    ranges_.push_back(loop.range);
    visit(loop.body);
    instances_ = before;
    ranges_.pop_back();
  }
  void of(const Scope& scope) { visit(scope.body); }
  void of(const If& branch) {
    if (branch.set || branch.flag.field != "known") visit(branch.then);
  }
  void of(const Call& call) {
    const Routine* routine = code_.routine(call.routine);
    if (routine == nullptr) return;
    const std::vector<KernelRange> outer = std::exchange(ranges_, {});
    const long before = std::exchange(calls_, instances_);
    visit(routine->body);
    calls_ = before;
    ranges_ = outer;
  }
  void of(const Alternate& two) { of(two.first); }
  void of(const Factorise&) {
    const auto [size, width] = matrix();
    add({.additions = width * width, .multiplications = width * width, .divisions = 1}, size);
  }
  void of(const SolveFactorised&) {
    const auto [size, width] = matrix();
    add({.additions = 2 * width, .multiplications = 2 * width}, size);
  }
  void of(const Iterate& iterate) { repeat(iterate.body); }
  void of(const IterateArray& iterate) { repeat(iterate.body); }
  void of(const Sweep& sweep) { repeat(sweep.body); }
  void of(const RefineArray& refine) {
    visit(refine.first);
    visit(refine.body);
  }
  void of(const Refine& refine) { visit(refine.body); }
  void of(const Return& end) {
    if (end.value) add(*end.value);
  }
  template <class Other>
  void of(const Other& /*no arithmetic of its own*/) {}

  void repeat(const Body& body) {
    iterating_ = true;
    visit(body);
    iterating_ = false;
  }
  // Rows, and how many others each of them is eliminated from.
  [[nodiscard]] std::pair<long, long> matrix() const {
    if (!code_.matrix || code_.matrix->kind == MatrixKind::eigen_sparse ||
        code_.matrix->kind == MatrixKind::eigen_dense)
      return {0, 0};
    const bool band = code_.matrix->kind == MatrixKind::band;
    const long others = code_.matrix->bandwidth + code_.matrix->rows_of_border();
    return {code_.matrix->size, band ? others : code_.matrix->size / 2};
  }

  const Program& code_;
  std::vector<KernelRange> ranges_;
  long instances_ = 1;  // of the innermost loop
  long calls_ = 1;      // of the routine
  bool iterating_ = false;
};

bool solves_linear_equations(const Program& code) {
  const Routine* solve = code.routine("solve");
  return solve != nullptr && std::ranges::any_of(solve->body, [](const Instruction& instruction) {
           const auto* iterate = std::get_if<IterateArray>(&instruction.value);
           return iterate != nullptr && iterate->rule == Rule::linear;
         });
}

}  // namespace

StepCost step_cost(const Program& code) {
  CodeCost count(code);
  count.run("solve");
  return {count.iterated, count.once};
}

double operations_per_step(const Program& code) {
  const auto operations = [](const Cost& cost) {
    return static_cast<double>(cost.additions + cost.multiplications) +
           10 * static_cast<double>(cost.divisions + cost.functions);
  };
  const StepCost cost = step_cost(code);
  const double iterations = code.rules.empty() && !solves_linear_equations(code) ? 8 : 1;
  return static_cast<double>(code.substeps.size()) *
         (operations(cost.besides) + iterations * operations(cost.iteration));
}

Cost routine_cost(const Program& code, const std::string& name) {
  CodeCost count(code);
  count.run(name);
  return count.once;
}

}  // namespace hamgen
