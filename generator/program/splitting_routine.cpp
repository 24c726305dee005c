#include "generator/program/splitting_routine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "generator/base/diagnostic.hpp"
#include "generator/program/function_routines.hpp"
#include "generator/program/local_velocity.hpp"

namespace hamgen {

namespace {

// dV/dq or dT/dp with what it takes of k.
Routine half_gradient(const Environment& environment, const Coefficients& coefficients,
                      const std::string& name, const Evaluation& evaluation) {
  Routine routine = values_routine(environment, name, evaluation, StateForm::record, true);
  routine.arguments.insert(routine.arguments.begin() + 1, {.name = "k", .record = "Coefficients"});
  for (const auto& [symbol, place] : coefficients.places) routine.places[symbol] = place;
  return routine;
}

// One of the two kinds of substeps: p -= kick dV/dq, or q += drift dT/dp.
struct HalfStep {
  bool kick = true;
  Place gradient = {};  // where it stands
  bool once = false;    // is it one substep of the step?
  [[nodiscard]] const char* routine() const {
    return kick ? "potential_gradient" : "kinetic_gradient";
  }
  [[nodiscard]] const char* lengths() const { return kick ? "kick" : "drift"; }
};

// What a loop over the momenta goes on with, unless drifts come first and kicks last.
std::optional<LocalVelocity> velocity_in_loops(const LoweredStep& lowered) {
  const Sequence& sequence = lowered.sequence;
  const bool kick_first = sequence.substeps.front().kind == SubstepKind::kick;
  if (!lowered.plan.arrays || (!kick_first && !is_closed(sequence))) return {};
  return local_velocity(lowered.plan.equations.mechanics, "j");
}

// Note [sums of kicks]
// What is small is summed first, the carry with it, and nothing of it is lost.  The kicks of a step
// are rounded multiples of one force where h and the coefficients are simple fractions, and then
// what their rounded sum loses is a pattern, the same at every step, and not chance: for h = 1/5,
// w = 1.3 the form of an oscillator drifts by 1e-3 units of rounding a step with sbab-3.  Of what
// changes once there is no sum: the change is the increment, and the carry the rest.
//
// Note [where a substep looks]
// A kick is a shear, whatever it makes of q, if it looks at a function of q: at q rounded.  But z +
// dz alone hangs on what has been rounded on the way to dz.  A symmetric step is the way back, too,
// and what its substeps do to areas cancels in the mean; ruth-3 drifted by 3e-4 units a step, and
// by 1e-5 if what is in the rest is added before the sum is rounded.
//
// Note [the way back]
// A symmetric step is the way back only if a substep looks at one number, coming and going: at a
// function of z + carry + dz, and not of how it was added.  A sum rounded twice is none: with it
// the form of the chain of 25 drifted by 2e-4 units of rounding a step by Stormer-Verlet, h = 0.7.
// So a step of three substeps looks at all three, rounded once.  It is the way back to the last
// place of the carry then.
// Until the last substep of a kind there is nothing in its rest but the carry: it begins there.  In
// loops the coordinates that are looked at stand in its place, which makes one array less to go
// through, and none to clear.
class SplittingRoutine {
 public:
  SplittingRoutine(const Environment& environment, const LoweredStep& lowered)
      : environment_(environment),
        lowered_(lowered),
        n_(environment.degrees_of_freedom),
        pairs_(static_cast<int>(lowered.sequence.substeps.size() / 2)),
        arrays_(lowered.plan.arrays.has_value()),
        symmetric_(lowered.plan.equations.scheme.symmetric || lowered.plain_sums),
        reversible_(pairs_ == 1 && !lowered.plain_sums),
        closed_(is_closed(lowered.sequence)) {
    const std::vector<Substep>& substeps = lowered.sequence.substeps;
    for (std::size_t i = 1; i < substeps.size(); ++i) {
      if (substeps[i].kind == substeps[i - 1].kind)
        internal_error("substeps that do not alternate");
    }
    first_.kick = substeps.front().kind == SubstepKind::kick;
    second_.kick = !first_.kick;
    velocity_ = velocity_in_loops(lowered);
    keeps_ = keeps_gradient(lowered);
    first_.gradient = keeps_ ? Place{"start", "value"} : Place{"first"};
    second_.gradient = {"second"};
    for (HalfStep* kind : {&first_, &second_}) {
      const auto is_of_kind = [&](const Substep& substep) {
        return (substep.kind == SubstepKind::kick) == kind->kick;
      };
      kind->once = std::ranges::count_if(substeps, is_of_kind) == 1;
    }
  }

  Routine build() {
    routine_ = {.name = "solve",
                .remark = {"dz + rest = Z - z for one step from z + carry."},
                .result = {.type = "StepReport", .object = "report"},
                .arguments = {parameters_argument(),
                              {.name = "k", .record = "Coefficients"},
                              state_argument("z"),
                              state_argument("carry")}};
    if (keeps_) {
      routine_.arguments.push_back({.name = "start", .record = "Start", .changes = true});
    }
    routine_.arguments.push_back(state_argument("dz", true));
    routine_.arguments.push_back(state_argument("rest", true));
    if (begins_in_loops() && closed_ && reversible_)
      routine_.remark.emplace_back(
          "The coordinates it looks at stand in rest.p before that begins.");
    if (velocity_) {
      environment_.bind_parameters(routine_);
      for (const auto& [symbol, place] : velocity_->places) routine_.places[symbol] = place;
    }
    Body& body = routine_.body;
    add_places(body);
    const Place known{"start", "known"};
    if (keeps_) {
      Body unknown;
      add_call(unknown, first_, velocity_ ? "z" : "now");
      body.push_back({If{known, false, std::move(unknown)}});
    }
    if (velocity_ && !first_.kick) {
      add_drifts_first(body);
    } else {
      add_pairs(body);
    }
    Return end;
    if (keeps_) end.flag = known;
    add_finite(end);
    body.push_back({std::move(end)});
    return std::move(routine_);
  }

 private:
  // What the step works on.  Where velocities are local nobody looks at the momenta on the way, and
  // a step of one pair of substeps begins its sums where it has the components.
  [[nodiscard]] bool begins_in_loops() const { return velocity_ && pairs_ == 1; }
  // The coordinates that it looks at there.
  [[nodiscard]] Place looked_at() const { return reversible_ ? Place{"rest", "p"} : Place{"q"}; }
  void add_places(Body& body) {
    if (!begins_in_loops()) {
      body.push_back({Copy{"State", "now", "z", true}});
      if (reversible_) {  // each component begins where it is changed
        add_carries_of_constants(body);
      } else {
        body.push_back({Copy{"State", "dz", "carry"}});
        body.push_back({Copy{"State", "rest", ""}});
      }
    } else if (closed_ && !reversible_) {
      body.push_back({Array{"q", {n_}}});
    }
    for (const HalfStep& kind : {first_, second_}) {
      const bool local = velocity_ && !kind.kick;
      if (kind.gradient.field.empty() && !local)
        body.push_back({Array{kind.gradient.object, {n_}}});
    }
  }

  // What there is of each pair, in a loop if there are several.
  template <class Add>
  void for_pairs(Body& body, const Add& add) {
    if (pairs_ == 1) return add(body, AffineIndex{});
    Body loop;
    add(loop, AffineIndex{0, {{"i", 1}}});
    body.push_back({For{{"i", {0, {}}, {pairs_ - 1, {}}}, std::move(loop)}});
  }
  // A drift, and behind every kick, where the momenta are, the next one.
  void add_drifts_first(Body& body) {
    Body change{{Let{velocity_->momentum, component("z", true, {0, {{"j", 1}}})}}};
    add_change(change, first_, {}, Look::state, true);
    add_loop(body, std::move(change));
    for_pairs(body, [&](Body& pair, AffineIndex substep) {
      add_call(pair, second_, "now");
      Body changes;
      add_change(changes, second_, substep, Look::velocity);
      ++substep.constant;
      add_change(changes, first_, substep, pairs_ == 1 ? Look::nobody : Look::state);
      add_loop(pair, std::move(changes));
    });
  }
  void add_pairs(Body& body) {
    for_pairs(body, [&](Body& pair, const AffineIndex& substep) { add_pair(pair, substep); });
    if (closed_) {
      Body change;
      add_change(change, first_, {pairs_, {}}, Look::nobody);
      add_loop(body, std::move(change));
    }
  }

  void add_pair(Body& body, const AffineIndex& substep) {
    const bool ends = pairs_ == 1 && !closed_;  // nobody looks at what the pair leaves
    if (!closed_) add_call(body, first_, begins_in_loops() ? "z" : "now");
    Body change;
    add_change(change, first_, substep, velocity_ ? Look::velocity : Look::state, true);
    if (!velocity_) {
      add_loop(body, std::exchange(change, {}));
      add_call(body, second_, "now");
    }
    add_change(change, second_, substep, velocity_ && ends ? Look::nobody : Look::state);
    add_loop(body, std::move(change));
    if (closed_) add_call(body, first_, "now");
  }

  // dV/dq or dT/dp at a state.
  void add_call(Body& body, const HalfStep& kind, const std::string& state) const {
    if (!arrays_) {
      body.push_back({Call{kind.routine(), {{"par"}, {"k"}, {"now"}, kind.gradient}}});
      return;
    }
    Place point{state, kind.kick ? "q" : "p"};
    if (begins_in_loops() && state == "now") point = looked_at();
    body.push_back({Call{kind.routine(), {{"par"}, std::move(point), kind.gradient}}});
  }

  Expression bind(const std::string& symbol, const Place& place) {
    routine_.places.insert_or_assign(symbol, place);
    return Expression::symbol(symbol, kRankOfTemporary);
  }
  Expression element(Place array, const AffineIndex& index) {
    array.indices.push_back(index);
    std::string symbol = to_text(array);
    std::ranges::replace(symbol, '[', '(');
    std::ranges::replace(symbol, ']', ')');
    return bind(symbol, array);
  }
  // Component `index` of the coordinates or momenta of a state.
  Expression component(const std::string& state, bool momentum, const AffineIndex& index) {
    if (begins_in_loops() && state == "now") return element(looked_at(), index);
    if (arrays_) return element({state, momentum ? "p" : "q"}, index);
    const Place place =
        environment_.place(state, static_cast<int>(index.constant) + (momentum ? n_ : 0));
    return bind(to_text(place), place);
  }

  // The components of a kind that change: of a written-out system those with a slope.
  [[nodiscard]] std::vector<AffineIndex> components(bool kick) const {
    if (arrays_) return {{0, {{"j", 1}}}};
    const Evaluation& gradient = kick ? lowered_.potential_gradient : lowered_.kinetic_gradient;
    std::vector<AffineIndex> result;
    for (int i = 0; i < n_; ++i) {
      if (!gradient.results[static_cast<std::size_t>(i)].is_zero()) result.push_back({i, {}});
    }
    return result;
  }

  // Who looks at what a substep has changed: the rest of the step at the state, the velocity in the
  // same loop, or nobody.
  enum class Look { state, velocity, nobody };

  // What nothing changes keeps its carry.
  void add_carries_of_constants(Body& body) {
    if (arrays_) return;
    for (const bool momentum : {false, true}) {
      const std::vector<AffineIndex> changed = components(momentum);
      for (int i = 0; i < n_; ++i) {
        const AffineIndex index{i, {}};
        if (std::ranges::find(changed, index) != changed.end()) continue;
        const Expression rest = component("rest", momentum, index);
        body.push_back({Assign{rest.name(), component("carry", momentum, index)}});
      }
    }
  }

  // dz -= kick dV/dq or dz += drift dT/dp, and what somebody looks at.
  // `begins`: the sums, too.
  void add_change(Body& body, const HalfStep& kind, const AffineIndex& substep, Look look,
                  bool begins = false) {
    for (const AffineIndex& i : components(kind.kick)) {
      const Expression length = element({"k", kind.lengths()}, substep);
      const Expression slope = velocity_ && !kind.kick ? velocity(body) : element(kind.gradient, i);
      const Expression change = (kind.kick ? -length : length) * slope;
      const Expression dz = component("dz", kind.kick, i);
      const Expression rest = component("rest", kind.kick, i);
      const Expression carry = component("carry", kind.kick, i);
      const Expression z = component("z", kind.kick, i);
      const Origin origin{.terms = velocity_ && !kind.kick ? velocity_->terms : std::set<int>()};
      // See Note [the way back]; with nothing to add to there is no sum.
      const bool no_sum = kind.once || (begins && (reversible_ || begins_in_loops()));
      if (no_sum) body.push_back({Assign{dz.name(), change}, {}, origin});
      if (kind.once || (reversible_ && !begins)) body.push_back({Assign{rest.name(), carry}});
      if (!no_sum) body.push_back({Collect{dz.name(), rest.name(), change}, {}, origin});
      if (look == Look::nobody) continue;
      const bool to_local = look == Look::velocity;
      const std::string looked_at =
          to_local ? velocity_->momentum : component("now", kind.kick, i).name();
      if (symmetric_ && !reversible_) {
        body.push_back(to_local ? Instruction{Let{looked_at, z + dz}}
                                : Instruction{Assign{looked_at, z + dz}});
        continue;
      }
      const Expression lost = Expression::symbol("lost(" + z.name() + ")", kRankOfTemporary);
      body.push_back({Let{lost.name(), reversible_ ? carry : rest, true}});
      body.push_back(to_local ? Instruction{Let{looked_at, z, true}}
                              : Instruction{Assign{looked_at, z}});
      body.push_back({Collect{looked_at, lost.name(), dz}});
      body.push_back({Accumulate{looked_at, lost}});
    }
  }
  // dT/dp_j, in a loop that has p_j.
  Expression velocity(Body& body) const {
    velocity_->compute(body);
    return velocity_->evaluation.results.front();
  }
  // The changes, of every element if they are those of arrays.
  void add_loop(Body& body, Body changes) const {
    if (arrays_) {
      body.push_back({For{{"j", {0, {}}, {n_ - 1, {}}}, std::move(changes)}});
    } else {
      for (Instruction& change : changes) body.push_back(std::move(change));
    }
  }

  void add_finite(Return& end) {
    for (const bool momentum : {false, true}) {
      for (const AffineIndex& i : components(momentum)) {
        end.finite.push_back(component("dz", momentum, i).name());
      }
    }
    if (arrays_) end.ranges = {{"j", {0, {}}, {n_ - 1, {}}}};
  }

  const Environment& environment_;
  const LoweredStep& lowered_;
  int n_, pairs_;
  bool arrays_, symmetric_;
  bool reversible_;  // see Note [the way back]
  bool closed_;
  bool keeps_ = false;       // the gradient that the step ends with, for the next
  HalfStep first_, second_;  // that comes first, and the other
  std::optional<LocalVelocity> velocity_;
  Routine routine_;
};

}  // namespace

std::vector<ScaledNumbers> splitting_lengths(const Sequence& sequence) {
  return {{"kick", lengths_of(sequence, SubstepKind::kick)},
          {"drift", lengths_of(sequence, SubstepKind::drift)}};
}

bool is_closed(const Sequence& sequence) {
  return sequence.substeps.front().kind == sequence.substeps.back().kind;
}

bool keeps_gradient(const LoweredStep& lowered) {
  const Sequence& sequence = lowered.sequence;
  if (!is_closed(sequence)) return false;
  const bool kick_first = sequence.substeps.front().kind == SubstepKind::kick;
  return kick_first || !velocity_in_loops(lowered);
}

std::vector<Routine> splitting_routines(const Environment& environment, const LoweredStep& lowered,
                                        const Coefficients& coefficients) {
  std::vector<Routine> routines;
  if (!lowered.plan.arrays) {
    routines.push_back(
        half_gradient(environment, coefficients, "potential_gradient", lowered.potential_gradient));
    routines.back().remark = {"dV/dq at z."};
    routines.push_back(
        half_gradient(environment, coefficients, "kinetic_gradient", lowered.kinetic_gradient));
    routines.back().remark = {"dT/dp at z."};
  }
  routines.push_back(SplittingRoutine(environment, lowered).build());
  return routines;
}

}  // namespace hamgen
