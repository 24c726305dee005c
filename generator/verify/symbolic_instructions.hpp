// What each kind of instruction does to a symbolic machine.
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/verify/symbolic_machine.hpp"

namespace hamgen {

// In a frame of it.
struct SymbolicMachine::Run {
  SymbolicMachine& m;
  Frame& frame;

  void operator()(const Let& let) const {
    const Expression value = m.evaluate(frame, let.value);
    frame.added.erase(let.symbol);  // to one of the name that nobody has read
    frame.locals[let.symbol] = m.define(let.symbol, value);
  }
  void operator()(const Assign& assign) const {
    m.assign(frame, assign.symbol, m.evaluate(frame, assign.value));
  }
  void operator()(const Accumulate& sum) const {
    const Expression value = m.evaluate(frame, sum.value);
    if (frame.locals.contains(sum.symbol)) {
      frame.added[sum.symbol].push_back(value);
    } else {
      m.assign(frame, sum.symbol, m.number(frame, sum.symbol) + value, false);
    }
  }
  // What rounding moves from one to the other changes nothing in their sum.
  void operator()(const Collect& sum) const { (*this)(Accumulate{sum.symbol, sum.value}); }
  void operator()(const CollectStages& sum) const {
    m.assign(frame, sum.symbol, sum_from(sum.in("slope"), sum.count));
    const Expression lost = m.number(frame, sum.lost) + sum_from(sum.in("change"), sum.count);
    m.assign(frame, sum.lost, lost, false);
  }
  [[nodiscard]] Expression sum_from(Place place, int count) const {
    Expression sum(0);
    for (int i = 0; i < count; ++i, ++place.indices.back().constant)
      sum += m.read(cell(m.reference(frame, place)));
    return sum;
  }
  void operator()(const Array& array) const {
    const std::string root = frame.prefix + array.name;
    frame.objects[array.name] = {.root = root, .sizes = array.sizes};
    m.forget(root);
    for (std::size_t i = 0; i < array.values.size(); ++i) {
      const Expression value = m.evaluate(frame, array.values[i]);
      m.write(fmt::format("{}[{}]", root, i), value);
    }
  }
  void operator()(const Matrix& matrix) const {
    const std::string root = frame.prefix + matrix.name;
    frame.objects[matrix.name] = {.root = root};
    m.matrices_[root].clear();
    // Another block's matrix may have had the name.
    m.symmetric_.erase(root);
    if (matrix.symmetric) m.symmetric_.insert(root);
  }
  void operator()(const Copy& copy) const {
    if (copy.declares) {
      frame.objects[copy.to] = {.root = frame.prefix + copy.to, .record = copy.record};
    }
    const Reference to = m.reference(frame, {copy.to});
    if (copy.from.empty()) return m.forget(to.root);
    const Reference from = m.reference(frame, {copy.from});
    const std::vector<std::string> target = m.cells_of(to);
    const std::vector<std::string> source = m.cells_of(from);
    for (std::size_t i = 0; i < target.size(); ++i) m.write(target[i], m.read(source.at(i)));
  }
  void operator()(const Clear& clear) const { matrix(clear.matrix).clear(); }
  void operator()(const Put& put) const {
    const Expression value = m.evaluate(frame, put.value);
    MatrixEntries& entries = matrix(put.matrix);
    const long row = at(frame, put.row);
    const long column = at(frame, put.column);
    const bool symmetric = m.symmetric_.contains(cell(m.reference(frame, put.matrix)));
    if (symmetric && row < column) return;  // is not looked at
    entries[{row, column}] += value;
    if (symmetric && row > column) entries[{column, row}] += value;
  }
  void operator()(const SetFlag& set) const {
    m.flags_[cell(m.reference(frame, set.flag))] = set.value;
  }
  void operator()(const For& loop) const {
    const long last = at(frame, loop.range.upper);
    for (long i = at(frame, loop.range.lower); i <= last && !frame.ended; ++i) {
      frame.indices[loop.range.index] = i;
      m.run(frame, loop.body);
    }
  }
  void operator()(const Scope& scope) const { m.run(frame, scope.body); }
  void operator()(const If& branch) const {
    if (m.flags_[cell(m.reference(frame, branch.flag))] == branch.set) m.run(frame, branch.then);
  }
  void operator()(const Call& call) const {
    if (m.skipped_.contains(call.routine)) return;
    const Routine& routine = *m.code_.routine(call.routine);
    Frame inner = m.frame_of(call.routine, fmt::format("{}#{}.", call.routine, ++m.frames_));
    for (std::size_t i = 0; i < routine.arguments.size(); ++i) {
      const Argument& argument = routine.arguments[i];
      const Place& given = call.arguments.at(i);
      if (argument.record.empty() && argument.sizes.empty()) {
        inner.locals[argument.name] = m.number_at(frame, given);
        continue;
      }
      Reference reference = m.reference(frame, given);
      reference.sizes = argument.sizes;
      if (!argument.record.empty()) reference.record = argument.record;
      inner.objects[argument.name] = std::move(reference);
    }
    if (m.opaque_.contains(call.routine)) return look_at(call.routine, inner);
    m.run(inner, routine.body);
    if (!call.object.empty()) {
      frame.objects[call.object] = inner.objects.at(routine.result.object);
    }
  }
  // Both, at the unknowns where each of them begins anew.
  void operator()(const Alternate& alternate) const {
    m.run(frame, alternate.before);
    (*this)(alternate.first);
    m.run(frame, alternate.between);
    (*this)(alternate.second);
  }
  void operator()(const Factorise&) const {}
  void operator()(const SolveFactorised& solve) const {
    EliminatedSystem system{.matrix = matrix(solve.matrix)};
    for (const std::string& place : m.cells_of(m.reference(frame, solve.vector))) {
      system.right_side.push_back(m.read(place));
      system.solution.push_back(m.free_symbol("solution(" + place + ")"));
      m.write(place, system.solution.back());
    }
    m.systems.push_back(std::move(system));
  }
  void operator()(const Invert& invert) const {
    InvertedMatrix inverted{.matrix = matrix({invert.matrix}), .inverse = {}};
    const Reference inverse = m.reference(frame, invert.inverse);
    const std::vector<std::string> cells = m.cells_of(inverse);
    const auto size = static_cast<std::size_t>(inverse.sizes.at(0));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i % size == 0) inverted.inverse.emplace_back();
      inverted.inverse.back().push_back(m.free_symbol(cells[i]));
      m.write(cells[i], inverted.inverse.back().back());
    }
    m.flags_[cell(m.reference(frame, invert.regular))] = true;
    m.inverses.push_back(std::move(inverted));
  }

  void operator()(const Iterate& iterate) const {
    IterationTrace trace{.rule = iterate.rule};
    begin(iterate.unknowns, trace);
    const std::size_t first = m.definitions_.size();
    m.run(frame, iterate.body);
    for (const Unknown& unknown : iterate.unknowns) {
      const Expression correction = m.evaluate(frame, unknown.correction);
      trace.corrections.push_back(correction);
    }
    for (const Expression& correction : trace.corrections) {
      trace.increments.push_back(iterate.rule == Rule::newton ? m.set_free(frame, correction, first)
                                                              : correction);
    }
    finish(first, trace);
  }
  void operator()(const IterateArray& iterate) const {
    IterationTrace trace{.rule = iterate.rule};
    const auto for_unknowns = [&](const auto& use) {
      for_each_instance(iterate.ranges, [&](const std::vector<long>& indices) {
        for (std::size_t i = 0; i < indices.size(); ++i) {
          frame.indices[iterate.ranges[i].index] = indices[i];
        }
        for (const UnknownArray& unknown : iterate.unknowns) use(unknown);
      });
    };
    for_unknowns([&](const UnknownArray& unknown) {
      trace.starts.push_back(m.number(frame, unknown.value));
      trace.unknowns.push_back(m.free_symbol(m.cell_of(frame, unknown.value)));
      m.assign(frame, unknown.value, trace.unknowns.back());
    });
    const std::size_t first = m.definitions_.size();
    m.run(frame, iterate.body);
    for_unknowns([&](const UnknownArray& unknown) {
      trace.corrections.push_back(m.number(frame, unknown.increment));
    });
    trace.increments = trace.corrections;
    finish(first, trace);
  }
  void operator()(const Refine& refine) const {
    m.run(frame, refine.body);
    IterationTrace& trace = m.iterations.back();
    for (std::size_t j = 0; j < refine.gradient.size(); ++j) {
      trace.gradient.push_back(m.evaluate(frame, refine.gradient[j]));
      const Place change{refine.name, "change", {{static_cast<long>(j), {}}}};
      const std::string place = cell(m.reference(frame, change));
      trace.changes.push_back(m.free_symbol(m.symbol_of(frame, change).value_or(place)));
      m.write(place, trace.changes.back());
    }
  }
  void operator()(const RefineArray& refine) const {
    m.run(frame, refine.first.empty() ? refine.body : refine.first);
    IterationTrace& trace = m.iterations.back();
    const Reference refinement = m.reference(frame, refine.refinement);
    const std::string stem = cell(refinement);
    const auto read_all = [&](const Place& array, std::vector<Expression>& values) {
      Reference unknowns = m.reference(frame, array);
      unknowns.sizes = {refine.count};
      for (const std::string& place : m.cells_of(unknowns)) values.push_back(m.read(place));
    };
    read_all(refine.point, trace.refined_at);
    read_all(refine.lack, trace.refined_lack);
    Reference gradient = m.reference(frame, refine.gradient);
    gradient.sizes = {refine.components};
    const std::vector<std::string> cells = m.cells_of(gradient);
    for (std::size_t j = 0; j < cells.size(); ++j) {
      trace.gradient.push_back(m.read(cells[j]));
      m.write(fmt::format("{}.slope[{}]", stem, j), trace.gradient.back());
      const std::string place = fmt::format("{}.change[{}]", stem, j);
      trace.changes.push_back(m.free_symbol(place));
      m.write(place, trace.changes.back());
    }
    if (refine.first.empty()) return;
    m.run(frame, refine.body);
    read_all(refine.lack, trace.moved_lack);
  }
  // With unknowns one pass through the body, else all of them.
  void operator()(const Sweep& sweep) const {
    SweepTrace trace{.count = sweep.count};
    for (const Unknown& unknown : sweep.unknowns) {
      trace.starts.push_back(m.evaluate(frame, unknown.start));
      trace.unknowns.push_back(m.free_symbol(unknown.symbol));
    }
    for (std::size_t j = 0; j < sweep.unknowns.size(); ++j) {
      frame.locals[sweep.unknowns[j].symbol] = trace.unknowns[j];
    }
    const int passes = sweep.unknowns.empty() ? sweep.count : 1;
    for (int i = 0; i < passes; ++i) m.run(frame, sweep.body);
    for (const Unknown& unknown : sweep.unknowns) {
      trace.next.push_back(m.evaluate(frame, unknown.correction));
    }
    for (const std::string& result : sweep.results) {
      trace.results.push_back(m.free_symbol(result));
      frame.locals[result] = trace.results.back();
    }
    m.sweeps.push_back(std::move(trace));
  }
  void operator()(const InstructionOfRun auto&) const {
    internal_error("a step that keeps a history");
  }
  void operator()(const Return& end) const {
    if (end.value) frame.result = m.evaluate(frame, *end.value);
    if (end.flag && end.success) m.flags_[cell(m.reference(frame, *end.flag))] = true;
    frame.ended = true;
  }

 private:
  [[nodiscard]] MatrixEntries& matrix(const Place& place) const {
    return m.matrices_[cell(m.reference(frame, place))];
  }
  void begin(const std::vector<Unknown>& unknowns, IterationTrace& trace) const {
    for (const Unknown& unknown : unknowns) {
      trace.starts.push_back(m.evaluate(frame, unknown.start));
      trace.unknowns.push_back(m.free_symbol(unknown.symbol));
    }
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      frame.locals[unknowns[j].symbol] = trace.unknowns[j];
    }
  }
  // Which definitions since `first` depend on the unknowns?
  void finish(std::size_t first, IterationTrace& trace) const {
    for (const Expression& unknown : trace.unknowns) trace.inside.insert(unknown.name());
    for (std::size_t i = first; i < m.definitions_.size(); ++i) {
      const Statement& s = m.definitions_.all()[i];
      const std::set<std::string> read = symbols(s.value);
      const auto inside = [&](const std::string& name) { return trace.inside.contains(name); };
      if (std::ranges::any_of(read, inside)) trace.inside.insert(s.name);
    }
    m.iterations.push_back(std::move(trace));
  }
  // Everything the routine may change becomes free.
  void look_at(const std::string& name, const Frame& inner) const {
    CallTrace trace{.routine = name, .input = {}, .output = {}};
    std::vector<std::string> changed;
    for (const Argument& argument : m.code_.routine(name)->arguments) {
      if (argument.record == "Parameters" || argument.record == "Coefficients") continue;
      if (argument.record.empty() && argument.sizes.empty()) continue;
      for (const std::string& place : m.cells_of(inner.objects.at(argument.name))) {
        if (argument.changes) {
          changed.push_back(place);
        } else {
          trace.input.push_back(m.read(place));
        }
      }
    }
    // At the same point it returns the same.
    const auto same = std::ranges::find_if(m.calls, [&](const CallTrace& other) {
      return other.routine == name && other.input == trace.input;
    });
    for (std::size_t i = 0; i < changed.size(); ++i) {
      trace.output.push_back(same != m.calls.end() ? same->output[i]
                                                   : m.free_symbol(fmt::format("{}({})", name, i)));
    }
    for (std::size_t i = 0; i < changed.size(); ++i) m.write(changed[i], trace.output[i]);
    m.calls.push_back(std::move(trace));
  }
};

}  // namespace hamgen
