#include "generator/verify/linear_step.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "generator/mechanics/generating_series.hpp"

namespace hamgen {

namespace {

using Eigen::MatrixXd;

MatrixXd identity(Eigen::Index size) { return MatrixXd::Identity(size, size); }

MatrixXd values_of(const SparseMatrix& c, int size, const std::map<std::string, Precise>& at) {
  const Substitution none;
  PreciseValues values(at, none);
  MatrixXd matrix = MatrixXd::Zero(size, size);
  for (const auto& [place, entry] : c) {
    const std::optional<Precise> value = values(entry);
    matrix(place.first, place.second) =
        value ? to_double(*value) : std::numeric_limits<double>::quiet_NaN();
  }
  return matrix;
}

std::vector<double> rounded(const std::vector<Expression>& coefficients) {
  std::vector<double> values;
  for (const Expression& e : coefficients) values.push_back(to_double(numeric_value(e)));
  return values;
}

// a x m: blocks a_ij m.
MatrixXd kronecker(const MatrixXd& a, const MatrixXd& m) {
  const Eigen::Index size = m.rows();
  MatrixXd result(a.rows() * size, a.cols() * size);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      result.block(i * size, j * size, size, size) = a(i, j) * m;
  }
  return result;
}

}  // namespace

MatrixXd linear_flow(const MatrixXd& s) {
  const Eigen::Index n = s.rows() / 2;
  MatrixXd a(2 * n, 2 * n);
  a << s.bottomRows(n), -s.topRows(n);
  return a;
}

LinearStep::LinearStep(Scheme scheme, std::map<std::string, Precise> values)
    : scheme_(std::move(scheme)), values_(std::move(values)) {
  if (const auto* splitting = std::get_if<Splitting>(&scheme_.method)) {
    kicks_ = rounded(splitting->kicks);
    drifts_ = rounded(splitting->drifts);
  } else if (const auto* composition = std::get_if<Composition>(&scheme_.method)) {
    substeps_ = rounded(composition->substeps);
  } else if (const auto* tableau = std::get_if<RungeKutta>(&scheme_.method)) {
    const auto stages = static_cast<Eigen::Index>(tableau->b.size());
    a_.resize(stages, stages);
    b_.resize(stages);
    for (Eigen::Index i = 0; i < stages; ++i) {
      const std::vector<double> row = rounded(tableau->a[static_cast<std::size_t>(i)]);
      for (Eigen::Index j = 0; j < stages; ++j) a_(i, j) = row[static_cast<std::size_t>(j)];
      b_(i) = to_double(numeric_value(tableau->b[static_cast<std::size_t>(i)]));
    }
  }
}

MatrixXd LinearStep::gauge(const Member& member, double h) const {
  std::map<std::string, Precise> at = values_;
  at.insert_or_assign("h", precise(from_double(h)));
  return values_of(member.c, 2 * member.degrees_of_freedom, at);
}

MatrixXd LinearStep::increment(const Member& member, double h, const MatrixXd& s) const {
  const MatrixXd a = linear_flow(s);
  if (member.generating_order <= 0) return h * a;
  const auto order = static_cast<std::size_t>(member.generating_order);
  const Eigen::Index size = a.rows();
  std::vector<MatrixXd> c;  // by powers of h
  for (const SparseMatrix& term : gauge_series(member.c, member.generating_order))
    c.push_back(values_of(term, static_cast<int>(size), values_));
  std::vector<MatrixXd> flow{identity(size)};
  for (std::size_t k = 1; k <= order; ++k) flow.push_back(flow.back() * a / static_cast<double>(k));
  // D = (I/2 + C) E + I/2 - C = I + ..., and X D = E - I.
  std::vector<MatrixXd> divisor{identity(size)};
  std::vector<MatrixXd> x{MatrixXd::Zero(size, size)};
  MatrixXd sum = x[0];
  double power = 1.0;
  for (std::size_t k = 1; k <= order; ++k) {
    MatrixXd d = flow[k] / 2.0;
    for (std::size_t l = 0; l < k; ++l) d += c[l] * flow[k - l];
    MatrixXd term = flow[k];
    for (std::size_t l = 1; l < k; ++l) term -= x[l] * divisor[k - l];
    divisor.push_back(std::move(d));
    power *= h;
    sum += power * term;
    x.push_back(std::move(term));
  }
  return sum;
}

MatrixXd LinearStep::member_matrix(const Member& member, double h, const MatrixXd& s) const {
  const MatrixXd x = increment(member, h, s);
  const MatrixXd c = gauge(member, h);
  const MatrixXd one = identity(x.rows());
  return (one - x * (one / 2.0 + c)).lu().solve(one + x * (one / 2.0 - c));
}

MatrixXd LinearStep::splitting_matrix(double h, const MatrixXd& s) const {
  const Eigen::Index n = s.rows() / 2;
  MatrixXd result = identity(2 * n);
  std::size_t kick = 0;
  std::size_t drift = 0;
  bool kicks = std::get<Splitting>(scheme_.method).kick_first;
  for (; kick < kicks_.size() || drift < drifts_.size(); kicks = !kicks) {
    if (kicks && kick < kicks_.size()) {
      result.bottomRows(n) -= kicks_[kick++] * h * s.topLeftCorner(n, n) * result.topRows(n);
    } else if (!kicks && drift < drifts_.size()) {
      result.topRows(n) += drifts_[drift++] * h * s.bottomRightCorner(n, n) * result.bottomRows(n);
    }
  }
  return result;
}

MatrixXd LinearStep::tableau_matrix(const MatrixXd& ha) const {
  const Eigen::Index size = ha.rows();
  MatrixXd ones(a_.rows() * size, size);
  for (Eigen::Index i = 0; i < a_.rows(); ++i) ones.middleRows(i * size, size) = identity(size);
  const MatrixXd z = (identity(ones.rows()) - kronecker(a_, ha)).lu().solve(ones);
  MatrixXd result = identity(size);
  for (Eigen::Index i = 0; i < a_.rows(); ++i) result += b_(i) * ha * z.middleRows(i * size, size);
  return result;
}

MatrixXd LinearStep::matrix(double h, const MatrixXd& s) const {
  if (const auto* member = std::get_if<Member>(&scheme_.method))
    return member_matrix(*member, h, s);
  if (std::holds_alternative<Splitting>(scheme_.method)) return splitting_matrix(h, s);
  if (std::holds_alternative<RungeKutta>(scheme_.method)) return tableau_matrix(h * linear_flow(s));
  const Member& base = std::get<Composition>(scheme_.method).base;
  MatrixXd result = identity(s.rows());
  for (const double part : substeps_) result = member_matrix(base, part * h, s) * result;
  return result;
}

MatrixXd LinearStep::iteration(double h, const MatrixXd& s) const {
  if (const auto* tableau = std::get_if<RungeKutta>(&scheme_.method)) {
    if (tableau->is_explicit()) return {};
    return kronecker(a_, h * linear_flow(s));
  }
  if (!scheme_.has_member()) return {};
  double largest = substeps_.empty() ? 1.0 : 0.0;
  for (const double part : substeps_) {
    if (std::abs(part) > std::abs(largest)) largest = part;
  }
  const Member& member = scheme_.member();
  return (identity(s.rows()) / 2.0 + gauge(member, largest * h)) *
         increment(member, largest * h, s);
}

}  // namespace hamgen
