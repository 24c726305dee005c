// What is measured: every method in every storage, on a problem where exact arithmetic keeps
// something.
#pragma once

#include "benchmarks/drift/measure.hpp"

namespace hamgen::drift {

[[nodiscard]] std::vector<Row> all_rows();

// The problems, as text of a model.
[[nodiscard]] std::string oscillator();  // w = 1.3
[[nodiscard]] std::string chain(int n);  // harmonic, fixed ends, in loops from n = 25
// The same, but the generator cannot know.
[[nodiscard]] std::string soft_chain(int n, const std::string& k = "1.3");
// A ring of springs, each mass tied to its place: H is a quadratic form.
[[nodiscard]] std::string ring(int n);
[[nodiscard]] std::string kepler();              // L is its first invariant
[[nodiscard]] std::string planar_bodies(int n);  // soft attraction, all pairs; L
// Oscillators whose frequency is their energy, weakly coupled in coordinates and momenta.
[[nodiscard]] std::string beating_ring(int n, const std::string& coupling = "1/30");
// A member whose alpha is a list: the sums are written out whatever n is.
[[nodiscard]] std::string list_of(int n, const std::string& value);

}  // namespace hamgen::drift
