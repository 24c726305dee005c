// Steps against the solution of the same equations in quad from the same exact state + carry:
// solves one after the other, and what is worst of them.  Included by the programs that run emitted
// steps, too.
//
// Note [contract of a solve]
// The equations of a step have stages Y_1..Y_s (a member has one, zbar):
//   Y_i = z + h sum_j a_ij J grad H(Y_j),      Z = z + h sum_j b_j J grad H(Y_j)
// with numbers a_ij for a Runge-Kutta method, and with s = 1, a = I/2 + C, b = 1 for a member.
// Solved in floating-point numbers of rounding unit eps they hold up to residuals
//   r_i = eps (|Y_i| + 2^-40 max |Y_i|) + w |h J (g(Y_i) - grad H(Y_i))|,
// g the gradient in these numbers: no algorithm does better than to round its own solution and to
// evaluate H's gradient as it is emitted.  (The maximum: quad rounds the
// largest to a 2^-113th, and what is judged by it must be a million times as much.  Y_i lies
// between two numbers, and g(Y_i) is the worse of the two there: where g is a single product, its
// error at one of them may vanish by chance.  Where g is what terms of another size leave (models
// that say so, as `near_rest`), it may do so over many numbers: it is the worst of those at Y_i and
// at a 32nd of the step Z - z to either side.  w is 1, and for a member what I/2 + C has beside its
// diagonal besides: the parts of h J g that a row of another component takes.)  Then, A = I - h (a
// J H''(Y_j)) the matrix of the equations, the stages err by |A^-1| r, and so does Z but for
// rounding it, as h J H'' dY = a^-1 (dY - r):
//   member:  dZ = (I/2 + C)^-1 dY, for the midpoint rule twice dY;
//   stages:  dZ = b^T a^-1 dY, each stage with its weight d = |b^T a^-1| (HLW IV.8).
// A step keeps the contract if in every component
//   |Z - Z_quad| <= 16 (D |A^-1| r + eps |Z|),
// D = |(I/2 + C)^-1| / 2, or I + |h J H''| where there is no inverse, and the sum of d_i / 2 times
// the part of stage i: 1 of the midpoint rule.  16 is what a handful of operations and the factor 2
// make of it; an iteration that stops too early is off by orders of magnitude.
//
// A method without equations is a product of explicit steps: the rounded one is the exact one from
// a state within rounding,
//   |Z - Z_quad| <= 16 (|dZ/dz| (eps |z| + 2^-10 eps max |z| + |h J (g - grad H)|) + eps |Z|),
// where the gradient's error is the worst of nine points from z to Z, and the maximum stands for
// those between them.
//
// Z_quad is the step in quad by the same code, and not believed: the residual of the equations as
// above is evaluated at it, with H's gradient in quad and no part of the solver, and A^-1 times it,
// which is the increment of dense Newton on all unknowns, says how far the solution is.  Equations
// of long steps may have several solutions: by the same measure a member's own Z may be another.
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "tests/contract/equations.hpp"

namespace hamgen::contract {

inline constexpr double kAllowed = 16;
// Of that bound quad may leave open.  A component is allowed a 2^-40th of a rounding of the largest
// at least, 2^-92 of it; in quad the stages that a fixed point ends at are up to 16 of its units
// from the solution, 2^-108.
inline constexpr double kDoubt = 0x1p-16;

// What is worst along a run.
struct Defects {
  std::string name = {};
  long long steps = 0;  // that were taken
  long long iterations = 0;
  long long solves = 0;     // of equations: a composition has several a step
  long long broken = 0;     // solves beyond 16 times the bound
  long long elsewhere = 0;  // solves with another solution than the quad step's
  long long unknown = 0;  // solves whose quad step finds no solution from a cold start: not judged
  double worst = 0;       // of |Z - Z_quad| / bound, where it was looked at
  long long worst_step = 0;
  double units = 0;      // of |Z - Z_quad| / (eps max|Z|)
  double reference = 0;  // of the doubt of Z_quad, in parts of the bound
  bool failed = false;   // the run ended with a step without a solution
};

// A step in quad: Z, and the stages one after the other where they are known.
struct ExactStep {
  bool converged = false;
  Vector end, stages = {};
};

// What the last step of the measured code needed.
struct Attempt {
  bool converged = false;
  long long iterations = 0;
};

// Code::Real and Code::epsilon are of the numbers that are measured; code.gradient(z) and
// exact.gradient(z) are grad H, in those numbers and in quad; exact.step(z, h) is an ExactStep.
template <class Code, class Exact>
class Watch {
 public:
  using Real = typename Code::Real;
  // cancels: is grad H what terms of another size leave?
  Watch(Code& code, Exact& exact, bool cancels) : code_(code), exact_(exact), cancels_(cancels) {}

  // One solve of a stepper with exact_state() and step(), of the length h; false if it fails.
  template <class Stepper>
  bool solve(Stepper& stepper, const Equations& equations, Quad h, Defects& defects) {
    const Vector z = stepper.exact_state();
    const Attempt attempt = stepper.step();
    defects.iterations += attempt.iterations;
    if (!attempt.converged) return false;
    ++defects.solves;
    const Vector Z = stepper.exact_state();
    const ExactStep wanted = exact_.step(z, h);
    if (!wanted.converged) {
      ++defects.unknown;
      return true;
    }
    Vector defect(z.size());
    Quad largest = 0;
    Quad furthest = 0;
    bool clear = true;
    for (std::size_t k = 0; k < z.size(); ++k) {
      defect[k] = magnitude(Z[k] - wanted.end[k]);
      furthest = larger(defect[k], furthest);
      largest = larger(magnitude(wanted.end[k]), largest);
      if (!(defect[k] <= Quad(kAllowed) * rounding(wanted.end[k]))) clear = false;
    }
    // Of a state that is nothing but zeros nothing is a part.
    const double units = furthest <= 0 ? 0.0 : static_cast<double>(furthest / rounding(largest));
    if (!(units <= defects.units)) defects.units = units;
    // What rounding Z itself allows need not be looked at, but for a sample.
    if (clear && defects.solves % 64 != 1) return true;
    const Vector bound = equations.stages() == 0
                             ? bound_by_condition(z, wanted.end, h)
                             : bound_by_residual(equations, z, wanted, h, defects);
    double ratio = 0;
    for (std::size_t k = 0; k < bound.size(); ++k) {
      const double here = defect[k] == 0 ? 0 : static_cast<double>(defect[k] / bound[k]);
      if (!(here <= ratio)) ratio = here;
    }
    if (!(ratio <= kAllowed) && solves_its_equations(equations, z, Z, h)) {
      ++defects.elsewhere;
      return true;
    }
    if (!(ratio <= defects.worst)) {
      defects.worst = ratio;
      defects.worst_step = defects.steps;
    }
    if (!(ratio <= kAllowed)) ++defects.broken;
    return true;
  }

 private:
  static Quad rounding(Quad x) { return Quad(Code::epsilon) * magnitude(x); }

  // eps (|x| + part max |x|)
  static Vector rounding(const Vector& x, Quad part) {
    Quad longest = 0;
    for (const Quad value : x) longest = larger(longest, magnitude(value));
    Vector result;
    for (const Quad value : x) result.push_back(rounding(magnitude(value) + part * longest));
    return result;
  }

  // J g
  static Vector turned(const Vector& g) {
    const std::size_t n = g.size() / 2;
    Vector f(g.size());
    for (std::size_t i = 0; i < n; ++i) {
      f[i] = g[n + i];
      f[n + i] = -g[i];
    }
    return f;
  }
  Vector field(const Vector& z) const { return turned(exact_.gradient(z)); }

  // Values lie between two numbers of type Real: the ones that are not the nearest.
  static Vector on_the_other_side(const Vector& values) {
    Vector result;
    for (const Quad value : values) {
      const Real nearest = static_cast<Real>(value);
      const Real far = std::numeric_limits<Real>::max();
      result.push_back(std::nextafter(nearest, static_cast<Quad>(nearest) < value ? far : -far));
    }
    return result;
  }

  // |h J (g(y) - grad H(y))|, f = J grad H(y).
  Vector gradient_error(const Vector& y, const Vector& f, Quad h) const {
    const Vector here = turned(code_.gradient(y));
    const Vector there = turned(code_.gradient(on_the_other_side(y)));
    Vector result(y.size());
    for (std::size_t k = 0; k < y.size(); ++k) {
      result[k] = magnitude(h) * larger(magnitude(here[k] - f[k]), magnitude(there[k] - f[k]));
    }
    return result;
  }
  // The worst of it at y + part way.
  Vector gradient_error(const Vector& y, const Vector& way, std::initializer_list<double> parts,
                        Quad h) const {
    Vector result(y.size());
    for (const double part : parts) {
      Vector point = y;
      for (std::size_t k = 0; k < y.size(); ++k) point[k] += part * way[k];
      const Vector error = gradient_error(point, field(point), h);
      for (std::size_t k = 0; k < y.size(); ++k) result[k] = larger(result[k], error[k]);
    }
    return result;
  }
  static Vector way(const Vector& z, const Vector& Z) {
    Vector result = Z;
    for (std::size_t k = 0; k < z.size(); ++k) result[k] -= z[k];
    return result;
  }

  // Column by column, by central differences, good to 20 digits and more: a dozen would do.
  template <class Map>
  static Matrix jacobian(const Vector& y, const Map& map) {
    const std::size_t size = y.size();
    Matrix result(size, Vector(size));
    for (std::size_t l = 0; l < size; ++l) {
      const Quad step = Quad(1e-11) * (magnitude(y[l]) + Quad(1e-6));
      Vector moved = y;
      moved[l] = y[l] + step;
      const Vector up = map(moved);
      moved[l] = y[l] - step;
      const Vector down = map(moved);
      for (std::size_t k = 0; k < size; ++k) result[k][l] = (up[k] - down[k]) / (2 * step);
    }
    return result;
  }

  Vector bound_by_condition(const Vector& z, const Vector& Z, Quad h) const {
    const Matrix slope =
        jacobian(z, [&](const Vector& start) { return exact_.step(start, h).end; });
    const Vector rounded = rounding(z, 1.0 / 1024);
    const Vector error =
        gradient_error(z, way(z, Z), {0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1}, h);
    Vector bound;
    for (std::size_t k = 0; k < z.size(); ++k) {
      Quad sum = rounding(Z[k]);
      for (std::size_t l = 0; l < z.size(); ++l) {
        sum += magnitude(slope[k][l]) * (rounded[l] + error[l]);
      }
      bound.push_back(sum);
    }
    return bound;
  }

  // The stages of the exact step: of a member zbar = z + (I/2 + C) (Z - z).
  static std::vector<Vector> stages(const Equations& e, const Vector& z, const ExactStep& exact) {
    const std::size_t size = z.size();
    std::vector<Vector> y(e.stages(), z);
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t l = 0; l < e.c.size(); ++l) y[0][k] += e.c[k][l] * (exact.end[l] - z[l]);
      for (std::size_t i = 0; i < y.size() && !e.is_member(); ++i) {
        y[i][k] = exact.stages[i * size + k];
      }
    }
    return y;
  }

  // (a_ij f)_k
  static Quad coupled(const Equations& e, std::size_t i, std::size_t j, std::size_t k,
                      const Vector& f) {
    if (!e.is_member()) return e.a[i][j] * f[k];
    Quad sum = 0;
    for (std::size_t l = 0; l < f.size(); ++l) {
      if (e.c[k][l] != 0) sum += e.c[k][l] * f[l];
    }
    return sum;
  }

  // r of stage j.
  Vector residual_of_rounding(const Equations& e, const Vector& y, const Vector& way,
                              Quad h) const {
    Vector r = rounding(y, 0x1p-40);
    const Vector error = cancels_ ? gradient_error(y, way, {0, -1.0 / 32, 1.0 / 32}, h)
                                  : gradient_error(y, field(y), h);
    for (std::size_t k = 0; k < y.size(); ++k) {
      r[k] += error[k];
      for (std::size_t l = 0; l < e.c.size(); ++l) {
        if (l != k) r[k] += 2 * magnitude(e.c[k][l]) * error[l];
      }
    }
    return r;
  }

  Vector bound_by_residual(const Equations& e, const Vector& z, const ExactStep& exact, Quad h,
                           Defects& defects) const {
    const std::size_t size = z.size();
    const std::size_t s = e.stages();
    const std::vector<Vector> y = stages(e, z, exact);
    // A few digits of A^-1 are enough.
    std::vector<std::vector<double>> a = unit<double>(s * size);
    Matrix lack(s, Vector(size));  // of the exact step
    Vector lack_of_end = z;
    Vector r;
    std::vector<Matrix> back;
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t k = 0; k < size; ++k) lack[i][k] = y[i][k] - z[k];
    }
    for (std::size_t j = 0; j < s; ++j) {
      const Vector f = field(y[j]);
      const Vector rounding_of_stage = residual_of_rounding(e, y[j], way(z, exact.end), h);
      r.insert(r.end(), rounding_of_stage.begin(), rounding_of_stage.end());
      for (std::size_t i = 0; i < s; ++i) {
        for (std::size_t k = 0; k < size; ++k) lack[i][k] -= h * coupled(e, i, j, k, f);
      }
      for (std::size_t k = 0; k < size; ++k) lack_of_end[k] += h * e.b[j] * f[k];
      const Matrix slope = jacobian(y[j], [&](const Vector& at) { return field(at); });
      back.push_back(bring_back(e, j, slope, h));
      for (std::size_t l = 0; l < size; ++l) {
        Vector column(size);
        for (std::size_t k = 0; k < size; ++k) column[k] = slope[k][l];
        for (std::size_t i = 0; i < s; ++i) {
          for (std::size_t k = 0; k < size; ++k) {
            a[i * size + k][j * size + l] -= static_cast<double>(h * coupled(e, i, j, k, column));
          }
        }
      }
    }
    std::vector<std::vector<double>> inverse = unit<double>(s * size);
    if (!contract::solve(a, inverse)) return {};  // any solution is as good as another
    Vector error(s * size);                       // |A^-1| r
    Vector doubt(s * size);                       // |A^-1| |lack|
    for (std::size_t row = 0; row < s * size; ++row) {
      for (std::size_t column = 0; column < s * size; ++column) {
        const Quad entry = std::abs(inverse[row][column]);
        error[row] += entry * r[column];
        doubt[row] += entry * magnitude(lack[column / size][column % size]);
      }
    }
    Quad off = 0;
    // Where the stage is had from the end, its lack says all.
    for (std::size_t k = 0; k < size && e.back.empty(); ++k) {
      off = larger(off, magnitude(exact.end[k] - lack_of_end[k]));
    }
    Vector bound;
    for (std::size_t k = 0; k < size; ++k) {
      Quad here = rounding(exact.end[k]);
      Quad doubt_here = off;
      for (std::size_t row = 0; row < s * size; ++row) {
        const Quad weight = back[row / size][k][row % size];
        here += weight * error[row];
        doubt_here += 2 * weight * doubt[row];
      }
      const double part = static_cast<double>(doubt_here / here);
      if (!(part <= defects.reference)) defects.reference = part;
      bound.push_back(here);
    }
    return bound;
  }

  // Is a member's Z a solution as a step in quad has to be one, if not the same?
  bool solves_its_equations(const Equations& e, const Vector& z, const Vector& Z, Quad h) const {
    if (!e.is_member()) return false;
    Defects own;
    const Vector bound = bound_by_residual(e, z, {.converged = true, .end = Z}, h, own);
    return !bound.empty() && own.reference <= kAllowed;
  }

  // D of stage j as a matrix: h f' is the step's for a member that has no inverse.
  static Matrix bring_back(const Equations& e, std::size_t j, const Matrix& slope, Quad h) {
    if (!e.back.empty()) return e.back;
    Matrix result = unit<Quad>(slope.size());
    for (std::size_t k = 0; k < slope.size(); ++k) {
      if (!e.is_member()) result[k][k] = e.d[j] / 2;
      for (std::size_t l = 0; l < slope.size() && e.is_member(); ++l) {
        result[k][l] += magnitude(h * slope[k][l]);
      }
    }
    return result;
  }

  Code& code_;
  Exact& exact_;
  bool cancels_;
};

}  // namespace hamgen::contract
