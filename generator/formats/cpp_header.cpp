#include "generator/formats/cpp_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_interface.hpp"
#include "generator/formats/cpp_member.hpp"
#include "generator/formats/cpp_preamble.hpp"
#include "generator/formats/cpp_refinement.hpp"
#include "generator/formats/cpp_schemes.hpp"
#include "generator/formats/cpp_support.hpp"
#include "generator/formats/cpp_tangent.hpp"

namespace hamgen {

namespace {

void write_includes(CodeWriter& out, const CppContext& context) {
  if (context.quad()) {
    // Declared here rather than by <quadmath.h>, which clang does not find.
    std::set<std::string> declared;
    for (const std::string& function : context.functions) {
      const Function* row = find_function(function);
      const bool two = function == "pow" || (row != nullptr && row->arity == 2);
      const std::string name = row != nullptr ? std::string(row->quad) : function + "q";
      if (function == "fabs" || !declared.insert(name).second) continue;
      if (declared.size() == 1) {
        out.line();
        out.line("extern \"C\" {");
      }
      out.line(fmt::format("__extension__ __float128 {}(__float128{}) noexcept;", name,
                           two ? ", __float128" : ""));
    }
    if (!declared.empty()) out.line("}");
  } else if (!context.functions.empty() && !context.options.builtins) {
    out.line("#include <cmath>");
  }
  if (context.arrays()) {
    const ArrayPlan& plan = *context.program.plan.arrays;
    if (!uses_eigen(plan)) return;
    if (plan.matrix->kind == MatrixKind::eigen_sparse) {
      out.line("#include <algorithm>");
      out.line("#include <vector>");
      out.line();
      out.line("#include <Eigen/SparseLU>");
    } else {
      out.line();
      out.line("#include <Eigen/LU>");
    }
  } else if (member_parts(context.program, context.scalar).eigen) {
    out.line();
    out.line("#include <Eigen/LU>");
  }
}

void open_namespace(CodeWriter& out, const CppContext& context) {
  out.line(fmt::format("namespace {} {{", context.options.name_space));
  out.line();
  out.line(context.quad() ? "__extension__ typedef __float128 Real;"
                          : fmt::format("using Real = {};", context.scalar.cpp));
  if (context.uses_pi) {
    // 50 digits, rounded by the compiler where the type is standard.
    const Rational pi = *parse_decimal("3.14159265358979323846264338327950288419716939937510");
    out.line(fmt::format("inline constexpr Real pi = {};", literal(pi, context.scalar)));
  }
  if (context.arrays()) {
    out.line(fmt::format("inline constexpr int n = {};  // degrees of freedom", context.n()));
  }
  out.line();
}

// The member of the plan, or the one that is composed.
void write_member(CodeWriter& out, CppContext& context, StepRole role) {
  const MemberParts parts = member_parts(context.program, context.scalar);
  write_types(out, context, parts.newton || parts.fixed_point || parts.elimination);
  write_functions(out, context);
  CoefficientText coefficients;
  if (parts.coefficients) coefficients = write_prepare(out, context, parts);
  write_support(out, context, parts);
  write_solve(out, context, parts, coefficients);
  if (role == StepRole::propagator) write_member_step(out, context, parts);
  write_member_propagator(out, context, parts, role);
  if (context.options.tangent) write_member_tangent(out, context, parts, role);
}

// The same for a system whose sums stay loops.
void write_array_member(CodeWriter& out, CppContext& context, StepRole role) {
  const ArrayPlan& plan = *context.program.plan.arrays;
  write_types(out, context, iterates(plan));
  const bool refined = plan.method == ArrayMethod::fixed_point;
  out.lines((refined ? cpp_two_sum() + "\n" + cpp_sum_with_rest() : cpp_compensated_sum()) + "\n");
  if (refined) out.lines(cpp_refinement(context.scalar) + "\n");
  if (iterates(plan)) {
    out.lines((plan.method == ArrayMethod::newton ? cpp_newton_rule(context.scalar)
                                                  : cpp_fixed_point_rule(context.scalar)) +
              "\n");
    out.lines(cpp_history(plan.reduced ? context.n() : 2 * context.n()) + "\n");
  }
  write_array_functions(out, context);
  write_array_propagator(out, context, role);
}

void write_scheme(CodeWriter& out, CppContext& context) {
  const Method& method = context.equations.scheme.method;
  if (std::holds_alternative<Splitting>(method)) {
    write_splitting(out, context);
    if (context.options.tangent && context.arrays()) {
      write_array_splitting_tangent(out, context);
    } else if (context.options.tangent) {
      write_splitting_tangent(out, context);
    }
  } else if (const auto* tableau = std::get_if<RungeKutta>(&method)) {
    write_runge_kutta(out, context, *tableau);
  } else {
    const bool composed = std::holds_alternative<Composition>(method);
    const StepRole role = composed ? StepRole::substep : StepRole::propagator;
    if (context.arrays()) {
      write_array_member(out, context, role);
    } else {
      write_member(out, context, role);
    }
    if (composed) write_composition(out, context);
    if (composed && context.options.tangent) write_composition_tangent(out, context);
  }
}

// Everything inside the namespace and the namespace itself.
std::string namespace_text(CppContext& context) {
  CodeWriter inner;
  write_scheme(inner, context);
  if (context.arrays()) write_invariants(inner, context);
  CodeWriter out;
  open_namespace(out, context);  // what it defines depends on what was used
  out.lines(inner.text());
  out.line(fmt::format("}}  // namespace {}", context.options.name_space));
  return out.text();
}

}  // namespace

std::string cpp_header(const Program& program, const CppOptions& options) {
  CppOptions with_derivatives = options;
  with_derivatives.gradient = options.gradient || (options.tangent && program.plan.sweeps);
  CppContext context(program, with_derivatives);
  const std::string body = namespace_text(context);
  CodeWriter out;
  write_preamble(out, context);
  out.line("#pragma once");
  write_includes(out, context);
  out.line();
  out.lines(body);
  return out.text();
}

std::string cpp_plugin(const Program& program, const CppOptions& options) {
  CppOptions with_gradient = options;
  with_gradient.gradient = true;
  with_gradient.builtins = true;
  CppContext context(program, with_gradient);
  const std::string body = namespace_text(context);
  CodeWriter out;
  write_preamble(out, context);
  out.line("#include \"plugin.h\"");
  write_includes(out, context);
  out.line();
  out.lines(body);
  write_interface(out, context);
  return out.text();
}

bool needs_eigen(const Program& program) {
  if (program.plan.arrays) return uses_eigen(*program.plan.arrays);
  return std::ranges::any_of(program.stages, [](const Stage& stage) {
    return stage.solve && stage.solve->linear_solver == LinearSolver::eigen_dense;
  });
}

}  // namespace hamgen
