// Runge-Kutta methods: the state as one array, f = J grad H of it.
#include <fmt/format.h>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_schemes.hpp"
#include "generator/formats/cpp_stages.hpp"
#include "generator/formats/cpp_step.hpp"
#include "generator/formats/cpp_tangent.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

void write_flat_state(CodeWriter& out, const CppContext& context, bool with_rest) {
  out.line("// The state as one array.");
  out.open("inline void read(const State& z, Real (&x)[dimension])");
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    out.line("x[i] = z.q[i];");
    out.line("x[n + i] = z.p[i];");
    out.close();
  } else {
    for (int i = 0; i < 2 * context.n(); ++i) {
      out.line(fmt::format("x[{}] = z.{};", i, context.state_field(i)));
    }
  }
  out.close();
  out.line();
  out.line(with_rest ? "// z += dz + rest, where the rest has the carry in it."
                     : "// z += dz, with what rounding loses kept in carry.");
  out.open(std::string("inline void add(State& z, State& carry, const Real (&dz)[dimension]") +
           (with_rest ? ", const Real (&rest)[dimension])" : ")"));
  const auto added = [&](const std::string& field, const std::string& index) {
    return with_rest ? fmt::format("add(z.{0}, carry.{0}, dz[{1}], rest[{1}]);", field, index)
                     : fmt::format("two_sum(z.{0}, carry.{0}, carry.{0} + dz[{1}]);", field, index);
  };
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    out.line(added("q[i]", "i"));
    out.line(added("p[i]", "n + i"));
    out.close();
  } else {
    for (int i = 0; i < 2 * context.n(); ++i) {
      out.line(added(context.state_field(i), std::to_string(i)));
    }
  }
  out.close();
  out.line();
}

void write_runge_kutta(CodeWriter& out, CppContext& context, const RungeKutta& tableau) {
  const bool implicit = context.program.plan.stage_solver.has_value();
  write_types(out, context, implicit);
  if (context.arrays()) {
    write_array_functions(out, context);
  } else {
    write_functions(out, context);
  }
  out.line(fmt::format("inline constexpr int dimension = {};", 2 * context.n()));
  out.line();
  context.write_routine(out, "vector_field");
  if (implicit) {
    out.lines(cpp_numerics("two_sum") + cpp_numerics("sum_with_rest"));
    write_flat_state(out, context, true);
    write_stages(out, context, tableau);
    write_single_step(out);
  } else {
    write_solver(out, context);
    write_steps(out, context);
  }
  if (!context.options.tangent) return;
  if (implicit) {
    write_stages_tangent(out);
  } else {
    write_flat_state(out, context, false);
    write_stage_hessian(out, context);
    write_explicit_tangent(out, context);
  }
}

}  // namespace hamgen
