// The step as a value: routines made of a dozen kinds of nodes.  Formats print them, the
// interpreter runs them.  Whatever has an algorithm in it is no node but a block of numerics/ that
// one calls.
//
// Values are expressions in symbols.  A symbol is a local of the routine, unless the routine says
// at which place it stands: "z.q" in the field q of the argument z.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// A member of a record: a number, an array of numbers, a flag, or a block of numerics/.
struct Field {
  std::string name;
  int length = 0;  // of an array; 0: a single one
  std::string remark = {};
  std::vector<Rational> values = {};  // to begin with; empty: zeros
  std::string type = "Real";          // or "bool", "NewtonRule"
  bool operator==(const Field&) const = default;
};

struct Record {
  std::string name;  // "State"
  std::vector<Field> fields;
  std::vector<std::string> remark = {};
  bool operator==(const Record&) const = default;
};

// An element of an object: z.q[i - 1], matrix[0][1].
struct Place {
  std::string object;
  std::string field = {};                 // empty: the object is an array
  std::vector<AffineIndex> indices = {};  // of an array
  bool operator==(const Place&) const = default;
};

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
struct Assign {
  std::string symbol;
  Expression value;
};
// symbol += value
struct Accumulate {
  std::string symbol;
  Expression value;
};
struct For {
  KernelRange range;  // both ends are taken
  Body body;
};
// A flag of a record, or its contrary.
struct If {
  Place flag;
  bool set = true;
  Body then;
};
struct Call {
  std::string routine;
  std::vector<Place> arguments;  // objects, or whole fields of theirs
};
// The solution of matrix x = vector, left in the array `vector`.  Where there is none the routine
// ends with an unsuccessful report.
struct SolveLinear {
  std::string matrix;  // an array
  std::string vector;
};

// What an iteration changes.  Newton adds the correction, a fixed point takes it for the new value.
struct Unknown {
  std::string symbol;
  Expression start;       // where nothing is known from earlier steps
  Expression correction;  // known after the body
  int memory = 0;         // where in start.value its solution is kept
};
enum class Rule { newton, fixed_point };
// The body over and over, until the rule is content.  The last correction of Newton is not made:
// what follows takes it into account.
struct Iterate {
  Rule rule = Rule::newton;
  std::string name;  // of the rule: a field of start, or a local
  std::vector<Unknown> unknowns;
  Body body;
  std::vector<std::string> kept;  // symbols of the body that what follows uses
};
// The body a fixed number of times; then the unknowns are `results`.
struct Sweep {
  int count = 0;
  std::vector<Unknown> unknowns;
  Body body;
  std::vector<std::string> results;
};
// A number, or the report: successful if the symbols have finite values.
struct Return {
  std::optional<Expression> value = {};
  bool success = true;
  std::vector<std::string> finite = {};
};

struct Instruction {
  std::variant<Let, Array, Assign, Accumulate, For, If, Call, SolveLinear, Iterate, Sweep, Return>
      value;
  std::vector<std::string> remark = {};  // lines of a comment above it
};

// A record by reference, an array of numbers, or a number.
struct Argument {
  std::string name;
  std::string record = {};
  std::vector<int> sizes = {};
  bool changes = false;
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
};

// Every symbol that the nodes read.
void collect_symbols(const Body& body, std::set<std::string>& names);
// Does the routine read or change the object: at a place, or in what it calls?
[[nodiscard]] bool uses_object(const Routine& routine, const std::string& object);

// "z.q[i - 1]"
[[nodiscard]] std::string to_text(const Place& place);
[[nodiscard]] std::string to_text(const Routine& routine);

}  // namespace hamgen
