#include "generator/formats/cpp_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/formats/cpp_arithmetic.hpp"
#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_functions.hpp"
#include "generator/formats/cpp_interface.hpp"
#include "generator/formats/cpp_preamble.hpp"
#include "generator/formats/cpp_step.hpp"
#include "generator/formats/cpp_tangent.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

void write_includes(CodeWriter& out, const CppContext& context) {
  if (context.quad()) {
    // Declared here rather than by <quadmath.h>, which clang does not find.
    std::set<std::string> declared;
    for (const std::string& function : context.used.functions) {
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
  } else if (!context.used.functions.empty() && !context.options.builtins) {
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
  } else if (needs_eigen(context)) {
    out.line();
    out.line("#include <Eigen/LU>");
  }
}

void open_namespace(CodeWriter& out, const CppContext& context) {
  out.line(fmt::format("namespace {} {{", context.options.name_space));
  out.line();
  out.line(context.quad() ? "__extension__ typedef __float128 Real;"
                          : fmt::format("using Real = {};", context.scalar.cpp));
  if (context.used.pi) {
    // 50 digits, rounded by the compiler where the type is standard.
    const Rational pi = *parse_decimal("3.14159265358979323846264338327950288419716939937510");
    out.line(fmt::format("inline constexpr Real pi = {};", literal(pi, context.scalar)));
  }
  if (context.arrays()) {
    out.line(fmt::format("inline constexpr int n = {};  // degrees of freedom", context.n()));
  }
  out.line();
}

void write_scheme(CodeWriter& out, CppContext& context) {
  write_types(out, context, needs_vocabulary(context));
  write_functions(out, context);
  write_solver(out, context);
  write_steps(out, context);
  if (context.options.tangent) context.write_with_callees(out, "tangent");
}

// Everything inside the namespace and the namespace itself.
std::string namespace_text(CppContext& context) {
  CodeWriter inner;
  write_scheme(inner, context);
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
  begin_ieee_arithmetic(out, context.scalar);
  out.line();
  out.lines(body);
  out.line();
  end_ieee_arithmetic(out);
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
  begin_ieee_arithmetic(out, context.scalar);
  out.line();
  out.lines(body);
  out.line();
  end_ieee_arithmetic(out);
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
