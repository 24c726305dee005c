#include "generator/verify/symbolic_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/base/diagnostic.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/program/lower.hpp"

namespace hamgen {

namespace {

// Of a field of a record; none of a scalar or of one that is not in it.
std::vector<int> field_sizes(const Record* record, const std::string& field) {
  if (record == nullptr) return {};
  const auto it = std::ranges::find(record->fields, field, &Field::name);
  return it == record->fields.end() ? std::vector<int>{} : it->sizes;
}

bool has_product_error(const Expression& e) {
  return (e.kind() == Kind::function && e.name() == kProductError) ||
         std::ranges::any_of(e.operands(), has_product_error);
}

long count_of(const std::vector<int>& sizes) {
  long count = 1;
  for (const int size : sizes) count *= size;
  return count;
}

}  // namespace

// Each kind of instruction, in a frame.
struct SymbolicMachine::Run {
  SymbolicMachine& m;
  Frame& frame;

  void operator()(const Let& let) const {
    frame.locals[let.symbol] = m.define(let.symbol, m.evaluate(frame, let.value));
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
    frame.objects[matrix.name] = {.root = frame.prefix + matrix.name};
    m.matrices_[frame.prefix + matrix.name].clear();
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
    Expression& entry = matrix(put.matrix)[{at(frame, put.row), at(frame, put.column)}];
    entry += value;
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
    m.run(frame, refine.body);
    IterationTrace& trace = m.iterations.back();
    const Reference refinement = m.reference(frame, refine.refinement);
    const std::string stem = cell(refinement);
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
      const Statement& s = m.definitions_[i];
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

SymbolicMachine::SymbolicMachine(const StepCode& code, std::set<std::string> opaque)
    : code_(code), opaque_(std::move(opaque)) {}

SymbolicMachine::Frame SymbolicMachine::frame_of(const std::string& routine,
                                                 const std::string& prefix) {
  Frame frame{.routine = code_.routine(routine), .prefix = prefix};
  if (frame.routine == nullptr) internal_error("no routine of the name " + routine);
  const Result& result = frame.routine->result;
  if (!result.object.empty()) {
    frame.objects[result.object] = {.root = prefix + result.object, .record = result.type};
  }
  return frame;
}

std::optional<Expression> SymbolicMachine::run(const std::string& routine) {
  Frame frame = frame_of(routine, "");
  for (const Argument& argument : frame.routine->arguments) {
    if (argument.record.empty() && argument.sizes.empty()) {
      frame.locals[argument.name] = argument.name == "h" ? Expression::symbol("h", kRankOfStep)
                                                         : Expression::symbol(argument.name);
    } else {
      frame.objects[argument.name] = {
          .root = argument.name, .record = argument.record, .sizes = argument.sizes};
    }
  }
  run(frame, frame.routine->body);
  last_locals_ = frame.locals;
  return frame.result;
}

void SymbolicMachine::run(Frame& frame, const Body& body) {
  for (const Instruction& instruction : body) {
    if (frame.ended) return;
    std::visit(Run{*this, frame}, instruction.value);
  }
}

// --- names and values ----------------------------------------------------------------------------

std::string SymbolicMachine::unique(const std::string& name) {
  const int used = names_[name]++;
  return used == 0 ? name : unique(fmt::format("{}#{}", name, used + 1));
}

Expression SymbolicMachine::free_symbol(const std::string& name) {
  const auto hint = hints_.find(name);
  return Expression::symbol(unique(hint == hints_.end() ? name : hint->second), kRankOfTemporary);
}

Expression SymbolicMachine::define(const std::string& name, const Expression& value) {
  if (is_trivial(value)) return value;
  if (value.kind() == Kind::function && value.name() == kProductError) {
    return without_rounding(name, value);
  }
  if (has_product_error(value)) return free_symbol(name);
  const auto [known, is_new] = known_.try_emplace({name, value}, Expression());
  if (!is_new) return known->second;
  known->second = Expression::symbol(unique(name), kRankOfTemporary);
  defined_[known->second.name()] = definitions_.size();
  definitions_.push_back({known->second.name(), value});
  return known->second;
}

// What a product loses is free, and its rounded value, which stands before it, is the product less
// that.
Expression SymbolicMachine::without_rounding(const std::string& name, const Expression& error) {
  const Expression product = error.operands()[0] * error.operands()[1];
  const auto known = lost_.find(product);
  if (known != lost_.end()) return known->second;
  for (std::size_t i = definitions_.size(); i-- > 0;) {
    if (definitions_[i].value != product) continue;
    const Expression lost = free_symbol(name);
    definitions_[i].value = product - lost;
    lost_.emplace(product, lost);
    return lost;
  }
  return free_symbol(name);  // of a product that nobody has computed
}

Expression SymbolicMachine::set_free(Frame& frame, const Expression& value, std::size_t first) {
  if (value.kind() != Kind::symbol) return value;
  const auto it = defined_.find(value.name());
  if (it == defined_.end() || it->second < first) return value;
  const Expression symbol = free_symbol(value.name() + "'");
  for (auto& [name, local] : frame.locals) {
    if (local == value) local = symbol;
  }
  return symbol;
}

std::optional<Expression> SymbolicMachine::local(const std::string& symbol) const {
  const auto it = last_locals_.find(symbol);
  if (it == last_locals_.end()) return {};
  return it->second;
}

Expression SymbolicMachine::evaluate(Frame& frame, const Expression& e) {
  Substitution values;
  for (const std::string& name : symbols(e)) values.emplace(name, number(frame, name));
  return substitute(e, values);
}

Expression SymbolicMachine::number(Frame& frame, const std::string& symbol) {
  const auto local = frame.locals.find(symbol);
  if (local != frame.locals.end()) {
    if (const auto added = frame.added.extract(symbol)) {
      std::vector<Expression> terms = added.mapped();
      terms.push_back(local->second);
      local->second = Expression::sum(std::move(terms));
    }
    return local->second;
  }
  const auto place = frame.routine->places.find(symbol);
  return place == frame.routine->places.end() ? Expression::symbol(symbol)
                                              : number_at(frame, place->second);
}

Expression SymbolicMachine::number_at(Frame& frame, const Place& place) {
  if (place.object.empty()) return Expression(at(frame, place.indices.at(0)));
  if (place.field.empty() && place.indices.empty()) {
    const auto local = frame.locals.find(place.object);
    if (local != frame.locals.end()) return local->second;
  }
  return read(cell(reference(frame, place)));
}

void SymbolicMachine::assign(Frame& frame, const std::string& symbol, const Expression& value,
                             bool by_name) {
  const auto place = frame.routine->places.find(symbol);
  if (place == frame.routine->places.end() || frame.locals.contains(symbol)) {
    frame.locals[symbol] = by_name ? define(symbol, value) : value;
  } else {
    const std::string where = cell(reference(frame, place->second));
    write(where, by_name ? define(where, value) : value);
  }
}

std::optional<std::string> SymbolicMachine::symbol_of(const Frame& frame, const Place& place) {
  const auto it = std::ranges::find_if(frame.routine->places,
                                       [&](const auto& entry) { return entry.second == place; });
  if (it == frame.routine->places.end()) return {};
  return it->first;
}

std::string SymbolicMachine::cell_of(Frame& frame, const std::string& symbol) {
  return cell(reference(frame, frame.routine->places.at(symbol)));
}

// --- places --------------------------------------------------------------------------------------

long SymbolicMachine::at(const Frame& frame, const AffineIndex& index) {
  long value = index.constant;
  for (const auto& [name, factor] : index.factors) value += factor * frame.indices.at(name);
  return value;
}

SymbolicMachine::Reference SymbolicMachine::reference(Frame& frame, const Place& place) const {
  const auto known = frame.objects.find(place.object);
  Reference result =
      known != frame.objects.end() ? known->second : Reference{.root = frame.prefix + place.object};
  if (!place.field.empty()) {
    result.field = place.field;
    result.sizes = field_sizes(code_.record(result.record), place.field);
    result.record.clear();
  }
  if (place.indices.empty()) return result;
  long linear = 0;
  for (std::size_t i = 0; i < place.indices.size(); ++i) {
    if (i > 0) linear *= result.sizes.at(i);
    linear += at(frame, place.indices[i]);
  }
  result.offset += linear;
  result.is_element = true;
  return result;
}

std::string SymbolicMachine::cell(const Reference& r) {
  const std::string stem = r.field.empty() ? r.root : r.root + "." + r.field;
  return r.is_element || !r.sizes.empty() ? fmt::format("{}[{}]", stem, r.offset) : stem;
}

std::vector<std::string> SymbolicMachine::cells_of(const Reference& reference) const {
  std::vector<std::string> cells;
  const auto add = [&](const std::string& stem, const std::vector<int>& sizes, long offset) {
    if (sizes.empty()) return cells.push_back(stem);
    for (long i = 0; i < count_of(sizes); ++i) {
      cells.push_back(fmt::format("{}[{}]", stem, offset + i));
    }
  };
  if (const Record* record = code_.record(reference.record)) {
    for (const Field& field : record->fields) {
      if (field.type == "Real") add(reference.root + "." + field.name, field.sizes, 0);
    }
    return cells;
  }
  const std::string& field = reference.field;
  add(field.empty() ? reference.root : reference.root + "." + field, reference.sizes,
      reference.offset);
  return cells;
}

void SymbolicMachine::forget(const std::string& root) {
  zeroed_.insert(root);
  std::erase_if(cells_, [&](const auto& entry) {
    return entry.first == root || entry.first.starts_with(root + ".") ||
           entry.first.starts_with(root + "[");
  });
}

Expression SymbolicMachine::read(const std::string& cell) {
  const auto it = cells_.find(cell);
  if (it != cells_.end()) return it->second;
  const std::string root = cell.substr(0, cell.find_last_of(".["));
  const bool zero = zeroed_.contains(root) || zeroed_.contains(cell.substr(0, cell.rfind('.')));
  const Expression value = zero ? Expression(0) : free_symbol(cell);
  cells_.emplace(cell, value);
  return value;
}

void SymbolicMachine::write(const std::string& cell, const Expression& value) {
  cells_.insert_or_assign(cell, value);
}

// --- from outside --------------------------------------------------------------------------------

Expression SymbolicMachine::value(const Place& place) { return read(outer_cell(place)); }

void SymbolicMachine::set(const Place& place, const Expression& value) {
  write(outer_cell(place), value);
}
void SymbolicMachine::set_flag(const Place& place, bool value) {
  flags_[outer_cell(place)] = value;
}
void SymbolicMachine::name(const Place& place, const std::string& symbol) {
  hints_[outer_cell(place)] = symbol;
}

std::string SymbolicMachine::outer_cell(const Place& place) const {
  std::string text = place.field.empty() ? place.object : place.object + "." + place.field;
  for (const AffineIndex& index : place.indices) text += fmt::format("[{}]", index.constant);
  return text;
}

}  // namespace hamgen
