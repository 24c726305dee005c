// Makes the steps of a machine from instructions that iterate.
#pragma once

#include "generator/interpreter/machine_memory.hpp"

namespace hamgen {

template <class Real>
class MachineIterationCompiler : public MachineMemory<Real> {
 protected:
  using Base = MachineMemory<Real>;
  using Base::address;
  using Base::compiled;
  using Base::for_all;
  using Base::index_of;
  using Base::judged;
  using Base::m_;
  using Base::object;
  using Base::range_of;
  using Base::run_all;
  using Base::run_contraction;
  using Base::run_newton;
  using Base::span;
  using Base::whole;
  using typename Base::Array2;
  using typename Base::Compiled;
  using typename Base::Distance;
  using typename Base::Range;
  using typename Base::Step;
  using typename Base::Steps;
  using typename Base::Whole;

  using Base::Base;
  using Base::operator();

  Step operator()(const Iterate& iterate) {
    const bool newton = iterate.rule == Rule::newton;
    std::vector<Unknown> list = iterate.unknowns;
    // A fixed point moves by the difference of the new value and the old one.
    for (Unknown& u : list) {
      if (!newton) u.correction = u.correction - Expression::symbol(u.symbol);
    }
    const std::vector<Compiled> unknowns = compiled(list);
    const int start = index_of("start");
    const Address memory = address(Place{"start", "value"});
    const Steps body = steps(iterate.body);
    return [this, unknowns, start, memory, body, newton, name = iterate.name, type = iterate.type] {
      const bool known = object(start).flags.at("known") != 0;
      Real* kept = &m_.frame.at(memory);
      for (const Compiled& u : unknowns) {
        m_.frame.at(u.target) = known ? kept[u.memory] : u.start(m_.frame);
      }
      const bool done = newton
                            ? solved_by_newton(*object(start).rules.at(name), known, unknowns, body)
                            : solved_by_fixed_point(type, unknowns, body);
      if (!done) return false;
      for (const Compiled& u : unknowns) {
        kept[u.memory] = m_.frame.at(u.target);
        if (newton) kept[u.memory] += u.correction(m_.frame);
      }
      return true;
    };
  }
  Step operator()(const IterateArray& iterate) {
    std::vector<Array2> unknowns;
    for (const UnknownArray& u : iterate.unknowns) {
      unknowns.push_back({address(u.value), address(u.increment), compiled(u.beside), u.by_torn});
    }
    std::vector<Range> ranges;
    for (const KernelRange& range : iterate.ranges) ranges.push_back(range_of(range));
    const Address residual = iterate.residual.empty() ? Address{} : address(iterate.residual);
    const int start = index_of("start");
    const std::string flag = iterate.factorised ? iterate.factorised->field : "";
    const Steps body = steps(iterate.body);
    const std::vector<WholeUnknowns> arrays = whole_unknowns(this->routine_, iterate);
    const bool are_whole = !arrays.empty();
    std::vector<Whole> foreseen;  // values, increments, and where the step began
    if (!iterate.refinement.empty() && arrays.size() == 1) {
      const auto count = static_cast<std::size_t>(arrays[0].count);
      for (const Place& array : {arrays[0].value, arrays[0].increment, arrays[0].beside})
        foreseen.push_back({address(array), count});
    }
    // Linear equations ask for none.
    const Whole lengths =
        iterate.rule != Rule::newton
            ? Whole{}
            : Whole{address(iterate.values), static_cast<std::size_t>(iterate.count)};
    return [this, unknowns, ranges, residual, leaves_last = iterate.leaves_last, start, flag,
            are_whole, lengths, foreseen, body, rule = iterate.rule, name = iterate.name,
            work = iterate.work, behind = iterate.refinement] {
      Object<Real>& memory = object(start);
      const auto each = [&](const std::function<void(const Array2&)>& use) {
        for_all(ranges, 0, [&] {
          for (const Array2& u : unknowns) use(u);
        });
      };
      if (rule == Rule::newton || rule == Rule::linear) {
        const bool known = memory.flags.at("known") != 0;
        AnyNewtonRule<Real>& newton = *memory.rules.at(name);
        return run_newton(
            newton, known, body,
            [&](int iteration) {
              return this->judged_in_loops(newton, lengths, each, unknowns.size(), iteration);
            },
            [&] { this->move_each(each); });
      }
      const auto measure = [&] {
        return this->measure_each(each, are_whole, unknowns.size(), leaves_last);
      };
      if (rule == Rule::simplified_newton) {
        AnySimplifiedNewtonRule<Real>& newton = *memory.simplified.at(name);
        int& factorised = memory.flags.at(flag);
        newton.begin(factorised != 0);
        const auto judge = [&](const Distance& distance, int iteration) {
          bool serves = factorised != 0;
          const Answer answer = newton(distance, m_.frame.at(residual), serves, iteration);
          factorised = serves ? 1 : 0;
          return std::pair(answer, newton.size());
        };
        return run_contraction(body, measure, judge, [&](Answer) { this->move_each(each); });
      }
      AnyFixedPointRule<Real>& fixed_point = *memory.contractions.at(name);
      fixed_point.begin(work.value_or(0));
      const auto judge = [&](const Distance& distance, int iteration) {
        return judged(fixed_point, distance, iteration);
      };
      return run_contraction(body, measure, judge, [&](Answer answer) {
        if (leaves_last && answer != Answer::go_on && !fixed_point.moves()) return;
        if (!foreseen.empty())
          memory.refinements.at(behind)->foresee(fixed_point, span(foreseen[0]), span(foreseen[1]),
                                                 span(foreseen[2]));
        this->move_each(each);
      });
    };
  }
  Step operator()(const RefineArray& refine) {
    const auto count = static_cast<std::size_t>(refine.count);
    const auto components = static_cast<std::size_t>(refine.components);
    const Whole point{address(refine.point), count};
    const Whole lack{address(refine.lack), count};
    const Whole gradient{address(refine.gradient), components};
    const std::string& name = refine.refinement.field;
    const Whole slope = whole(Place{refine.refinement.object, name + ".slope"});
    const Whole change = whole(Place{refine.refinement.object, name + ".change"});
    const int target = index_of(refine.refinement.object);
    const int start = refine.rule.empty() && !refine.patience ? 0 : index_of("start");
    return [this, point, lack, gradient, slope, change, target, name, start, rule = refine.rule,
            begun = refine.begun, gives_up = refine.gives_up, steps_of_other = refine.steps,
            patience = refine.patience ? refine.patience->field : "", first = steps(refine.first),
            body = steps(refine.body), beside = compiled(refine.beside)] {
      AnyRefinement<Real>& refinement = *object(target).refinements.at(name);
      refinement.round_beside(beside(m_.frame));
      const bool begins = !first.empty();
      const bool is_left = begun && (rule.empty() || !object(start).contractions.at(rule)->moves());
      for (bool more = true, is_first = true; more; is_first = false) {
        const bool is_known = is_first && is_left;
        if (!is_known && !run_all(is_first && begins ? first : body)) return false;
        more = rule.empty() ? refinement(span(point), span(lack), span(gradient))
                            : refinement.refine(*object(start).contractions.at(rule), span(point),
                                                span(lack), span(gradient));
      }
      refinement.get_slope(span(slope));
      refinement.get_change(span(change));
      if (gives_up && object(start).contractions.at(rule)->gives_up()) return false;
      if (this->is_found(refinement)) return true;
      if (steps_of_other > 0) object(start).flags.at(patience) = steps_of_other;
      return false;
    };
  }
  Step operator()(const Refine& refine) {
    std::vector<Unknown> list = refine.unknowns;
    for (Unknown& u : list) u.correction = u.correction - Expression::symbol(u.symbol);
    const std::vector<Compiled> unknowns = compiled(list);
    std::vector<CompiledExpression<Real>> gradient;
    for (const Expression& e : refine.gradient) gradient.push_back(compiled(e));
    std::vector<Address> kept;
    for (const std::string& symbol : refine.kept) kept.push_back(address(symbol));
    const Address change{index_of(refine.name), 0, {}};
    return [this, unknowns, gradient, kept, change, body = steps(refine.body),
            beside = compiled(refine.beside)] {
      const auto refinement = Blocks<Real>::refinement(static_cast<int>(unknowns.size()),
                                                       static_cast<int>(gradient.size()));
      refinement->round_beside(beside(m_.frame));
      std::vector<Real> waiting(kept.size());
      for (bool more = true; more;) {
        if (!run_all(body)) return false;
        std::vector<Real> lack;
        std::vector<Real> slope;
        std::vector<Real> point;
        for (const Compiled& u : unknowns) {
          lack.push_back(u.correction(m_.frame));
          point.push_back(m_.frame.at(u.target));
        }
        for (const auto& component : gradient) slope.push_back(component(m_.frame));
        for (std::size_t j = 0; refinement->is_first() && j < kept.size(); ++j) {
          waiting[j] = m_.frame.at(kept[j]);
        }
        more = (*refinement)(point, lack, slope);
        for (std::size_t j = 0; j < point.size(); ++j) m_.frame.at(unknowns[j].target) = point[j];
      }
      for (std::size_t j = 0; j < kept.size(); ++j) m_.frame.at(kept[j]) = waiting[j];
      refinement->get_change({&m_.frame.at(change), gradient.size()});
      return this->is_found(*refinement);
    };
  }
  Step operator()(const Sweep& sweep) {
    const std::vector<Compiled> unknowns = compiled(sweep.unknowns);
    std::vector<Address> results;
    for (const std::string& result : sweep.results) results.push_back(address(result));
    return [this, unknowns, results, body = steps(sweep.body), count = sweep.count] {
      for (const Compiled& u : unknowns) m_.frame.at(u.target) = u.start(m_.frame);
      for (int i = 0; i < count; ++i) {
        if (!run_all(body)) return false;
        std::vector<Real> next;
        for (const Compiled& u : unknowns) next.push_back(u.correction(m_.frame));
        for (std::size_t j = 0; j < next.size(); ++j) m_.frame.at(unknowns[j].target) = next[j];
      }
      for (std::size_t j = 0; j < results.size(); ++j) {
        m_.frame.at(results[j]) = m_.frame.at(unknowns[j].target);
      }
      m_.report.iterations = count;
      return true;
    };
  }

  // Of what is inside.
  virtual Steps steps(const Body& body) = 0;

 private:
  bool solved_by_newton(AnyNewtonRule<Real>& rule, bool predicted,
                        const std::vector<Compiled>& unknowns, const Steps& body) const {
    std::vector<Real> corrections;
    const auto judge = [&](int iteration) {
      corrections = this->corrections_of(unknowns);
      return this->judged(rule, unknowns, corrections, iteration);
    };
    return run_newton(rule, predicted, body, judge, [&] {
      for (std::size_t j = 0; j < unknowns.size(); ++j)
        m_.frame.at(unknowns[j].target) += corrections[j];
    });
  }
  bool solved_by_fixed_point(const std::string& type, const std::vector<Compiled>& unknowns,
                             const Steps& body) const {
    const auto rule = Blocks<Real>::fixed_point_rule(type);
    const auto move = [&] { return this->move_all(unknowns, this->corrections_of(unknowns)); };
    return run_contraction(body, move, [&](const Distance& distance, int iteration) {
      return judged(*rule, distance, iteration);
    });
  }
};

}  // namespace hamgen
