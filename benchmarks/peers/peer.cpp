#include "benchmarks/peers/peer.hpp"

namespace hamgen::peers {

namespace {

Form form_of(const Flow& flow, const std::vector<double>& z) {
  const std::size_t n = flow.n();
  std::vector<double> moved = z;
  for (std::size_t i = 0; i < n; ++i) moved[n + i] += 0.3 + 0.1 * static_cast<double>(i);
  std::vector<double> elsewhere = moved;
  for (std::size_t i = 0; i < n; ++i) elsewhere[i] += 0.01 * static_cast<double>(i + 1);
  std::vector<double> gradient(2 * n);
  std::vector<double> other(2 * n);
  std::vector<double> third(2 * n);
  flow.gradient(z.data(), gradient.data());
  flow.gradient(moved.data(), other.data());
  flow.gradient(elsewhere.data(), third.data());
  bool unit_mass = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (gradient[i] != other[i] || third[n + i] != other[n + i]) return Form::any;
    unit_mass = unit_mass && other[n + i] == moved[n + i];
  }
  return unit_mass ? Form::unit_mass : Form::separable;
}

}  // namespace

Form Flow::form(const std::vector<double>& z) const {
  if (!form_) form_ = form_of(*this, z);
  return *form_;
}

}  // namespace hamgen::peers
