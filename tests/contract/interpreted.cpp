#include "tests/contract/interpreted.hpp"

#include <algorithm>
#include <map>

#include "generator/base/diagnostic.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/interpreter/interpreter.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/program/build_program.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen::contract {

struct Interpretable::Parts {
  SourceText source;
  Model model;
  Mechanics mechanics;
};

namespace {

template <class Real>
std::vector<Real> rounded(const Vector& z) {
  std::vector<Real> result;
  for (const Quad value : z) result.push_back(static_cast<Real>(value));
  return result;
}
template <class Real>
Vector exact(const std::vector<Real>& values) {
  return Vector(values.begin(), values.end());
}

template <class Real>
Vector state_and_carry(const Interpreter<Real>& run) {
  Vector z = exact(run.state());
  for (std::size_t k = 0; k < z.size(); ++k) z[k] += run.carry()[k];
  return z;
}

template <class Number>
struct Interpreted {
  using Real = Number;
  static constexpr Real epsilon = NumericsOf<Real>::unit;
  Interpreter<Real>& run;
  [[nodiscard]] Vector gradient(const Vector& z) const {
    return exact(run.values("gradient", rounded<Real>(z)));
  }
};

template <class Real>
struct InterpretedSubstep {
  Interpreter<Real>& run;
  std::size_t i = 0;
  [[nodiscard]] Vector exact_state() const { return state_and_carry(run); }
  Attempt step() {
    const auto report = run.substep(i);
    return {report.converged, report.iterations};
  }
};

// Steps of any length, each from a state of which nothing is remembered.
class InterpretedExact {
 public:
  InterpretedExact(Program code, std::vector<Quad> parameters)
      : code_(std::move(code)), parameters_(std::move(parameters)) {
    code_.substeps = {1};
  }
  [[nodiscard]] Vector gradient(const Vector& z) const {
    return runs_.begin()->second->values("gradient", z);
  }
  [[nodiscard]] ExactStep step(const Vector& z, Quad h) {
    auto& run = runs_[h];
    if (!run) run = std::make_unique<Interpreter<Quad>>(code_, parameters_, h, z);
    run->reset(z, Vector(z.size()));
    const bool converged = run->step().converged;
    const Vector values = run->remembered(0, "value");
    if (!code_.stages) return {converged, state_and_carry(*run), values};
    Vector stages;
    for (long i = 0; i < code_.stages->stages; ++i) {
      for (long j = 0; j < code_.stages->dimension; ++j)
        stages.push_back(values[static_cast<std::size_t>(code_.stages->at(i, j))]);
    }
    return {converged, state_and_carry(*run), stages};
  }

 private:
  Program code_;
  std::vector<Quad> parameters_;
  std::map<Quad, std::unique_ptr<Interpreter<Quad>>> runs_;
};

Program code_of(const StepEquations& equations, const std::string& solver, bool lanes = false) {
  return build_program(plan_solve(equations, solver), {.stages_in_lanes = lanes});
}

// A slow fixed point has not the iterations for the digits of quad; Newton has.
struct Codes {
  StepEquations equations;
  Program measured, exact;
};

template <class Real>
Defects measure(const Case& c, const Codes& codes) {
  const Start start = start_of(c);
  const StepEquations& equations = codes.equations;
  const int n = equations.mechanics.degrees_of_freedom;
  std::vector<Real> parameters;
  for (const auto& [name, unit, comment, value] : codes.measured.environment.parameters) {
    parameters.push_back(static_cast<Real>(
        std::ranges::find(start.parameters, name, &std::pair<std::string, double>::first)->second));
  }
  InterpretedExact exact_run(codes.exact, std::vector<Quad>(parameters.begin(), parameters.end()));
  Interpreter<Real> run(codes.measured, parameters, static_cast<Real>(start.h),
                        rounded<Real>(exact(start.state)));
  Interpreted<Real> measured{run};
  Watch watch(measured, exact_run, has_cancelling_forces(c.model));
  std::map<Quad, Equations> of_length;
  Defects defects{.name = c.name};
  for (; defects.steps < start.steps; ++defects.steps) {
    for (std::size_t i = 0; i < run.substeps(); ++i) {
      const Quad h = run.length(i);
      if (!of_length.contains(h)) of_length[h] = equations_of(equations.scheme, n, start, h);
      InterpretedSubstep<Real> substep{run, i};
      defects.failed = !watch.solve(substep, of_length[h], h, defects);
      if (defects.failed) return defects;
    }
  }
  return defects;
}

}  // namespace

Interpretable::Interpretable(SourceText source) {
  Model model = read_request(source, {});
  Mechanics mechanics = derive(model, true);
  parts_ = std::make_unique<const Parts>(
      Parts{std::move(source), std::move(model), std::move(mechanics)});
}
Interpretable::~Interpretable() = default;

const Model& Interpretable::model() const { return parts_->model; }

std::vector<Defects> Interpretable::measure(const Request& request,
                                            const std::vector<Case>& cases) const {
  Codes codes{.equations = discretise(parts_->mechanics,
                                      choose_scheme(parts_->model, parts_->mechanics, request))};
  codes.exact =
      code_of(codes.equations, request.solver == "fixed-point" ? "" : request.solver.text());
  // As double numbers are emitted.
  codes.measured =
      code_of(codes.equations, request.solver.text(), request.scalar->type->digits == 53);
  std::vector<Defects> result;
  for (const Case& c : cases) {
    result.push_back(request.scalar == "float"         ? contract::measure<float>(c, codes)
                     : request.scalar == "long-double" ? contract::measure<long double>(c, codes)
                                                       : contract::measure<double>(c, codes));
  }
  return result;
}

}  // namespace hamgen::contract
