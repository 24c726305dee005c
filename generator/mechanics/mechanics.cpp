#include "generator/mechanics/mechanics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen {

Expression Mechanics::second_derivative(int i, int j) const {
  const auto it = hessian.find(std::minmax(i, j));
  return it == hessian.end() ? Expression(0) : it->second;
}

bool Mechanics::is_separable() const {
  for (const Kernel& kernel : kernels) {
    if (uses_coordinates(kernel) && uses_momenta(kernel)) return false;
  }
  for (const auto& [place, value] : hessian) {
    if (place.first < degrees_of_freedom && place.second >= degrees_of_freedom) return false;
  }
  return true;
}

bool Mechanics::is_time(const AffineIndex& place) const {
  return has_time && place == AffineIndex{.constant = degrees_of_freedom - 1, .factors = {}};
}

bool Mechanics::is_momentum_of_time(const AffineIndex& place) const {
  return has_time && place == AffineIndex{.constant = 2 * degrees_of_freedom - 1, .factors = {}};
}

Expression Mechanics::variable(int i) const {
  return Expression::symbol(variables.name(static_cast<std::size_t>(i)), kRankOfVariable + i);
}

namespace {

std::string kernels_text(const Mechanics& mechanics) {
  std::string text = "H is a sum of loops:\n";
  for (const Kernel& kernel : mechanics.kernels) {
    text += "  ";
    for (const KernelRange& range : kernel.ranges) {
      text +=
          fmt::format("sum {} = {}..{}: ", range.index, to_text(range.lower), to_text(range.upper));
    }
    if (kernel.sum) text += "to " + mechanics.sums[*kernel.sum].name + ": ";
    text += to_text(kernel.value) + "\n";
  }
  if (!mechanics.sums.empty()) text += "  " + to_text(mechanics.of_sums) + "\n";
  return text;
}

}  // namespace

std::string to_text(const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  std::string text =
      fmt::format("system {}, {} degree{} of freedom, {}\n", mechanics.name, n, n == 1 ? "" : "s",
                  mechanics.is_separable() ? "separable" : "not separable");
  if (mechanics.keeps_sums()) return text + kernels_text(mechanics);
  text += "H = " + to_text(mechanics.energy) + "\n";
  for (int i = 0; i < 2 * n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    text +=
        fmt::format("dH/d{} = {}\n", mechanics.variables.name(k), to_text(mechanics.gradient[k]));
  }
  for (const auto& [place, value] : mechanics.hessian) {
    text += fmt::format(
        "d2H/d{} d{} = {}\n", mechanics.variables.name(static_cast<std::size_t>(place.first)),
        mechanics.variables.name(static_cast<std::size_t>(place.second)), to_text(value));
  }
  for (const NamedExpression& invariant : mechanics.invariants) {
    text += fmt::format("{} {} = {}\n", invariant.is_event() ? "event" : "invariant",
                        invariant.name, to_text(invariant.value));
  }
  return text;
}

}  // namespace hamgen
