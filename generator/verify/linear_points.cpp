// Where the linear part is taken, and what is said of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generator/verify/linear_stability.hpp"

namespace hamgen {

namespace {

using Point = std::map<std::string, Precise>;

// H'' at the point; empty where it is not defined.
std::optional<QuadraticPart> quadratic_part(const Mechanics& mechanics, const Point& point) {
  const auto size = static_cast<std::size_t>(2 * mechanics.degrees_of_freedom);
  QuadraticPart part{mechanics.degrees_of_freedom, std::vector<double>(size * size)};
  const Substitution none;
  PreciseValues values(point, none);
  for (const auto& [place, derivative] : mechanics.hessian) {
    const std::optional<Precise> value = values(derivative);
    if (!value) return std::nullopt;
    const auto i = static_cast<std::size_t>(place.first);
    const auto j = static_cast<std::size_t>(place.second);
    part.hessian[i * size + j] = part.hessian[j * size + i] = to_double(*value);
  }
  // With 60 digits cos(pi/2) is not quite zero.
  double largest = 0.0;
  for (const double entry : part.hessian) largest = std::max(largest, std::abs(entry));
  for (double& entry : part.hessian) {
    if (std::abs(entry) < 1e-60 * largest) entry = 0.0;
  }
  return part;
}

bool is_equilibrium(const Mechanics& mechanics, const Point& point) {
  const Substitution none;
  PreciseValues values(point, none);
  return std::ranges::all_of(mechanics.gradient, [&](const Expression& component) {
    const std::optional<Precise> value = values(component);
    return value && std::abs(to_double(*value)) < 1e-50;
  });
}

std::string flow_text(const LinearStability& found) {
  const auto& w = found.frequencies;
  std::string text;
  if (w.size() == 1) {
    text = fmt::format("one oscillation, w = {:.6g}, h w = {:.6g}", w[0], found.h * w[0]);
  } else if (!w.empty()) {
    text = fmt::format("{} oscillations, w = {:.6g} to {:.6g}, h w up to {:.6g}", w.size(),
                       w.front(), w.back(), found.h * w.back());
  }
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (found.free_motions > 0)
    add(fmt::format("{} free motion{}", found.free_motions, found.free_motions == 1 ? "" : "s"));
  if (found.growing > 0)
    add(fmt::format("{} growing, up to exp({:.6g} t)", found.growing, found.growth_rate));
  if (found.resonant) add("a double frequency with a Jordan block, which grows like t");
  return text;
}

std::string bound_text(const LinearStability& found) {
  if (found.bounded_for_every_h) return "; for every h";
  if (found.frequencies.empty() || !found.margin) return "";
  if (!found.largest_h) return "; no bound of h was found";
  const double w = found.frequencies.back();
  return fmt::format("; bounded up to h = {:.8g} (h w = {:.6g})", *found.largest_h,
                     *found.largest_h * w);
}

// The mode whose angle is nearest to 2 pi/m, m = 3 to 6, as a part of that.
std::string resonance_text(const LinearStability& found) {
  const double turn = 2.0 * std::numbers::pi;
  std::string text = fmt::format("the fastest turns by theta = {:.6g} = 2 pi/{:.4g} a step",
                                 found.angles.back(), turn / found.angles.back());
  double nearest = 1.0;
  std::string near;
  for (std::size_t k = 0; k < found.angles.size(); ++k) {
    for (int m = 3; m <= 6; ++m) {
      const double off = std::abs(found.angles[k] * m / turn - 1.0);
      if (off >= nearest) continue;
      nearest = off;
      near = fmt::format("w = {:.6g} is {:.2g}% off 2 pi/{}", found.frequencies[k], 100.0 * off, m);
    }
  }
  if (nearest < 0.05) text += "; near a resonance: " + near;
  std::string where;
  for (const auto& [m, h] : found.resonant_h)
    where += fmt::format("{}2 pi/{} at h = {:.6g}", where.empty() ? "; " : ", ", m, h);
  return text + where;
}

}  // namespace

std::vector<LinearPoint> linear_points(const Mechanics& mechanics, const Scheme& scheme,
                                       const std::map<std::string, Rational>& point, double h) {
  Point state;
  for (const auto& [name, value] : point) state.emplace(name, precise(value));
  const Substitution none;
  const std::optional<Precise> energy = PreciseValues(state, none)(mechanics.energy);
  if (!energy) return {};
  Point origin = state;
  for (const Quantity& variable : mechanics.variables)
    origin.insert_or_assign(variable.name, precise(0));
  // What C may depend on.
  Point values = state;
  values.insert_or_assign("E0", *energy);
  std::vector<LinearPoint> points;
  const auto here = quadratic_part(mechanics, state);
  if (here) points.push_back({"initial state", linear_stability(*here, scheme, values, h)});
  if (!is_equilibrium(mechanics, origin)) return points;
  const auto there = quadratic_part(mechanics, origin);
  // A quadratic H has one linear part.
  if (there && !(here && there->hessian == here->hessian))
    points.push_back({"origin", linear_stability(*there, scheme, values, h)});
  return points;
}

Proof findings(const LinearPoint& point) {
  const LinearStability& found = point.stability;
  const std::string place = ", " + point.place;
  Proof proof{{"linear part" + place, Verdict::measured, flow_text(found)},
              {"linear stability" + place, found.verdict, found.detail + bound_text(found)}};
  if (!found.angles.empty())
    proof.push_back({"resonances" + place, Verdict::measured, resonance_text(found)});
  if (const auto& radius = found.iteration_radius) {
    proof.push_back({"fixed point iteration" + place, Verdict::measured,
                     fmt::format("{}: spectral radius {:.4g} of its linear part{}",
                                 *radius < 1.0 ? "contracts" : "does not contract", *radius,
                                 *radius < 0.3   ? ""
                                 : *radius < 1.0 ? "; above 0.3 Newton's iteration is cheaper"
                                                 : "; Newton's iteration is needed")});
  }
  return proof;
}

}  // namespace hamgen
