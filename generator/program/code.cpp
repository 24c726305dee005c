#include "generator/program/code.hpp"

#include <algorithm>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

namespace {

// The symbols a node reads and writes, and the objects it names.
struct Mentions {
  std::set<std::string> read, written, objects;
};

void mention(const Expression& e, Mentions& found) { collect_symbols(e, found.read); }
void mention(const Body& body, Mentions& found);

void mention(const std::vector<Unknown>& unknowns, Mentions& found) {
  for (const Unknown& unknown : unknowns) {
    found.written.insert(unknown.symbol);
    mention(unknown.start, found);
    mention(unknown.beside, found);
    mention(unknown.correction, found);
  }
}

struct Reader {
  Mentions& found;

  void operator()(const Let& let) const { mention(let.value, found); }
  void operator()(const Array& array) const {
    for (const Expression& e : array.values) mention(e, found);
  }
  void operator()(const Matrix&) const {}
  void operator()(const Copy& copy) const { found.objects.insert({copy.from, copy.to}); }
  void operator()(const Clear& clear) const { found.objects.insert(clear.matrix.object); }
  void operator()(const Put& put) const {
    found.objects.insert(put.matrix.object);
    mention(put.value, found);
  }
  void operator()(const SetFlag& set) const { found.objects.insert(set.flag.object); }
  void operator()(const Invert& invert) const {
    found.objects.insert({invert.matrix, invert.inverse.object});
  }
  void operator()(const Assign& assign) const {
    found.written.insert(assign.symbol);
    mention(assign.value, found);
  }
  void operator()(const Collect& sum) const {
    found.written.insert({sum.symbol, sum.lost});
    mention(sum.value, found);
  }
  void operator()(const CollectStages& sum) const {
    found.written.insert({sum.symbol, sum.lost});
    found.objects.insert(sum.refinement.object);
  }
  void operator()(const Accumulate& sum) const {
    found.written.insert(sum.symbol);
    mention(sum.value, found);
  }
  void operator()(const For& loop) const { mention(loop.body, found); }
  void operator()(const Scope& scope) const { mention(scope.body, found); }
  void operator()(const If& branch) const {
    found.objects.insert(branch.flag.object);
    if (branch.also) found.objects.insert(branch.also->object);
    mention(branch.then, found);
  }
  void operator()(const Call& call) const {
    for (const Place& place : call.arguments) found.objects.insert(place.object);
  }
  void operator()(const Alternate& alternate) const {
    (*this)(alternate.first);
    (*this)(alternate.second);
    found.objects.insert(alternate.patience.object);
    mention(alternate.between, found);
    mention(alternate.before, found);
  }
  void operator()(const Factorise& factorise) const {
    found.objects.insert(factorise.matrix.object);
  }
  void operator()(const SolveFactorised& solve) const {
    found.objects.insert({solve.matrix.object, solve.vector.object});
  }
  void operator()(const Iterate& iterate) const {
    found.objects.insert({"start", "report"});
    mention(iterate.unknowns, found);
    mention(iterate.body, found);
  }
  void operator()(const IterateArray& iterate) const {
    found.objects.insert({"start", "report"});
    for (const UnknownArray& u : iterate.unknowns) {
      found.written.insert({u.value, u.increment});
      mention(u.beside, found);
    }
    mention(iterate.body, found);
  }
  void operator()(const RefineArray& refine) const {
    found.objects.insert(refine.refinement.object);
    mention(refine.beside, found);
    mention(refine.first, found);
    mention(refine.body, found);
  }
  void operator()(const Refine& refine) const {
    mention(refine.unknowns, found);
    mention(refine.body, found);
    for (const Expression& e : refine.gradient) mention(e, found);
    mention(refine.beside, found);
  }
  void operator()(const Sweep& sweep) const {
    mention(sweep.unknowns, found);
    mention(sweep.body, found);
  }
  void operator()(const Use& use) const {
    for (const Place& place : use.arguments) found.objects.insert(place.object);
  }
  void operator()(const Declare&) const {}
  void operator()(const Note& note) const { found.objects.insert(note.from.object); }
  void operator()(const Count& count) const {
    found.objects.insert(count.count.object);
    if (count.by) found.objects.insert(count.by->object);
  }
  void operator()(const Ask& ask) const {
    found.objects.insert({ask.flag.object, ask.count.object});
  }
  void operator()(const Forget& forget) const { found.objects.insert(forget.what.object); }
  void operator()(const Repeat& repeat) const {
    found.objects.insert(repeat.times);
    mention(repeat.body, found);
  }
  void operator()(const Break&) const {}
  void operator()(const RequireFinite& finite) const {
    for (const Place& place : finite.numbers) found.objects.insert(place.object);
  }
  void operator()(const Return& end) const {
    if (end.value) mention(*end.value, found);
    found.read.insert(end.finite.begin(), end.finite.end());
    if (end.flag) found.objects.insert(end.flag->object);
  }
};

void mention(const Body& body, Mentions& found) {
  for (const Instruction& node : body) std::visit(Reader{found}, node.value);
}

// Every value of a node, to be changed.
struct Writer {
  const std::function<void(Expression&)>& use;

  void operator()(Let& let) const { use(let.value); }
  void operator()(Array& array) const { std::ranges::for_each(array.values, use); }
  void operator()(Assign& assign) const { use(assign.value); }
  void operator()(Accumulate& sum) const { use(sum.value); }
  void operator()(Collect& sum) const { use(sum.value); }
  void operator()(Put& put) const { use(put.value); }
  void operator()(Iterate& iterate) const { (*this)(iterate.unknowns); }
  void operator()(IterateArray& iterate) const {
    for (UnknownArray& unknown : iterate.unknowns) use(unknown.beside);
  }
  void operator()(Refine& refine) const {
    (*this)(refine.unknowns);
    std::ranges::for_each(refine.gradient, use);
    use(refine.beside);
  }
  void operator()(RefineArray& refine) const { use(refine.beside); }
  void operator()(Sweep& sweep) const { (*this)(sweep.unknowns); }
  void operator()(Return& end) const {
    if (end.value) use(*end.value);
  }
  void operator()(std::vector<Unknown>& unknowns) const {
    for (Unknown& unknown : unknowns) {
      use(unknown.start);
      use(unknown.beside);
      use(unknown.correction);
    }
  }
  template <class Other>
  void operator()(Other& /*without values*/) const {}
};

}  // namespace

std::optional<Place> whole_array(const Routine& routine, const std::string& symbol,
                                 const std::vector<KernelRange>& ranges) {
  const auto found = routine.places.find(symbol);
  if (ranges.size() != 1 || found == routine.places.end()) return {};
  const KernelRange& range = ranges.front();
  Place place = found->second;
  const bool counts = range.lower == AffineIndex{} && range.upper.factors.empty();
  if (!counts || place.indices.size() != 1) return {};
  AffineIndex& index = place.indices.front();
  if (index.factors != std::map<std::string, long>{{range.index, 1}}) return {};
  index.factors.clear();
  if (index.constant == 0) place.indices.clear();
  return place;
}

std::vector<WholeUnknowns> whole_unknowns(const Routine& routine, const IterateArray& iterate) {
  std::vector<WholeUnknowns> list;
  for (const UnknownArray& u : iterate.unknowns) {
    if (u.beside.kind() != Kind::symbol) return {};
    const auto array = [&](const std::string& symbol) {
      return whole_array(routine, symbol, iterate.ranges);
    };
    const std::optional<Place> value = array(u.value);
    const std::optional<Place> increment = array(u.increment);
    const std::optional<Place> beside = array(u.beside.name());
    if (!value || !increment || !beside) return {};
    list.push_back({*value, *increment, *beside, iterate.ranges.front().upper.constant + 1});
  }
  return list;
}

For moved_in_lanes(const IterateArray& iterate) {
  const UnknownArray& u = iterate.unknowns.front();
  const Expression moved = Expression::symbol(u.value, kRankOfVariable) +
                           Expression::symbol(u.increment, kRankOfVariable + 1);
  return {iterate.ranges.front(), {{Assign{u.value, moved}}}, iterate.lanes};
}

std::vector<std::vector<std::string>> finite_sums(const Routine& routine, const Return& end) {
  std::vector<std::vector<std::string>> sums;
  for (const std::string& symbol : end.finite) {
    const auto found = routine.places.find(symbol);
    const bool is_rest = found != routine.places.end() && found->second.object == "rest";
    if (!is_rest) sums.emplace_back();
    sums.back().push_back(symbol);
  }
  return sums;
}

std::vector<std::vector<Place>> finite_arrays(const Routine& routine, const Return& end) {
  std::vector<std::vector<Place>> list;
  for (const std::vector<std::string>& sum : finite_sums(routine, end)) {
    list.emplace_back();
    for (const std::string& symbol : sum) {
      const std::optional<Place> array = whole_array(routine, symbol, end.ranges);
      if (!array || !array->indices.empty()) return {};
      list.back().push_back(*array);
    }
  }
  return list;
}

std::vector<const Body*> inner_bodies(const Instruction& instruction) {
  if (const auto* loop = std::get_if<For>(&instruction.value)) return {&loop->body};
  if (const auto* scope = std::get_if<Scope>(&instruction.value)) return {&scope->body};
  if (const auto* branch = std::get_if<If>(&instruction.value)) return {&branch->then};
  if (const auto* iterate = std::get_if<Iterate>(&instruction.value)) return {&iterate->body};
  if (const auto* iterate = std::get_if<IterateArray>(&instruction.value)) return {&iterate->body};
  if (const auto* refine = std::get_if<Refine>(&instruction.value)) return {&refine->body};
  if (const auto* refine = std::get_if<RefineArray>(&instruction.value))
    return {&refine->first, &refine->body};
  if (const auto* two = std::get_if<Alternate>(&instruction.value))
    return {&two->before, &two->between};
  if (const auto* sweep = std::get_if<Sweep>(&instruction.value)) return {&sweep->body};
  if (const auto* repeat = std::get_if<Repeat>(&instruction.value)) return {&repeat->body};
  return {};
}

std::vector<Body*> inner_bodies(Instruction& instruction) {
  std::vector<Body*> bodies;
  for (const Body* body : inner_bodies(std::as_const(instruction))) {
    bodies.push_back(const_cast<Body*>(body));  // of an instruction that is not const
  }
  return bodies;
}

std::string find_in(const Body& body, const std::function<std::string(const Instruction&)>& look) {
  for (const Instruction& instruction : body) {
    std::string found = look(instruction);
    for (const Body* inner : inner_bodies(instruction)) {
      if (found.empty()) found = find_in(*inner, look);
    }
    if (!found.empty()) return found;
  }
  return {};
}

void for_values(Instruction& instruction, const std::function<void(Expression&)>& use) {
  std::visit(Writer{use}, instruction.value);
}

std::set<std::string> called_routines(const Body& body) {
  std::set<std::string> found;
  for (const Instruction& instruction : body) {
    if (const auto* call = std::get_if<Call>(&instruction.value)) found.insert(call->routine);
    if (const auto* two = std::get_if<Alternate>(&instruction.value)) {
      found.insert({two->first.routine, two->second.routine});
    }
    for (const Body* inner : inner_bodies(instruction)) found.merge(called_routines(*inner));
  }
  return found;
}

void collect_symbols(const Body& body, std::set<std::string>& names) {
  Mentions found;
  mention(body, found);
  names.merge(found.read);
}

bool uses_object(const Routine& routine, const std::string& object) {
  Mentions found;
  mention(routine.body, found);
  // A symbol of this name may be something else: the parameter k beside the coefficients k, the
  // momentum par beside the parameters par.  Of arguments only numbers are symbols themselves.
  const auto argument = std::ranges::find(routine.arguments, object, &Argument::name);
  const bool is_record =
      argument != routine.arguments.end() && !(argument->record.empty() && argument->sizes.empty());
  const bool is_symbol =
      !is_record && !routine.places.contains(object) && found.read.contains(object);
  if (is_symbol || found.objects.contains(object)) return true;
  return std::ranges::any_of(routine.places, [&](const auto& entry) {
    const auto& [symbol, place] = entry;
    return place.object == object &&
           (found.read.contains(symbol) || found.written.contains(symbol));
  });
}

}  // namespace hamgen
