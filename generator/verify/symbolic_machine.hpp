// Routines on expressions.  What a routine assigns becomes a definition, so that shared values stay
// shared; loops run over their instances; what an iteration solves for, what an elimination
// returns and what rounding takes from a product are free symbols.
//
// Nothing here knows how a step was planned or built: it is the meaning of the instructions.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/program/program.hpp"
#include "generator/program/statement.hpp"
#include "generator/verify/defined_values.hpp"

namespace hamgen {

using MatrixEntries = std::map<std::pair<long, long>, Expression>;

// matrix solution = right side; the solution consists of free symbols.
struct EliminatedSystem {
  MatrixEntries matrix = {};
  std::vector<Expression> right_side = {};
  std::vector<Expression> solution = {};
};
// A matrix and the symbols of its inverse, row by row.
struct InvertedMatrix {
  MatrixEntries matrix;
  std::vector<std::vector<Expression>> inverse;
};

// One pass through the body of an iteration, at unknowns that are free.
struct IterationTrace {
  Rule rule = Rule::newton;
  std::vector<Expression> unknowns = {};     // free symbols
  std::vector<Expression> starts = {};       // where nothing is known from earlier steps
  std::vector<Expression> corrections = {};  // of Newton what is added, else the next values
  // Newton's corrections as what follows knows them: free symbols where they have names.
  std::vector<Expression> increments = {};
  // Of a fixed point: what its refinement looks at, and the free symbols of what that lacks.
  std::vector<Expression> gradient = {};
  std::vector<Expression> changes = {};
  // The same of arrays: where it looks, and what the unknowns lack there.
  std::vector<Expression> refined_at = {};
  std::vector<Expression> refined_lack = {};
  std::vector<Expression> moved_lack = {};  // by another routine, as it would say of that point
  std::set<std::string> inside = {};        // definitions that depend on the unknowns
};
struct SweepTrace {
  int count = 0;
  std::vector<Expression> unknowns = {}, starts = {}, next = {}, results = {};
};
// A routine that was not looked into.
struct CallTrace {
  std::string routine;
  std::vector<Expression> input;   // of arrays and states, in the order of their elements
  std::vector<Expression> output;  // free symbols
};

class SymbolicMachine {
 public:
  // Routines of the names in `opaque` are not run: what they change becomes free symbols.
  explicit SymbolicMachine(const Program& code, std::set<std::string> opaque = {});

  // Calls of this routine are left out: of claims that do not look at what it changes.
  void skip(const std::string& routine) { skipped_.insert(routine); }

  // A field or an element of an argument, from outside.
  void set(const Place& place, const Expression& value);
  void set_flag(const Place& place, bool value);
  // What the free symbol of a place is to be called.
  void name(const Place& place, const std::string& symbol);
  // What stands there: a free symbol of the place's name if nothing has been assigned to it.
  [[nodiscard]] Expression value(const Place& place);
  // Entries of a matrix that is an argument.
  [[nodiscard]] MatrixEntries& matrix(const std::string& name) { return matrices_[name]; }
  // A name of the model: what a routine computes gets another.
  void reserve(const std::string& name) { ++names_[name]; }
  // Of a local of the routine that was run last, the last one of this name.
  [[nodiscard]] std::optional<Expression> local(const std::string& symbol) const;

  // With arguments that are objects of their own names.  A Result that is a record is an object of
  // its name, too.  The number that it returns, if it does.
  std::optional<Expression> run(const std::string& routine);

  [[nodiscard]] const std::vector<Statement>& definitions() const { return definitions_.all(); }

  std::vector<IterationTrace> iterations;
  std::vector<SweepTrace> sweeps;
  std::vector<EliminatedSystem> systems;
  std::vector<InvertedMatrix> inverses;
  std::vector<CallTrace> calls;

 private:
  // An object or a part of an array of one, as a routine that was given it sees it.
  struct Reference {
    std::string root;
    std::string record = {};
    std::string field = {};
    long offset = 0;
    bool is_element = false;
    std::vector<int> sizes = {};
  };
  struct Frame {
    const Routine* routine = nullptr;
    std::string prefix;
    std::map<std::string, Reference> objects = {};
    std::map<std::string, Expression> locals = {};
    // What has been added to locals and not been read yet.
    std::map<std::string, std::vector<Expression>> added = {};
    std::map<std::string, long> indices = {};
    std::optional<Expression> result = {};
    bool ended = false;
  };
  struct Run;  // an instruction in a frame

  Frame frame_of(const std::string& routine, const std::string& prefix);
  void run(Frame& frame, const Body& body);
  Expression define(const std::string& name, const Expression& value);
  Expression without_rounding(const std::string& name, const Expression& error);
  Expression free_symbol(const std::string& name);
  // What follows knows a value that was defined since `first` as a free symbol.
  Expression set_free(Frame& frame, const Expression& value, std::size_t first);
  std::string unique(const std::string& name);

  [[nodiscard]] static long at(const Frame& frame, const AffineIndex& index);
  [[nodiscard]] Reference reference(Frame& frame, const Place& place) const;
  [[nodiscard]] static std::string cell(const Reference& reference);
  [[nodiscard]] Expression read(const std::string& cell);
  void write(const std::string& cell, const Expression& value);
  void forget(const std::string& root);
  [[nodiscard]] Expression number(Frame& frame, const std::string& symbol);
  [[nodiscard]] Expression number_at(Frame& frame, const Place& place);
  // What the routine calls the place.
  [[nodiscard]] static std::optional<std::string> symbol_of(const Frame& frame, const Place& place);
  [[nodiscard]] std::string cell_of(Frame& frame, const std::string& symbol);
  [[nodiscard]] std::string outer_cell(const Place& place) const;
  [[nodiscard]] Expression evaluate(Frame& frame, const Expression& e);
  // As a definition of its own, or, of a sum that grows, as it is.
  void assign(Frame& frame, const std::string& symbol, const Expression& value,
              bool by_name = true);
  // The cells of an array or of the fields of a record.
  [[nodiscard]] std::vector<std::string> cells_of(const Reference& reference) const;

  const Program& code_;
  std::set<std::string> opaque_;
  std::set<std::string> skipped_;
  std::map<std::string, Expression> cells_;
  std::set<std::string> zeroed_;  // objects and fields that begin with zeros
  std::map<std::string, bool> flags_;
  std::map<std::string, MatrixEntries> matrices_;
  std::set<std::string> symmetric_;  // of them
  DefinedValues definitions_;
  std::map<Expression, Expression> lost_;  // by their exact values, what rounding takes from them
  std::map<std::string, int> names_;
  std::map<std::string, std::string> hints_;
  std::map<std::pair<std::string, Expression>, Expression> known_;
  std::map<std::string, Expression> last_locals_;
  int frames_ = 0;
};

}  // namespace hamgen
