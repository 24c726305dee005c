// Emitted integrators, compiled and loaded, or interpreted, and run in this process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::numerics_test {

using Quad = __float128;
using Vector = std::vector<long double>;

// What few steps show is interpreted, one integrator of a scalar at a time: that compiled code
// takes the same steps is the matter of tests/interpreter.  With HAMGEN_COMPILE_STEPS set, it is
// compiled too.
enum class Steps { compiled, interpreted };

class Emitted {
 public:
  // The model's text without its first line.
  Emitted(const std::string& text, const Request& request, Steps steps = Steps::interpreted);
  // A shipped model by its name, shipped("kepler"), compiled.
  [[nodiscard]] static Emitted shipped(const std::string& name, const Request& request);

  // Default parameters, unless given in the interface's order; state is q then p.
  [[nodiscard]] runtime::Integrator start(const Vector& state, long double h,
                                          const Vector& parameters = {}) const;
  // The state after so many steps; all of them must succeed.
  [[nodiscard]] Vector after(long long steps, const Vector& state, long double h,
                             const Vector& parameters = {}) const;

  [[nodiscard]] const PluginSource& source() const { return source_; }
  [[nodiscard]] const runtime::Library& library() const { return *library_; }

 private:
  Emitted(const SourceText& text, const Request& request, Steps steps);
  PluginSource source_;
  std::shared_ptr<const runtime::Library> library_;
  Vector defaults_;
};

[[nodiscard]] runtime::Wide wide(long double value);
[[nodiscard]] Vector state(const runtime::Integrator& run);
// The largest |a_i - b_i|.
[[nodiscard]] long double distance(const Vector& a, const Vector& b);
// log2 of the ratios of successive errors: orders as observed when h is halved.
[[nodiscard]] std::vector<double> observed_orders(const std::vector<long double>& errors);

}  // namespace hamgen::numerics_test
