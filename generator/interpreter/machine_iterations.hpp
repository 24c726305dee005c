// The iterations of a routine, with the rules of generator/numerics.
#pragma once

#include "generator/interpreter/machine_addresses.hpp"

namespace hamgen {

template <class Real>
class MachineIterations : public MachineAddresses<Real> {
 protected:
  using Base = MachineAddresses<Real>;
  using Base::Base;
  using Base::m_;
  using Base::magnitude;
  using typename Base::Array2;
  using typename Base::Compiled;
  using typename Base::Distance;
  using Step = std::function<bool()>;  // false: the routine has ended
  using Steps = std::vector<Step>;

  static bool run_all(const Steps& steps) {
    return std::ranges::all_of(steps, [](const Step& step) { return step(); });
  }

  template <class Each>
  bool run_newton_on(AnyNewtonRule<Real>& rule, bool predicted, const Each& each,
                     const Steps& body) const {
    rule.begin(predicted);
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      Real size = 0;
      Real scale = 0;
      each([&](const Array2& u) {
        size += magnitude(m_.frame.at(u.increment));
        scale += magnitude(m_.frame.at(u.value)) + magnitude(u.beside(m_.frame));
      });
      const Answer answer = rule(size, scale, static_cast<int>(m_.iteration));
      if (answer != Answer::go_on) m_.report.iterations += m_.iteration;
      if (answer == Answer::failed) m_.report.increment = size;
      if (answer != Answer::go_on) return answer == Answer::done;
      each([&](const Array2& u) { m_.frame.at(u.value) += m_.frame.at(u.increment); });
    }
  }

  template <class Each>
  bool run_contraction(Object<Real>& memory, const std::string& name, const std::string& flag,
                       const Each& each, const Steps& body, const Address& residual) const {
    const bool newton = !flag.empty();
    if (newton) {
      memory.simplified.at(name)->begin(memory.flags.at(flag) != 0);
    } else {
      memory.contractions.at(name)->begin();
    }
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      Distance distance;
      each([&](const Array2& u) {
        Real& value = m_.frame.at(u.value);
        const Real increment = m_.frame.at(u.increment);
        distance.add(magnitude(increment), magnitude(value) + magnitude(u.beside(m_.frame)));
        value += increment;
      });
      const auto iteration = static_cast<int>(m_.iteration);
      Answer answer = Answer::go_on;
      Real size = 0;
      if (newton) {
        bool factorised = memory.flags.at(flag) != 0;
        AnySimplifiedNewtonRule<Real>& rule = *memory.simplified.at(name);
        answer = rule(distance, m_.frame.at(residual), factorised, iteration);
        memory.flags.at(flag) = factorised ? 1 : 0;
        size = rule.size();
      } else {
        AnyFixedPointRule<Real>& rule = *memory.contractions.at(name);
        answer = rule(distance, iteration);
        size = rule.size();
      }
      if (answer == Answer::go_on) continue;
      m_.report.iterations += m_.iteration;
      if (answer == Answer::failed) m_.report.increment = size;
      return answer == Answer::done;
    }
  }
  template <class Each>
  bool run_settling(AnyContractionRule<Real>& rule, int work, const Each& each,
                    const Steps& body) const {
    rule.begin(work);
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      Distance distance;
      each([&](const Array2& u) {
        Real& value = m_.frame.at(u.value);
        const Real increment = m_.frame.at(u.increment);
        distance.add(magnitude(increment), magnitude(value) + magnitude(u.beside(m_.frame)));
        value += increment;
      });
      const Answer answer = rule(distance, static_cast<int>(m_.iteration));
      if (answer == Answer::go_on) continue;
      m_.report.iterations += m_.iteration;
      if (answer == Answer::failed) m_.report.increment = rule.size();
      return answer == Answer::done;
    }
  }
  bool run_newton(AnyNewtonRule<Real>& rule, bool predicted, const std::vector<Compiled>& unknowns,
                  const Steps& body) const {
    rule.begin(predicted);
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      Real size = 0;
      Real scale = 0;
      std::vector<Real> corrections;
      for (const Compiled& u : unknowns) {
        corrections.push_back(u.correction(m_.frame));
        size += magnitude(corrections.back());
      }
      // From the left, term by term, as it is written.
      for (const Compiled& u : unknowns) {
        scale += magnitude(m_.frame.at(u.target));
        scale += magnitude(u.start(m_.frame));
      }
      const Answer answer = rule(size, scale, static_cast<int>(m_.iteration));
      if (answer != Answer::go_on) m_.report.iterations += m_.iteration;
      if (answer == Answer::failed) m_.report.increment = size;
      if (answer != Answer::go_on) return answer == Answer::done;
      for (std::size_t j = 0; j < unknowns.size(); ++j) {
        m_.frame.at(unknowns[j].target) += corrections[j];
      }
    }
  }

  bool run_fixed_point(const std::vector<Compiled>& unknowns, const Steps& body) const {
    const auto rule = make_fixed_point_rule<Real>();
    for (m_.iteration = 1;; ++m_.iteration) {
      if (!run_all(body)) return false;
      std::vector<Real> increments;
      for (const Compiled& u : unknowns) increments.push_back(u.correction(m_.frame));
      Distance distance;
      for (std::size_t j = 0; j < unknowns.size(); ++j) {
        Real& value = m_.frame.at(unknowns[j].target);
        distance.add(magnitude(increments[j]),
                     magnitude(value) + magnitude(unknowns[j].start(m_.frame)));
        value += increments[j];
      }
      const Answer answer = (*rule)(distance, static_cast<int>(m_.iteration));
      if (answer == Answer::go_on) continue;
      m_.report.iterations += m_.iteration;
      if (answer == Answer::failed) m_.report.increment = rule->size();
      return answer == Answer::done;
    }
  }
};

}  // namespace hamgen
