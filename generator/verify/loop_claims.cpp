// A member of a system whose sums are loops, one and the same alpha, beta, gamma everywhere.  The
// loops run over all their instances, and the claims are made of every element: growth.hpp says
// what they are for systems that are too large for that.
//
// In solve the gradient is a function of which nothing is known: what it returns is free, and where
// it is called is compared.  What the functions return, and what is made of H''
// (loop_hessian_claims), are claims of their own, against H written out and differentiated anew.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/equations/step_equations.hpp"
#include "generator/verify/emitted.hpp"

namespace hamgen {

namespace {

bool calls_velocity(const StepUnderProof& step) {
  return called_routines(step.code.routine("evaluate")->body).contains("kinetic_gradient");
}

class LoopMemberClaims {
 public:
  LoopMemberClaims(const StepUnderProof& step, const Derivatives& derivatives,
                   const FamilyParameters& member, std::optional<int> sweeps)
      : step_(step),
        derivatives_(derivatives),
        member_(member),
        sweeps_(sweeps),
        n_(step.mechanics.degrees_of_freedom),
        raised_(step.scheme.member().generating_order > 0),
        reduced_(step.code.routine("evaluate") != nullptr),
        local_(reduced_ && (!member.beta.is_zero() || !calls_velocity(step))),
        partners_(derivatives.partners()) {}

  std::vector<Identities> run() {
    std::vector<Identities> found;
    // t is given, wherever an iteration starts.
    for (const bool known : {false, true}) {
      if (known && !(is_given(n_ - 1) && !sweeps_)) break;
      known_ = known;
      // Either may be what a step is solved by.
      found.push_back(solve_identities(has("contract") ? "newton" : ""));
      if (has("contract")) found.push_back(solve_identities("contract"));
    }
    return found;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] bool has(const char* routine) const {
    return step_.code.routine(routine) != nullptr;
  }
  // Are the torn momenta in an array?
  [[nodiscard]] bool keeps_momenta() const {
    const std::vector<Field>& fields = step_.code.record("Start")->fields;
    return std::ranges::find(fields, "momentum", &Field::name) != fields.end();
  }
  void claim(std::string what, const Expression& emitted, const Expression& expected) {
    identities_.claims.push_back({std::move(what), emitted, expected});
  }
  [[nodiscard]] const char* curvature() const {
    return reduced_ ? "potential_curvature" : "curvature";
  }
  Expression mass(int i) const { return derivatives_.second(n_ + i, n_ + i); }

  // --- the step -------------------------------------------------------------------------------

  // grad H as it was called at these points; a symbol that nobody knows if it was not.
  Expression slope(const SymbolicMachine& machine, const std::vector<Expression>& point, int k) {
    if (local_ && k >= n_) return velocity(k, point);
    const auto first = point.begin();
    const std::vector<Expression> q(first, first + n_);
    const std::vector<Expression> p(first + n_, first + 2 * n_);
    for (const CallTrace& call : machine.calls) {
      const bool whole = call.routine == (raised_ ? "generating_gradient" : "gradient");
      if (whole && call.input == point) return call.output[at(k)];
      if (raised_) continue;
      if (call.routine == "potential_gradient" && k < n_ && call.input == q)
        return call.output[at(k)];
      if (call.routine == "kinetic_gradient" && k >= n_ && call.input == p)
        return call.output[at(k - n_)];
    }
    return Expression::symbol("not evaluated: dH/d" + step_.name(k));
  }

  // dT/dp = d + m p
  Expression velocity(int k, const std::vector<Expression>& point) const {
    return substitute(derivatives_.first(k), {{step_.name(k), point[at(k)]}});
  }
  // The momentum whose row holds, where it depends on itself.
  Expression solved_momentum(int i, const Expression& force) const {
    const auto& [alpha, beta, gamma] = member_;
    const Expression h = step_size();
    const Expression drift = substitute(derivatives_.first(i), {{step_.name(i), Expression(0)}});
    return (step_.mechanics.variable(i) + step_.carry(i) - h * (Expression(1) - alpha) * force -
            h * beta * drift) /
           (Expression(1) + h * beta * mass(i - n_));
  }

  // Is it t that is known, or p_t?  Nothing is lacking of these.
  bool is_given(int i) const { return i % n_ == n_ - 1 && knows_time(step_.mechanics, member_); }
  // The state, and t at the stage: dH/dp_t is 1.
  Expression start(int i) const {
    const Expression z = step_.mechanics.variable(i);
    if (!is_given(i) || i >= n_ || member_.alpha.is_zero()) return z;
    return z + step_.carry(i) + step_size() * member_.alpha;
  }

  // z_i + carry_i + h (B g)_i
  Expression row(int i, const std::function<Expression(int)>& g) {
    const auto& [alpha, beta, gamma] = member_;
    const Expression h = step_size();
    Expression sum = step_.mechanics.variable(i) + step_.carry(i);
    if (i < n_) {
      if (!alpha.is_zero()) sum += h * alpha * g(n_ + i);
      if (!gamma.is_zero()) sum += h * gamma * g(i);
      return moves(i) ? sum : step_.mechanics.variable(i);
    }
    if (!alpha.is_one()) sum += -(h * (Expression(1) - alpha)) * g(i - n_);
    if (!beta.is_zero()) sum += -(h * beta) * g(i);
    return moves(i) ? sum : step_.mechanics.variable(i);
  }
  // Has the row any weight?
  [[nodiscard]] bool moves(int i) const {
    return i < n_ ? !member_.alpha.is_zero() || !member_.gamma.is_zero()
                  : !member_.alpha.is_one() || !member_.beta.is_zero();
  }

  // Without the routine that is skipped, if any.
  Identities solve_identities(const std::string& skipped) {
    identities_ = {};
    std::set<std::string> opaque = {"gradient", "potential_gradient", "generating_gradient",
                                    "differentiate"};
    if (!local_) opaque.insert("kinetic_gradient");
    if (!has("gradient_error")) opaque.insert(curvature());
    SymbolicMachine machine = step_.machine(std::move(opaque));
    for (int i = 0; i < n_; ++i) machine.name({"start", "value", {{i, {}}}}, bar(i));
    for (int i = 0; i < n_ && (!reduced_ || keeps_momenta()); ++i) {
      machine.name(reduced_ ? Place{"start", "momentum", {{i, {}}}}
                            : Place{"start", "value", {{n_ + i, {}}}},
                   bar(n_ + i));
    }
    // What the other one has left in `rest` in a step before is no part of this one.
    const std::vector<Argument>& given = step_.code.routine("solve")->arguments;
    const bool has_rest = std::ranges::find(given, "rest", &Argument::name) != given.end();
    for (int i = 0; i < 2 * n_ && !skipped.empty() && has_rest; ++i) {
      machine.set(step_.environment.place("rest", i),
                  Expression::symbol("left in rest(" + step_.name(i) + ")", kRankOfTemporary));
    }
    if (has("prepare")) machine.run("prepare");
    machine.skip(skipped);
    machine.set_flag({"start", "known"}, known_);
    for (int i = 0; known_ && i < (reduced_ ? n_ : 2 * n_); ++i)
      machine.set({"start", "value", {{i, {}}}}, Expression::symbol("predicted " + step_.name(i)));
    machine.run("solve");
    if (sweeps_) {
      claim_sweeps(machine);
    } else if (machine.iterations.empty()) {
      claim_explicit(machine);
    } else {
      claim_solved(machine);
    }
    identities_.emitted = machine.definitions();
    return std::move(identities_);
  }
  [[nodiscard]] std::string bar(int i) const { return "bar(" + step_.name(i) + ")"; }

  // The stage of an explicit method: half of it is z, and half follows from the gradient there.
  void claim_explicit(SymbolicMachine& machine) {
    const bool kick_first = member_.alpha.is_zero();
    std::vector<Expression> point;
    for (int i = 0; i < 2 * n_; ++i) {
      const bool follows = (i >= n_) == kick_first;
      point.push_back(follows ? machine.value({"start", "value", {{i % n_, {}}}})
                              : step_.mechanics.variable(i));
    }
    const auto g = [&](int k) { return slope(machine, point, k); };
    for (int i = 0; i < 2 * n_; ++i) {
      claim("the stage value of " + step_.name(i), point[at(i)], row(i, g));
    }
    claim_increments(machine, g);
  }

  void claim_increments(SymbolicMachine& machine, const std::function<Expression(int)>& g) {
    for (int i = 0; i < 2 * n_; ++i) {
      const Expression flow = i < n_ ? step_size() * g(n_ + i) : -(step_size() * g(i - n_));
      claim("the increment of " + step_.name(i), step_.increment(machine, i),
            step_.carry(i) + flow);
    }
  }

  // First grad H(z), then K times grad H(zbar(g)): the points of the calls in their order.
  void claim_sweeps(SymbolicMachine& machine) {
    const std::size_t per_sweep = has("potential_gradient") && !raised_ ? 2 : 1;
    const auto expected = static_cast<std::size_t>(*sweeps_ + 1) * per_sweep;
    claim("the number of evaluations", Expression(std::ssize(machine.calls)),
          Expression(static_cast<long>(expected)));
    if (machine.calls.size() != expected) return;
    std::vector<Expression> values;
    for (int i = 0; i < 2 * n_; ++i) values.push_back(step_.mechanics.variable(i));
    for (std::size_t s = 0; s <= static_cast<std::size_t>(*sweeps_); ++s) {
      std::vector<Expression> point;
      std::vector<Expression> g;
      for (std::size_t c = s * per_sweep; c < (s + 1) * per_sweep; ++c) {
        const CallTrace& call = machine.calls[c];
        point.insert(point.end(), call.input.begin(), call.input.end());
        g.insert(g.end(), call.output.begin(), call.output.end());
      }
      for (int i = 0; i < 2 * n_; ++i) {
        claim(fmt::format("where sweep {} evaluates, {}", s, step_.name(i)), point.at(at(i)),
              values[at(i)]);
      }
      const auto of_sweep = [&](int k) { return g.at(at(k)); };
      for (int i = 0; i < 2 * n_; ++i) values[at(i)] = row(i, of_sweep);
      if (s == static_cast<std::size_t>(*sweeps_)) claim_increments(machine, of_sweep);
    }
  }

  // zbar of an iteration whose unknowns are these: with the momenta torn out these follow from the
  // coordinates, and satisfy their rows.
  std::vector<Expression> stage_of(SymbolicMachine& machine,
                                   const std::vector<Expression>& unknowns, const char* where) {
    if (!reduced_) return unknowns;
    std::vector<Expression> point = unknowns;
    const auto force = std::ranges::find_if(machine.calls, [&](const CallTrace& call) {
      return call.routine == "potential_gradient" && call.input == unknowns;
    });
    const bool evaluated = force != machine.calls.end();
    const bool has_momenta = evaluated && (local_ || std::next(force) != machine.calls.end());
    claim(fmt::format("the gradient is evaluated {}", where), Expression(has_momenta ? 1 : 0),
          Expression(1));
    for (int i = 0; i < n_; ++i) {
      point.push_back(!has_momenta ? step_.mechanics.variable(n_ + i)
                      : local_     ? solved_momentum(n_ + i, force->output[at(i)])
                                   : std::next(force)->input.at(at(i)));
    }
    if (local_ || !has_momenta) return point;
    for (int i = n_; i < 2 * n_; ++i) {
      claim(fmt::format("the stage value of {} {}", step_.name(i), where), point[at(i)],
            row(i, [&](int k) { return slope(machine, point, k); }));
    }
    return point;
  }

  void claim_solved(SymbolicMachine& machine) {
    const IterationTrace& trace = machine.iterations.front();
    const int m = reduced_ ? n_ : 2 * n_;
    claim("the number of unknowns", Expression(std::ssize(trace.unknowns)), Expression(m));
    if (std::ssize(trace.unknowns) != m) return;
    // The order in which the iteration lists them is no matter.
    std::vector<Expression> unknowns;
    for (int i = 0; i < m; ++i) unknowns.push_back(Expression::symbol(bar(i), kRankOfTemporary));
    const std::vector<Expression> point = stage_of(machine, unknowns, "in the iteration");
    const auto g = [&](int k) { return slope(machine, point, k); };
    std::vector<Expression> increments;
    for (int i = 0; i < m; ++i) {
      const auto place = std::ranges::find(trace.unknowns, unknowns[at(i)]);
      const bool known = place != trace.unknowns.end();
      claim(step_.name(i) + " is an unknown", Expression(known ? 1 : 0), Expression(1));
      if (!known) return;
      const auto j = static_cast<std::size_t>(place - trace.unknowns.begin());
      increments.push_back(trace.corrections[j]);
      if (!known_ || i == n_ - 1) claim("the start of " + step_.name(i), trace.starts[j], start(i));
    }
    if (trace.rule == Rule::fixed_point) {
      for (int i = 0; i < m; ++i) {
        claim("what the equations lack for " + step_.name(i), increments[at(i)],
              is_given(i) ? Expression(0) : row(i, g) - unknowns[at(i)]);
      }
      claim_refined(machine, trace, g);
      return;
    }
    claim_newton(machine, point, unknowns, increments);
  }

  // The matrix is what `differentiate` makes of the unknowns; the last increment is made.
  void claim_newton(SymbolicMachine& machine, const std::vector<Expression>& before,
                    const std::vector<Expression>& unknowns,
                    const std::vector<Expression>& increments) {
    const auto g = [&](int k) { return slope(machine, before, k); };
    const auto m = static_cast<int>(unknowns.size());
    const bool solved = machine.systems.size() == 1;
    claim("the number of linear systems", Expression(std::ssize(machine.systems)), Expression(1));
    if (!solved) return;
    const EliminatedSystem& system = machine.systems.front();
    const auto call = std::ranges::find(machine.calls, "differentiate", &CallTrace::routine);
    const bool at_unknowns =
        call != machine.calls.end() &&
        std::equal(unknowns.begin(), unknowns.end(), call->input.begin(), call->input.end());
    claim("the matrix is taken at the unknowns", Expression(at_unknowns ? 1 : 0), Expression(1));
    const bool linear = has("gradient_error");
    for (int i = 0; i < m; ++i) {
      if (!linear) {
        claim("what the equations lack for " + step_.name(i), system.right_side.at(at(i)),
              is_given(i) ? Expression(0) : row(i, g) - unknowns[at(i)]);
      }
      claim("the increment of the stage value of " + step_.name(i), increments[at(i)],
            system.solution.at(at(i)));
      claim("the last stage value of " + step_.name(i),
            machine.value({"start", "value", {{i, {}}}}), unknowns[at(i)] + increments[at(i)]);
    }
    if (linear) {
      claim_linear(machine, before);
    } else {
      claim_moved_slope(machine, before, increments, g);
    }
  }

  // The step moves by the gradient of the last iteration and H'' times the last increment, of which
  // the torn momenta have their share.
  void claim_moved_slope(SymbolicMachine& machine, const std::vector<Expression>& before,
                         const std::vector<Expression>& increments,
                         const std::function<Expression(int)>& g) {
    std::vector<Expression> input(before.begin(), before.begin() + std::ssize(increments));
    input.insert(input.end(), increments.begin(), increments.end());
    const auto call = std::ranges::find(machine.calls, curvature(), &CallTrace::routine);
    const bool is_there = call != machine.calls.end() && call->input == input;
    claim("H'' times the last increment is taken at the unknowns", Expression(is_there ? 1 : 0),
          Expression(1));
    if (!is_there) return;
    const auto& [alpha, beta, gamma] = member_;
    const Expression h = step_size();
    claim_increments(machine, [&](int k) {
      if (!reduced_ || k < n_) return g(k) + call->output[at(k)];
      const Expression own = mass(k - n_) / (Expression(1) + h * beta * mass(k - n_));
      return g(k) - h * (Expression(1) - alpha) * own * call->output[at(k - n_)];
    });
  }

  // H is quadratic, its gradient H'' z: whatever was rounded in the slopes taken at this point, the
  // step is that of the equations solved there.
  void claim_linear(SymbolicMachine& machine, const std::vector<Expression>& point) {
    const Expression h = step_size();
    const auto& [alpha, beta, gamma] = member_;
    const auto times = [&](int k, const std::function<Expression(int)>& vector) {
      std::vector<Expression> terms;
      for (const int j : partners_[at(k)]) terms.push_back(derivatives_.second(k, j) * vector(j));
      return Expression::sum(std::move(terms));
    };
    const auto exact = [&](int k) { return times(k, [&](int j) { return point[at(j)]; }); };
    const auto own = [&](int i) {
      return Expression::power(Expression(1) + h * beta * mass(i), Expression(-1));
    };
    // What is torn out is solved for before the rest.
    std::vector<Expression> off(at(2 * n_), Expression(0));
    for (int i = n_; reduced_ && i < 2 * n_; ++i)
      off[at(i)] = (row(i, exact) - point[at(i)]) * own(i - n_);
    const auto torn = [&](int k) { return exact(k) + times(k, [&](int j) { return off[at(j)]; }); };
    const EliminatedSystem& system = machine.systems.front();
    for (std::size_t i = 0; i < system.solution.size(); ++i) {
      const int k = static_cast<int>(i);
      claim("what the equations lack for " + step_.name(k), system.right_side[i],
            row(k, torn) - point[i]);
    }
    const auto moved = [&](int j) {
      if (at(j) < system.solution.size()) return system.solution[at(j)];
      const Expression force =
          times(j - n_, [&](int l) { return l < n_ ? system.solution[at(l)] : Expression(0); });
      return off[at(j)] - h * (Expression(1) - alpha) * own(j - n_) * force;
    };
    claim_increments(machine, [&](int k) { return exact(k) + times(k, moved); });
  }
  void claim_refined(SymbolicMachine& machine, const IterationTrace& trace,
                     const std::function<Expression(int)>& g) {
    const bool all = std::ssize(trace.changes) == 2 * n_;
    claim("the number of components refined", Expression(std::ssize(trace.changes)),
          Expression(2 * n_));
    if (!all) return;
    for (int k = 0; k < 2 * n_; ++k) {
      claim("dH/d" + step_.name(k) + " at the fixed point", trace.gradient[at(k)], g(k));
    }
    claim_increments(machine, [&](int k) { return g(k) + trace.changes[at(k)]; });
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const FamilyParameters member_;
  std::optional<int> sweeps_;
  int n_;
  bool known_ = false;  // is the start?
  bool raised_;         // K stands in for H, and so do `derivatives`
  bool reduced_;        // the momenta are torn out
  // They depend on dT/dp, which is linear in them then, and is looked into.
  bool local_;  // is dT/dp what the routine itself makes of its momenta?
  std::vector<std::vector<int>> partners_;
  Identities identities_;
};

}  // namespace

std::vector<Identities> loop_member_identities(const StepUnderProof& step,
                                               const Derivatives& derivatives, const Member& member,
                                               std::optional<int> sweeps) {
  return LoopMemberClaims(step, derivatives, uniform_parameters(member).value(), sweeps).run();
}

}  // namespace hamgen
