// A routine as it is written: a dozen kinds of statements, and values as they stand in them.
// Formats print these, and what is read back is compared with them, so that what an instruction
// looks like, iterations above all, is said once: here.
//
// A name that ends in a blank, "size ", is one that only the text has: no symbol of the user's.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "generator/program/code.hpp"
#include "generator/solvers/matrix_storage.hpp"

namespace hamgen::written {

// What the text is made for.
struct Form {
  bool references = true;  // records are given by reference, else by their address
  bool lanes = false;      // a number is a pack of as many as there are trajectories
  bool eigen = true;       // may large matrices be Eigen's?
};

struct Value {
  enum class Kind {
    formula,
    place,     // the number, flag or record there
    object,    // what an action is done to
    given,     // as it is handed on to a routine; an element: the array from there on
    index,     // an integer
    count,     // an integer that counts elements
    word,      // "true", "false", or "largest", the largest number
    constant,  // that the text defines: "Verdict::done"
    zeros,     // the record `text` as it begins
    call,      // of a fixed block; the first `changed` arguments are changed
    routine,   // of a routine of the program
    of_run,    // of one that is given what a run keeps
    action,    // what the object parts[0], of the type `type`, does; without `text` what it is for
    member,    // parts[0].text
    prefix,    // "!", "--"
    joined,    // by the operator `text`
    choice,    // parts[0] ? parts[1] : parts[2]
    list,
  };
  Kind kind = Kind::formula;
  std::string text = {};
  std::string type = {};
  Expression formula = {};
  Place place = {};  // of an integer its index
  std::vector<Value> parts = {};
  std::size_t changed = 0;
};

struct Statement;
using Body = std::vector<Statement>;

// Where a body stands: in braces, on the line of its head if it is short and fits, or always.
enum class Shape { braces, fitting, line };

// A local with its value: a symbol of the program if it is one number, else called as it says.
struct Define {
  std::string type, name;
  Value value;
  bool varies = false;
  std::vector<int> sizes = {};  // of an array
};
// A number, or one of each of the stages in lanes?
[[nodiscard]] inline bool is_number(const Define& define) {
  return define.sizes.empty() && (define.type == "Real" || define.type == "Lanes");
}
// Value += sum and the like.
struct Set {
  Value to;
  std::string sign;
  Value value;
};
struct Do {
  Value value;
};
struct For {
  KernelRange range;  // both ends are taken
  Body body;
  Shape shape = Shape::braces;
  int lanes = 0;  // so many at once
};
// for (type index = first; index < limit; ++index); without a limit until something ends it.
struct Loop {
  std::string type, index;
  int first = 0;
  std::string limit = {};
  Body body;
  Shape shape = Shape::braces;
};
// While the flag `more`, true to begin with, is true.
struct While {
  Body body;
};
// All that a run keeps of this name, called `name` in the body.
struct Each {
  std::string type, name;
  Body body;
  Shape shape = Shape::line;
};
struct If {
  Value condition;
  Body body;
  Shape shape = Shape::braces;
};
struct Block {
  Body body;
};
struct Continue {};
struct Return {
  Value value;
};

struct Statement {
  std::variant<Declare, Define, Set, Do, For, Loop, While, Each, If, Block, Break, Continue, Return>
      value;
  std::vector<std::string> remark = {};  // lines of a comment above it
  bool is_short = false;                 // may stand on the line of a head
};

// Has only the text such a name, and which one?
[[nodiscard]] inline bool is_of_text(const std::string& name) { return name.ends_with(' '); }
[[nodiscard]] inline std::string name_in_text(const std::string& name) {
  return is_of_text(name) ? name.substr(0, name.size() - 1) : name;
}

// From what it returns, as that begins, to its end.
[[nodiscard]] Body body_of(const Routine& routine, const Form& form);
// Are the numbers of the array side by side in the loop of this index?
[[nodiscard]] bool is_of_lanes(const Place& place, const std::string& index);
// "BandMatrix<8, 1>"
[[nodiscard]] std::string type_of(const ArrayMatrix& matrix);
// The body inside a statement, if there is one.
[[nodiscard]] const Body* inner_body(const Statement& statement);

}  // namespace hamgen::written
