#include "generator/readback/machine_value.hpp"

#include <utility>

#include "generator/base/diagnostic.hpp"
#include "generator/program/arithmetic.hpp"

namespace hamgen {

namespace {

using MachineKind = MachineValue::Kind;

// What the mathematical library calls the functions of the language.
std::string library_name(const std::string& function) {
  return function == "abs" ? "fabs" : function;
}

MachineValue without_sign(MachineValue a) {
  a.negative = false;
  return a;
}

MachineValue scaled(MachineKind kind, MachineValue a, MachineValue b) {
  MachineValue result{.kind = kind, .negative = a.negative != b.negative};
  result.parts.reserve(2);
  result.parts.push_back(without_sign(std::move(a)));
  result.parts.push_back(without_sign(std::move(b)));
  return result;
}

MachineValue machine_value(const Arithmetic& a,
                           const std::function<std::string(const std::string&)>& name) {
  const auto operand = [&](std::size_t i) { return machine_value(a.operands[i], name); };
  switch (a.operation) {
    case Operation::number:
      return {.kind = MachineKind::number, .number = a.number};
    case Operation::symbol:
      return machine_symbol(name(a.name));
    case Operation::negate:
      return -operand(0);
    case Operation::add:
      return operand(0) + operand(1);
    case Operation::subtract:
      return operand(0) + -operand(1);
    case Operation::multiply:
      return operand(0) * operand(1);
    case Operation::divide:
      return operand(0) / operand(1);
    case Operation::call: {
      std::vector<MachineValue> arguments;
      for (std::size_t i = 0; i < a.operands.size(); ++i) arguments.push_back(operand(i));
      return machine_call(library_name(a.name), std::move(arguments));
    }
  }
  internal_error("unknown operation");
}

bool same_parts(const MachineValue& a, const MachineValue& b, bool crossed,
                const Precision& precision) {
  if (a.parts.size() != b.parts.size()) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const std::size_t j = crossed ? a.parts.size() - 1 - i : i;
    if (!is_same(a.parts[i], b.parts[j], precision)) return false;
  }
  return true;
}

// Symbols by their names alone.
Expression meaning(const Arithmetic& a) {
  std::vector<Expression> operands;
  for (const Arithmetic& operand : a.operands) operands.push_back(meaning(operand));
  switch (a.operation) {
    case Operation::number:
      return a.number;
    case Operation::symbol:
      return Expression::symbol(a.name);
    case Operation::negate:
      return -operands[0];
    case Operation::add:
      return operands[0] + operands[1];
    case Operation::subtract:
      return operands[0] - operands[1];
    case Operation::multiply:
      return operands[0] * operands[1];
    case Operation::divide:
      return operands[0] / operands[1];
    case Operation::call:
      if (a.name == "pow") return Expression::power(operands[0], operands[1]);
      if (a.name == "sqrt") return square_root(operands[0]);
      return Expression::apply(a.name, std::move(operands));
  }
  internal_error("unknown operation");
}

Expression without_ranks(const Expression& e) {
  std::vector<Expression> operands;
  for (const Expression& operand : e.operands()) operands.push_back(without_ranks(operand));
  if (e.kind() == Kind::symbol) return Expression::symbol(e.name());
  return with_operands(e, std::move(operands));
}

}  // namespace

MachineValue machine_symbol(std::string name) {
  return {.kind = MachineKind::symbol, .name = std::move(name)};
}

MachineValue machine_call(std::string name, std::vector<MachineValue> arguments) {
  return {.kind = MachineKind::call, .name = std::move(name), .parts = std::move(arguments)};
}

MachineValue operator-(MachineValue a) {
  a.negative = !a.negative;
  return a;
}

MachineValue operator+(MachineValue a, MachineValue b) {
  MachineValue result{.kind = MachineKind::sum};
  result.parts.reserve(2);
  result.parts.push_back(std::move(a));
  result.parts.push_back(std::move(b));
  return result;
}

MachineValue operator*(MachineValue a, MachineValue b) {
  return scaled(MachineKind::product, std::move(a), std::move(b));
}

MachineValue operator/(MachineValue a, MachineValue b) {
  return scaled(MachineKind::quotient, std::move(a), std::move(b));
}

MachineValue machine_value(const Expression& e,
                           const std::function<std::string(const std::string&)>& name) {
  return machine_value(arrange(e), name);
}

bool is_same(const MachineValue& written, const MachineValue& exact, const Precision& precision) {
  if (written.kind != exact.kind || written.negative != exact.negative) return false;
  if (written.kind == MachineKind::number)
    return is_rounded(written.number, exact.number, precision);
  if (written.name != exact.name) return false;
  if (same_parts(written, exact, false, precision)) return true;
  const bool turns = written.kind == MachineKind::sum || written.kind == MachineKind::product;
  return turns && same_parts(written, exact, true, precision);
}

bool is_computed_as_meant(const Expression& e) { return meaning(arrange(e)) == without_ranks(e); }

}  // namespace hamgen
