#include "app/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "app/initial_data.hpp"
#include "app/interrupt.hpp"
#include "app/load_integrator.hpp"
#include "runtime/extrapolation.hpp"
#include "runtime/sha256.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

constexpr double kTolerance = 1e-28;
constexpr double kCoarseTolerance = 1e-24;

std::string exact_text(const runtime::Wide& value) {
  return fmt::format("{:a} {:a}\n", value.hi, value.lo);
}

std::string reference_key(const PluginSource& plugin, const runtime::InitialValues& start,
                          const runtime::Wide& time) {
  runtime::Sha256 hash;
  hash.update_field("reference 1");
  hash.update_field(plugin.text);
  for (const auto& value : start.parameters) hash.update_field(exact_text(value));
  for (const auto& value : start.state) hash.update_field(exact_text(value));
  hash.update_field(exact_text(time));
  return hash.hex();
}

// The error, then hi and lo of each component: hexadecimal, so nothing is rounded.
std::string text_of(const ReferenceSolution& reference) {
  std::string text = fmt::format("{:a}\n", reference.error);
  for (const auto& value : reference.state) text += exact_text(value);
  return text;
}

ReferenceSolution reference_from(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double value = std::strtod(at, &end);
    if (end == at) break;
    numbers.push_back(value);
  }
  ReferenceSolution reference;
  reference.error = numbers.empty() ? 0.0 : numbers.front();
  for (std::size_t i = 1; i + 1 < numbers.size(); i += 2)
    reference.state.push_back({.hi = numbers[i], .lo = numbers[i + 1]});
  reference.from_cache = true;
  return reference;
}

double largest_difference(const std::vector<runtime::Wide>& x,
                          const std::vector<runtime::Wide>& y) {
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    largest = std::max(largest, std::fabs((x[i].hi - y[i].hi) + (x[i].lo - y[i].lo)));
  return largest;
}

ReferenceSolution compute(const runtime::LoadedPlugin& loaded, const runtime::InitialValues& start,
                          const runtime::Wide& time, const ReferenceRequest& request) {
  // The finer solution takes about two thirds of the work.
  const auto extrapolated = [&](double tolerance, double from, double to) {
    runtime::ExtrapolationOptions options;
    options.tolerance = tolerance;
    options.stop = &interrupt_flag();
    if (request.on_progress)
      options.on_progress = [&request, from, to](double part) {
        request.on_progress(from + part * (to - from));
      };
    return runtime::extrapolate_midpoint(loaded.library, start, time, options);
  };
  ReferenceSolution reference;
  const runtime::Extrapolation coarse = extrapolated(kCoarseTolerance, 0.0, 0.4);
  reference.failure = coarse.failure;
  if (!reference.failure.empty()) return reference;
  const runtime::Extrapolation fine = extrapolated(kTolerance, 0.4, 1.0);
  reference.failure = fine.failure;
  if (!reference.failure.empty()) return reference;
  reference.state = fine.state;
  reference.error = largest_difference(fine.state, coarse.state);
  return reference;
}

}  // namespace

ReferenceSolution reference_solution(const SourceText& source, const SceneValues& scene,
                                     const Rational& time, const ReferenceRequest& request) {
  const auto begin = std::chrono::steady_clock::now();
  Request midpoint;
  midpoint.scheme = "implicit-midpoint";
  midpoint.scalar = "quad";
  midpoint.sizes = request.sizes;
  midpoint.fold = request.fold;
  const PluginSource plugin = generate_plugin(source, midpoint);
  const runtime::LoadedPlugin loaded = load_integrator(plugin, request.compiler);
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  const runtime::Wide end = wide(time);
  const std::string key = reference_key(plugin, start, end);
  const runtime::Cache cache = runtime::open_cache();
  ReferenceSolution reference;
  if (const auto text = runtime::find_text(cache, key)) {
    reference = reference_from(*text);
  } else {
    reference = compute(loaded, start, end, request);
    if (reference.failure.empty() && cache.usable())
      runtime::publish_text(cache, key, text_of(reference));
  }
  reference.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

}  // namespace hamgen::app
