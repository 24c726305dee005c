// Where the linear part is taken, and what is said of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generator/algebra/evaluate.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/verify/linear_stability.hpp"
#include "generator/verify/rational_step.hpp"

namespace hamgen {

namespace {

using Point = std::map<std::string, Rational>;

// Is the value of a function at a rational point rational by itself?
bool is_exact_value(const std::string& name, const Rational& x) {
  if (name == "abs") return true;
  if (name == "sqrt")
    return mpz_perfect_square_p(x.get_num_mpz_t()) != 0 &&
           mpz_perfect_square_p(x.get_den_mpz_t()) != 0;
  const Function* row = find_function(name);
  return row != nullptr && row->exact_at && x == *row->exact_at;
}

// Is the value of the expression there an exact one, or its first 50 digits?
bool is_exact(const Expression& e, const Point& point) {
  if (e.is_number()) return true;
  if (e.kind() == Kind::symbol) {
    const auto value = point.find(e.name());
    return value != point.end() && is_short(value->second);
  }
  if (!std::ranges::all_of(e.operands(), [&](const Expression& x) { return is_exact(x, point); }))
    return false;
  const auto first = evaluate(e.operands()[0], point);
  if (!first) return false;
  if (e.kind() == Kind::function) return is_exact_value(e.name(), *first);
  if (e.kind() != Kind::power) return true;
  const auto exponent = evaluate(e.operands()[1], point);
  if (!exponent) return false;
  return exponent->get_den() == 1 || (exponent->get_den() == 2 && is_exact_value("sqrt", *first));
}

// H'' at the point; empty where it is not defined.
std::optional<QuadraticPart> quadratic_part(const Mechanics& mechanics, const Point& point) {
  const auto size = static_cast<std::size_t>(2 * mechanics.degrees_of_freedom);
  QuadraticPart part{mechanics.degrees_of_freedom, std::vector<Rational>(size * size)};
  for (const auto& [place, derivative] : mechanics.hessian) {
    const std::optional<Rational> value = evaluate(derivative, point);
    if (!value) return std::nullopt;
    part.exact = part.exact && is_exact(derivative, point);
    const auto i = static_cast<std::size_t>(place.first);
    const auto j = static_cast<std::size_t>(place.second);
    part.hessian[i * size + j] = part.hessian[j * size + i] = *value;
  }
  if (part.exact) return part;
  // With 50 digits cos(pi/2) is not quite zero.
  Rational largest = 0;
  for (const Rational& entry : part.hessian) largest = std::max(largest, Rational(abs(entry)));
  largest *= *parse_decimal("1e-45");
  for (Rational& entry : part.hessian) {
    if (abs(entry) < largest) entry = 0;
  }
  return part;
}

bool is_equilibrium(const Mechanics& mechanics, const Point& point) {
  return std::ranges::all_of(mechanics.gradient, [&](const Expression& component) {
    const std::optional<Rational> value = evaluate(component, point);
    return value && abs(*value) < *parse_decimal("1e-45");
  });
}

std::string flow_text(const LinearStability& found) {
  const auto& w = found.frequencies;
  std::string text;
  if (w.size() == 1) {
    text =
        fmt::format("one oscillation, `omega = {:.6g}`, `h omega = {:.6g}`", w[0], found.h * w[0]);
  } else if (!w.empty()) {
    text = fmt::format("{} oscillations, `omega = {:.6g}` to `{:.6g}`, `h omega` up to `{:.6g}`",
                       w.size(), w.front(), w.back(), found.h * w.back());
  }
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (found.free_motions > 0)
    add(fmt::format("{} free motion{}", found.free_motions, found.free_motions == 1 ? "" : "s"));
  if (found.growing > 0)
    add(fmt::format("{} growing, up to `exp({:.6g} t)`", found.growing, found.growth_rate));
  if (found.resonant) add("a double frequency with a Jordan block, which grows like `t`");
  return text;
}

// "up to h = 1.0067 (h omega = 1.3), and from 1.036 to 1.185"
std::string bound_text(const LinearStability& found) {
  if (found.verdict == Verdict::refuted || found.frequencies.empty()) return "";
  std::string text;
  if (found.bounded_for_every_h) {
    text = "; for every `h`";
  } else if (!found.searched) {
    return found.verdict == Verdict::not_decided ? "" : "; up to which `h` is not known";
  } else if (found.bounded_steps.empty()) {
    return "";
  } else {
    constexpr std::size_t most = 4;
    const double w = found.frequencies.back();
    const std::size_t count = found.bounded_steps.size();
    for (std::size_t k = 0; k < std::min(count, most); ++k) {
      const auto& [from, to] = found.bounded_steps[k];
      text += text.empty() ? "; bounded " : ", and ";
      if (from > 0.0) text += fmt::format("from `h = {:.8g}` ", from);
      if (std::isinf(to)) {
        text += "on";
      } else {
        text += fmt::format("{} `h = {:.8g}` (`h omega = {:.6g}`)", from > 0.0 ? "to" : "up to", to,
                            to * w);
        if (to >= found.looked_to) text += ", as far as was looked";
      }
    }
    if (count > most) text += fmt::format(", and {} more beyond", count - most);
  }
  if (std::isfinite(found.looked_to)) text += "; by intervals of `h`";
  constexpr std::size_t most = 3;
  for (std::size_t k = 0; k < std::min(found.borders.size(), most); ++k)
    text += fmt::format("{} {:.8g}", k == 0 ? "; on the border at h =" : ",", found.borders[k]);
  if (found.borders.size() > most) text += ", ...";
  return text;
}

// The mode whose angle is nearest to 2 pi/m, m = 3 to 6, as a part of that.
std::string resonance_text(const LinearStability& found) {
  const double turn = 2.0 * std::numbers::pi;
  std::string text = fmt::format("the fastest turns by `theta = {:.6g} = 2 pi/{:.4g}` a step",
                                 found.angles.back(), turn / found.angles.back());
  double nearest = 1.0;
  std::string near;
  for (std::size_t k = 0; k < found.angles.size(); ++k) {
    for (int m = 3; m <= 6; ++m) {
      const double off = std::abs(found.angles[k] * m / turn - 1.0);
      if (off >= nearest) continue;
      nearest = off;
      near = fmt::format("`omega = {:.6g}` is {:.2g}% off `2 pi/{}`", found.frequencies[k],
                         100.0 * off, m);
    }
  }
  if (nearest < 0.05) text += "; near a resonance: " + near;
  std::string where;
  for (const auto& [m, h] : found.resonant_h)
    where += fmt::format("{}`2 pi/{}` at `h = {:.6g}`", where.empty() ? "; " : ", ", m, h);
  return text + where;
}

}  // namespace

std::vector<LinearPoint> linear_points(const Mechanics& mechanics, const Scheme& scheme,
                                       const std::map<std::string, Rational>& point,
                                       const Rational& h) {
  const std::optional<Rational> energy = evaluate(mechanics.energy, point);
  if (!energy) return {};
  Point origin = point;
  for (const Quantity& variable : mechanics.variables)
    origin.insert_or_assign(variable.name, Rational(0));
  // What C may depend on.
  Point values = point;
  values.insert_or_assign("E0", *energy);
  std::vector<LinearPoint> points;
  const auto here = quadratic_part(mechanics, point);
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
