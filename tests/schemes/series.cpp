#include "tests/schemes/series.hpp"

#include <algorithm>
#include <variant>

#include "generator/schemes/all_schemes.hpp"

namespace hamgen::schemes_test {

Series operator+(const Series& a, const Series& b) {
  Series result(a.order());
  for (int k = 0; k <= a.order(); ++k) result[k] = a[k] + b[k];
  return result;
}

Series operator-(const Series& a, const Series& b) { return a + Quad(-1) * b; }

Series operator*(const Series& a, const Series& b) {
  Series result(a.order());
  for (int i = 0; i <= a.order(); ++i) {
    for (int j = 0; i + j <= a.order(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

Series operator*(Quad a, const Series& b) {
  Series result(b.order());
  for (int k = 0; k <= b.order(); ++k) result[k] = a * b[k];
  return result;
}

// b c = a, term by term.
Series operator/(Quad a, const Series& b) {
  Series result(b.order());
  for (int k = 0; k <= b.order(); ++k) {
    Quad rest = k == 0 ? a : Quad(0);
    for (int i = 1; i <= k; ++i) rest -= b[i] * result[k - i];
    result[k] = rest / b[0];
  }
  return result;
}

Series times_h(const Series& a) {
  Series result(a.order());
  for (int k = 1; k <= a.order(); ++k) result[k] = a[k - 1];
  return result;
}

namespace {

Series constant(Quad value, const State& z) { return Series(z[0].order(), value); }

constexpr std::array<Quad, 4> kStart = {Quad(3) / 10, Quad(-1) / 5, Quad(1) / 2, Quad(7) / 10};

// J grad H.
State field(const Problem& problem, const State& z) {
  const State g = problem.gradient(z);
  return {g[2], g[3], Quad(-1) * g[0], Quad(-1) * g[1]};
}

State plus(const State& z, Quad factor, const State& f) {
  State result;
  for (std::size_t i = 0; i < z.size(); ++i) result.push_back(z[i] + factor * times_h(f[i]));
  return result;
}

State start_of(const Problem& problem, int order) {
  State z;
  for (const Quad value : problem.start) z.emplace_back(order, value);
  return z;
}

// Z = z + h f(zbar) with zbar = z + B-rows h f(zbar); each sweep settles one power of h.
State member_substep(const Problem& problem, const Member& member, Quad c, const State& z) {
  // One degree of freedom stands for both: constant alpha, no beta and gamma.
  const Quad alpha = quad_value(uniform_parameters(member).value().alpha);
  State bar = z;
  for (int sweep = 0; sweep <= z[0].order(); ++sweep) {
    const State f = field(problem, bar);
    bar = z;
    for (std::size_t i = 0; i < 4; ++i) {
      bar[i] = z[i] + (c * (i < 2 ? alpha : 1 - alpha)) * times_h(f[i]);
    }
  }
  return plus(z, c, field(problem, bar));
}

State splitting_step(const Problem& problem, const Splitting& splitting, State z) {
  const std::size_t count = splitting.kicks.size() + splitting.drifts.size();
  std::size_t kicks = 0;
  std::size_t drifts = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool kick = (i % 2 == 0) == splitting.kick_first;
    const State f = field(problem, z);
    const Quad c = quad_value(kick ? splitting.kicks[kicks++] : splitting.drifts[drifts++]);
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t at = kick ? 2 + k : k;
      z[at] = z[at] + c * times_h(f[at]);
    }
  }
  return z;
}

State tableau_step(const Problem& problem, const RungeKutta& tableau, const State& z) {
  const std::size_t s = tableau.b.size();
  std::vector<State> slopes(s, field(problem, z));
  const int sweeps = tableau.is_explicit() ? static_cast<int>(s) : z[0].order() + 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < s; ++i) {
      State stage = z;
      for (std::size_t j = 0; j < s; ++j) {
        stage = plus(stage, quad_value(tableau.a[i][j]), slopes[j]);
      }
      slopes[i] = field(problem, stage);
    }
  }
  State result = z;
  for (std::size_t i = 0; i < s; ++i) result = plus(result, quad_value(tableau.b[i]), slopes[i]);
  return result;
}

}  // namespace

Quad quad_value(const Expression& e) {
  const TripleDouble parts = to_triple(numeric_value(e));
  return Quad(parts.lower) + Quad(parts.lo) + Quad(parts.hi);
}

// V = 1/(2 + q1^2 + q1 q2) + q2^2/2 + q1^3/3,  T = (p1^2 + p2^2)/2 [+ 1/(3 + p1 p2 + p2^2)].
Problem separable_problem(bool quadratic, Quad size_of_potential) {
  return {[quadratic, size_of_potential](const State& z) {
            const Series r = Quad(1) / (constant(2, z) + z[0] * z[0] + z[0] * z[1]);
            const Series r2 = r * r;
            State g{size_of_potential * (z[0] * z[0] - (Quad(2) * z[0] + z[1]) * r2),
                    size_of_potential * (z[1] - z[0] * r2), z[2], z[3]};
            if (quadratic) return g;
            const Series s = Quad(1) / (constant(3, z) + z[2] * z[3] + z[3] * z[3]);
            const Series s2 = s * s;
            g[2] = g[2] - z[3] * s2;
            g[3] = g[3] - (z[2] + Quad(2) * z[3]) * s2;
            return g;
          },
          kStart};
}

// H = p1^2 (1 + q2)/2 + p2^2/2 + 1/(2 + q1^2 + q2 p1).
Problem mixed_problem() {
  return {[](const State& z) {
            const Series r = Quad(1) / (constant(2, z) + z[0] * z[0] + z[1] * z[2]);
            const Series r2 = r * r;
            return State{Quad(-2) * z[0] * r2, Quad(0.5) * z[2] * z[2] - z[2] * r2,
                         z[2] + z[2] * z[1] - z[1] * r2, z[3]};
          },
          kStart};
}

// (k + 1) z_{k+1} = f(z)_k.
State exact_series(const Problem& problem, int order) {
  State z = start_of(problem, order);
  for (int k = 0; k < order; ++k) {
    const State f = field(problem, z);
    for (std::size_t i = 0; i < 4; ++i) z[i][k + 1] = f[i][k] / (k + 1);
  }
  return z;
}

State step_series(const Problem& problem, const Scheme& scheme, int order) {
  const State z = start_of(problem, order);
  if (const auto* splitting = std::get_if<Splitting>(&scheme.method)) {
    return splitting_step(problem, *splitting, z);
  }
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme.method)) {
    return tableau_step(problem, *tableau, z);
  }
  if (const auto* composition = std::get_if<Composition>(&scheme.method)) {
    State now = z;
    for (const Expression& c : composition->substeps) {
      now = member_substep(problem, composition->base, quad_value(c), now);
    }
    return now;
  }
  return member_substep(problem, scheme.member(), 1, z);
}

double difference(const State& a, const State& b, int k) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = static_cast<double>(a[i][k] - b[i][k]);
    largest = std::max(largest, d < 0 ? -d : d);
  }
  return largest;
}

}  // namespace hamgen::schemes_test
