#include "tests/random/direct_step.hpp"

#include <stdexcept>

#include "generator/interpreter/compiled_expression.hpp"

namespace hamgen::random {
namespace {

Quad magnitude(Quad x) { return x < 0 ? -x : x; }

// The value of a coefficient, which may have h in it.
Quad value_of(const Expression& e, Quad h) {
  Frame<Quad> frame{.objects = {&h}, .indices = {}};
  return CompiledExpression<Quad>(e, [](const std::string& symbol) -> Address {
    if (symbol != "h") throw std::runtime_error("a coefficient with " + symbol);
    return {};
  })(frame);
}

// J grad H(z) = (dH/dp, -dH/dq).
Vector field(const DirectModel& model, const Vector& z) {
  const Vector gradient = model.hamiltonian(z).gradient;
  const std::size_t n = model.degrees_of_freedom();
  Vector f(2 * n);
  for (std::size_t k = 0; k < n; ++k) {
    f[k] = gradient[n + k];
    f[n + k] = -gradient[k];
  }
  return f;
}

// y of y = map(y): until it moves by no more than the rounding of quad, or twice as little again.
template <class Map>
Vector fixed_point(Vector y, const Map& map) {
  for (int iteration = 0; iteration < 1000; ++iteration) {
    const Vector next = map(y);
    Quad moved = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      const Quad by = magnitude(next[k] - y[k]) / (1 + magnitude(y[k]));
      if (!(by <= moved)) moved = by;
    }
    y = next;
    if (moved < Quad(1e-30)) return y;
  }
  throw std::runtime_error("the direct step does not contract");
}

Vector moved_by(Vector z, Quad h, const Vector& f) {
  for (std::size_t k = 0; k < z.size(); ++k) z[k] += h * f[k];
  return z;
}

// zbar = z + h (I/2 + C) J grad H(zbar),  Z = z + h J grad H(zbar).
Vector step_of(const DirectModel& model, const Member& of, Quad h, const Vector& z) {
  std::map<std::pair<int, int>, Quad> a;
  const int n = static_cast<int>(model.degrees_of_freedom());
  for (int k = 0; k < 2 * n; ++k) a[{k, k}] = Quad(0.5);
  // THE LIST's C is of one degree of freedom, and stands for any number of them.
  const bool one_for_all = of.degrees_of_freedom == 1;
  for (const auto& [place, entry] : of.c) {
    const Quad value = value_of(entry, h);
    if (!one_for_all) a[place] += value;
    for (int k = 0; one_for_all && k < n; ++k) {
      a[{place.first * n + k, place.second * n + k}] += value;
    }
  }
  const Vector zbar = fixed_point(z, [&](const Vector& y) {
    const Vector f = field(model, y);
    Vector next = z;
    for (const auto& [place, value] : a) {
      next[static_cast<std::size_t>(place.first)] +=
          h * value * f[static_cast<std::size_t>(place.second)];
    }
    return next;
  });
  return moved_by(z, h, field(model, zbar));
}

Vector step_of(const DirectModel& model, const Composition& of, Quad h, Vector z) {
  for (const Expression& e : of.substeps) z = step_of(model, of.base, h * value_of(e, h), z);
  return z;
}

Vector step_of(const DirectModel& model, const Splitting& of, Quad h, Vector z) {
  const std::size_t n = model.degrees_of_freedom();
  const std::size_t parts = of.kicks.size() + of.drifts.size();
  for (std::size_t i = 0; i < parts; ++i) {
    const bool kick = (i % 2 == 0) == of.kick_first;
    const Quad length = h * value_of((kick ? of.kicks : of.drifts).at(i / 2), h);
    const Vector f = field(model, z);
    for (std::size_t k = 0; k < n; ++k) z[kick ? n + k : k] += length * f[kick ? n + k : k];
  }
  return z;
}

// All stages one after the other are the unknown.
Vector step_of(const DirectModel& model, const RungeKutta& of, Quad h, const Vector& z) {
  const std::size_t m = z.size();
  const std::size_t s = of.b.size();
  const auto fields = [&](const Vector& stages) {
    std::vector<Vector> result;
    for (std::size_t j = 0; j < s; ++j) {
      const auto first = stages.begin() + static_cast<std::ptrdiff_t>(j * m);
      result.push_back(field(model, Vector(first, first + static_cast<std::ptrdiff_t>(m))));
    }
    return result;
  };
  Vector start;
  for (std::size_t j = 0; j < s; ++j) start.insert(start.end(), z.begin(), z.end());
  const Vector stages = fixed_point(start, [&](const Vector& y) {
    const std::vector<Vector> f = fields(y);
    Vector next = start;
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t j = 0; j < s; ++j) {
        const Quad length = h * value_of(of.a[i][j], h);
        for (std::size_t k = 0; k < m; ++k) next[i * m + k] += length * f[j][k];
      }
    }
    return next;
  });
  Vector result = z;
  const std::vector<Vector> f = fields(stages);
  for (std::size_t j = 0; j < s; ++j) result = moved_by(result, h * value_of(of.b[j], h), f[j]);
  return result;
}

}  // namespace

Vector direct_step(const DirectModel& model, const Scheme& scheme, Quad h, const Vector& z) {
  return std::visit([&](const auto& of) { return step_of(model, of, h, z); }, scheme.method);
}

}  // namespace hamgen::random
