// Compiled into programs beside emitted code, never into a test itself: every step that a
// Propagator takes, against the solution of the same equations in quad from the same exact state +
// carry.
//
// Note [contract of a solve]
// The equations of a step have stages Y_1..Y_s (a member has one, zbar):
//   Y_i = z + h sum_j a_ij J grad H(Y_j),      Z = z + h sum_j b_j J grad H(Y_j)
// with numbers a_ij for a Runge-Kutta method, and with s = 1, a = I/2 + C, b = 1 for a member.
// Solved in floating-point numbers of rounding unit eps they hold up to residuals
//   r_i = eps (|Y_i| + 2^-10 max |Y_i|) + |h J (g(Y_i) - grad H(Y_i))|,
// g the emitted gradient in these numbers: no algorithm does better than to round its own solution
// and to evaluate H's gradient as it is emitted.  (The maximum: a rule that adds up the increments
// of its unknowns cannot see one that is a thousand times smaller than the others to its last
// digit.  Y_i lies between two numbers, and g(Y_i) is the worse of the two there: where g is a
// single product, its error at one of them may vanish by chance.)  Then, A = I - h (a J H''(Y_j))
// the matrix of the equations, the stages err by |A^-1| r, and so does Z but for rounding it:
//   member:  dZ = h J H'' dY + h J dg,  and h J H'' dY = (I/2 + C)^-1 (dY - r): for the midpoint
//   rule
//            twice dY, for others of that order;
//   stages:  dZ = b^T a^-1 (dY - r) likewise, each stage with its weight d = |b^T a^-1| (HLW IV.8).
// A step keeps the contract if in every component
//   |Z - Z_quad| <= 16 (|A^-1| r + eps |Z|),          |A^-1| r meaning sum_i d_i (|A^-1| r)_i /
//   d(1),
// d(1) = 2 the midpoint rule's.  16 is what a handful of operations and the factor 2 make of it; an
// iteration that stops too early is off by orders of magnitude.
//
// Z_quad is the emitted quad step, and not believed: the residual of the equations as above is
// evaluated at it, with H's gradient in quad and no part of the solver, and A^-1 times it, which is
// the increment of dense Newton on all unknowns, says how far the solution is.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace contract {

__extension__ typedef __float128 Quad;
using Vector = std::vector<Quad>;
using Matrix = std::vector<Vector>;

inline Quad magnitude(Quad x) { return x < 0 ? -x : x; }

// A state is nothing but its numbers.
template <class Real, class State>
Vector numbers(const State& state) {
  std::vector<Real> values(sizeof(State) / sizeof(Real));
  std::memcpy(values.data(), &state, sizeof(State));
  return Vector(values.begin(), values.end());
}
template <class Real, class State>
State state_of(const Vector& values) {
  State state;
  if constexpr (!std::is_empty_v<State>) {
    std::vector<Real> rounded;
    for (const Quad value : values) rounded.push_back(static_cast<Real>(value));
    std::memcpy(static_cast<void*>(&state), rounded.data(), sizeof(State));
  }
  return state;
}

// Values lie between two numbers of type Real: the ones that are not the nearest.
template <class Real>
Vector on_the_other_side(const Vector& values) {
  Vector result;
  for (const Quad value : values) {
    const Real nearest = static_cast<Real>(value);
    const Real far = std::numeric_limits<Real>::max();
    result.push_back(std::nextafter(nearest, static_cast<Quad>(nearest) < value ? far : -far));
  }
  return result;
}

// J grad H at the numbers of a state, by the code of one scalar.
template <class Code>
Vector field(const typename Code::Parameters& par, const Vector& z) {
  using Real = typename Code::Real;
  const std::size_t n = z.size() / 2;
  std::vector<Real> g(z.size());
  Code::gradient(par, state_of<Real, typename Code::State>(z), g.data());
  Vector f(z.size());
  for (std::size_t i = 0; i < n; ++i) {
    f[i] = g[n + i];
    f[n + i] = -static_cast<Quad>(g[i]);
  }
  return f;
}

// The equations of a step: a is one number for each pair of stages, or one matrix.
struct Equations {
  Matrix a;  // s x s
  Vector b;  // s
  Vector d;  // |b^T a^-1|
  Matrix c;  // of a member I/2 + C; empty for Runge-Kutta methods
  std::size_t stages() const { return b.size(); }
};

// x of A x = v by elimination with partial pivoting, and A^-1 from it.
template <class Real>
bool solve(std::vector<std::vector<Real>> a, std::vector<std::vector<Real>>& v) {
  const std::size_t m = a.size();
  for (std::size_t c = 0; c < m; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < m; ++r) {
      if (magnitude(a[r][c]) > magnitude(a[pivot][c])) pivot = r;
    }
    if (!(magnitude(a[pivot][c]) > 0)) return false;
    std::swap(a[c], a[pivot]);
    std::swap(v[c], v[pivot]);
    for (std::size_t r = 0; r < m; ++r) {
      if (r == c || a[r][c] == 0) continue;
      const Real factor = a[r][c] / a[c][c];
      for (std::size_t j = c; j < m; ++j) a[r][j] -= factor * a[c][j];
      for (std::size_t j = 0; j < v[r].size(); ++j) v[r][j] -= factor * v[c][j];
    }
  }
  for (std::size_t r = 0; r < m; ++r) {
    for (Real& value : v[r]) value /= a[r][r];
  }
  return true;
}

template <class Real>
std::vector<std::vector<Real>> unit(std::size_t size) {
  std::vector<std::vector<Real>> result(size, std::vector<Real>(size));
  for (std::size_t i = 0; i < size; ++i) result[i][i] = 1;
  return result;
}

// A member with the same alpha, beta, gamma in every degree of freedom.
inline Equations member(std::size_t n, Quad alpha, Quad beta, Quad gamma) {
  Equations e{{{1}}, {1}, {2}, Matrix(2 * n, Vector(2 * n))};
  for (std::size_t i = 0; i < n; ++i) {
    e.c[i][i] = alpha;
    e.c[n + i][n + i] = 1 - alpha;
    e.c[i][n + i] = -gamma;
    e.c[n + i][i] = -beta;
  }
  return e;
}

// a_ij = coupling_ij b_j, from the coefficients of a step h = 1.
template <class Coefficients>
Equations runge_kutta(const Coefficients& k) {
  const auto& coupling = k.coupling;
  const auto& weight = k.scaled;
  const std::size_t s = sizeof(weight) / sizeof(weight[0]);
  Equations e{Matrix(s, Vector(s)), Vector(s), Vector(s), {}};
  Matrix transposed(s, Vector(s));
  Matrix right(s, Vector(1));
  for (std::size_t i = 0; i < s; ++i) {
    e.b[i] = weight[i];
    right[i][0] = weight[i];
    for (std::size_t j = 0; j < s; ++j) {
      e.a[i][j] = static_cast<Quad>(coupling[i][j]) * static_cast<Quad>(weight[j]);
      transposed[j][i] = e.a[i][j];
    }
  }
  solve(transposed, right);
  for (std::size_t i = 0; i < s; ++i) e.d[i] = magnitude(right[i][0]);
  return e;
}

// What is worst along a run.
struct Defects {
  long long steps = 0;
  long long iterations = 0;
  long long solves = 0;
  long long broken = 0;   // solves beyond 16 times the bound
  long long unknown = 0;  // whose quad step finds no solution from a cold start
  double worst = 0;       // of |Z - Z_quad| / (|A^-1| r + eps |Z|)
  long long worst_step = 0;
  double units = 0;      // of |Z - Z_quad| / (eps max|Z|)
  double reference = 0;  // of |A^-1 residual of Z_quad| / (bound), where it was wanted
  bool failed = false;   // a step did not converge
};

// The steps of Code, one by one.
template <class Code, class Exact>
class Watch {
 public:
  using Real = typename Code::Real;
  Watch(const typename Code::Parameters& par, Equations equations)
      : par_(par), exact_par_(parameters(par)), equations_(std::move(equations)) {}

  // One solve of a stepper whose length is h; false if it fails.
  template <class Stepper, class ExactStepper>
  bool solve(Stepper& stepper, Quad h, Defects& defects) {
    const Vector z = exact_state(stepper);
    const auto report = stepper.step();
    defects.iterations += report.iterations;
    if (!report.converged) return false;
    ++defects.solves;
    const Vector Z = exact_state(stepper);
    ExactStepper reference(exact_par_, h, state_of<Quad, typename Exact::State>(z));
    const auto exact_report = reference.step();
    const Vector wanted = exact_state(reference);
    Vector defect(z.size());
    Quad largest = 0;
    Quad furthest = 0;
    bool clear = true;
    for (std::size_t k = 0; k < z.size(); ++k) {
      defect[k] = magnitude(Z[k] - wanted[k]);
      if (defect[k] > furthest) furthest = defect[k];
      if (magnitude(wanted[k]) > largest) largest = magnitude(wanted[k]);
      if (!(defect[k] <= Code::epsilon * magnitude(wanted[k]))) clear = false;
    }
    if (!exact_report.converged) {
      ++defects.unknown;
      return true;
    }
    const double units = static_cast<double>(furthest / (Code::epsilon * largest));
    if (!(units <= defects.units)) defects.units = units;
    // Within one unit of rounding of Z itself nothing more need be known, but for a sample.
    if (clear && defects.solves % 64 != 1) return true;
    const double ratio = compare(z, wanted, h, reference, defect, defects);
    if (!(ratio <= defects.worst)) {
      defects.worst = ratio;
      defects.worst_step = defects.steps;
    }
    if (!(ratio <= 16)) ++defects.broken;
    return true;
  }

 private:
  static typename Exact::Parameters parameters(const typename Code::Parameters& par) {
    typename Exact::Parameters result;
    if constexpr (!std::is_empty_v<typename Code::Parameters>) {
      result = state_of<Quad, typename Exact::Parameters>(numbers<Real>(par));
    }
    return result;
  }
  template <class Stepper>
  static Vector exact_state(const Stepper& stepper) {
    using R = std::conditional_t<
        std::is_same_v<std::decay_t<decltype(stepper.z_)>, typename Exact::State>, Quad, Real>;
    Vector z = numbers<R>(stepper.z_);
    const Vector carry = numbers<R>(stepper.carry_);
    for (std::size_t k = 0; k < z.size(); ++k) z[k] += carry[k];
    return z;
  }

  // The stages of the exact step: of a member zbar = z + (I/2 + C) (Z - z).
  template <class Stepper>
  std::vector<Vector> stages(const Vector& z, const Vector& Z, const Stepper& stepper) const {
    const std::size_t size = z.size();
    std::vector<Vector> y(equations_.stages(), z);
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t l = 0; l < equations_.c.size(); ++l) {
        y[0][k] += equations_.c[k][l] * (Z[l] - z[l]);
      }
    }
    if constexpr (requires { stepper.start_.value; }) {
      if (!equations_.c.empty()) return y;
      for (std::size_t i = 0; i < y.size(); ++i) {
        for (std::size_t k = 0; k < size; ++k) y[i][k] = stepper.start_.value[i * size + k];
      }
    }
    return y;
  }

  // f'(y) by central differences, good to 20 digits and more: a dozen would do.
  Matrix jacobian(const Vector& y) const {
    const std::size_t size = y.size();
    Matrix result(size, Vector(size));
    for (std::size_t l = 0; l < size; ++l) {
      const Quad step = Quad(1e-11) * (magnitude(y[l]) + Quad(1e-6));
      Vector moved = y;
      moved[l] = y[l] + step;
      const Vector up = field<Exact>(exact_par_, moved);
      moved[l] = y[l] - step;
      const Vector down = field<Exact>(exact_par_, moved);
      for (std::size_t k = 0; k < size; ++k) result[k][l] = (up[k] - down[k]) / (2 * step);
    }
    return result;
  }

  // (a f)_i: of a member (I/2 + C) f.
  Vector collected(const std::vector<Vector>& f, std::size_t i) const {
    const std::size_t size = f[0].size();
    Vector sum(size);
    for (std::size_t j = 0; j < f.size(); ++j) {
      for (std::size_t k = 0; k < size; ++k) {
        if (equations_.c.empty()) {
          sum[k] += equations_.a[i][j] * f[j][k];
        } else {
          for (std::size_t l = 0; l < size; ++l) sum[k] += equations_.c[k][l] * f[j][l];
        }
      }
    }
    return sum;
  }

  template <class Stepper>
  double compare(const Vector& z, const Vector& Z, Quad h, const Stepper& reference,
                 const Vector& defect, Defects& defects) const {
    const std::size_t size = z.size();
    const std::size_t s = equations_.stages();
    const std::vector<Vector> y = stages(z, Z, reference);
    // A few digits of A^-1 are enough.
    std::vector<std::vector<double>> a = unit<double>(s * size);
    std::vector<Vector> exact_field;
    Matrix right(s * size, Vector(2));  // r, and the residual of the reference
    for (std::size_t j = 0; j < s; ++j) {
      const Vector f = field<Exact>(exact_par_, y[j]);
      const Vector rounded = field<Code>(par_, y[j]);
      const Vector other = field<Code>(par_, on_the_other_side<Real>(y[j]));
      exact_field.push_back(f);
      const Matrix slope = jacobian(y[j]);
      Quad longest = 0;
      for (const Quad value : y[j])
        longest = magnitude(value) > longest ? magnitude(value) : longest;
      for (std::size_t k = 0; k < size; ++k) {
        const Quad here = magnitude(rounded[k] - f[k]);
        const Quad there = magnitude(other[k] - f[k]);
        right[j * size + k][0] = Code::epsilon * (magnitude(y[j][k]) + longest / 1024) +
                                 magnitude(h) * (here > there ? here : there);
        for (std::size_t i = 0; i < s; ++i) {
          for (std::size_t l = 0; l < size; ++l) {
            Quad entry = 0;
            if (equations_.c.empty()) {
              entry = equations_.a[i][j] * slope[k][l];
            } else {
              for (std::size_t m = 0; m < size; ++m) entry += equations_.c[k][m] * slope[m][l];
            }
            a[i * size + k][j * size + l] -= static_cast<double>(h * entry);
          }
        }
      }
    }
    Quad residual_of_Z = 0;
    for (std::size_t i = 0; i < s; ++i) {
      const Vector sum = collected(exact_field, i);
      for (std::size_t k = 0; k < size; ++k) {
        right[i * size + k][1] = y[i][k] - z[k] - h * sum[k];
      }
    }
    for (std::size_t k = 0; k < size; ++k) {
      Quad moved = 0;
      for (std::size_t j = 0; j < s; ++j) moved += equations_.b[j] * exact_field[j][k];
      const Quad off = magnitude(Z[k] - z[k] - h * moved);
      if (off > residual_of_Z) residual_of_Z = off;
    }
    std::vector<std::vector<double>> inverse = unit<double>(s * size);
    if (!contract::solve(a, inverse)) return 0;  // any solution is as good as another
    double worst = 0;
    for (std::size_t k = 0; k < size; ++k) {
      Quad bound = Code::epsilon * magnitude(Z[k]);
      Quad off = residual_of_Z;
      for (std::size_t i = 0; i < s; ++i) {
        for (std::size_t column = 0; column < s * size; ++column) {
          const Quad entry = magnitude(inverse[i * size + k][column]) * equations_.d[i] / 2;
          bound += entry * right[column][0];
          off += 2 * entry * magnitude(right[column][1]);
        }
      }
      const double here = static_cast<double>(defect[k] / bound);
      const double doubt = static_cast<double>(off / bound);
      if (!(here <= worst)) worst = here;
      if (!(doubt <= defects.reference)) defects.reference = doubt;
    }
    return worst;
  }

  typename Code::Parameters par_;
  typename Exact::Parameters exact_par_;
  Equations equations_;
};

// Substep i of a composition's Propagator.
template <class Propagator, class State>
struct SubstepOf {
  Propagator& all;
  int i;
  State z_, carry_;
  auto step() { return all.substep(i, z_, carry_); }
};

// One substep of the length h from a state, by the Propagator of a composition.
template <class Code>
struct OneSubstep {
  using State = typename Code::State;
  using Parameters = typename Code::Parameters;
  OneSubstep(const Parameters& par, Quad h, const State& z) : all(par, h, z), z_(z) {
    all.lengths_[0] = h;
    if constexpr (requires { all.k_; }) all.k_[0] = prepare(par, h);
  }
  auto step() { return all.substep(0, z_, carry_); }
  typename Code::Propagator all;
  State z_, carry_;
};

// Steps of a Propagator, of a composition substep by substep as its step() takes them.
template <class Code, class Exact>
Defects run(const typename Code::Parameters& par, const Equations& equations, typename Code::Real h,
            const typename Code::State& start, long long steps) {
  typename Code::Propagator propagator(par, h, start);
  Watch<Code, Exact> watch(par, equations);
  Defects defects;
  for (defects.steps = 0; defects.steps < steps; ++defects.steps) {
    if constexpr (requires { Code::Propagator::substeps; }) {
      using State = typename Code::State;
      SubstepOf<typename Code::Propagator, State> substep{propagator, 0, propagator.z_,
                                                          propagator.carry_};
      for (substep.i = 0; substep.i < Code::Propagator::substeps; ++substep.i) {
        defects.failed = !watch.template solve<decltype(substep), OneSubstep<Exact>>(
            substep, propagator.lengths_[substep.i], defects);
        if (defects.failed) return defects;
      }
      propagator.z_ = substep.z_;
      propagator.carry_ = substep.carry_;
    } else {
      defects.failed = !watch.template solve<typename Code::Propagator, typename Exact::Propagator>(
          propagator, h, defects);
      if (defects.failed) return defects;
    }
  }
  return defects;
}

inline void print(const char* name, const Defects& d) {
  std::printf("%s\t%lld\t%lld\t%lld\t%.6g\t%lld\t%.6g\t%.6g\t%d\t%lld\t%lld\n", name, d.steps,
              d.solves, d.iterations, d.worst, d.worst_step, d.units, d.reference, d.failed ? 1 : 0,
              d.broken, d.unknown);
}

}  // namespace contract
