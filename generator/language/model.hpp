// A Hamiltonian system as its author stated it: names checked, indexed sums still sums.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/base/source_text.hpp"
#include "generator/language/ast.hpp"

namespace hamgen {

struct IndexRange {
  long first = 1;
  long last = 1;
  [[nodiscard]] long size() const { return last - first + 1; }
  bool operator==(const IndexRange&) const = default;
};

// A coordinate or a momentum, scalar or array.
struct Variable {
  std::string name;
  std::optional<IndexRange> range;  // empty for a scalar
  std::string unit;                 // as written between brackets, may be empty
  std::string comment;              // trailing comment of the declaration
  bool periodic = false;            // q[last + k] is q[first + k - 1], and so on round
  std::map<long, NodePtr> beyond;   // values outside the range: "with q[0] = 0, q[N+1] = 0"
  bool is_time = false;             // the coordinate of `time t`, or its momentum p_t
  Span span;
};

struct Parameter {
  std::string name;
  std::optional<IndexRange> range;
  std::vector<NodePtr> values;  // one per element: constant expressions in earlier parameters
  std::string unit;
  std::string comment;
  bool folded = false;  // burnt into the code with its default value
  Span span;
};

struct Size {
  std::string name;
  long value = 0;   // in ranges and subscripts
  long number = 0;  // elsewhere: the same, unless a proof looks at fewer elements of a system
  std::string comment;
  Span span;
};

struct Definition {  // let NAME = ...
  std::string name;
  NodePtr value;
  std::string text;
  Span span;
};

struct Invariant {
  std::string name;
  NodePtr value;
  std::string text;
  std::string comment;
  Span span;
  bool only_observed = false;  // nobody says that it is conserved
  // Of an event, which the emitted code has the value of: the directions that count.
  bool rising = false, falling = false;

  [[nodiscard]] bool is_event() const { return rising || falling; }
};

// What is looked for along an orbit: where the value crosses zero.
struct ModelEvent {
  std::string name;
  NodePtr value;
  std::string text;                    // as written, with its direction
  std::string formula = {};            // without it
  bool rising = true, falling = true;  // the directions that count
  std::string comment = {};
  Span span = {};
};

// One line of a scene: "q = 3.1", "q[i] = sin(pi*i/(N+1))", "q[2] = 1", "q = [1, 0, 0]", "eps = 1".
struct Setting {
  std::string name;
  std::string index;            // name of a free index, empty if there is none
  NodePtr element;              // fixed subscript, null if there is none
  std::vector<NodePtr> values;  // one, or one per element for a list
  bool is_list = false;
  Span span;
};

// What a scene looks at: "energy", an invariant, "q", "q[2]", or "radius = sqrt(x^2 + y^2)".
struct Observed {
  std::string name;
  NodePtr element;        // fixed subscript, null if there is none
  NodePtr value = {};     // of a new name, null for one of the model's
  std::string text = {};  // that value as written
  Span span = {};         // of the name
};

struct Scene {
  std::string name;
  std::string comment;
  std::vector<Setting> settings;  // of coordinates, momenta and parameters, in order
  NodePtr h;                      // null if not given
  NodePtr steps;                  // null if not given
  NodePtr every;                  // null if not given: record every k-th step
  std::vector<Observed> observe;  // empty means all there is
  Span span;
  // Why it cannot be run, of a scene written for other sizes than the ones asked for.
  std::vector<Diagnostic> mistakes = {};
};

struct Model {
  SourceText source;
  std::string name;
  std::vector<Size> sizes;
  std::vector<Variable> coordinates;  // the i-th coordinate belongs to the i-th momentum
  std::vector<Variable> momenta;
  std::vector<Parameter> parameters;
  std::vector<Definition> definitions;
  NodePtr hamiltonian;  // without the p_t that `time t` adds
  std::string hamiltonian_text;
  std::vector<Invariant> invariants;
  std::vector<ModelEvent> events;
  std::vector<Scene> scenes;
  std::vector<Diagnostic> warnings;
};

// Number of degrees of freedom: elements of all coordinates.
[[nodiscard]] long degrees_of_freedom(const Model& model);
// "q", "q[3]": the names of all elements of coordinates (or momenta, parameters), in state order.
[[nodiscard]] std::vector<std::string> element_names(const std::vector<Variable>& variables);
[[nodiscard]] std::vector<std::string> element_names(const std::vector<Parameter>& parameters);
// "kepler has no event", and how to declare one.
[[nodiscard]] std::string no_event_text(const Model& model);
// An expression in the language's own notation, with the fewest parentheses.
[[nodiscard]] std::string to_text(const NodePtr& node);
[[nodiscard]] std::string to_text(const Model& model);

}  // namespace hamgen
