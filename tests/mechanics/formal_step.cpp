#include "tests/mechanics/formal_step.hpp"

#include <stdexcept>

#include "generator/base/source_text.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"

namespace hamgen::mechanics_test {

namespace {

std::vector<std::string> names(const Mechanics& mechanics) {
  std::vector<std::string> result;
  for (const Quantity& v : mechanics.variables) result.push_back(v.name);
  for (const Quantity& p : mechanics.parameters) result.push_back(p.name);
  result.emplace_back("h");
  return result;
}

Vector inputs(const Vector& z, const Vector& parameters, long double h) {
  Vector result = z;
  result.insert(result.end(), parameters.begin(), parameters.end());
  result.push_back(h);
  return result;
}

Vector defaults(const Mechanics& mechanics) {
  Vector result;
  for (const Quantity& p : mechanics.parameters) result.push_back(number(p.value));
  return result;
}

std::vector<Expression> values(const std::map<std::pair<int, int>, Expression>& matrix) {
  std::vector<Expression> result;
  for (const auto& [place, value] : matrix) result.push_back(value);
  return result;
}

// J v.
Vector rotated(const Vector& v) {
  const std::size_t n = v.size() / 2;
  Vector result(v.size());
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = v[n + i];
    result[n + i] = -v[i];
  }
  return result;
}

Vector sum(const Vector& a, long double factor, const Vector& b) {
  Vector result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] += factor * b[i];
  return result;
}

Vector classical(const Tape& slopes, const Vector& parameters, Vector z, long double t, int n) {
  const long double h = t / n;
  const auto f = [&](const Vector& x) { return rotated(slopes(inputs(x, parameters, 0))); };
  for (int i = 0; i < n; ++i) {
    const Vector k1 = f(z);
    const Vector k2 = f(sum(z, h / 2, k1));
    const Vector k3 = f(sum(z, h / 2, k2));
    const Vector k4 = f(sum(z, h, k3));
    z = sum(sum(sum(sum(z, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  return z;
}

}  // namespace

Mechanics mechanics_of(const std::string& text) {
  return derive(read_model(make_source("test.ham", "system test\n" + text)), false);
}

Mechanics shipped(const std::string& name) {
  return derive(read_model(read_source(HAMGEN_SOURCE_DIR "/hamiltonians/" + name + ".ham")), false);
}

Scheme scheme_of(const Mechanics& mechanics, const Gauge& gauge) {
  const Model model =
      read_model(make_source("gauge.ham", "system g\ncoordinate q\nmomentum p\nH = p\n"));
  const auto value = [&](const std::string& text) {
    return GaugeBlock{
        .entries = {scheme_parameter(model, "alpha", read_expression("alpha", text, {"h"}))}};
  };
  return family_member(mechanics.degrees_of_freedom, value(gauge.alpha), value(gauge.beta),
                       value(gauge.gamma));
}

FormalStep::FormalStep(const Mechanics& mechanics, const Member& member,
                       const std::vector<Expression>& slopes)
    : parameters_(defaults(mechanics)),
      slopes_(slopes, names(mechanics)),
      matrix_(values(stage_matrix(of_all(member, mechanics.degrees_of_freedom))),
              names(mechanics)) {
  for (const auto& [place, value] : stage_matrix(of_all(member, mechanics.degrees_of_freedom)))
    places_.push_back(place);
}

Vector FormalStep::after(int steps, const Vector& start, long double h) const {
  Vector z = start;
  const Vector entries = matrix_(inputs(z, parameters_, h));
  for (int step = 0; step < steps; ++step) {
    Vector bar = z;
    Vector slope;
    long double previous = HUGE_VALL;
    for (int iteration = 0;; ++iteration) {
      if (iteration == 500) throw std::runtime_error("the stage value does not converge");
      slope = slopes_(inputs(bar, parameters_, h));
      Vector next = z;
      for (std::size_t k = 0; k < places_.size(); ++k) {
        const auto [row, column] = places_[k];
        next[static_cast<std::size_t>(row)] +=
            h * entries[k] * slope[static_cast<std::size_t>(column)];
      }
      long double size = 0;
      for (std::size_t i = 0; i < z.size(); ++i) size += std::abs(next[i] - bar[i]);
      bar = next;
      if (size == 0 || (size < 1e-17L && size >= previous)) break;
      previous = size;
    }
    z = sum(z, h, rotated(slope));
  }
  return z;
}

Vector flow(const Mechanics& mechanics, const Vector& start, long double t, int n) {
  const Tape slopes(mechanics.gradient, names(mechanics));
  const Vector parameters = defaults(mechanics);
  const Vector coarse = classical(slopes, parameters, start, t, n);
  const Vector fine = classical(slopes, parameters, start, t, 2 * n);
  return sum(fine, 1 / 15.0L, sum(fine, -1, coarse));
}

std::vector<double> observed_orders(const FormalStep& step, const Vector& start, long double t,
                                    int n, const Vector& exact) {
  std::vector<double> orders;
  long double before = 0;
  for (const int factor : {1, 2, 4}) {
    const Vector z = step.after(n * factor, start, t / (n * factor));
    long double error = 0;
    for (std::size_t i = 0; i < z.size(); ++i) error = std::hypot(error, z[i] - exact[i]);
    if (factor > 1) orders.push_back(static_cast<double>(std::log2(before / error)));
    before = error;
  }
  return orders;
}

}  // namespace hamgen::mechanics_test
