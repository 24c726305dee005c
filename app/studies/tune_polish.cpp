#include "app/studies/tune_polish.hpp"

#include <nlopt.h>

#include <cmath>
#include <memory>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

struct PolishProblem {
  const std::function<double(const std::vector<double>&)>& function;
  const std::vector<double>& centre;
  const std::vector<double>& steps;
  nlopt_opt optimiser;
  StopFlag stop;
  int evaluations = 0;

  // In units of the steps: one tolerance fits all coefficients.
  [[nodiscard]] std::vector<double> coefficients(const double* x) const {
    std::vector<double> result = centre;
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += steps[k] * x[k];
    return result;
  }
};

double polish_value(unsigned, const double* x, double*, void* data) {
  PolishProblem& problem = *static_cast<PolishProblem*>(data);
  if (is_stopped(problem.stop)) nlopt_force_stop(problem.optimiser);
  ++problem.evaluations;
  const double value = problem.function(problem.coefficients(x));
  return std::isfinite(value) ? value : 1e300;
}

}  // namespace

Polished polish(const std::function<double(const std::vector<double>&)>& function,
                const std::vector<double>& start, const std::vector<double>& steps,
                int most_evaluations, StopFlag stop) {
  // Where the simplex is this small, in units of the steps, nothing is left to find.
  constexpr double kSmall = 1e-7;
  Polished best{.coefficients = start, .value = function(start), .evaluations = 1};
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(NLOPT_LN_NELDERMEAD, static_cast<unsigned>(start.size())), &nlopt_destroy);
  if (!optimiser) internal_error("NLopt knows no Nelder-Mead");
  double size = 1.0;
  while (best.evaluations < most_evaluations && !is_stopped(stop)) {
    const std::vector<double> centre = best.coefficients;
    PolishProblem problem{function, centre, steps, optimiser.get(), stop};
    nlopt_set_min_objective(optimiser.get(), polish_value, &problem);
    nlopt_set_maxeval(optimiser.get(), most_evaluations - best.evaluations);
    nlopt_set_xtol_abs1(optimiser.get(), kSmall);
    nlopt_set_initial_step1(optimiser.get(), size);
    std::vector<double> x(start.size(), 0.0);
    double value = 0.0;
    nlopt_optimize(optimiser.get(), x.data(), &value);
    best.evaluations += problem.evaluations;
    const double before = best.value;
    if (value < best.value) {
      best.value = value;
      best.coefficients = problem.coefficients(x.data());
    }
    best.ended = best.evaluations < most_evaluations && !(best.value < 0.99 * before);
    if (best.ended) break;
    size /= 10;
  }
  return best;
}

}  // namespace hamgen::app
