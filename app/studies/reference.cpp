#include "app/studies/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "runtime/extrapolation.hpp"
#include "runtime/processor_time.hpp"
#include "runtime/sha256.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

constexpr double kTolerance = 1e-28;
constexpr double kCoarseTolerance = 1e-24;

std::string exact_text(const runtime::Wide& value) {
  return fmt::format("{:a} {:a}\n", value.hi, value.lo);
}

// Numbers, then hi and lo of each component: hexadecimal, so nothing is rounded.
std::string text_of(const std::vector<double>& numbers, const std::vector<runtime::Wide>& values) {
  std::string text = fmt::format("{}\n", numbers.size());
  for (const double number : numbers) text += fmt::format("{:a}\n", number);
  for (const auto& value : values) text += exact_text(value);
  return text;
}

struct NumbersAndValues {
  std::vector<double> numbers;
  std::vector<runtime::Wide> values;
};

NumbersAndValues read_numbers(const std::string& text) {
  char* at = nullptr;
  const unsigned long count = std::strtoul(text.c_str(), &at, 10);
  std::vector<double> all;
  for (char* end = nullptr;; at = end) {
    const double value = std::strtod(at, &end);
    if (end == at) break;
    all.push_back(value);
  }
  NumbersAndValues result;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, all.size()); ++i)
    result.numbers.push_back(all[i]);
  for (std::size_t i = count; i + 1 < all.size(); i += 2)
    result.values.push_back({.hi = all[i], .lo = all[i + 1]});
  return result;
}

// Both rules are symmetric and of order 2; the explicit one needs no iterations.
std::string base_scheme(const SourceText& source, const ReferenceRequest& request) {
  const bool separable = derive(read_model(source, request.sizes)).is_separable();
  return separable && find_scheme("stormer-verlet") != nullptr ? "stormer-verlet"
                                                               : "implicit-midpoint";
}

std::string reference_key(const ReferenceRule& rule, const runtime::InitialValues& start,
                          const std::string& what, const std::vector<Rational>& times) {
  runtime::Sha256 hash;
  hash.update_field("reference 2");
  hash.update_field(what);
  hash.update_field(rule.plugin.text);
  for (const auto& value : start.parameters) hash.update_field(exact_text(value));
  for (const auto& value : start.state) hash.update_field(exact_text(value));
  for (const Rational& time : times) hash.update_field(exact_text(wide(time)));
  return hash.hex();
}

double largest_difference(const std::vector<runtime::Wide>& x,
                          const std::vector<runtime::Wide>& y) {
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    largest = std::max(largest, std::fabs((x[i].hi - y[i].hi) + (x[i].lo - y[i].lo)));
  return largest;
}

// Both tolerances side by side from time to time, until one of them fails or the time is over.
ReferenceTrack compute_track(const std::shared_ptr<const runtime::Library>& library,
                             const runtime::InitialValues& start,
                             const std::vector<Rational>& times, double seconds, StopFlag stop) {
  const double begin = runtime::thread_seconds();
  std::atomic<bool> late = false;
  runtime::ExtrapolationOptions options{.stop = &late};
  options.on_progress = [&](double) {
    late = late || runtime::thread_seconds() - begin > seconds || is_stopped(stop);
  };
  ReferenceTrack track;
  runtime::InitialValues coarse = start;
  runtime::InitialValues fine = start;
  Rational before = 0;
  for (const Rational& time : times) {
    for (auto [values, tolerance] :
         {std::pair{&coarse, kCoarseTolerance}, std::pair{&fine, kTolerance}}) {
      options.tolerance = tolerance;
      const runtime::Extrapolation next =
          runtime::extrapolate(library, *values, wide(time - before), options);
      if (!next.failure.empty()) {
        track.missing =
            fmt::format("the reference ends at t = {:.4g}: {}", to_double(before) + next.reached,
                        late ? fmt::format("{:.2g} s are over", seconds)
                             : std::string("no step is small enough"));
        return track;
      }
      values->state = next.state;
    }
    track.states.push_back(fine.state);
    track.errors.push_back(largest_difference(fine.state, coarse.state));
    before = time;
  }
  return track;
}

ReferenceSolution compute(const runtime::LoadedPlugin& loaded, const runtime::InitialValues& start,
                          const runtime::Wide& time, const ReferenceRequest& request) {
  // The finer solution takes about two thirds of the work.
  const auto extrapolated = [&](double tolerance, double from, double to) {
    runtime::ExtrapolationOptions options;
    options.tolerance = tolerance;
    options.stop = request.stop;
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

// With what it is of, for the list of the cache.  Where that has no room the reference is computed
// again next time, as a plugin is compiled again: `run` says so.
void keep(const runtime::Cache& cache, const std::string& key, const std::string& text,
          const PluginSource& plugin) {
  try {
    runtime::publish_text(cache, key, text);
    runtime::publish_record(cache, key,
                            {.model = plugin.model.name, .scheme = plugin.scheme_name, .made = {}});
  } catch (const runtime::ToolError&) {
    return;
  }
}

}  // namespace

ReferenceRule reference_rule(const SourceText& source, const ReferenceRequest& request) {
  Request quad;
  quad.scheme = base_scheme(source, request);
  quad.scalar = "quad";
  quad.sizes = request.sizes;
  quad.fold = request.fold;
  ReferenceRule rule{.plugin = generate_plugin(source, quad)};
  rule.loaded = load_integrator(rule.plugin, request.compiler, request.stop);
  return rule;
}

ReferenceSolution reference_solution(const SourceText& source, const SceneValues& scene,
                                     const Rational& time, const ReferenceRequest& request) {
  const auto begin = std::chrono::steady_clock::now();
  ReferenceRule rule;
  try {
    rule = reference_rule(source, request);
  } catch (const runtime::ToolError& error) {
    return {.failure = error.failure().message};
  }
  const runtime::InitialValues start = initial_values(rule.plugin, scene, *rule.loaded.library);
  const std::string key = reference_key(rule, start, "end", {time});
  const runtime::Cache cache = runtime::open_cache();
  ReferenceSolution reference;
  if (const auto text = runtime::find_text(cache, key)) {
    NumbersAndValues kept = read_numbers(*text);
    reference = {.state = std::move(kept.values), .error = kept.numbers.at(0), .from_cache = true};
  } else {
    reference = compute(rule.loaded, start, wide(time), request);
    if (reference.failure.empty() && cache.usable())
      keep(cache, key, text_of({reference.error}, reference.state), rule.plugin);
  }
  reference.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return reference;
}

ReferenceTrack reference_track(const ReferenceRule& rule, const runtime::InitialValues& start,
                               const std::vector<Rational>& times, double seconds, StopFlag stop) {
  const std::string key = reference_key(rule, start, fmt::format("track {:a}", seconds), times);
  const runtime::Cache cache = runtime::open_cache();
  const std::size_t size = start.state.size();
  ReferenceTrack track;
  if (const auto text = runtime::find_text(cache, key)) {
    const NumbersAndValues kept = read_numbers(*text);
    track.errors = kept.numbers;
    for (std::size_t i = 0; i < kept.numbers.size(); ++i) {
      const auto at = kept.values.begin() + static_cast<std::ptrdiff_t>(i * size);
      track.states.emplace_back(at, at + static_cast<std::ptrdiff_t>(size));
    }
    track.missing = text->substr(text->find('#') + 1);
    return track;
  }
  track = compute_track(rule.loaded.library, start, times, seconds, stop);
  if (!cache.usable() || is_stopped(stop)) return track;
  std::vector<runtime::Wide> all;
  for (const auto& state : track.states) all.insert(all.end(), state.begin(), state.end());
  keep(cache, key, text_of(track.errors, all) + "#" + track.missing, rule.plugin);
  return track;
}

double distance(const std::vector<runtime::Wide>& x, const std::vector<runtime::Wide>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = (x[i].hi - y[i].hi) + (x[i].lo - y[i].lo);
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

}  // namespace hamgen::app
