#include "app/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/initial_data.hpp"
#include "app/load_integrator.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {
namespace {

// Solving for M leaves some 2n rounding errors in entries of size |M|, and M^T J M multiplies two
// of them: scaled by |M|^2 that is far below this for the sizes that are written out.
constexpr double kRoundOff = 1e-13;
constexpr int kStates = 100;
constexpr long kOrbit = 10000;  // steps along which invariants are watched

struct Sample {
  std::vector<double> parameters, state;
};

// Parameters and state of the scene, each moved by up to a tenth.
Sample random_sample(const runtime::InitialValues& start, std::mt19937_64& source) {
  std::uniform_real_distribution<double> tenth(-0.1, 0.1);
  Sample sample;
  for (const runtime::Wide& p : start.parameters) {
    sample.parameters.push_back(p.hi * (1 + tenth(source)));
  }
  double size = 0;
  for (const runtime::Wide& z : start.state) size = std::max(size, std::abs(z.hi));
  for (const runtime::Wide& z : start.state) {
    sample.state.push_back(z.hi + tenth(source) * std::max(std::abs(z.hi), 0.1 * size));
  }
  return sample;
}

// max |M^T J M - J| / max(1, max |M|^2).
double symplectic_defect(const std::vector<double>& m, std::size_t n) {
  const std::size_t size = 2 * n;
  double largest = 1;
  for (const double entry : m) largest = std::max(largest, std::abs(entry));
  double worst = 0;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      double sum = j == i + n ? -1 : (i == j + n ? 1 : 0);
      for (std::size_t k = 0; k < n; ++k) {
        sum += m[k * size + i] * m[(n + k) * size + j] - m[(n + k) * size + i] * m[k * size + j];
      }
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst / (largest * largest);
}

// How far a step back from the end of a step is from its start, relative to the state.
double reversal_residual(const std::vector<double>& there, const std::vector<double>& back) {
  double size = 0;
  double worst = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    size = std::max(size, std::abs(there[i]));
    worst = std::max(worst, std::abs(there[i] - back[i]));
  }
  return worst / std::max(size, 1e-300);
}

Finding within_round_off(const std::string& property, double value, const std::string& where) {
  return {property, value <= kRoundOff ? Verdict::tested : Verdict::refuted,
          fmt::format("at most {:.2e} {}; round-off is below {:.0e}", value, where, kRoundOff)};
}

std::vector<InvariantDefect> invariant_defects(const PluginSource& plugin,
                                               const runtime::LoadedPlugin& loaded,
                                               const runtime::InitialValues& start, long steps) {
  if (plugin.invariant_names.empty()) return {};
  runtime::Integrator integrator(loaded.library, start);
  std::vector<InvariantDefect> defects;
  const std::vector<double> before = integrator.invariants();
  for (std::size_t i = 0; i < before.size(); ++i)
    defects.push_back({.name = plugin.invariant_names[i], .initial = before[i] + 0.0});  // no -0
  const long most = std::min(steps, kOrbit);
  for (long done = 0; done < most;) {
    const long now = std::min(10L, most - done);
    if (integrator.advance(now, false).status != runtime::Status::done) break;
    done += now;
    const std::vector<double> after = integrator.invariants();
    for (std::size_t i = 0; i < defects.size(); ++i) {
      defects[i].largest = std::max(defects[i].largest, std::abs(after[i] - before[i]));
      defects[i].steps = done;
    }
  }
  return defects;
}

}  // namespace

Measured measure(const SourceText& source, Request request, const SceneRequest& wanted,
                 bool symmetric) {
  request.tangent = true;
  const PluginSource plugin = generate_plugin(source, request);
  const SceneValues scene = complete_scene(plugin.model, wanted);
  const runtime::LoadedPlugin loaded = load_integrator(plugin, "");
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  const hamgen_plugin& step = loaded.library->plugin();
  const std::string where =
      fmt::format("at {} states and parameters around the scene, h = {:g}", kStates, start.h.hi);
  Proof proof;
  if (step.tangent == nullptr) {
    proof.push_back({"tangent map", Verdict::not_decided,
                     "emitted for single members whose sums are written out only"});
  } else {
    const auto n = static_cast<std::size_t>(step.degrees_of_freedom);
    std::mt19937_64 source_of_numbers(1);
    std::vector<double> matrix(4 * n * n);
    std::vector<double> end(2 * n);
    std::vector<double> back(2 * n);
    double defect = 0;
    double reversal = 0;
    int failed = 0;
    for (int i = 0; i < kStates; ++i) {
      const Sample z = random_sample(start, source_of_numbers);
      if (step.tangent(z.parameters.data(), start.h.hi, z.state.data(), end.data(),
                       matrix.data()) == 0) {
        ++failed;
        continue;
      }
      defect = std::max(defect, symplectic_defect(matrix, n));
      if (step.tangent(z.parameters.data(), -start.h.hi, end.data(), back.data(), matrix.data()) !=
          0) {
        reversal = std::max(reversal, reversal_residual(z.state, back));
      }
    }
    const std::string how =
        where + (failed == 0 ? "" : fmt::format(" ({} of them without a step)", failed));
    proof.push_back(within_round_off("tangent map symplectic", defect, how));
    if (symmetric) proof.push_back(within_round_off("reversal", reversal, how));
  }
  return {std::move(proof), invariant_defects(plugin, loaded, start, *scene.steps)};
}

Finding finding(const InvariantDefect& defect) {
  return {defect.name + " measured", Verdict::measured,
          fmt::format("changes by at most {:.2e} from {:.6g} in {} steps of the scene",
                      defect.largest, defect.initial, defect.steps)};
}

}  // namespace hamgen::app
