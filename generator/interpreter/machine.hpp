// A routine made ready to run: its symbols are addresses, its instructions functions.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/interpreter/compiled_expression.hpp"
#include "generator/interpreter/numerics.hpp"
#include "generator/program/step_code.hpp"

namespace hamgen {

// A record at run time: its numbers, field after field, and what else is in it.
template <class Real>
struct Object {
  std::vector<Real> numbers;
  std::map<std::string, int> flags;
  std::map<std::string, std::unique_ptr<AnyNewtonRule<Real>>> rules;
  std::map<std::string, std::unique_ptr<AnyFixedPointRule<Real>>> contractions;
  std::map<std::string, std::unique_ptr<AnySimplifiedNewtonRule<Real>>> simplified;
  std::map<std::string, std::unique_ptr<AnyRefinement<Real>>> refinements;
  std::map<std::string, std::unique_ptr<AnyMatrix<Real>>> matrices;
};
// With the values its fields begin with.  A field "Matrix" has the size of the code's.
template <class Real>
[[nodiscard]] Object<Real> make_object(const Record& record, const StepCode& code);
// The fields that are numbers, a Refinement's slope and change among them.
[[nodiscard]] std::vector<Field> numeric_fields(const Record& record);
// Where the numbers of a field begin.
[[nodiscard]] long offset_of(const Record& record, const std::string& field);

// What an argument is given: an object, or numbers alone.
template <class Real>
struct Given {
  Real* numbers = nullptr;
  Object<Real>* object = nullptr;
  AnyMatrix<Real>* matrix = nullptr;
};

template <class Real>
struct MachineReport {
  bool converged = false;
  long long iterations = 0;
  Real increment = 0;
  Real value = 0;  // of a routine that returns a number
};

template <class Real>
class Machine {
 public:
  // The routines it calls stay with `others`, which outlives it.
  using Others = std::map<std::string, std::unique_ptr<Machine>>;
  Machine(const Routine& routine, const StepCode& code, const Others& others);
  Machine(const Machine&) = delete;  // its functions point into it
  Machine& operator=(const Machine&) = delete;
  ~Machine();

  // In the order of its arguments.
  MachineReport<Real> run(const std::vector<Given<Real>>& arguments);
  // The record that the last run filled in, of a routine that returns one.
  [[nodiscard]] const Object<Real>& result() const;

 private:
  using Step = std::function<bool()>;  // false: the routine has ended
  using Steps = std::vector<Step>;
  struct Shape {  // of an object
    const Record* record = nullptr;
    std::vector<int> sizes = {};
  };
  class Compiler;

  static bool run_all(const Steps& steps) {
    for (const Step& step : steps) {
      if (!step()) return false;
    }
    return true;
  }

  std::map<std::string, int> object_index_;  // 0: the locals
  std::vector<Shape> shapes_;
  std::vector<Object<Real>*> objects_;  // of this run
  std::vector<std::unique_ptr<Object<Real>>> own_;
  std::map<std::string, AnyMatrix<Real>*> matrices_;  // locals and arguments
  std::map<std::string, std::unique_ptr<AnyMatrix<Real>>> own_matrices_;
  std::map<std::string, int> local_index_;
  std::map<std::string, int> loop_index_;
  std::vector<Real> locals_;
  Frame<Real> frame_;
  MachineReport<Real> report_;
  long long iteration_ = 0;  // of the iteration that is going on
  std::vector<std::string> arguments_;
  std::unique_ptr<Compiler> compiler_;  // what the steps point into
  Steps steps_;
};

}  // namespace hamgen
