#include "generator/formats/cpp_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/formats/cpp_matrices.hpp"
#include "generator/formats/numerics.hpp"
#include "generator/program/arithmetic.hpp"

namespace hamgen {

namespace {

std::string sizes_text(const Field& field) {
  std::string text;
  for (const int size : field.sizes) text += fmt::format("[{}]", size);
  return text;
}

std::string initial_value(const Field& field, const ScalarType& scalar) {
  std::string values;
  for (const Rational& value : field.values) {
    const std::string text = field.type == "int"    ? value.get_str()
                             : field.type != "bool" ? literal(value, scalar)
                             : value == 0           ? "false"
                                                    : "true";
    values += (values.empty() ? "" : ", ") + text;
  }
  if (!field.sizes.empty()) return " = {" + values + "}";
  if (!values.empty()) return " = " + values;
  return field.type == "Real" ? " = " + literal(0, scalar) : "";
}

// Is there an instruction of this kind anywhere in the body?
bool any(const Body& body, const std::function<bool(const Instruction&)>& is) {
  return std::ranges::any_of(body, [&](const Instruction& instruction) {
    return is(instruction) ||
           std::ranges::any_of(inner_bodies(instruction),
                               [&](const Body* inner) { return any(*inner, is); });
  });
}

template <class Kind>
bool has(const Routine* routine) {
  return routine != nullptr && any(routine->body, [](const Instruction& i) {
           return std::holds_alternative<Kind>(i.value);
         });
}

bool iterates(const Routine* routine, Rule rule) {
  return routine != nullptr && any(routine->body, [rule](const Instruction& i) {
           const auto* iterate = std::get_if<Iterate>(&i.value);
           return iterate != nullptr && iterate->rule == rule;
         });
}

bool has_matrix(const Routine* routine, bool large) {
  return routine != nullptr && any(routine->body, [large](const Instruction& i) {
           const auto* matrix = std::get_if<Matrix>(&i.value);
           return matrix != nullptr && !matrix->patterned && matrix->large == large;
         });
}

// Has Start a field of this block?
bool remembers(const CppContext& context, std::string_view block) {
  const Record* start = context.code.record("Start");
  return start != nullptr && std::ranges::any_of(start->fields, [block](const Field& field) {
           return field.type.starts_with(block);
         });
}

// What is written of the step itself.
std::vector<const Routine*> written(const CppContext& context) {
  std::vector<const Routine*> routines;
  for (const Routine& routine : context.code.routines) {
    if (context.needs(routine.name)) routines.push_back(&routine);
  }
  return routines;
}

template <class Is>
bool any_written(const CppContext& context, const Is& is) {
  return std::ranges::any_of(written(context), is);
}

}  // namespace

void write_record(CodeWriter& out, const Record& record, const ScalarType& scalar) {
  for (const std::string& line : record.remark) out.remark("// ", line);
  if (record.fields.empty()) {
    out.line("struct " + record.name + " {};");
    return;
  }
  out.open("struct " + record.name);
  std::vector<std::pair<std::string, std::string>> members;
  for (const Field& field : record.fields) {
    members.emplace_back(fmt::format("{} {}{}{};", field.type, field.name, sizes_text(field),
                                     initial_value(field, scalar)),
                         field.remark);
  }
  out.aligned(members);
  out.close(";");
}

bool takes_product_errors(const Routine* routine) {
  return routine != nullptr && any(routine->body, [](const Instruction& i) {
           const auto* let = std::get_if<Let>(&i.value);
           const auto* assign = std::get_if<Assign>(&i.value);
           const Expression* value = let != nullptr      ? &let->value
                                     : assign != nullptr ? &assign->value
                                                         : nullptr;
           return value != nullptr && value->kind() == Kind::function &&
                  value->name() == kProductError;
         });
}

bool needs_vocabulary(const CppContext& context) {
  return any_written(context, [](const Routine* routine) {
    return has<Matrix>(routine) || has<Iterate>(routine) || has<IterateArray>(routine) ||
           takes_product_errors(routine);
  });
}

bool needs_eigen(const CppContext& context) {
  return !context.quad() &&
         any_written(context, [](const Routine* routine) { return has_matrix(routine, true); });
}

void write_solver(CodeWriter& out, CppContext& context) {
  const Routine* prepare = context.code.routine("prepare");
  const Routine* solve = context.code.routine("solve");
  const bool large =
      any_written(context, [](const Routine* routine) { return has_matrix(routine, true); });
  const bool small =
      any_written(context, [](const Routine* routine) { return has_matrix(routine, false); });
  // Eigen does not know quad numbers.
  const bool dense = small || (large && context.quad());
  if (context.code.matrix) {
    write_matrix(out, *context.code.matrix);
    if (dense && context.code.matrix->kind != MatrixKind::dense)
      out.lines(cpp_numerics("dense_matrix"));
  } else if (dense) {
    out.lines(cpp_numerics("dense_matrix"));
  }
  if (needs_eigen(context)) out.lines(cpp_numerics("eigen_dense_matrix"));
  if (has<Invert>(prepare)) out.lines(cpp_numerics("inverse"));
  if (any_written(context, takes_product_errors)) out.lines(cpp_numerics("product_error"));
  if (prepare != nullptr) {
    write_record(out, *context.code.record("Coefficients"), context.scalar);
    out.line();
    context.write_with_callees(out, "prepare");
  }
  for (const char* part : {"potential_gradient", "kinetic_gradient"}) {
    if (!context.arrays()) context.write_routine(out, part);
  }
  out.lines(cpp_numerics("two_sum"));
  if (context.code.has_rest()) out.lines(cpp_numerics("sum_with_rest"));
  if (has<Collect>(solve)) out.lines(cpp_numerics("collected_sum"));
  const bool newton = iterates(solve, Rule::newton) || remembers(context, "NewtonRule");
  const bool simplified = remembers(context, "SimplifiedNewtonRule");
  const bool impatient = remembers(context, "ImpatientRule");
  const bool fixed_point = iterates(solve, Rule::fixed_point) || simplified || impatient ||
                           remembers(context, "FixedPointRule");
  if (newton || fixed_point) out.lines(cpp_numerics("verdict"));
  if (newton) out.lines(cpp_numerics("newton_rule"));
  if (fixed_point) out.lines(cpp_numerics("fixed_point_rule"));
  if (impatient) out.lines(cpp_numerics("impatient_rule"));
  if (simplified) out.lines(cpp_numerics("simplified_newton_rule"));
  if (has<Refine>(solve) || remembers(context, "Refinement")) out.lines(cpp_numerics("refinement"));
  if (const Record* start = context.code.record("Start")) {
    write_record(out, *start, context.scalar);
    out.line();
  }
  context.write_with_callees(out, "solve");
}

}  // namespace hamgen
