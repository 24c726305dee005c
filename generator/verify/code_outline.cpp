#include "generator/verify/code_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

using Event = CodeEvent::Kind;

// May they be parts of each other?
bool meet(const Place& a, const Place& b) {
  return a.object == b.object && (a.field == b.field || a.field.empty() || b.field.empty());
}

class Outline {
 public:
  explicit Outline(const Program* code = nullptr) : code_(code) {}
  std::vector<CodeEvent> take() { return std::move(events_); }

  void word(std::string text, std::vector<long> numbers = {}) {
    events_.push_back({.text = std::move(text), .numbers = std::move(numbers)});
  }
  void begin(const Routine& routine) {
    routine_ = &routine;
    locals_.clear();
    events_.push_back({.kind = Event::routine, .text = routine.name});
    word(routine.result.type + " " + routine.result.object);
    for (const Argument& a : routine.arguments) {
      word(fmt::format("argument {} {} {}", a.record, a.changes, a.decays), lengths(a));
      events_.back().names = {a.name};
    }
  }
  void run(const Body& body) {
    for (const Instruction& instruction : body) std::visit(*this, instruction.value);
  }
  // Symbols of a kernel stand at these places.
  void run(const Kernel& kernel) {
    Routine slots;
    for (const Slot& slot : kernel.slots) slots.places[slot.symbol] = {"z", "", {slot.position}};
    for (const ParameterSlot& slot : kernel.parameters) {
      slots.places[slot.symbol] = {"par", slot.parameter, {slot.position}};
    }
    for (const KernelRange& range : kernel.ranges)
      slots.places[range.index] = {"", "", {{0, {{range.index, 1}}}}};
    begin(slots);
    if (kernel.sum) word("to a sum", {static_cast<long>(*kernel.sum)});
    for (const KernelRange& range : kernel.ranges) loop(range);
    read(kernel.value);
    for (std::size_t i = 0; i < kernel.ranges.size(); ++i) end();
    routine_ = nullptr;
  }

  void operator()(const Let& let) {
    read(let.value);
    word(let.varies ? "variable" : "const");
    events_.push_back({.kind = Event::local, .text = local(let.symbol)});
  }
  void operator()(const Assign& assign) {
    read_multiple(assign.value);
    use(Event::set, assign.symbol);
  }
  void operator()(const Accumulate& sum) {
    read_multiple(sum.value);
    use(Event::add, sum.symbol);
  }
  void operator()(const Collect& sum) {
    read(sum.value);
    use(Event::add, sum.symbol);
    use(Event::add, sum.lost);
  }
  void operator()(const CollectStages& sum) {
    word("stages", {sum.count, sum.lanes});
    use(Event::get, sum.in("slope"));
    use(Event::get, sum.in("change"));
    use(Event::set, sum.symbol);
    use(Event::add, sum.lost);
  }
  void operator()(const Put& put) {
    read(put.value);
    Place place = put.matrix;
    place.indices.push_back(put.row);
    place.indices.push_back(put.column);
    use(Event::add, place);
  }
  void operator()(const For& range) {
    loop(range.range);
    events_.back().lanes = range.lanes;
    run(range.body);
    end();
  }
  void operator()(const Scope& scope) {
    word("scope");
    run(scope.body);
    word("end");
  }
  void operator()(const Array& array) {
    word("array " + array.name, {array.sizes.begin(), array.sizes.end()});
    read(array.values);
  }
  void operator()(const Matrix& matrix) {
    word(fmt::format("matrix {} {} {} {}", matrix.name, matrix.large, matrix.patterned,
                     matrix.symmetric),
         {matrix.size});
  }
  void operator()(const Clear& clear) { whole("clear", clear.matrix); }
  void operator()(const Copy& copy) {
    word(fmt::format("copy {} {}", copy.record, copy.declares));
    events_.back().names = {copy.to, copy.from};
  }
  void operator()(const SetFlag& set) { whole(set.value ? "raise" : "lower", set.flag); }
  void operator()(const If& branch) {
    whole(branch.set ? "if" : "if not", branch.flag);
    if (branch.also) whole("and", *branch.also);
    if (branch.any) word("any");
    run(branch.then);
    word("end");
  }
  void operator()(const Call& call) {
    events_.push_back({.kind = Event::call, .text = call.routine});
    word(fmt::format("{} {} {} {} {}", call.record, call.object, call.must_succeed, call.varies,
                     call.again));
    for (const Place& place : call.arguments) whole("given", place);
    const std::vector<Argument>& arguments = code_->routine(call.routine)->arguments;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      for (std::size_t j = 0; j < arguments.size(); ++j) {
        if (arguments[i].changes && !arguments[j].changes &&
            meet(call.arguments[i], call.arguments[j]))
          events_.push_back({.kind = Event::shared});
      }
    }
  }
  void operator()(const Alternate& alternate) {
    whole("alternate", alternate.patience);
    word("steps", {alternate.steps});
    run(alternate.before);
    (*this)(alternate.first);
    run(alternate.between);
    (*this)(alternate.second);
  }
  void operator()(const Factorise& factorise) { whole("factorise", factorise.matrix); }
  void operator()(const SolveFactorised& solve) {
    whole("solve", solve.matrix);
    whole("for", solve.vector);
  }
  void operator()(const Invert& invert) {
    whole("invert " + invert.matrix, invert.inverse);
    whole("regular", invert.regular);
  }
  void operator()(const Iterate& iterate) {
    word(fmt::format("iterate {} {}", static_cast<int>(iterate.rule), iterate.name));
    list(iterate.unknowns, iterate.body);
    for (const std::string& name : iterate.kept) word("kept " + local(name));
  }
  void operator()(const IterateArray& iterate) {
    word(fmt::format("iterate {} {}{}", static_cast<int>(iterate.rule), iterate.name,
                     iterate.leaves_last ? " but for the last" : ""));
    run(iterate.body);
    for (const KernelRange& range : iterate.ranges) loop(range);
    for (const UnknownArray& unknown : iterate.unknowns) {
      use(Event::get, unknown.increment);
      read(unknown.beside);
      use(Event::set, unknown.value);
    }
    for (std::size_t i = 0; i < iterate.ranges.size(); ++i) end();
    if (iterate.factorised) whole("factorised", *iterate.factorised);
    word("end");
  }
  void operator()(const Refine& refine) {
    word("refine " + refine.name);
    list(refine.unknowns, refine.body);
    for (const std::string& name : refine.kept) word("kept " + local(name));
    read(refine.gradient);
    read(refine.beside);
  }
  void operator()(const RefineArray& refine) {
    if (!refine.first.empty()) {
      run(refine.first);
      word("then");
    }
    run(refine.body);
    word((refine.begun ? "refine further " : "refine ") + refine.rule);
    if (refine.gives_up) word("or give up");
    if (refine.patience) whole("or wait", *refine.patience);
    whole("refinement", refine.refinement);
    whole("at", refine.point);
    whole("lack", refine.lack);
    whole("gradient", refine.gradient);
    read(refine.beside);
    word("size", {refine.count, refine.components});
  }
  void operator()(const Sweep& sweep) {
    word(fmt::format("sweep {}", sweep.count));
    list(sweep.unknowns, sweep.body);
    for (const std::string& name : sweep.results) word("result " + local(name));
  }
  void operator()(const InstructionOfRun auto&) { internal_error("a step that keeps a history"); }
  void operator()(const Return& end_of_routine) {
    word(fmt::format("return {}", end_of_routine.success));
    if (end_of_routine.value) word("value " + name_of_sum(*end_of_routine.value));
    if (end_of_routine.flag) whole("flag", *end_of_routine.flag);
    for (const KernelRange& range : end_of_routine.ranges) loop(range);
    for (const std::string& name : end_of_routine.finite) use(Event::get, name);
    for (std::size_t i = 0; i < end_of_routine.ranges.size(); ++i) end();
  }

 private:
  static std::vector<long> lengths(const Argument& a) { return {a.sizes.begin(), a.sizes.end()}; }

  void loop(const KernelRange& range) {
    CodeEvent event{.kind = Event::loop, .text = range.index};
    for (const AffineIndex* bound : {&range.lower, &range.upper}) {
      event.numbers.push_back(bound->constant);
      if (bound == &range.upper) event.names.emplace_back(kUpTo);
      for (const auto& [name, factor] : bound->factors) {
        event.names.push_back(name);
        event.numbers.push_back(factor);
      }
    }
    events_.push_back(std::move(event));
  }
  void end() { events_.push_back({.kind = Event::end}); }

  // Locals in the order in which they are met: their names may hold a place.
  std::string local(const std::string& symbol) {
    return fmt::format("local {}", locals_.try_emplace(symbol, locals_.size()).first->second);
  }
  // The value of a routine is the local that it has summed up, or an expression.
  std::string name_of_sum(const Expression& value) {
    if (value.kind() == Kind::symbol && !routine_->places.contains(value.name()))
      return local(value.name());
    read(value);
    return "";
  }
  void use(Event kind, const std::string& symbol) {
    const auto place = routine_->places.find(symbol);
    if (place == routine_->places.end() || locals_.contains(symbol)) {
      events_.push_back({.kind = kind, .text = local(symbol)});
    } else if (place->second.object.empty()) {
      events_.push_back({.kind = Event::index, .text = "index"});
      elements(place->second);
    } else {
      use(kind, place->second);
    }
  }
  void use(Event kind, const Place& place) {
    events_.push_back({.kind = kind, .text = place.object + "." + place.field});
    elements(place);
  }
  void whole(const std::string& what, const Place& place) {
    word(what);
    events_.back().names = {place.object + "." + place.field};
    elements(place);
  }
  void elements(const Place& place) {
    for (const AffineIndex& index : place.indices) {
      CodeEvent event{.kind = Event::element};
      for (const auto& [name, factor] : index.factors) {
        event.names.push_back(name);
        event.numbers.push_back(factor);
      }
      event.numbers.push_back(index.constant);
      events_.push_back(std::move(event));
    }
  }
  void read(const std::vector<Expression>& values) {
    for (const Expression& value : values) read(value);
  }
  // A symbol that is there by itself, or a multiple of it, is marked.
  void read_multiple(const Expression& value) {
    const Expression* symbol = &value;
    if (value.kind() == Kind::product && value.operands().size() == 2 &&
        value.operands()[0].kind() == Kind::number) {
      read(value.operands()[0]);
      symbol = &value.operands()[1];
    }
    if (symbol->kind() != Kind::symbol) return read(value);
    word(kAlone);
    read(*symbol);
  }
  // A number in a value is no place: it has to be the same.
  void read(const Expression& e) {
    switch (e.kind()) {
      case Kind::number:
        return word(e.number().get_str());
      case Kind::symbol:
        return use(Event::get, e.name());
      case Kind::function:
        word(e.name());
        break;
      case Kind::power:
      case Kind::product:
      case Kind::sum:
        word(fmt::format("{} of {}", static_cast<int>(e.kind()), e.operands().size()));
        break;
    }
    for (const Expression& operand : e.operands()) read(operand);
  }
  void list(const std::vector<Unknown>& unknowns, const Body& body) {
    for (const Unknown& unknown : unknowns) {
      read(unknown.start);
      read(unknown.beside);
    }
    for (const Unknown& unknown : unknowns) word("unknown " + local(unknown.symbol));
    run(body);
    for (const Unknown& unknown : unknowns) read(unknown.correction);
  }

  const Program* code_;
  std::vector<CodeEvent> events_;
  const Routine* routine_ = nullptr;
  std::map<std::string, std::size_t> locals_;
};

}  // namespace

std::vector<CodeEvent> outline(const Program& code, const std::set<std::string>& left_out) {
  Outline lines(&code);
  for (const Record& record : code.records) {
    lines.word("record " + record.name);
    // A block of numerics/ may have its size in its type: it is made for the records' sizes.
    for (const Field& field : record.fields) {
      lines.word(fmt::format("{} {}", field.name, field.type.substr(0, field.type.find('<'))),
                 {field.sizes.begin(), field.sizes.end()});
      // One value for all elements of an array is one value for more of them.
      const auto differs = [&](const Rational& value) { return value != field.values.front(); };
      const bool all_one = std::ranges::none_of(field.values, differs);
      for (const Rational& value : field.values) {
        lines.word(value.get_str());
        if (all_one) break;
      }
    }
  }
  for (const Routine& routine : code.routines) {
    if (left_out.contains(routine.name)) continue;
    lines.begin(routine);
    lines.run(routine.body);
  }
  for (const Rational& substep : code.substeps) lines.word("substep " + substep.get_str());
  lines.word("unknowns", {code.unknowns});
  for (const RuleOfNewton& rule : code.rules) lines.word(rule.name, {rule.first, rule.count});
  lines.word(code.retries ? "retries" : "does not retry");
  return lines.take();
}

std::vector<CodeEvent> outline(const std::vector<Kernel>& kernels) {
  Outline lines;
  for (const Kernel& kernel : kernels) lines.run(kernel);
  return lines.take();
}

}  // namespace hamgen
