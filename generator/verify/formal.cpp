#include "generator/verify/formal.hpp"

#include <stdexcept>

#include "generator/mechanics/generating_series.hpp"

namespace hamgen {

// Of the kinds of points those that are no larger than the scenes: the terms of a series of order
// 10 grow like the tenth power of what they are made of.
FormalPoint::FormalPoint(const Mechanics& mechanics, const Surroundings& around, int number)
    : mechanics_(mechanics) {
  constexpr int kinds[] = {4, 0, 1};
  SamplePoint draw(around, 5 * (number / 3) + kinds[number % 3], 0);
  for (const Quantity& parameter : mechanics.parameters) {
    symbols_[parameter.name] = {draw(parameter.name)};
  }
  symbols_["E0"] = {draw("E0")};
  symbols_["h"] = {precise(0), precise(1)};
  for (const Quantity& variable : mechanics.variables) z_.push_back(draw(variable.name));
  random_ = SamplePoint({}, 4, 5 * number)("h");
}

Precise FormalPoint::spacing(std::size_t i) const {
  static const Precise part = precise(*parse_decimal("1e-20"));
  const Precise size = cln::abs(z_[i]);
  return part * (cln::zerop(size) ? precise(1) : size);
}

std::vector<PowerSeries> FormalPoint::state() const {
  std::vector<PowerSeries> result;
  for (const Precise& z : z_) result.push_back({z});
  return result;
}

std::vector<PowerSeries> FormalPoint::values(const std::vector<Expression>& expressions,
                                             const std::vector<PowerSeries>& state,
                                             std::size_t length) const {
  std::map<std::string, PowerSeries> symbols = symbols_;
  for (std::size_t i = 0; i < state.size(); ++i) symbols[mechanics_.variables.name(i)] = state[i];
  SeriesValues evaluate(std::move(symbols), length);
  std::vector<PowerSeries> result;
  for (const Expression& e : expressions) {
    auto value = evaluate(e);
    if (!value) throw std::domain_error("no value at this point");
    result.push_back(std::move(*value));
  }
  return result;
}

std::map<std::pair<int, int>, PowerSeries> FormalPoint::gauge(const Member& member,
                                                              std::size_t length) const {
  std::map<std::pair<int, int>, PowerSeries> result;
  std::vector<SparseMatrix> limits;
  for (const auto& [place, entry] : member.c) {
    if (const auto value = SeriesValues(symbols_, length)(entry)) {
      result[place] = *value;
      continue;
    }
    if (limits.empty()) limits = gauge_series(member.c, static_cast<int>(length));
    PowerSeries& series = result[place];
    Precise power = precise(1);  // of a step that is a part of h
    for (const SparseMatrix& limit : limits) {
      const auto it = limit.find(place);
      const Expression term = it == limit.end() ? Expression(0) : it->second;
      series.push_back(power * coefficient(values({term}, {}, 1)[0], 0));
      power = power * coefficient(step(), 1);
    }
  }
  return result;
}

std::vector<PowerSeries> rotated(const std::vector<PowerSeries>& gradient) {
  const std::size_t n = gradient.size() / 2;
  std::vector<PowerSeries> result(gradient.begin() + static_cast<std::ptrdiff_t>(n),
                                  gradient.end());
  for (std::size_t i = 0; i < n; ++i) result.push_back(-gradient[i]);
  return result;
}

// (k + 1) z_(k+1) is the coefficient of h^k of J grad H(z).
std::vector<PowerSeries> flow_series(const Derivatives& derivatives, const FormalPoint& point,
                                     std::size_t length) {
  std::vector<PowerSeries> z = point.state();
  for (std::size_t k = 0; k + 1 < length; ++k) {
    const auto field = rotated(point.values(derivatives.gradient(), z, k + 1));
    const Precise divisor = precise(Rational(static_cast<unsigned long>(k + 1)));
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i].resize(k + 1, precise(0));
      z[i].push_back(coefficient(field[i], k) / divisor);
    }
  }
  return z;
}

}  // namespace hamgen
