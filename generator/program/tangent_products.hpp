// What the tangent maps of all methods are made of: products of the Hessian with the columns of a
// matrix.
#pragma once

#include <functional>

#include "generator/program/environment.hpp"
#include "generator/program/kernel_routines.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

// Where a state is: a record State, or 2n numbers from this place on.
struct TangentPoint {
  Place place;
  bool is_record = true;
};

class TangentBuilder : public RoutineBuilder {
 public:
  // tangent(par, h, z, dz, m), to be given its body: m = dZ/dz of the step that moves z by dz.
  TangentBuilder(const Environment& environment, const LoweredStep& lowered, std::string name,
                 std::vector<std::string> remark);

  [[nodiscard]] int n() const { return n_; }
  [[nodiscard]] bool arrays() const { return arrays_; }
  [[nodiscard]] const Environment& environment() const { return environment_; }

  // for row = 0..2n-1, for column = 0..2n-1
  [[nodiscard]] Instruction for_entries(Body each) const;
  // matrix[row + first][column]
  Expression entry(const std::string& matrix, long first = 0);
  // Rows "row" of another range: coordinates only, say.
  [[nodiscard]] Instruction for_rows(int count, Body each) const;
  [[nodiscard]] Instruction set_unit(const std::string& matrix);

  // out = H''(point) in; both 2n x 2n, and different.
  void multiply_hessian(Body& body, const TangentPoint& point, const std::string& in,
                        const std::string& out);
  // values = grad H at the point, q first.
  void add_gradient(Body& body, const TangentPoint& point, const std::string& values) const;
  // y = H''(q, p) u, of a system in loops.
  [[nodiscard]] Instruction curvature(const Place& q, const Place& p, const Place& u) const;
  // state += increment
  void add_increment(Body& body, const std::string& state, const std::string& increment);
  // Each component of a record State, or one loop over the elements of its arrays: `each` is given
  // the component of any such record, as an expression, and its number from 0 to 2n - 1, of which
  // an array is one in a loop over "row".
  using Component = std::function<Expression(const std::string& record)>;
  void for_components(Body& body,
                      const std::function<void(Body&, const Component&, const AffineIndex&)>& each);
  // Success if m is finite.
  void finish();

 private:
  // Where the coordinates and the momenta of a system in loops begin.
  [[nodiscard]] std::pair<Place, Place> halves(const TangentPoint& point) const;

  const Environment& environment_;
  int n_;
  bool arrays_;
  bool raised_;  // K stands in for H
};

[[nodiscard]] Instruction tangent_call(std::string routine, std::vector<Place> arguments);
// k = prepare(par, h)
[[nodiscard]] Instruction prepared(Place h);
// A step of length h (a number of this name) from the state, which must succeed: moved, rest and
// start are locals of it.
void add_step(Body& body, const Program& code, const std::string& h, const std::string& state);

// Of a system in loops: curvature(par, q, p, u, y), y = H'' u; where K stands in for H, of that,
// with h behind par.  Of the potential alone potential_curvature(par, q, u, y), y = V'' u.
[[nodiscard]] std::string curvature_name(Part part);
[[nodiscard]] Routine curvature_routine(const Environment& environment,
                                        const StepEquations& equations, Part part = Part::all);

}  // namespace hamgen
