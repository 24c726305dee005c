#include "generator/program/loops_text.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

// "reads q[i+1], q[i], m[i]"
std::string reads(const Kernel& kernel) {
  std::string text;
  auto also = [&](const std::string& name) { text += (text.empty() ? "" : ", ") + name; };
  for (const Slot& slot : kernel.slots) also(slot.symbol);
  for (const ParameterSlot& slot : kernel.parameters) also(slot.symbol);
  return "reads " + text;
}

// What the loop adds where, with what its results share computed once.
std::string body(const Kernel& kernel, const std::string& indent) {
  std::vector<std::string> targets{"H"};
  std::vector<Expression> values{kernel.value};
  for (std::size_t i = 0; i < kernel.slots.size(); ++i) {
    if (kernel.gradient[i].is_zero()) continue;
    targets.push_back(fmt::format("dH/d{}", kernel.slots[i].symbol));
    values.push_back(kernel.gradient[i]);
  }
  for (const auto& [slots, value] : kernel.hessian) {
    targets.push_back(fmt::format("d2H/d{} d{}", kernel.slots[slots.first].symbol,
                                  kernel.slots[slots.second].symbol));
    values.push_back(value);
  }
  const Evaluation evaluation = evaluate_together(values);
  std::string text;
  for (const Statement& s : evaluation.statements) {
    text += fmt::format("{}{} = {}\n", indent, s.name, to_text(s.value));
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    text += fmt::format("{}{} += {}\n", indent, targets[i], to_text(evaluation.results[i]));
  }
  return text;
}

std::string loop(const Kernel& kernel) {
  if (kernel.ranges.empty()) {
    return fmt::format("once: {}\n", reads(kernel)) + body(kernel, "  ");
  }
  std::string text = "for";
  for (const KernelRange& range : kernel.ranges) {
    text += fmt::format("{} {} = {}..{}", text == "for" ? "" : ",", range.index,
                        to_text(range.lower), to_text(range.upper));
  }
  return fmt::format("{}: {}\n", text, reads(kernel)) + body(kernel, "  ");
}

std::string matrix_line(const ArrayPlan& plan) {
  if (!plan.matrix) return "";
  const ArrayMatrix& matrix = *plan.matrix;
  std::string text = fmt::format("matrix of size {}", matrix.size);
  switch (matrix.kind) {
    case MatrixKind::band:
      text += fmt::format(", bandwidth {}", matrix.bandwidth);
      if (matrix.arrays > 1) text += fmt::format(", {} arrays element by element", matrix.arrays);
      if (matrix.folded) text += ", the ring folded flat: first, last, second, last but one, ...";
      break;
    case MatrixKind::dense:
      text += ", full";
      break;
    case MatrixKind::eigen_dense:
      text += ", full, by Eigen";
      break;
    case MatrixKind::eigen_sparse:
      text += ", sparse, by Eigen";
      break;
  }
  if (plan.constant_matrix) text += ", factorised once per run";
  return text + "\n";
}

// The step in terms of V = dH/dq and T = dH/dp.
std::string step(const Program& program) {
  const SolvePlan& plan = program.plan;
  const char* update = "new q = q + h*dH/dp, new p = p - h*dH/dq\n";
  switch (plan.arrays->method) {
    case ArrayMethod::explicit_a:
      return std::string("bar(q) = q; bar(p) = p - h*dH/dq\n") + update;
    case ArrayMethod::explicit_b:
      return std::string("bar(p) = p; bar(q) = q + h*dH/dp\n") + update;
    case ArrayMethod::gradient_only:
      return plan.equations.scheme.description + "\n";
    default:
      break;
  }
  const FamilyParameters member = uniform_parameters(plan.equations.scheme.member()).value();
  const Expression h = Expression::symbol("h", kRankOfStep);
  auto stage = [&](const std::string& name, const Expression& by_q, const Expression& by_p) {
    return fmt::format(
        "  bar({0}) = {1}\n", name,
        to_text(Expression::symbol(name, 0) + h * by_q * Expression::symbol("dH/dq", 1) +
                h * by_p * Expression::symbol("dH/dp", 2)));
  };
  std::string text;
  if (plan.sweeps) {
    text = fmt::format("dH/dq, dH/dp at (q, p); then {} sweeps:\n", *plan.sweeps);
  } else {
    text = plan.arrays->reduced ? "iterate on bar(q), with bar(p) made from it:\n"
                                : "iterate on bar(q), bar(p):\n";
  }
  text += stage("q", member.gamma, member.alpha);
  text += stage("p", -(Expression(1) - member.alpha), -member.beta);
  return text + matrix_line(*plan.arrays) + "then:\n  " + update;
}

}  // namespace

std::string loops_text(const Program& program) {
  std::string text = "loops:\n";
  for (const Kernel& kernel : program.plan.equations.mechanics.kernels) text += loop(kernel);
  return text + "step: " + program.plan.solver + "\n" + step(program);
}

}  // namespace hamgen
