// The system as mathematics: H, its gradient and Hessian, in one canonical order.
//
// The state is z = (q, p), q first (Hairer, Lubich and Wanner write (p, q)); z' = J grad H with
// J = [[0, I], [-I, 0]].
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/kernel.hpp"
#include "generator/mechanics/quantity_list.hpp"

namespace hamgen {

struct NamedExpression {
  std::string name;
  Expression value;
  bool only_observed = false;  // an "invariant" that need not be conserved
  std::string comment = {};    // of its author
  // Of an event, which is looked for where the value crosses zero: the directions that count.
  bool rising = false, falling = false;

  [[nodiscard]] bool is_event() const { return rising || falling; }
};

// A summand of H as it was written.
struct EnergyTerm {
  std::string text;
  int line = 0;                          // of the model's file
  std::set<std::string> variables = {};  // of the state; not known of large systems
};

struct Mechanics {
  std::string name;
  std::string hamiltonian_text;                                  // as the user wrote it
  std::vector<std::pair<std::string, std::string>> definitions;  // of what it names, the same
  int degrees_of_freedom = 0;                                    // n
  bool has_time = false;             // the last one is t with its momentum p_t, and H contains p_t
  QuantityList variables;            // 2n: q1..qn, p1..pn
  std::vector<EnergyTerm> terms;     // of H, numbered from 0
  std::vector<Quantity> parameters;  // run-time parameters, in declaration order
  std::vector<Quantity> constants;   // parameters whose values have been put in
  // Large systems keep their sums as loops: then the kernels hold H and its derivatives, and the
  // written-out expressions below are empty.
  std::vector<Kernel> kernels;
  std::vector<CollectiveSum> sums;  // of which H has a function besides
  Expression of_sums;
  Expression energy;                                  // H(z), sums written out
  std::vector<Expression> gradient;                   // 2n
  std::map<std::pair<int, int>, Expression> hessian;  // nonzero entries, i <= j
  std::vector<NamedExpression> invariants;

  // d^2 H / dz_i dz_j, zero where absent.
  [[nodiscard]] Expression second_derivative(int i, int j) const;
  [[nodiscard]] bool keeps_sums() const { return !kernels.empty(); }
  // No mixed derivative in q and p.
  [[nodiscard]] bool is_separable() const;
  // The place of t, or of its momentum.
  [[nodiscard]] bool is_time(const AffineIndex& place) const;
  [[nodiscard]] bool is_momentum_of_time(const AffineIndex& place) const;
  // The symbol of z_i.
  [[nodiscard]] Expression variable(int i) const;
};

// Ranks of symbols: they give every sum and product its order.
inline constexpr int kRankOfStep = -2;          // h
inline constexpr int kRankOfParameter = 0;      // + position
inline constexpr int kRankOfVariable = 100000;  // + position in z
inline constexpr int kRankOfTemporary = 500'000'000;

[[nodiscard]] std::string to_text(const Mechanics& mechanics);

}  // namespace hamgen
