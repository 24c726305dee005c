// The function K that a step of --order R takes in place of H, decided without its derivation.
//
// K was found from the Hamilton-Jacobi equation.  Here the flow itself is the witness: with
// z(h) its power series and zbar = (z + Z)/2 + C (Z - z) along it,
//
//   Z - z = h J grad K(zbar, h) + O(h^(r + 1)),
//
// which for all z determines grad K up to h^(r - 1); and the emitted gradient is one of a function,
// so that the step is symplectic: its Jacobian is symmetric.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "generator/mechanics/operation_count.hpp"
#include "generator/verify/emitted.hpp"
#include "generator/verify/formal.hpp"

namespace hamgen {

namespace {

// What is refuted, or nothing.
using Witness = std::optional<std::string>;

constexpr const char* kTolerance = "1e-30";

// Operations of the checks at all points together: a few seconds.
constexpr long kMostWork = 5'000'000;
constexpr int kMostPoints = 200;
// With more instances the sums of a K in loops are not written out.
constexpr long kMostOfFunction = 2000;

// The largest size among them; at least that of the smallest number compared.
Precise largest(const std::vector<Precise>& values) {
  Precise result = precise(0);
  for (const Precise& x : values) result = std::max(result, cln::abs(x));
  return result;
}

Witness differ(const std::string& what, const std::vector<Precise>& emitted,
               const std::vector<Precise>& expected, const Precise& beside = precise(0)) {
  static const Precise tolerance = precise(*parse_decimal(kTolerance));
  const Precise size = std::max(std::max(largest(emitted), largest(expected)), beside);
  for (std::size_t i = 0; i < emitted.size(); ++i) {
    if (cln::abs(emitted[i] - expected[i]) <= tolerance * size) continue;
    return fmt::format("{}, component {}, is {:.10g} and should be {:.10g} at a random point", what,
                       i + 1, to_double(emitted[i]), to_double(expected[i]));
  }
  return std::nullopt;
}

class FunctionCheck {
 public:
  FunctionCheck(const Mechanics& mechanics, const Derivatives& derivatives, const Member& member,
                const GeneratingFunction& function, const Surroundings& around)
      : mechanics_(mechanics),
        derivatives_(derivatives),
        member_(member),
        function_(function),
        around_(around),
        size_(mechanics.variables.size()),
        length_(static_cast<std::size_t>(function.order)) {}

  // Throws std::domain_error where something is not defined.
  Witness at(int point) const {
    const FormalPoint here(mechanics_, around_, point);
    Witness witness = follows_the_flow(here);
    return witness || is_differentiated() ? witness : has_a_symmetric_jacobian(here);
  }

  [[nodiscard]] int points() const {
    // Series multiply length^2/2 numbers; the Jacobian of K takes 4n gradients, and so does the
    // Hessian of a K that is cut off.
    const auto l = static_cast<long>(length_);
    const auto cut = static_cast<long>(function_.hessian_order);
    const auto gradients = is_differentiated() ? 0 : static_cast<long>(2 * size_);
    const long series = l * l / 2 + (cut == l ? 0 : gradients * (cut * cut + 1) / 2);
    const long work = function_.operations * (series + gradients);
    // A point of a system in loops is one of each of its elements, which are of few kinds.
    const long elements = is_differentiated() ? static_cast<long>(size_) / 2 : 1;
    return static_cast<int>(
        std::max(3L, std::min(kMostWork / std::max(work, 1L), kMostPoints / elements)));
  }

 private:
  // Of K as sums gradient and Hessian are derivatives of the sum, made anew.
  [[nodiscard]] bool is_differentiated() const { return !function_.kernels.empty(); }

  Witness follows_the_flow(const FormalPoint& here) const {
    const std::vector<PowerSeries> start = here.state();
    const std::vector<PowerSeries> flow = flow_series(derivatives_, here, length_ + 1);
    std::vector<PowerSeries> change;
    std::vector<PowerSeries> bar;
    const Precise half = precise(Rational(1, 2));
    for (std::size_t i = 0; i < size_; ++i) {
      change.push_back(flow[i] - start[i]);
      bar.push_back(start[i] + half * change[i]);
      bar.back().resize(length_, precise(0));
    }
    for (const auto& [place, entry] : here.gauge(member_, length_)) {
      const auto [i, j] = place;
      PowerSeries& target = bar[static_cast<std::size_t>(i)];
      target = target + product(entry, change[static_cast<std::size_t>(j)], length_);
    }
    const auto field = rotated(here.values(function_.gradient, bar, length_));
    Precise size = precise(0);  // of the terms before: what cancels is rounded as they are
    for (std::size_t k = 0; k < length_; ++k) {
      std::vector<Precise> of_k;
      std::vector<Precise> of_flow;
      for (std::size_t i = 0; i < size_; ++i) {
        of_k.push_back(coefficient(field[i], k));
        of_flow.push_back(coefficient(flow[i], k + 1));
      }
      const std::string what = fmt::format("the term in h^{} of the step", k + 1);
      if (Witness witness = differ(what, of_k, of_flow, size)) return witness;
      size = std::max(size, largest(of_flow));
    }
    return std::nullopt;
  }

  // grad K at a number for h, or as a series as far as h^(length - 1) summed there; the state moved
  // along z_j.
  [[nodiscard]] std::vector<Precise> slopes(FormalPoint here, std::size_t j, const Precise& by,
                                            std::size_t length) const {
    here.move(j, by);
    const auto series = here.values(function_.gradient, here.state(), length);
    std::vector<Precise> result;
    for (const PowerSeries& s : series) {
      Precise sum = precise(0);
      for (std::size_t k = s.size(); k-- > 0;) sum = sum * here.random() + s[k];
      result.push_back(sum);
    }
    return result;
  }

  // By central differences, whose error of 1e-40 is below the tolerance.
  [[nodiscard]] std::vector<Precise> jacobian(const FormalPoint& here, std::size_t length) const {
    std::vector<Precise> result;  // d(slope i)/d(z_j) at j * size + i
    for (std::size_t j = 0; j < size_; ++j) {
      const Precise by = here.spacing(j);
      const std::vector<Precise> up = slopes(here, j, by, length);
      const std::vector<Precise> down = slopes(here, j, -by, length);
      for (std::size_t i = 0; i < size_; ++i) result.push_back((up[i] - down[i]) / (by + by));
    }
    return result;
  }

  Witness has_a_symmetric_jacobian(const FormalPoint& here) const {
    FormalPoint fixed = here;
    fixed.set_step({here.random()});
    const std::vector<Precise> slopes = jacobian(fixed, 1);
    std::vector<Precise> mirrored;
    for (std::size_t j = 0; j < size_; ++j) {
      for (std::size_t i = 0; i < size_; ++i) mirrored.push_back(slopes[i * size_ + j]);
    }
    if (Witness witness =
            differ("the Jacobian of grad K, which is not symmetric", slopes, mirrored))
      return witness;
    // The Hessian that Newton's iteration uses: of K, or of H or a K of lower order.
    const auto length = static_cast<std::size_t>(function_.hessian_order);
    std::vector<Precise> hessian(size_ * size_, precise(0));
    for (const auto& [place, entry] : function_.hessian) {
      const auto i = static_cast<std::size_t>(place.first);
      const auto j = static_cast<std::size_t>(place.second);
      const Precise value = coefficient(fixed.values({entry}, here.state(), 1)[0], 0);
      hessian[i * size_ + j] = value;
      hessian[j * size_ + i] = value;
    }
    return differ("the Hessian of K", hessian, length == length_ ? slopes : jacobian(here, length));
  }

  const Mechanics& mechanics_;
  const Derivatives& derivatives_;
  const Member& member_;
  const GeneratingFunction& function_;
  const Surroundings& around_;
  std::size_t size_;
  std::size_t length_;
};

}  // namespace

GeneratingFunction written_out_function(const StepEquations& equations) {
  GeneratingFunction function = *equations.function;
  if (function.kernels.empty()) return function;
  const Derivatives derivatives(equations.mechanics, sum_of_kernels(equations.mechanics));
  function.gradient = derivatives.gradient();
  function.hessian = derivatives.hessian();
  std::set<std::string> variables;
  for (const Quantity& variable : equations.mechanics.variables) variables.insert(variable.name);
  function.operations = operation_count(function.gradient, variables);
  return function;
}

namespace {

// Of a system in loops, every element.
Decision decide_every_element(const Mechanics& mechanics, const StepEquations& equations,
                              const Expression& hamiltonian, const Surroundings& around) {
  return decide_function(mechanics, Derivatives(mechanics, hamiltonian),
                         of_all(equations.scheme.member(), mechanics.degrees_of_freedom),
                         written_out_function(equations), around);
}

}  // namespace

Decision decide_raised(const Mechanics& mechanics, const SolvePlan& plan, const Program& program,
                       const std::optional<Expression>& hamiltonian, const Surroundings& around,
                       const std::optional<SmallerSystems>& smaller) {
  const StepEquations& equations = plan.equations;
  if (!mechanics.keeps_sums())
    return decide_function(mechanics, Derivatives(mechanics), equations.scheme.member(),
                           *equations.function, around);
  if (mechanics.degrees_of_freedom <= kMostLookedAt)
    return decide_every_element(mechanics, equations, *hamiltonian, around);
  const std::optional<std::string> why =
      smaller ? why_not_inherited(mechanics, plan, program, *smaller)
              : std::optional<std::string>("there is no size to make smaller");
  if (why && hamiltonian && instances_of_loops(equations.mechanics) <= kMostOfFunction)
    return decide_every_element(mechanics, equations, *hamiltonian, around);
  if (why)
    return {.verdict = Verdict::not_decided,
            .witness = "K is not looked at, with so many elements: " + *why};
  Decision total{.verdict = Verdict::proved};
  for (const SizedSystem* system : {&smaller->first, &smaller->second}) {
    const Decision decision =
        decide_every_element(system->mechanics, system->plan.equations, system->hamiltonian,
                             system->around.centres.empty() ? around : system->around);
    total.points += decision.points;
    total.verdict = both(total.verdict, decision.verdict);
    if (holds(decision.verdict)) continue;
    total.verdict = decision.verdict;
    total.witness =
        fmt::format("at {} = {}: {}", smaller->constant, system->size, decision.witness);
    break;
  }
  return total;
}

Decision decide_function(const Mechanics& mechanics, const Derivatives& derivatives,
                         const Member& member, const GeneratingFunction& function,
                         const Surroundings& around) {
  const FunctionCheck check(mechanics, derivatives, member, function, around);
  Decision decision;
  const int wanted = check.points();
  // A point may lie outside the domain of H: then another is taken.
  for (int point = 0; decision.points < wanted; ++point) {
    if (point == 50 * wanted) {
      decision.witness = "no point was found where all of K is defined";
      return decision;
    }
    try {
      if (auto witness = check.at(point)) {
        decision.verdict = Verdict::refuted;
        decision.witness = std::move(*witness);
        return decision;
      }
      ++decision.points;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  decision.verdict = Verdict::tested;
  return decision;
}

}  // namespace hamgen
