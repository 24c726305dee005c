#include "generator/schemes/matrix_function.hpp"

#include <ginac/ginac.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "generator/algebra/balance.hpp"
#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::cpp_bin_float<70>, mp::et_off>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

// What the eigenvalues of a matrix in 70 digits agree to if they are equal, relative to the
// largest.
const Real kSame("1e-30");
// Eigenvectors worse conditioned than this belong to a matrix that is not diagonalisable.
const Real kWorst("1e12");

Real to_real(const Rational& value) {
  return Real(value.get_num().get_str()) / Real(value.get_den().get_str());
}

// The simplest fraction within 1e-45 of the value, relative to it, if it is short; else its first
// 50 digits.
Rational to_rational(const Real& value) {
  Integer p0 = 0, q0 = 1, p1 = 1, q1 = 0;
  Real rest = value;
  for (int i = 0; i < 24 && q1 < 1000000; ++i) {
    const Real whole = floor(rest);
    const Integer a(whole.convert_to<mp::cpp_int>().str());
    const Integer p2 = a * p1 + p0;
    const Integer q2 = a * q1 + q0;
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    const Rational fraction(p1, q1);
    if (abs(to_real(fraction) - value) <= abs(value) * Real("1e-45")) return fraction;
    rest = 1 / (rest - whole);
  }
  const std::string digits = Real(abs(value)).str(50, std::ios::scientific);
  const Rational magnitude = parse_decimal(digits).value();
  return value < 0 ? Rational(-magnitude) : magnitude;
}

RationalMatrix to_rational(const Matrix& matrix) {
  const Real scale = matrix.cwiseAbs().maxCoeff();
  RationalMatrix result(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const bool zero = abs(matrix(i, j)) <= scale * Real("1e-40");
      result[static_cast<std::size_t>(i)].push_back(zero ? Rational(0) : to_rational(matrix(i, j)));
    }
  }
  return result;
}

Expression h() { return Expression::symbol("h", kRankOfStep); }

Expression number(const Real& value) { return Expression(to_rational(value)); }

Expression call(const char* name, const Expression& x) { return Expression::apply(name, {x}); }

RationalMatrix product(const RationalMatrix& a, const RationalMatrix& b) {
  RationalMatrix result(a.size(), std::vector<Rational>(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (sgn(a[i][k]) == 0) continue;
      for (std::size_t j = 0; j < a.size(); ++j) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

bool is_zero(const RationalMatrix& a) {
  return std::ranges::all_of(a, [](const auto& row) {
    return std::ranges::all_of(row, [](const Rational& x) { return sgn(x) == 0; });
  });
}

// f(x) = - sum B_2k x^(2k-1) / (2k)!, which ends for a nilpotent A.  Empty if A is not nilpotent.
std::vector<MatrixTerm> nilpotent_terms(const RationalMatrix& a) {
  std::vector<MatrixTerm> terms;
  const RationalMatrix square = product(a, a);
  RationalMatrix power = a;
  for (int k = 1; !is_zero(power); ++k) {
    if (2 * k - 1 > static_cast<int>(a.size())) return {};
    const GiNaC::ex coefficient = -GiNaC::bernoulli(2 * k) / GiNaC::factorial(2 * k);
    const Expression factor(hamgen::to_rational(GiNaC::ex_to<GiNaC::numeric>(coefficient)));
    terms.push_back({factor * Expression::power(h(), Expression(2 * k - 1)), power});
    power = product(power, square);
  }
  return terms;
}

// Eigenvalues a +- i b of A^2 that are one, with the projector P on their space.
struct Cluster {
  Real a, b;
  Matrix projector;
};

std::vector<Cluster> clusters(const Matrix& square) {
  const Eigen::EigenSolver<Matrix> solver(square);
  const Matrix vectors = solver.pseudoEigenvectors();
  const Eigen::FullPivLU<Matrix> lu(vectors);
  const Matrix inverse = lu.isInvertible() ? Matrix(lu.inverse()) : Matrix();
  const auto largest_row = [](const Matrix& m) { return m.cwiseAbs().rowwise().sum().maxCoeff(); };
  if (solver.info() != Eigen::Success || inverse.size() == 0 ||
      largest_row(vectors) * largest_row(inverse) > kWorst) {
    throw UsageError(
        "--gauge locally-exact: the linear part at the reference has a multiple frequency without "
        "enough modes, its matrix is not diagonalisable\n"
        "help: choose another point with --reference");
  }
  const auto& values = solver.eigenvalues();
  const Real scale = values.cwiseAbs().maxCoeff();
  std::vector<Cluster> result;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    Real a = values(i).real();
    Real b = abs(values(i).imag());
    if (b <= scale * kSame) b = 0;
    if (b == 0 && abs(a) <= scale * kSame) a = 0;
    const Matrix projector = vectors.col(i) * inverse.row(i);
    const auto same = std::ranges::find_if(result, [&](const Cluster& c) {
      return abs(c.a - a) <= scale * kSame && abs(c.b - b) <= scale * kSame;
    });
    if (same == result.end()) {
      result.push_back({a, b, projector});
    } else {
      same->projector += projector;
    }
  }
  return result;
}

// Note [no difference of poles]
// With x = y/2 the poles of 1/y - coth(y/2)/2 and of cot(y/2)/2 - 1/y at 0 cancel, and of a small x
// the difference of what is left has nothing of worth.  Halves of x take the pole away:
//   coth x - 1/x = sum_(k = 1..n) 2^-k tanh(x/2^k) + 2^-n (coth t - 1/t),  t = x/2^n,
//   1/x - cot x  = sum_(k = 1..n) 2^-k tan(x/2^k)  + 2^-n (1/t - cot t),
// by coth t = (tanh(t/2) + coth(t/2))/2, and what remains is Lambert's continued fraction
//   coth t - 1/t = t/(3 + t^2/(5 + t^2/(7 + ...))),  1/t - cot t = t/(3 - t^2/(5 - t^2/(7 - ...))).
// The terms are of one sign, for tan up to x = pi.  Ended after 2m + 1 the fraction lacks
// 3 t^2m / ((2m + 1)!!^2 (2m + 3)) of itself: with n = 12 and m = 8 that is less than the rounding
// of quad up to y = 1000, and than that of double up to y = 10000.
constexpr int kHalvings = 12;
constexpr int kLastOfFraction = 17;

// (coth x - 1/x)/(2h), or of tan and cot (1/x - cot x)/(2h), where x = rate h.
Expression half_of_rest(const Real& rate, bool oscillates) {
  std::vector<Expression> terms;
  Real part = rate;
  Rational weight(1, 2);
  for (int k = 1; k <= kHalvings; ++k) {
    part /= 2;
    weight /= 2;
    terms.push_back(Expression(weight) * call(oscillates ? "tan" : "tanh", number(part) * h()) /
                    h());
  }
  const Expression square = number(oscillates ? Real(-part * part) : Real(part * part)) * h() * h();
  Expression fraction(kLastOfFraction);
  for (int odd = kLastOfFraction - 2; odd >= 3; odd -= 2) {
    fraction = Expression(odd) + square / fraction;
  }
  terms.push_back(Expression(weight) * number(part) / fraction);
  return Expression::sum(std::move(terms));
}

// The same of coth at x = (s + i w) h, real and imaginary part, with
//   tanh(u + i v) = (sinh u cosh u + i sin v cos v)/(sinh^2 u + cos^2 v),
// divided by cosh(u)^2, which may overflow.  What remains is its series
//   coth t - 1/t = sum_(j = 1..) B_2j 2^2j t^(2j-1)/(2j)!,
// real and imaginary part for themselves: its first term is the only one of weight.
constexpr int kTermsOfSeries = 9;

std::pair<Expression, Expression> half_of_complex_rest(const Real& s, const Real& w) {
  std::vector<Expression> real;
  std::vector<Expression> imaginary;
  Real part_s = s;
  Real part_w = w;
  Rational weight(1, 2);
  for (int k = 1; k <= kHalvings; ++k) {
    part_s /= 2;
    part_w /= 2;
    weight /= 2;
    const Expression u = number(part_s) * h();
    const Expression v = number(part_w) * h();
    const Expression tangent = call("tanh", u);
    const Expression sine = call("sin", v) / call("cosh", u);
    const Expression cosine = call("cos", v) / call("cosh", u);
    const Expression denominator = tangent * tangent + cosine * cosine;
    real.push_back(Expression(weight) * tangent / denominator / h());
    imaginary.push_back(Expression(weight) * sine * cosine / denominator / h());
  }
  // With t = r e^(i a) its terms are r^(2j-1) times a number near one: nested in r^2, for the
  // powers of a small r may be no numbers any more.
  const Real modulus = sqrt(part_s * part_s + part_w * part_w);
  const Real angle = atan2(part_w, part_s);
  const Expression square = number(Real(modulus * modulus)) * h() * h();
  const auto nested = [&](const auto& part) {
    Expression sum;
    for (int j = kTermsOfSeries; j >= 1; --j) {
      const GiNaC::ex exact = GiNaC::bernoulli(2 * j) * GiNaC::pow(4, j) / GiNaC::factorial(2 * j);
      const Real factor = to_real(hamgen::to_rational(GiNaC::ex_to<GiNaC::numeric>(exact)));
      sum = number(factor * part(Real((2 * j - 1) * angle))) + square * sum;
    }
    return Expression(weight) * number(modulus) * sum;
  };
  real.push_back(nested([](const Real& x) { return Real(cos(x)); }));
  imaginary.push_back(nested([](const Real& x) { return Real(sin(x)); }));
  return {Expression::sum(std::move(real)), Expression::sum(std::move(imaginary))};
}

// Rates below this do not turn in any step: f(x) = -x/12 to the last place for h below 1e20.
const Real kAtRest("1e-40");

void add_terms(const Matrix& a, const Cluster& cluster, MatrixFunction& result) {
  const Matrix linear = a * cluster.projector;
  if (sqrt(abs(cluster.a) + cluster.b) < kAtRest) {
    result.terms.push_back({-h() / Expression(12), to_rational(linear)});
    return;
  }
  if (cluster.b == 0) {
    // Eigenvalues +-i w or +-s of A.
    const bool oscillates = cluster.a < 0;
    const Real rate = sqrt(abs(cluster.a));
    const Expression function = -h() * half_of_rest(rate / 2, oscillates);
    result.terms.push_back({function, to_rational(Matrix(linear / rate))});
    if (oscillates) result.frequencies.push_back(to_rational(rate));
    return;
  }
  // Eigenvalues +-(s +- i w): with f(h(s + i w)) = F + i G and Q = (A^2 - a) P / b, whose square is
  // -P, the part is A (Re((F + i G)/(s + i w)) P + Im((F + i G)/(s + i w)) Q).
  const Real modulus = sqrt(cluster.a * cluster.a + cluster.b * cluster.b);
  const Real s = sqrt((modulus + cluster.a) / 2);
  const Real w = sqrt((modulus - cluster.a) / 2);
  const Matrix turned =
      a * ((a * a - cluster.a * Matrix::Identity(a.rows(), a.cols())) * cluster.projector) /
      cluster.b;
  const auto [real, imaginary] = half_of_complex_rest(s / 2, w / 2);
  result.terms.push_back({-h() * real, to_rational(Matrix((s * linear - w * turned) / modulus))});
  result.terms.push_back(
      {-h() * imaginary, to_rational(Matrix((w * linear + s * turned) / modulus))});
}

std::vector<std::vector<double>> rounded(const RationalMatrix& a) {
  std::vector<std::vector<double>> result;
  for (const auto& row : a) {
    result.emplace_back();
    for (const Rational& x : row) result.back().push_back(to_double(x));
  }
  return result;
}

}  // namespace

MatrixFunction gauge_function(const RationalMatrix& a) {
  MatrixFunction result;
  result.terms = nilpotent_terms(a);
  if (!result.terms.empty() || is_zero(a)) return result;
  const auto size = static_cast<Eigen::Index>(a.size());
  Matrix matrix(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      matrix(i, j) = to_real(a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
    }
  }
  // In units of the variables in which rows and columns are of one size, and back: what
  // eigenvectors there are does not depend on units, how well they are told apart does.
  const std::vector<int> units = balance(rounded(a));
  const auto in_units = [&units](auto i, auto j) {
    return units[static_cast<std::size_t>(j)] - units[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) matrix(i, j) = ldexp(matrix(i, j), in_units(i, j));
  }
  for (const Cluster& cluster : clusters(matrix * matrix)) add_terms(matrix, cluster, result);
  for (MatrixTerm& term : result.terms) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < a.size(); ++j) term.matrix[i][j] *= power_of_two(-in_units(i, j));
    }
  }
  return result;
}

}  // namespace hamgen
