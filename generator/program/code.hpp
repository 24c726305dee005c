// The step as a value: routines made of the kinds of instructions below.  The interpreter runs
// them; what they are as statements, which formats print, is in written_code.hpp.  Whatever has an
// algorithm in it is no instruction but a block of numerics/ that one of them calls.  Routines of a
// run, those of a Propagator, are made of the same and of some kinds that only they have.
//
// Values are expressions in symbols.  A symbol is a local of the routine, unless the routine says
// at which place it stands: "z.q" in the field q of the argument z.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/kernel.hpp"
#include "generator/program/place.hpp"

namespace hamgen {

struct Instruction;
using Body = std::vector<Instruction>;

// A local: const, unless it is assigned to later.
struct Let {
  std::string symbol;
  Expression value;
  bool varies = false;
};
// A local array of numbers, zero where no values are given.
struct Array {
  std::string name;
  std::vector<int> sizes;
  std::vector<Expression> values = {};
};
// A local matrix, zero; large ones are eliminated by Eigen.
struct Matrix {
  std::string name;
  int size = 0;
  bool large = false;
  bool patterned = false;  // of the type that Program::matrix describes
  bool symmetric = false;  // what is above its diagonal is not put
};
// to = from, both records of one type; `declares` a local of it.  Without `from` zeros.
struct Copy {
  std::string record;
  std::string to, from;
  bool declares = false;
};
struct Assign {
  std::string symbol;
  Expression value;
};
// symbol += value, where what rounding loses is added to `lost`.
struct Collect {
  std::string symbol, lost;
  Expression value;
};
// symbol = the sum of as many slopes of a refinement as a component has, from one of them on, so
// many lanes at once; what rounding loses of it, and their changes, are added to `lost`.
struct CollectStages {
  std::string symbol, lost;
  Place refinement;
  AffineIndex first;
  int count = 0, lanes = 0;

  // Where they begin in its array of this name, "slope" or "change".
  [[nodiscard]] Place in(const std::string& array) const {
    return {refinement.object, refinement.field + "." + array, {first}};
  }
};
// symbol += value
struct Accumulate {
  std::string symbol;
  Expression value;
};
// All entries become zero.
struct Clear {
  Place matrix;
};
// matrix(row, column) += value
struct Put {
  Place matrix;
  AffineIndex row, column;
  Expression value;
};
struct SetFlag {
  Place flag;
  bool value = true;
};
struct For {
  KernelRange range;  // both ends are taken
  Body body;
  // So many at once, of a range from 0 on: what has the index has it once, in its last index, and
  // functions are those of lanes.  0: one after the other.
  int lanes = 0;
};
// Locals that end with it.
struct Scope {
  Body body;
};
// Runs its body where the flag is set, or where it is not; if there is another, where that is set.
struct If {
  Place flag;
  bool set = true;
  Body then;
  std::optional<Place> also = {};
  bool any = false;  // of lanes: of any of them
};
struct Call {
  std::string routine;
  std::vector<Place> arguments;  // objects, or whole fields of theirs
  // The record that it returns, and the local that this one becomes.
  std::string record = {}, object = {};
  bool must_succeed = false;  // the routine ends without success where the other one does
  bool varies = false;        // is the local changed later?
  bool again = false;         // the local is there, and becomes what is returned
  bool of_run = false;        // is the routine given what a run keeps?
};
// Calls one of two routines that may fail: the first, where that fails once more from where
// `between` leads, for a prediction may lie further off than the state; and then the second, which
// serves `steps` times before the first is tried again.  Where the second fails the routine ends
// without success.  With `before`, which keeps the prediction, the first has one attempt, and the
// second begins with what was kept.
struct Alternate {
  Call first, second;
  Place patience;  // times that are left to the second
  int steps = 0;
  Body between;      // after each failure of the first
  Body before = {};  // the first

  [[nodiscard]] int attempts() const { return before.empty() ? 2 : 1; }
};
// Factorises a matrix.  Where it is singular or not finite the routine ends without success, and
// the report of an iteration says that its increment is not finite.
struct Factorise {
  Place matrix;
  int compared = 0;  // of so many unknowns, by the rule of the iteration with the step before
};
// The solution of matrix x = vector with the factors, left in the array `vector`.
struct SolveFactorised {
  Place matrix, vector;
};
// The inverse of a matrix that is wanted many times; the flag is cleared where there is none.
struct Invert {
  std::string matrix;
  Place inverse, regular;
};

// What an iteration changes.  Newton adds the correction, a fixed point takes it for the new value.
struct Unknown {
  std::string symbol;
  Expression start;       // where nothing is known from earlier steps
  Expression correction;  // known after the body
  int memory = 0;         // where in start.value its solution is kept
  Expression beside;      // what it is rounded with as well
  // Is it moved by a momentum that is torn out of the equations?  Then its way counts: see Note
  // [what every unknown lacks] in numerics/newton_rule_of_many.hpp.
  bool by_torn = false;
};
enum class Rule { newton, simplified_newton, fixed_point, linear };
// The body over and over, until the rule is content.  The last correction of Newton is not made:
// what follows takes it into account.
struct Iterate {
  Rule rule = Rule::newton;
  std::string name;  // of the rule: a field of start, or a local
  std::string type;  // of that local: "FixedPointRule<2>"
  std::vector<Unknown> unknowns;
  Body body;
  std::vector<std::string> kept;  // symbols of the body that what follows uses
};
// Unknowns that stand in arrays: over the ranges each `value` moves by its `increment`, and was
// rounded with `beside` as well.
struct UnknownArray {
  std::string value, increment;
  Expression beside;
  bool by_torn = false;    // see Unknown
  AffineIndex index = {};  // of the value among all unknowns
};
// As Iterate, for arrays whose values are there before it begins.  The body leaves the increments.
// The rule is a field of start.
struct IterateArray {
  Rule rule = Rule::newton;
  std::string name;
  std::vector<KernelRange> ranges;
  std::vector<UnknownArray> unknowns;
  Body body;
  int lanes = 0;  // so many of one array of unknowns are moved at once, as of For
  // Of a ContractionRule: what the matrix behind it costs, or 0; what foresees its last increment.
  std::optional<int> work = {};
  std::string refinement = {};
  // Of Newton: what all are rounded with, all increments; of linear equations their number, too.
  Place values = {}, increments = {};
  int count = 0;
  // Of a fixed point: whether the increment with which it ends is left to Refinement, unless a
  // ContractionRule makes it.
  bool leaves_last = false;
  // Of a simplified Newton: whether its matrix serves, and what the equations lacked.
  std::optional<Place> factorised = {};
  std::string residual = {};
};
// That Newton has, once a fixed point was slow, before it is tried again.
inline constexpr int kStepsOfNewton = 32;
// What is said where it is emitted.
inline constexpr const char* kRefinementRemark =
    "What the equations lack at the rounded unknowns is solved for, too.";
// What a fixed point lacks below the last place of its unknowns: see numerics/refinement.hpp.  The
// values of the body stay those at the unknowns; element j of the object's `change` is what the
// component `gradient` j lacks there.
struct Refine {
  std::string name;
  std::vector<Unknown> unknowns;
  Body body;
  std::vector<std::string> kept;
  std::vector<Expression> gradient;
  Expression beside = {};  // a length that its unknowns are rounded with besides, or 0
};
// The same for unknowns in an array: the body leaves the gradient in an array of so many elements
// and what the unknowns lack in another.  `refinement` is a field of start.  If there is something
// in `first` that does so at the rounded unknowns, the body only where they have been moved.
struct RefineArray {
  Place refinement, point, lack, gradient;
  std::string rule = {};   // a ContractionRule of start that may have settled it, or none
  int count = 0;           // of unknowns
  int components = 0;      // of the gradient
  bool begun = false;      // the body has been run there, unless the rule has moved it
  bool gives_up = false;   // fails where the rule finds that another solver is worth its work
  Expression beside = {};  // as of Refine
  // Where the solution is not found the routine fails, and Alternate's second solver has so many
  // steps from then on.
  std::optional<Place> patience = {};
  int steps = 0;
  Body first;
  Body body;
};
// The body a fixed number of times; then the unknowns are `results`.
struct Sweep {
  int count = 0;
  std::vector<Unknown> unknowns;
  Body body;
  std::vector<std::string> results;
};
// What a fixed block does: two_sum(x, y, z), or history.record(values), of a place of that type.
struct Use {
  std::string block;
  std::string action = {};
  std::vector<Place> arguments;  // of an action the first is the place
};
// Locals of one record, each as it begins.
struct Declare {
  std::string record;
  std::vector<std::string> objects;
};
// A local count or flag that keeps what stands at the place.
struct Note {
  std::string type, name;  // "long long", "wasted"
  Place from;
  bool varies = false;  // is it set anew afterwards?
};
// count += by, or ++count
struct Count {
  Place count;
  std::optional<Place> by = {};
};
// flag = count > 0
struct Ask {
  Place flag, count;
};
// A place of this type becomes what it begins with; of what each substep has, all of them.
struct Forget {
  Place what;
  std::string type;
  int each = 0;  // how many there are of it, if all
};
// The body as often as `times` says; a constant has its value besides.
struct Repeat {
  std::string type, index;  // "int", "i"
  std::string times;
  long count = 0;
  Body body;
};
// Out of the loop.
struct Break {};
// report.converged: are the numbers at these places finite, for all i below `count` if it is there?
struct RequireFinite {
  std::string report;
  std::vector<Place> numbers;
  int count = 0;
};
// A number, or success: given if the symbols have finite values, all over the ranges if there are
// any.  The flag says afterwards whether it was.
struct Return {
  std::optional<Expression> value = {};
  bool success = true;
  std::vector<std::string> finite = {};
  std::vector<KernelRange> ranges = {};
  std::optional<Place> flag = {};
  std::string report = {};  // a report that is there, and is returned as it is
};

// Why an instruction is there.
enum class When { called, run, step_size, step, iteration };
struct Origin {
  When when = When::called;  // how often it is done; of a function of the state: when called
  std::set<int> terms = {};  // of H, from 0
  std::string stage = {};    // the stage value that it defines: "bar(q)"
  bool operator==(const Origin&) const = default;
};

struct Instruction {
  std::variant<Let, Array, Matrix, Copy, Assign, Accumulate, Collect, CollectStages, Clear, Put,
               SetFlag, For, Scope, If, Call, Alternate, Factorise, SolveFactorised, Invert,
               Iterate, IterateArray, Refine, RefineArray, Sweep, Use, Declare, Note, Count, Ask,
               Forget, Repeat, Break, RequireFinite, Return>
      value;
  std::vector<std::string> remark = {};  // lines of a comment above it
  Origin origin = {};
};

// A record by reference, an array of numbers, or a number.
struct Argument {
  std::string name;
  std::string record = {};
  std::vector<int> sizes = {};
  bool changes = false;
  bool decays = false;     // an array that is given by its first element
  std::string count = {};  // of a number that is an integer: its type
  bool alone = false;      // of a record: is nothing else that the routine is given a part of it?
};

// What a routine returns: nothing, a number, or a record of this name that it fills in.
struct Result {
  std::string type = {};    // "", "Real", "StepReport"
  std::string object = {};  // what the record is called inside
  bool operator==(const Result&) const = default;
};

struct Routine {
  std::string name;
  std::vector<std::string> remark = {};
  Result result = {};
  std::vector<Argument> arguments = {};
  std::map<std::string, Place> places = {};  // of symbols that are no locals
  Body body = {};
  bool of_run = false;   // is it given what a run keeps, as "self"?
  bool inlined = false;  // wherever it is called
  // Of trajectories in lanes: objects and fields that it changes only in those of start.turn.
  std::vector<Place> in_turn = {};
};

// What only the routines of a run have, those of a Propagator.
template <class Node>
concept InstructionOfRun = std::is_same_v<Node, Use> || std::is_same_v<Node, Declare> ||
    std::is_same_v<Node, Note> || std::is_same_v<Node, Count> || std::is_same_v<Node, Ask> ||
    std::is_same_v<Node, Forget> || std::is_same_v<Node, Repeat> || std::is_same_v<Node, Break> ||
    std::is_same_v<Node, RequireFinite>;

// The array whose element of the loop's index the symbol is, from the first one that the loop meets
// on: none if that is not 0, or not one after the other.
[[nodiscard]] std::optional<Place> whole_array(const Routine& routine, const std::string& symbol,
                                               const std::vector<KernelRange>& ranges);
// The unknowns of such an iteration as whole arrays: none if one of them is not.
struct WholeUnknowns {
  Place value, increment, beside;
  long count = 0;
};
[[nodiscard]] std::vector<WholeUnknowns> whole_unknowns(const Routine& routine,
                                                        const IterateArray& iterate);
// How such an iteration moves its array of unknowns, in lanes.
[[nodiscard]] For moved_in_lanes(const IterateArray& iterate);
// The sums that should be finite: of an increment and the rest behind it, or of a symbol alone.
[[nodiscard]] std::vector<std::vector<std::string>> finite_sums(const Routine& routine,
                                                                const Return& end);
// The whole arrays of them: none if one is not whole.
[[nodiscard]] std::vector<std::vector<Place>> finite_arrays(const Routine& routine,
                                                            const Return& end);
// The bodies inside an instruction.
[[nodiscard]] std::vector<const Body*> inner_bodies(const Instruction& instruction);
[[nodiscard]] std::vector<Body*> inner_bodies(Instruction& instruction);
// The first text that `look` finds in an instruction or, behind it, in the bodies inside it.
[[nodiscard]] std::string find_in(const Body& body,
                                  const std::function<std::string(const Instruction&)>& look);
// Every value of the instruction itself, not of the bodies inside it.
void for_values(Instruction& instruction, const std::function<void(Expression&)>& use);
// The names of what is called.
[[nodiscard]] std::set<std::string> called_routines(const Body& body);
// Every symbol that the instructions read.
void collect_symbols(const Body& body, std::set<std::string>& names);
// Does the routine read or change the object: at a place, or in what it calls?
[[nodiscard]] bool uses_object(const Routine& routine, const std::string& object);

[[nodiscard]] std::string to_text(const Routine& routine);
// The same with the origin of each line before it.
[[nodiscard]] std::string text_with_origins(const Routine& routine);

}  // namespace hamgen
