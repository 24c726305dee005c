#include "app/studies/frequencies.hpp"

#include <Eigen/Dense>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hamgen::app {
namespace {

using Complex = std::complex<double>;
using Signal = std::vector<Complex>;

// Hann's, of mean 1.
double window(std::size_t k, std::size_t count) {
  const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
  return 1.0 - std::cos(turn);
}

Complex wave(double frequency, double dt, std::size_t k) {
  return std::polar(1.0, frequency * dt * static_cast<double>(k));
}

// The windowed mean of signal exp(-i w t).
Complex mean(const Signal& signal, double frequency, double dt) {
  Complex sum = 0.0;
  for (std::size_t k = 0; k < signal.size(); ++k)
    sum += window(k, signal.size()) * signal[k] * std::conj(wave(frequency, dt, k));
  return sum / static_cast<double>(signal.size());
}

// Half of the slope of |mean|^2 by the frequency: its zero is found to rounding, where the place of
// a maximum is found to the root of it.
double slope_of_mean(const Signal& signal, double frequency, double dt) {
  Complex sum = 0.0;
  Complex turned = 0.0;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const Complex term = window(k, signal.size()) * signal[k] * std::conj(wave(frequency, dt, k));
    sum += term;
    turned += Complex(0.0, -dt * static_cast<double>(k)) * term;
  }
  return (std::conj(sum) * turned).real();
}

// Of the largest peak of the spectrum, between its neighbours.
double strongest_frequency(const Signal& signal, double dt) {
  Signal windowed(signal);
  for (std::size_t k = 0; k < signal.size(); ++k) windowed[k] *= window(k, signal.size());
  Signal spectrum;
  Eigen::FFT<double> transform;
  transform.fwd(spectrum, windowed);
  std::size_t peak = 0;
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    if (std::norm(spectrum[k]) > std::norm(spectrum[peak])) peak = k;
  }
  const auto size = static_cast<double>(signal.size());
  double place = static_cast<double>(peak);
  if (2 * peak > signal.size()) place -= size;
  const double unit = 2.0 * std::numbers::pi / (size * dt);
  const double low = (place - 1.0) * unit;
  const double high = (place + 1.0) * unit;
  const auto slope = [&](double frequency) { return slope_of_mean(signal, frequency, dt); };
  const double at_low = slope(low);
  const double at_high = slope(high);
  if (!(at_low > 0.0 && at_high < 0.0)) return place * unit;  // two peaks that touch
  std::uintmax_t iterations = 60;
  const auto root = boost::math::tools::toms748_solve(
      slope, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(52), iterations);
  return 0.5 * (root.first + root.second);
}

// The windowed mean of exp(i (w - v) t).
Complex overlap(double w, double v, double dt, std::size_t count) {
  Complex sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += window(k, count) * wave(w - v, dt, k);
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<Harmonic> leading_harmonics(std::span<const Complex> signal, double dt, int count) {
  constexpr double kNothing = 1e-14;  // of the signal's size
  const Signal whole(signal.begin(), signal.end());
  Signal rest = whole;
  double size = 0.0;
  for (const Complex& x : whole) size = std::max(size, std::abs(x));
  std::vector<double> found;
  Eigen::VectorXcd amplitudes;
  for (int i = 0; i < count && whole.size() >= 8; ++i) {
    const double frequency = strongest_frequency(rest, dt);
    if (!(std::abs(mean(rest, frequency, dt)) > kNothing * size)) break;
    found.push_back(frequency);
    // The amplitudes of all so far together: their waves are not orthogonal.
    const auto n = static_cast<Eigen::Index>(found.size());
    Eigen::MatrixXcd gram(n, n);
    Eigen::VectorXcd right(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const double w = found[static_cast<std::size_t>(a)];
      right[a] = mean(whole, w, dt);
      for (Eigen::Index b = 0; b < n; ++b)
        gram(a, b) = overlap(found[static_cast<std::size_t>(b)], w, dt, whole.size());
    }
    amplitudes = gram.fullPivLu().solve(right);
    rest = whole;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      for (Eigen::Index a = 0; a < n; ++a)
        rest[k] -= amplitudes[a] * wave(found[static_cast<std::size_t>(a)], dt, k);
    }
  }
  std::vector<Harmonic> harmonics;
  for (std::size_t i = 0; i < found.size(); ++i)
    harmonics.push_back({found[i], amplitudes[static_cast<Eigen::Index>(i)]});
  return harmonics;
}

}  // namespace hamgen::app
