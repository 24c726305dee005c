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
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
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

// A number, then hi and lo of each component: hexadecimal, so nothing is rounded.
std::string text_of(double first, const std::vector<runtime::Wide>& values) {
  std::string text = fmt::format("{:a}\n", first);
  for (const auto& value : values) text += exact_text(value);
  return text;
}

struct NumberAndValues {
  double first = 0.0;
  std::vector<runtime::Wide> values;
};

NumberAndValues read_numbers(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double value = std::strtod(at, &end);
    if (end == at) break;
    numbers.push_back(value);
  }
  NumberAndValues result{.first = numbers.empty() ? 0.0 : numbers.front()};
  for (std::size_t i = 1; i + 1 < numbers.size(); i += 2)
    result.values.push_back({.hi = numbers[i], .lo = numbers[i + 1]});
  return result;
}

// The integrator that is extrapolated, and where it starts.
struct BaseRule {
  PluginSource plugin;
  runtime::LoadedPlugin loaded;
  runtime::InitialValues start;
};

// Both rules are symmetric and of order 2; the explicit one needs no iterations.
std::string base_scheme(const SourceText& source, const ReferenceRequest& request) {
  const bool separable = derive(read_model(source, request.sizes)).is_separable();
  return separable && find_scheme("stormer-verlet") != nullptr ? "stormer-verlet"
                                                               : "implicit-midpoint";
}

BaseRule load_base_rule(const SourceText& source, const SceneValues& scene,
                        const ReferenceRequest& request) {
  Request quad;
  quad.scheme = base_scheme(source, request);
  quad.scalar = "quad";
  quad.sizes = request.sizes;
  quad.fold = request.fold;
  BaseRule base{.plugin = generate_plugin(source, quad)};
  base.loaded = load_integrator(base.plugin, request.compiler);
  base.start = initial_values(base.plugin, scene, *base.loaded.library);
  return base;
}

std::string reference_key(const BaseRule& base, const std::string& what,
                          const runtime::Wide& time) {
  runtime::Sha256 hash;
  hash.update_field("reference 1");
  hash.update_field(what);
  hash.update_field(base.plugin.text);
  for (const auto& value : base.start.parameters) hash.update_field(exact_text(value));
  for (const auto& value : base.start.state) hash.update_field(exact_text(value));
  hash.update_field(exact_text(time));
  return hash.hex();
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
    return runtime::extrapolate(loaded.library, start, time, options);
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
  BaseRule base;
  try {
    base = load_base_rule(source, scene, request);
  } catch (const runtime::ToolError& error) {  // quad numbers may be more than the compiler can do
    return {.failure = error.failure().message};
  }
  const runtime::Wide end = wide(time);
  const std::string key = reference_key(base, "end", end);
  const runtime::Cache cache = runtime::open_cache();
  ReferenceSolution reference;
  if (const auto text = runtime::find_text(cache, key)) {
    NumberAndValues kept = read_numbers(*text);
    reference = {.state = std::move(kept.values), .error = kept.first, .from_cache = true};
  } else {
    reference = compute(base.loaded, base.start, end, request);
    if (reference.failure.empty() && cache.usable())
      runtime::publish_text(cache, key, text_of(reference.error, reference.state));
  }
  reference.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

std::vector<std::vector<runtime::Wide>> reference_track(const SourceText& source,
                                                        const SceneValues& scene,
                                                        const Rational& interval, int count,
                                                        const ReferenceRequest& request) {
  BaseRule base = load_base_rule(source, scene, request);
  const std::size_t size = base.start.state.size();
  const std::string key = reference_key(base, fmt::format("track {}", count), wide(interval));
  const runtime::Cache cache = runtime::open_cache();
  std::vector<runtime::Wide> all;
  if (const auto text = runtime::find_text(cache, key)) {
    all = read_numbers(*text).values;
  } else {
    runtime::ExtrapolationOptions options{.tolerance = kTolerance, .stop = &interrupt_flag()};
    std::string failure;
    for (int i = 0; i < count && failure.empty(); ++i) {
      const runtime::Extrapolation next =
          runtime::extrapolate(base.loaded.library, base.start, wide(interval), options);
      failure = next.failure;
      if (!failure.empty()) break;
      all.insert(all.end(), next.state.begin(), next.state.end());
      base.start.state = next.state;
      if (request.on_progress) request.on_progress((i + 1.0) / count);
    }
    if (failure.empty() && cache.usable()) runtime::publish_text(cache, key, text_of(0.0, all));
  }
  std::vector<std::vector<runtime::Wide>> track;
  for (auto at = all.begin(); at != all.end(); at += static_cast<std::ptrdiff_t>(size))
    track.emplace_back(at, at + static_cast<std::ptrdiff_t>(size));
  return track;
}

}  // namespace hamgen::app
