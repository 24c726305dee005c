// Frequency analysis of quasi-periodic signals.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace hamgen::app {

// amplitude exp(i frequency t), t from 0 at the first sample; frequency in radians per time.
struct Harmonic {
  double frequency = 0.0;
  std::complex<double> amplitude;
};

// The leading harmonics of a signal sampled at distance dt, the largest first, to about 1/T^4 for
// a signal of length T whose frequencies are apart: each is where the windowed mean of signal times
// exp(-i w t) is largest once those before it are taken away.  At most `count`; fewer where nothing
// is left but rounding.
//   J. Laskar: The chaotic motion of the solar system, Icarus 88 (1990) 266; Frequency analysis for
//   multi-dimensional systems, Physica D 67 (1993) 257.
[[nodiscard]] std::vector<Harmonic> leading_harmonics(std::span<const std::complex<double>> signal,
                                                      double dt, int count);

}  // namespace hamgen::app
