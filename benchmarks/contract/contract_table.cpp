// How well emitted steps solve their equations: every shipped scene, by every solver, against quad
// steps from the same exact state.  See Note [contract of a solve] in
// tests/contract/step_defect.hpp.
//
//   contract_table [--scalar S]... [--method M]... [--steps N] [MODEL...]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/language/scene.hpp"
#include "tests/contract/measure.hpp"
#include "tests/contract/models.hpp"

namespace {

using hamgen::contract::Case;
using hamgen::contract::Defects;

struct Method {
  std::string name;
  hamgen::Request request;
  std::string alpha = "1/2", beta = "0", gamma = "0";
};

std::vector<Method> all_methods() {
  return {{"newton", {}},
          {"fixed-point", {.solver = "fixed-point"}},
          {"member", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10"}, "3/10", "1/5", "-1/10"},
          {"euler-a", {.scheme = "symplectic-euler-a"}, "0"},
          {"euler-b", {.scheme = "symplectic-euler-b"}, "1"},
          {"order-4", {.order = 4}},
          {"order-6", {.order = 6}},
          {"yoshida-4", {.scheme = "yoshida-4"}},
          {"kahan-li-8", {.scheme = "kahan-li-8"}},
          {"gauss-4", {.scheme = "gauss-4"}},
          {"gauss-4-fixed", {.scheme = "gauss-4", .solver = "fixed-point"}},
          {"gauss-4-newton", {.scheme = "gauss-4", .solver = "newton"}},
          {"gauss-8", {.scheme = "gauss-8"}},
          {"gauss-16", {.scheme = "gauss-16"}}};
}

// The residual of a reference is that of H's equations; those of a member of higher order are K's.
bool has_reference(const std::string& name) { return name.find("order-") == std::string::npos; }

struct Choice {
  std::vector<std::string> scalars, methods, models;
  long steps = 0;
};

std::vector<std::string> names(const std::vector<Method>& methods) {
  std::vector<std::string> result;
  for (const Method& m : methods) result.push_back(m.name);
  return result;
}

std::vector<std::string> all_models() {
  std::vector<std::string> models;
  for (const auto& steep : hamgen::contract::kSteepModels) models.emplace_back(steep.name);
  for (const auto& entry : std::filesystem::directory_iterator(HAMGEN_SOURCE_DIR "/hamiltonians")) {
    models.push_back(entry.path().stem().string());
  }
  std::ranges::sort(models);
  return models;
}

Choice read(int argc, char** argv) {
  Choice choice;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--scalar") {
      choice.scalars.push_back(value), ++i;
    } else if (word == "--method") {
      choice.methods.push_back(value), ++i;
    } else if (word == "--steps") {
      choice.steps = std::stol(value), ++i;
    } else {
      choice.models.push_back(word);
    }
  }
  if (choice.models.empty()) choice.models = all_models();
  if (choice.scalars.empty()) choice.scalars = {"double"};
  if (choice.methods.empty()) choice.methods = names(all_methods());
  return choice;
}

// The model's scenes by one method; a scene without h or steps is left out.
std::vector<Case> cases(const std::string& model, const Method& method, const std::string& scalar,
                        long most_steps) {
  const hamgen::SourceText source = hamgen::contract::model(model);
  const hamgen::Model parsed = hamgen::read_request(source, {});
  std::vector<Case> result;
  for (const hamgen::Scene& scene : parsed.scenes) {
    const auto values = hamgen::scene_values(parsed, {.scene = scene.name});
    if (!values.h || !values.steps) continue;
    Case c{.name = fmt::format("{} {} {} {}", model, scene.name, method.name, scalar),
           .model = source,
           .scene = scene.name,
           .request = method.request,
           .alpha = method.alpha,
           .beta = method.beta,
           .gamma = method.gamma,
           .steps = most_steps > 0 ? std::min(most_steps, *values.steps) : *values.steps};
    c.request.scalar = scalar;
    result.push_back(c);
  }
  return result;
}

struct Summary {
  long long runs = 0, solves = 0, broken = 0, unknown = 0, stopped = 0;
  double worst = 0;
  std::string where;
};

void print(const Defects& d, Summary& summary) {
  fmt::print("{:<52} {:>9} {:>6.3f} {:>11.4g} {:>9} {:>10.4g} {:>7} {:>7}{}{}\n", d.name, d.steps,
             static_cast<double>(d.iterations) / static_cast<double>(std::max(d.solves, 1LL)),
             d.worst, d.worst_step, d.units, d.broken, d.unknown, d.failed ? "  stopped" : "",
             d.reference > 1e-6 && has_reference(d.name) ? "  reference!" : "");
  std::fflush(stdout);
  ++summary.runs;
  summary.solves += d.solves;
  summary.broken += d.broken;
  summary.unknown += d.unknown;
  summary.stopped += d.failed ? 1 : 0;
  if (d.worst <= summary.worst) return;
  summary.worst = d.worst;
  summary.where = d.name;
}

}  // namespace

int main(int argc, char** argv) {
  const Choice choice = read(argc, argv);
  fmt::print("{:<52} {:>9} {:>6} {:>11} {:>9} {:>10} {:>7} {:>7}\n", "model, scene, method, scalar",
             "steps", "it/sol", "worst", "at step", "units", "broken", "unknown");
  Summary summary;
  for (const std::string& model : choice.models) {
    for (const std::string& scalar : choice.scalars) {
      for (const Method& method : all_methods()) {
        if (std::ranges::find(choice.methods, method.name) == choice.methods.end()) continue;
        try {
          const std::vector<Case> wanted = cases(model, method, scalar, choice.steps);
          for (const Defects& d : hamgen::contract::measure(wanted)) print(d, summary);
        } catch (const std::exception& e) {  // no such method for this model
          fmt::print("{} {} {}: {:.300}\n", model, method.name, scalar, e.what());
        }
      }
    }
  }
  fmt::print(
      "{} runs, {} solves: {} beyond 16 times rounding, {} without a quad step, {} runs stopped; "
      "worst {:.4g}, {}\n",
      summary.runs, summary.solves, summary.broken, summary.unknown, summary.stopped, summary.worst,
      summary.where);
}
