#include "app/studies/ball_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/ball_expression.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

using Rows = std::vector<BallVector>;

// d(J grad H)_i/dz_j: the Hessian's row of the partner of i, q before p, with the sign of J.
BallMatrix field_jacobian(const BallModel& model, std::span<const Ball> z) {
  const auto n = static_cast<int>(z.size() / 2);
  BallMatrix result;
  const auto add = [&](int i, int j, const Ball& entry) {
    if (i < n) {
      result[{i + n, j}] = -entry;
    } else {
      result[{i - n, j}] = entry;
    }
  };
  for (const auto& [place, entry] : model.hamiltonian(z, true).hessian) {
    add(place.first, place.second, entry);
    if (place.first != place.second) add(place.second, place.first, entry);
  }
  return result;
}

// h M f for a matrix in balls.
BallVector applied(const BallMatrix& matrix, const Ball& h, const BallVector& f) {
  BallVector result(f.size());
  for (const auto& [place, entry] : matrix)
    result[static_cast<std::size_t>(place.first)].add_product(
        h * entry, f[static_cast<std::size_t>(place.second)]);
  return result;
}

void add_scaled(BallVector& z, const Ball& factor, const BallVector& f) {
  for (std::size_t i = 0; i < z.size(); ++i) z[i].add_product(factor, f[i]);
}

BallVector part(std::span<const Ball> all, std::size_t i, std::size_t size) {
  return {all.begin() + static_cast<std::ptrdiff_t>(i * size),
          all.begin() + static_cast<std::ptrdiff_t>((i + 1) * size)};
}

}  // namespace

BallStep::BallStep(const BallModel& model, const Scheme& scheme, std::map<std::string, Ball> values,
                   Ball h)
    : model_(model), scheme_(scheme), values_(std::move(values)), h_(std::move(h)) {}

std::string BallStep::refusal(const Scheme& scheme, std::size_t degrees_of_freedom) {
  std::size_t unknowns = 2 * degrees_of_freedom;
  if (const auto* stages = std::get_if<RungeKutta>(&scheme.method); stages != nullptr)
    unknowns *= stages->is_explicit() ? 0 : stages->b.size();
  if (std::holds_alternative<Splitting>(scheme.method)) unknowns = 0;
  if (scheme.has_member() && scheme.member().generating_order > 0)
    return "with --order its equations hold a function K derived from H, not the model's H";
  if (unknowns > kMostBallUnknowns)
    return fmt::format(
        "it has {} unknowns, and the full matrix by which their solution is proved is computed for "
        "{} "
        "at most",
        unknowns, kMostBallUnknowns);
  return "";
}

BallVector BallStep::field(std::span<const Ball> z) const {
  const BallJet energy = model_.hamiltonian(z, false);
  const std::size_t n = z.size() / 2;
  BallVector f(z.size());
  for (const auto& [k, slope] : energy.gradient) {
    const auto i = static_cast<std::size_t>(k);
    if (i < n) {
      f[i + n] = -slope;
    } else {
      f[i - n] = slope;
    }
  }
  // log(q) has a slope where it has no value.
  if (!energy.value.is_finite()) f.front() = energy.value;
  return f;
}

Ball BallStep::number(const Expression& e, const Ball& h) const {
  std::map<std::string, Ball> values = values_;
  values.insert_or_assign("h", h);
  return evaluate_in_balls(e, values, h.bits());
}

BallSolution BallStep::solve(BallEquations equations, const BallVector& from, bool must_contain) {
  const auto n = static_cast<std::size_t>(equations.degrees_of_freedom);
  for (std::size_t i = 0; i < from.size(); ++i) {
    double& largest = largest_[i / n % 2];
    largest = std::max(largest, std::fabs(from[i].nearest()));
  }
  equations.largest = largest_;
  BallSolution solution = solve_in_balls(equations, from, must_contain, 8.0 * radius_);
  if (solution.failure.empty()) radius_ = std::min(solution.radius, 0.125);
  return solution;
}

// zbar - z - h B f(zbar) = 0 with B = I/2 + C, and Z = z + h f(zbar).
BallSolution BallStep::member_step(const Member& member, const Ball& h, const BallVector& z,
                                   const BallVector* computed) {
  BallMatrix b;
  for (const auto& [place, entry] : member.c) b[place] = number(entry, h);
  const auto size = static_cast<int>(z.size());
  for (int i = 0; i < size; ++i) b[{i, i}] += Ball(Rational(1, 2), h.bits());
  BallVector from = z;
  if (computed != nullptr) {
    BallVector change;
    for (std::size_t i = 0; i < z.size(); ++i) change.push_back((*computed)[i] - z[i]);
    const BallVector moved = applied(b, Ball(1), change);
    for (std::size_t i = 0; i < z.size(); ++i) from[i] += moved[i];
  }
  for (Ball& value : from) value = value.midpoint();
  const BallEquations equations{
      [&](std::span<const Ball> x) {
        BallVector f = applied(b, -h, field(x));
        for (std::size_t i = 0; i < z.size(); ++i) f[i] += x[i] - z[i];
        return f;
      },
      [&](std::span<const Ball> x) {
        BallMatrix result;
        const BallMatrix slope = field_jacobian(model_, x);
        for (const auto& [place, weight] : b) {
          const auto row = slope.lower_bound({place.second, 0});
          for (auto it = row; it != slope.end() && it->first.first == place.second; ++it)
            result[{place.first, it->first.second}].add_product(-h * weight, it->second);
        }
        for (int i = 0; i < size; ++i) result[{i, i}] += Ball(1);
        return result;
      },
      size / 2};
  BallSolution solution = solve(equations, from, computed != nullptr);
  if (!solution.failure.empty()) return solution;
  BallVector end = z;
  add_scaled(end, h, field(solution.x));
  solution.x = std::move(end);
  return solution;
}

BallSolution BallStep::compose(const Composition& method, const BallVector& z) {
  BallSolution whole{.x = z, .radius = 1.0};
  for (const Expression& length : method.substeps) {
    const Ball h = number(length, h_) * h_;
    BallSolution part = member_step(method.base, h, whole.x, nullptr);
    if (!part.failure.empty()) return part;
    whole.x = std::move(part.x);
    whole.radius = std::min(whole.radius, part.radius);
  }
  return whole;
}

// Y_i - z - h sum_j a_ij f(Y_j) = 0, and Z = z + h sum b_i f(Y_i).
BallSolution BallStep::stages_step(const RungeKutta& method, const BallVector& z,
                                   const BallVector& computed) {
  const std::size_t s = method.b.size();
  const std::size_t size = z.size();
  Rows a(s);
  BallVector from;
  for (std::size_t i = 0; i < s; ++i) {
    for (const Expression& entry : method.a[i]) a[i].push_back(number(entry, h_));
    // On the straight line from z to Z, of which stage i has done c_i.
    const Ball c = number(method.c[i], h_);
    for (std::size_t k = 0; k < size; ++k)
      from.push_back((z[k] + c * (computed[k] - z[k])).midpoint());
  }
  const BallEquations equations{
      [&](std::span<const Ball> x) {
        BallVector result;
        Rows f;
        for (std::size_t j = 0; j < s; ++j) f.push_back(field(part(x, j, size)));
        for (std::size_t i = 0; i < s; ++i) {
          BallVector lack = part(x, i, size);
          for (std::size_t k = 0; k < size; ++k) lack[k] -= z[k];
          for (std::size_t j = 0; j < s; ++j) add_scaled(lack, -h_ * a[i][j], f[j]);
          std::ranges::move(lack, std::back_inserter(result));
        }
        return result;
      },
      [&](std::span<const Ball> x) {
        BallMatrix result;
        for (std::size_t j = 0; j < s; ++j) {
          for (const auto& [place, slope] : field_jacobian(model_, part(x, j, size))) {
            for (std::size_t i = 0; i < s; ++i)
              result[{static_cast<int>(i * size) + place.first,
                      static_cast<int>(j * size) + place.second}]
                  .add_product(-h_ * a[i][j], slope);
          }
        }
        for (int i = 0; i < static_cast<int>(s * size); ++i) result[{i, i}] += Ball(1);
        return result;
      },
      static_cast<int>(size / 2)};
  BallSolution solution = solve(equations, from, false);
  if (!solution.failure.empty()) {
    // Where a step is long the line leads astray.
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = z[i % size].midpoint();
    solution = solve(equations, from, false);
  }
  if (!solution.failure.empty()) return solution;
  BallVector end = z;
  for (std::size_t i = 0; i < s; ++i)
    add_scaled(end, h_ * number(method.b[i], h_), field(part(solution.x, i, size)));
  solution.x = std::move(end);
  return solution;
}

BallSolution BallStep::explicit_step(const RungeKutta& method, const BallVector& z) const {
  Rows f;
  for (std::size_t i = 0; i < method.b.size(); ++i) {
    BallVector stage = z;
    for (std::size_t j = 0; j < i; ++j) {
      if (!method.a[i][j].is_zero()) add_scaled(stage, h_ * number(method.a[i][j], h_), f[j]);
    }
    f.push_back(field(stage));
  }
  BallSolution result{.x = z};
  for (std::size_t i = 0; i < f.size(); ++i)
    add_scaled(result.x, h_ * number(method.b[i], h_), f[i]);
  return result;
}

// Kicks and drifts in turn: of a separable H each moves one half of z by the other half's field.
BallSolution BallStep::split_step(const Splitting& method, const BallVector& z) const {
  BallSolution result{.x = z};
  const std::size_t n = z.size() / 2;
  const std::size_t count = method.kicks.size() + method.drifts.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool kick = (i % 2 == 0) == method.kick_first;
    const Ball length = h_ * number((kick ? method.kicks : method.drifts).at(i / 2), h_);
    const BallVector f = field(result.x);
    for (std::size_t k = kick ? n : 0; k < (kick ? 2 * n : n); ++k)
      result.x[k].add_product(length, f[k]);
    if (!f.front().is_finite()) result.x.front() = f.front();
  }
  return result;
}

BallSolution BallStep::step(const BallVector& z, const BallVector& computed) {
  BallSolution result;
  if (const auto* member = std::get_if<Member>(&scheme_.method)) {
    result = member_step(*member, h_, z, &computed);
  } else if (const auto* composition = std::get_if<Composition>(&scheme_.method)) {
    result = compose(*composition, z);
  } else if (const auto* splitting = std::get_if<Splitting>(&scheme_.method)) {
    result = split_step(*splitting, z);
  } else {
    const auto& stages = std::get<RungeKutta>(scheme_.method);
    result = stages.is_explicit() ? explicit_step(stages, z) : stages_step(stages, z, computed);
  }
  if (result.failure.empty() && !std::ranges::all_of(result.x, &Ball::is_finite))
    result.failure = "H has no gradient at a state that the step goes through";
  return result;
}

}  // namespace hamgen::app
