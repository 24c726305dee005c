// The stages of implicit Runge-Kutta methods: their equations, whichever way they are solved.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "generator/verify/stage_claims.hpp"

namespace hamgen {

namespace {

Expression mobility_of(SymbolicMachine& machine, const StepUnderProof& step, long j) {
  return has_mobility(step) ? machine.value(of_k("mobility", j)) : Expression(1);
}

// Rows and columns of two stages in 1 - coupling h b J H'', or of their coordinates in
// 1 + twice h b V'' / m.  Of entries that are as they should be
// as they stand the first is claimed for all.
void add_block(Claims& claims, const StepUnderProof& step, const EliminatedSystem& system,
               std::pair<long, long> stages, const Expression& weight,
               const std::vector<Expression>& hessian, bool coordinates) {
  const Substitution meaning = meaning_of(claims.machine());
  const StageLayout layout = step.code.stages->without_room();
  const long dimension = step.size();
  const long n = dimension / 2;
  const long components = coordinates ? n : dimension;
  for (long j = 0; j < components; ++j) {
    for (long c = 0; c < components; ++c) {
      const std::pair at(layout.at(stages.first, j), layout.at(stages.second, c));
      const auto entry = system.matrix.find(at);
      const Expression emitted =
          entry == system.matrix.end() ? Expression(0) : substitute(entry->second, meaning);
      const long row = coordinates ? j : (j + n) % dimension;
      const Expression& second = hessian[static_cast<std::size_t>(row * dimension + c)];
      const Expression unit(at.first == at.second ? 1 : 0);
      const Expression expected =
          coordinates ? unit + weight * mobility_of(claims.machine(), step, j) * second
          : j < n     ? unit - weight * second
                      : unit + weight * second;
      if (emitted != expected || j + c == 0)
        claims.add("an entry of Newton's matrix", emitted, expected);
    }
  }
}

// The stages Y_i are free.  What they lack is z + carry + sum_j coupling_ij L_j - Y_i with
// L_j = h b_j f(Y_j), and the step adds up the L_j, with what the rounded stages lack of the exact
// ones.  Newton's matrix is that of one Hessian for all stages, which decides how fast it
// converges, and not to what; and so do the momenta that are eliminated.
class ImplicitStages {
 public:
  ImplicitStages(const StepUnderProof& step, const Derivatives& derivatives)
      : step_(step),
        derivatives_(derivatives),
        layout_(*step.code.stages),
        packed_(layout_.without_room()),
        n_(layout_.dimension / 2),
        claims_(step, {"vector_field", "vector_fields", "forces", "hessian"}),
        machine_(claims_.machine()) {
    for (long i = 0; i < layout_.stages; ++i) {
      coupling_.push_back(row_of(machine_, layout_, "coupling", i));
      scaled_.push_back(machine_.value(of_k("scaled", i)));
    }
    machine_.skip("eliminate_momenta");  // which has claims of its own
    machine_.run("solve");
  }

  Identities run() {
    claims_.add_count("the number of iterations", machine_.iterations.empty() ? 0 : 1, 1);
    if (machine_.iterations.empty()) return claims_.take();
    std::size_t system = 0;
    for (const IterationTrace& trace : machine_.iterations) {
      const long components = components_of(trace, layout_);
      claims_.add_count("the number of stages", trace.unknowns.size(),
                        nth(layout_.room() * components));
      if (std::ssize(trace.unknowns) != layout_.room() * components) return claims_.take();
      const bool newton = trace.rule != Rule::fixed_point;
      if (newton && system == machine_.systems.size()) break;
      const EliminatedSystem* solved = newton ? &machine_.systems[system++] : nullptr;
      if (components == n_) {
        add_coordinates(trace.unknowns, trace.corrections, solved, Which::iteration);
      } else {
        add_lack(trace.unknowns, trace.corrections, solved);
      }
      if (solved == nullptr) continue;
      for (long i = 0; i < layout_.stages; ++i) {
        for (long j = 0; j < components; ++j)
          claims_.add(fmt::format("the increment of stage {}, {}", i + 1, name(j)),
                      trace.corrections[nth(layout_.at(i, j))],
                      solved->solution.at(nth(packed_.at(i, j))));
      }
      if (!add_matrix(trace, *solved)) break;
    }
    add_end(std::span(machine_.systems).subspan(system));
    return claims_.take();
  }

 private:
  [[nodiscard]] std::string name(long j) const { return step_.name(static_cast<int>(j)); }
  [[nodiscard]] Expression variable(long j) const {
    return step_.mechanics.variable(static_cast<int>(j));
  }

  // h b_m f(Y_m) where the stages are these.
  Expression slope(const std::vector<Expression>& all, long m, long j) const {
    for (const CallTrace& call : machine_.calls) {
      if (call.routine == "vector_fields" && call.input == all)
        return scaled_[nth(m)] * call.output[nth(layout_.at(m, j))];
      if (call.routine != "vector_field") continue;
      const auto first = all.begin() + layout_.at(m, 0);
      if (std::ranges::equal(call.input, std::span(first, nth(layout_.dimension))))
        return scaled_[nth(m)] * call.output[nth(j)];
    }
    return Expression::symbol("nothing at stage " + std::to_string(m + 1));
  }
  // h b_m times the force on coordinate j at stage m, where the coordinates are these: of the call
  // in the iteration, or of the last one.
  enum class Which { iteration, last };
  Expression force(const std::vector<Expression>& coordinates, long m, long j,
                   Which which = Which::iteration) const {
    const CallTrace* found = nullptr;
    for (const CallTrace& call : machine_.calls) {
      if (call.routine != "forces" || (found != nullptr && which == Which::iteration)) continue;
      if (std::ranges::equal(std::span(call.input.begin(), coordinates.size()), coordinates))
        found = &call;
    }
    return found != nullptr ? scaled_[nth(m)] * found->output[nth(layout_.at(m, n_ + j))]
                            : Expression::symbol("no force at stage " + std::to_string(m + 1));
  }

  // What the stages lack, or what a matrix is multiplied with that contracts better.
  void add_lack(const std::vector<Expression>& stages, const std::vector<Expression>& lacks,
                const EliminatedSystem* solved) {
    for (long i = 0; i < layout_.stages; ++i) {
      for (long j = 0; j < layout_.dimension; ++j) {
        const std::size_t row = nth(layout_.at(i, j));
        Expression lack = variable(j) + step_.carry(static_cast<int>(j)) - stages[row];
        for (long m = 0; m < layout_.stages; ++m)
          lack += coupling_[nth(i)][nth(m)] * slope(stages, m, j);
        const std::size_t equation = nth(packed_.at(i, j));
        const bool is_solved = solved != nullptr && equation < solved->right_side.size();
        claims_.add(fmt::format("what stage {} lacks of {}", i + 1, name(j)),
                    is_solved ? solved->right_side[equation] : lacks[row], lack);
      }
    }
  }

  // Of q + h c dH/dp(p) + (h A)^2 times the accelerations, which the exact coordinates are but for
  // the carry.
  void add_coordinates(const std::vector<Expression>& coordinates,
                       const std::vector<Expression>& lacks, const EliminatedSystem* solved,
                       Which which) {
    for (long i = 0; i < layout_.stages; ++i) {
      const Expression node = machine_.value(of_k("node", i));
      const std::vector<Expression> twice = row_of(machine_, layout_, "twice", i);
      for (long j = 0; j < n_; ++j) {
        const std::size_t row = nth(layout_.at(i, j));
        Expression pushed(0);
        for (long m = 0; m < layout_.stages; ++m)
          pushed += twice[nth(m)] * force(coordinates, m, j, which);
        claims_.add(fmt::format("what coordinate {} of stage {} lacks", name(j), i + 1),
                    solved != nullptr ? solved->right_side.at(nth(packed_.at(i, j))) : lacks[row],
                    variable(j) + node * derivatives_.first(static_cast<int>(n_ + j)) +
                        mobility(j) * pushed - coordinates[row]);
      }
    }
  }
  // Where the coordinates are these.
  void add_momenta(const std::vector<Expression>& stages) {
    const std::vector<Expression> coordinates(stages.begin(), stages.begin() + layout_.at(0, n_));
    for (long i = 0; i < layout_.stages; ++i) {
      for (long j = 0; j < n_; ++j) {
        Expression momentum = variable(n_ + j) + step_.carry(static_cast<int>(n_ + j));
        for (long m = 0; m < layout_.stages; ++m)
          momentum += coupling_[nth(i)][nth(m)] * force(coordinates, m, j);
        claims_.add(fmt::format("the momentum of stage {}, {}", i + 1, name(n_ + j)),
                    stages[nth(layout_.at(i, n_ + j))], momentum);
      }
    }
  }
  Expression mobility(long j) { return mobility_of(machine_, step_, j); }

  // 1 - coupling h b J H'' at the mean.
  bool add_matrix(const IterationTrace& trace, const EliminatedSystem& solved) {
    const auto hessian = std::ranges::find(machine_.calls, "hessian", &CallTrace::routine);
    claims_.add_count("the number of Hessians", hessian == machine_.calls.end() ? 0 : 1, 1);
    if (hessian == machine_.calls.end()) return false;
    const long components = components_of(trace, layout_);
    for (long j = 0; j < components; ++j) {
      Expression sum(0);
      for (long m = 0; m < layout_.stages; ++m) sum += trace.unknowns[nth(layout_.at(m, j))];
      claims_.add("the mean of the stages", hessian->input[nth(j)],
                  sum * Expression(Rational(1, layout_.stages)));
    }
    const bool coordinates = components == n_;
    for (long i = 0; i < layout_.stages; ++i) {
      const std::vector<Expression> row =
          coordinates ? row_of(machine_, layout_, "twice", i) : coupling_[nth(i)];
      for (long m = 0; m < layout_.stages; ++m) {
        add_block(claims_, step_, solved, {i, m}, row[nth(m)] * scaled_[nth(m)], hessian->output,
                  coordinates);
      }
    }
    return true;
  }

  // What is refined, and the sum.  Where the momenta are eliminated the coordinates are, which lack
  // there what all equations say, and what they alone say once they have been moved.
  void add_end(std::span<const EliminatedSystem> solved) {
    const IterationTrace& last = machine_.iterations.back();
    const long components = components_of(last, layout_);
    const std::size_t count = nth(layout_.room() * components);
    claims_.add_count("the number of components refined", last.changes.size(),
                      nth(layout_.count()));
    claims_.add_count("the number of unknowns refined", last.refined_at.size(), count);
    if (std::ssize(last.changes) != layout_.count() || last.refined_at.size() != count) return;
    const bool coordinates = components == n_;
    std::vector<Expression> stages = last.refined_at;
    std::vector<Expression> lack = last.refined_lack;
    for (long i = std::ssize(stages); i < layout_.count(); ++i) {
      stages.push_back(machine_.value(of_start("value", i)));
      lack.push_back(machine_.value(of_start("lack", i)));
    }
    add_lack(stages, lack, solved.empty() ? nullptr : solved.data());
    if (coordinates) {
      add_momenta(stages);
      add_coordinates(last.refined_at, last.moved_lack, solved.size() < 2 ? nullptr : &solved[1],
                      Which::last);
    }
    for (long j = 0; j < layout_.dimension; ++j) {
      const auto i = static_cast<int>(j);
      Expression sum = step_.carry(i);
      for (long m = 0; m < layout_.stages; ++m) {
        sum += slope(stages, m, j);
        sum += coordinates && j < n_ ? velocity_change(lack, last.changes, m, j)
                                     : last.changes[nth(layout_.at(m, j))];
      }
      claims_.add("the increment of " + step_.name(i), step_.increment(machine_, i), sum);
    }
  }
  // h b_m times the velocity that the momentum of stage m lacks, with what the forces change by.
  Expression velocity_change(const std::vector<Expression>& lack,
                             const std::vector<Expression>& changes, long m, long j) {
    Expression momentum = lack[nth(layout_.at(m, n_ + j))];
    for (long l = 0; l < layout_.stages; ++l)
      momentum += coupling_[nth(m)][nth(l)] * changes[nth(layout_.at(l, n_ + j))];
    return scaled_[nth(m)] * mobility(j) * momentum;
  }

  const StepUnderProof& step_;
  const Derivatives& derivatives_;
  const StageLayout& layout_;
  StageLayout packed_;
  long n_;
  Claims claims_;
  SymbolicMachine& machine_;
  std::vector<std::vector<Expression>> coupling_;
  std::vector<Expression> scaled_;
};

}  // namespace

Identities implicit_stages_identities(const StepUnderProof& step, const Derivatives& derivatives) {
  return ImplicitStages(step, derivatives).run();
}

Identities elimination_identities(const StepUnderProof& step) {
  Claims claims(step);
  SymbolicMachine& machine = claims.machine();
  const StageLayout& layout = *step.code.stages;
  const long n = layout.dimension / 2;
  std::vector<Expression> lack;
  for (long i = 0; i < layout.count(); ++i) lack.push_back(machine.value(of_start("lack", i)));
  machine.run("eliminate_momenta");
  for (long i = 0; i < layout.stages; ++i) {
    const std::vector<Expression> coupling = row_of(machine, layout, "coupling", i);
    for (long j = 0; j < layout.dimension; ++j) {
      const Expression emitted = machine.value(of_start("lack", layout.at(i, j)));
      Expression expected = lack[nth(layout.at(i, j))];
      for (long m = 0; j < n && m < layout.stages; ++m) {
        const Expression mobility =
            has_mobility(step) ? machine.value(of_k("mobility", j)) : Expression(1);
        expected += mobility * coupling[nth(m)] * machine.value(of_k("scaled", m)) *
                    lack[nth(layout.at(m, n + j))];
      }
      claims.add(
          fmt::format("the elimination at stage {}, {}", i + 1, step.name(static_cast<int>(j))),
          emitted, expected);
    }
  }
  return claims.take();
}

}  // namespace hamgen
