// How well steps solve their equations: every shipped scene, by every method and solver, against
// quad steps from the same exact state.  See Note [contract of a solve] in
// tests/contract/watch.hpp.
//
//   contract_table [--scalar S]... [--method M]... [--steps N] [--compiled]
//                  [--batch W] [--but MODEL]... [MODEL...]
//
// The steps are interpreted, or with --compiled emitted and compiled, with --batch the first lane
// of a header of W trajectories.  Exit status 1 if any is beyond what is allowed.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tests/contract/interpreted.hpp"
#include "tests/contract/measure.hpp"

namespace {

using hamgen::contract::Case;
using hamgen::contract::Defects;
using hamgen::contract::Method;

// The residual of a reference is that of H's equations; those of a member of higher order are K's.
bool has_reference(const std::string& name) { return name.find("order-") == std::string::npos; }

struct Choice {
  std::vector<std::string> scalars, methods, models;
  long steps = 0;
  bool compiled = false;
  int batch = 0;
};

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
    } else if (word == "--but") {
      if (choice.models.empty()) choice.models = hamgen::contract::all_models();
      std::erase(choice.models, value), ++i;
    } else if (word == "--batch") {
      choice.batch = std::stoi(value), ++i;
      choice.compiled = true;
    } else if (word == "--compiled") {
      choice.compiled = true;
    } else {
      choice.models.push_back(word);
    }
  }
  if (choice.models.empty()) choice.models = hamgen::contract::all_models();
  if (choice.scalars.empty()) choice.scalars = {"double"};
  return choice;
}

struct Summary {
  long long runs = 0, solves = 0, broken = 0, elsewhere = 0, unknown = 0, stopped = 0;
  double worst = 0;
  std::string where;
};

void print(const Defects& d, Summary& summary) {
  fmt::print("{:<52} {:>9} {:>6.3f} {:>11.4g} {:>9} {:>10.4g} {:>7} {:>7}{}{}\n", d.name, d.steps,
             static_cast<double>(d.iterations) / static_cast<double>(std::max(d.solves, 1LL)),
             d.worst, d.worst_step, d.units, d.broken, d.unknown, d.failed ? "  stopped" : "",
             d.reference > hamgen::contract::kDoubt && has_reference(d.name) ? "  reference!" : "");
  std::fflush(stdout);
  ++summary.runs;
  summary.solves += d.solves;
  summary.broken += d.broken;
  summary.elsewhere += d.elsewhere;
  summary.unknown += d.unknown;
  summary.stopped += d.failed ? 1 : 0;
  if (d.worst <= summary.worst) return;
  summary.worst = d.worst;
  summary.where = d.name;
}

void measure(const hamgen::contract::Interpretable& model, const std::vector<Case>& cases,
             bool compiled, Summary& summary) {
  try {
    for (const Defects& d : compiled ? hamgen::contract::measure(cases)
                                     : model.measure(cases.front().request, cases)) {
      print(d, summary);
    }
  } catch (const std::exception& e) {  // no such method for this model
    fmt::print("{}: {:.300}\n", cases.front().name, e.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Choice choice = read(argc, argv);
  fmt::print("{:<52} {:>9} {:>6} {:>11} {:>9} {:>10} {:>7} {:>7}\n", "model, scene, method, scalar",
             "steps", "it/sol", "worst", "at step", "units", "broken", "unknown");
  Summary summary;
  for (const std::string& name : choice.models) {
    const hamgen::SourceText source = hamgen::contract::model(name);
    const hamgen::contract::Interpretable model(source);
    for (const std::string& scalar : choice.scalars) {
      for (Method method : hamgen::contract::all_methods()) {
        if (!choice.methods.empty() &&
            std::ranges::find(choice.methods, method.name) == choice.methods.end()) {
          continue;
        }
        method.request.scalar = scalar;
        method.request.batch = choice.batch;
        method.name += " " + scalar;
        const std::vector<Case> cases =
            hamgen::contract::scenes_of(model.model(), source, method, choice.steps);
        if (!cases.empty()) measure(model, cases, choice.compiled, summary);
      }
    }
  }
  fmt::print(
      "{} runs, {} solves: {} beyond 16 times rounding, {} with another solution, {} without a "
      "quad "
      "step, {} runs stopped; worst {:.4g}, {}\n",
      summary.runs, summary.solves, summary.broken, summary.elsewhere, summary.unknown,
      summary.stopped, summary.worst, summary.where);
  return summary.broken > 0 ? 1 : 0;
}
