// A routine made ready to run: its symbols are addresses, its instructions functions.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/interpreter/compiled_expression.hpp"
#include "generator/interpreter/object.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

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

// What the steps of a machine work on.
template <class Real>
struct MachineState {
  struct Shape {  // of an object
    const Record* record = nullptr;
    std::vector<int> sizes = {};
  };
  std::map<std::string, int> object_index;  // 0: the locals
  std::vector<Shape> shapes;
  std::vector<Object<Real>*> objects;  // of this run
  std::vector<std::unique_ptr<Object<Real>>> own;
  std::map<std::string, AnyMatrix<Real>*> matrices;                      // locals and arguments
  std::map<std::string, std::unique_ptr<AnyMatrix<Real>>> own_matrices;  // by name and form
  std::map<std::string, int> local_index;
  std::map<std::string, int> loop_index;
  std::vector<Real> locals;
  Frame<Real> frame;
  MachineReport<Real> report;
  long long iteration = 0;  // of the iteration that is going on
  AnyNewtonRule<Real>* newton = nullptr;
  std::vector<std::string> arguments;
  struct Kept {  // an object that is a field of the run's memory
    std::size_t index = 0;
    std::string field;
    bool of_substep = false;
  };
  std::vector<Kept> kept;
  RunMemory<Real>* memory = nullptr;
};

template <class Real>
class Machine {
 public:
  // The routines it calls stay with `others`, which outlives it.
  using Others = std::map<std::string, std::unique_ptr<Machine>>;
  Machine(const Routine& routine, const Program& code, const Others& others);
  Machine(const Machine&) = delete;  // its functions point into it
  Machine& operator=(const Machine&) = delete;
  ~Machine();

  // For a routine that is given what a run keeps.
  void remember(RunMemory<Real>& memory) { state_.memory = &memory; }
  // In the order of its arguments.
  MachineReport<Real> run(const std::vector<Given<Real>>& arguments);
  // The record that the last run filled in, of a routine that returns one.
  [[nodiscard]] const Object<Real>& result() const;

 private:
  MachineState<Real> state_;
  std::shared_ptr<const void> compiler_;      // what the steps point into
  std::vector<std::function<bool()>> steps_;  // false: the routine has ended
};

}  // namespace hamgen
