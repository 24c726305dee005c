#include "generator/mechanics/cancelling_forces.hpp"

#include <algorithm>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/evaluate.hpp"

namespace hamgen {

namespace {

// So many terms of a product of sums are looked at.
constexpr double kMostMultipliedOut = 256;

// So many terms has e, sums in products multiplied out; more than that need not be counted.
double count_terms(const Expression& e) {
  const bool is_sum = e.kind() == Kind::sum;
  if (!is_sum && e.kind() != Kind::product) return 1;
  double count = is_sum ? 0 : 1;
  for (const Expression& operand : e.operands()) {
    if (count > kMostMultipliedOut) break;
    count = is_sum ? count + count_terms(operand) : count * count_terms(operand);
  }
  return count;
}

void add_terms(const Expression& e, const Expression& factor, std::vector<Expression>& terms) {
  if (e.kind() == Kind::sum) {
    for (const Expression& term : e.operands()) add_terms(term, factor, terms);
    return;
  }
  if (e.kind() == Kind::product) {
    const auto& operands = e.operands();
    const auto is_sum = [](const Expression& x) { return x.kind() == Kind::sum; };
    if (const auto sum = std::ranges::find_if(operands, is_sum); sum != operands.end()) {
      std::vector<Expression> rest(operands.begin(), sum);
      rest.insert(rest.end(), sum + 1, operands.end());
      const Expression others = Expression::product(std::move(rest));
      for (const Expression& term : sum->operands()) add_terms(others * term, factor, terms);
      return;
    }
  }
  terms.push_back(factor * e);
}

// The size of an expression, with `abs` where its sign is not known.
Expression size_of(const Expression& e) {
  switch (e.kind()) {
    case Kind::number:
      return Expression(Rational(abs(e.number())));
    case Kind::product: {
      std::vector<Expression> factors;
      for (const Expression& factor : e.operands()) factors.push_back(size_of(factor));
      return Expression::product(std::move(factors));
    }
    case Kind::power: {
      const Expression& exponent = e.operands()[1];
      const bool is_even = exponent.is_number() && exponent.number().get_den() == 1 &&
                           exponent.number().get_num() % 2 == 0;
      return is_even ? e : Expression::power(size_of(e.operands()[0]), exponent);
    }
    case Kind::function:
      if (e.name() == "exp" || e.name() == "abs") return e;
      break;
    case Kind::symbol:
    case Kind::sum:
      break;
  }
  return Expression::apply("abs", {e});
}

// Values of the state at zero, of the parameters as they are declared.
class AtZero {
 public:
  explicit AtZero(const Mechanics& mechanics) {
    for (const Quantity& parameter : mechanics.parameters)
      values_.emplace(parameter.name, parameter.value);
    close_by_ = values_;
  }
  void add(const std::string& variable) {
    values_.emplace(variable, Rational(0));
    // Differences of variables change as well.
    const auto number = static_cast<long>(zero_.size() + 1);
    close_by_.emplace(variable, Rational(number) / Rational(Integer(1) << 60));
    zero_.emplace(variable, Expression(0));
  }
  [[nodiscard]] std::optional<Rational> value(const Expression& e) const {
    return evaluate(e, values_);
  }
  // In the parameters, with a power of two for what is a number: only its size counts.
  [[nodiscard]] Expression size(const Expression& e) const {
    return size_of(folded(substitute(e, zero_)));
  }
  // Does a 2^-60th away from zero an expression differ by more than a 2^-80th of itself?
  [[nodiscard]] bool has_slope(const Expression& e) const {
    const std::optional<Rational> here = value(e);
    const std::optional<Rational> there = evaluate(e, close_by_);
    if (!here || !there) return false;
    return abs(*there - *here) > abs(*here) / Rational(Integer(1) << 80);
  }
  [[nodiscard]] bool depends(const Expression& e) const {
    return std::ranges::any_of(symbols(e), [&](const auto& name) { return zero_.contains(name); });
  }

 private:
  static Expression folded(const Expression& e) {
    if (symbols(e).empty()) {
      if (const std::optional<Rational> number = evaluate(e, {})) return Expression(*number);
      return e;
    }
    if (e.operands().empty()) return e;
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) operands.push_back(folded(operand));
    return with_operands(e, std::move(operands));
  }

  Values values_, close_by_;
  Substitution zero_;
};

// A number as the power of two that is next above it.
Expression rounded_up(const Expression& e) {
  if (!e.is_number() || e.is_zero()) return e;
  Rational power(1);
  while (power < e.number()) power *= 2;
  while (power / 2 >= e.number()) power /= 2;
  return Expression(power);
}

// The terms of forces that do not vanish at zero.
struct TermsAtZero {
  std::vector<Expression> terms;
  Rational total = 0, all = 0;  // what they come to together, and their sizes do
  bool have_slope = false;      // does one of them change with the state there?

  // False where they have no values there, or are too many.
  bool add(const Expression& force, const AtZero& zero) {
    if (count_terms(force) > kMostMultipliedOut) return false;
    std::vector<Expression> all_terms;
    add_terms(force, Expression(1), all_terms);
    for (Expression& term : all_terms) {
      const std::optional<Rational> value = zero.value(term);
      if (!value) return false;
      if (*value == 0) continue;
      total += *value;
      all += abs(*value);
      have_slope = have_slope || zero.has_slope(term);
      terms.push_back(std::move(term));
    }
    return true;
  }
  [[nodiscard]] bool cancel() const { return have_slope && abs(total) * 1'000'000'000'000 <= all; }
};

// Of the forces on all elements, to be had in one pass.
class SizesOfElements {
 public:
  explicit SizesOfElements(const Mechanics& mechanics) : n_(mechanics.degrees_of_freedom) {}
  void add(const Kernel& kernel, std::size_t slot, const Rational& size) {
    if (size != 0) parts_.push_back({&kernel, slot, size.get_d()});
  }
  // What they come to is no less than a quarter of the whole for any element: at the end of a chain
  // it may be a half.
  [[nodiscard]] bool are_alike(const Rational& whole) const {
    std::vector<double> sums(static_cast<std::size_t>(n_), 0.0);
    for (const Part& part : parts_) {
      for_each_instance(part.kernel->ranges, [&](const std::vector<long>& indices) {
        const AffineIndex& position = part.kernel->slots[part.slot].position;
        sums[static_cast<std::size_t>(value_at(position, part.kernel->ranges, indices))] +=
            part.size;
      });
    }
    return std::ranges::all_of(sums, [&](double sum) { return 4 * sum >= whole.get_d(); });
  }

 private:
  struct Part {
    const Kernel* kernel;
    std::size_t slot;
    double size;
  };
  int n_;
  std::vector<Part> parts_;
};

Expression sum_of_sizes(const std::vector<Expression>& terms, const AtZero& zero) {
  std::vector<Expression> sizes;
  for (const Expression& term : terms) sizes.push_back(zero.size(term));
  return rounded_up(Expression::sum(std::move(sizes)));
}

Expression slope_at_zero(const Expression& slope, const AtZero& zero) {
  const std::optional<Rational> value = zero.value(slope);
  return value && *value != 0 ? zero.size(slope) : Expression(0);
}

}  // namespace

std::map<int, CancellingForce> cancelling_forces(const Mechanics& mechanics) {
  std::map<int, CancellingForce> found;
  AtZero zero(mechanics);
  const int size = 2 * mechanics.degrees_of_freedom;
  for (int i = 0; i < size; ++i) zero.add(mechanics.variable(i).name());
  for (int k = 0; k < static_cast<int>(mechanics.gradient.size()); ++k) {
    const Expression& force = mechanics.gradient[static_cast<std::size_t>(k)];
    if (!zero.depends(force)) continue;
    TermsAtZero terms;
    if (!terms.add(force, zero) || !terms.cancel()) continue;
    const Expression slope = slope_at_zero(derivative(force, mechanics.variable(k)), zero);
    if (slope.is_zero()) continue;
    found.emplace(k, CancellingForce{sum_of_sizes(terms.terms, zero), rounded_up(slope)});
  }
  return found;
}

std::optional<CancellingForce> cancelling_force_in_loops(const Mechanics& mechanics) {
  AtZero zero(mechanics);
  TermsAtZero terms;
  std::vector<Expression> slopes;
  SizesOfElements sizes(mechanics);
  for (const Kernel& kernel : mechanics.kernels) {
    if (!uses_coordinates(kernel) || kernel.ranges.size() != 1) continue;
    for (const Slot& slot : kernel.slots) zero.add(slot.symbol);
    for (std::size_t s = 0; s < kernel.slots.size(); ++s) {
      if (kernel.slots[s].is_momentum) continue;
      const Rational before = terms.all;
      if (kernel.sum || !terms.add(kernel.gradient[s], zero)) return {};
      sizes.add(kernel, s, Rational(terms.all - before));
      const auto second = kernel.hessian.find({s, s});
      if (second != kernel.hessian.end()) slopes.push_back(slope_at_zero(second->second, zero));
    }
  }
  if (!terms.cancel() || !sizes.are_alike(terms.all)) return {};
  const Expression slope = Expression::sum(std::move(slopes));
  if (slope.is_zero()) return {};
  return CancellingForce{sum_of_sizes(terms.terms, zero), rounded_up(slope)};
}

Expression CancellingForce::reach() const {
  return Expression::power(slope * Expression(2) / terms, Expression(2));
}

Expression nearness(const Expression& far) {
  return Expression(1) / (Expression(1) + Expression::power(far, Expression(8)));
}

Expression rounded_beside(const CancellingForce& force, const Expression& answer) {
  const Expression moved = size_of(answer);
  return moved * force.terms / (Expression(1) + moved * force.slope);
}

std::optional<Expression> common_length(const Mechanics& mechanics,
                                        const std::vector<Expression>& lengths) {
  Values values{{"h", Rational(1, 64)}};
  for (const Quantity& parameter : mechanics.parameters)
    values.emplace(parameter.name, parameter.value);
  // What else they are made of is the state.
  for (const Expression& length : lengths) {
    for (const std::string& name : symbols(length)) {
      if (name != "pi") values.emplace(name, Rational(0));
    }
  }
  std::optional<Rational> least, most;
  for (const Expression& length : lengths) {
    const std::optional<Rational> value = evaluate(length, values);
    if (!value || *value <= 0) return {};
    if (!least || *value < *least) least = value;
    if (!most || *value > *most) most = value;
  }
  if (!least || *most > 16 * *least) return {};
  return lengths[0];
}

std::vector<Expression> rounded_beside(const Mechanics& mechanics, const WeightOfGradient& weight) {
  const int size = 2 * mechanics.degrees_of_freedom;
  std::vector<Expression> result(static_cast<std::size_t>(size), Expression(0));
  const std::map<int, CancellingForce> forces = cancelling_forces(mechanics);
  if (forces.empty()) return result;
  AtZero zero(mechanics);
  for (int i = 0; i < size; ++i) zero.add(mechanics.variable(i).name());
  std::map<std::pair<int, int>, Expression> weights;
  std::map<int, std::vector<int>> moved_by;  // force -> what it moves
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < size; ++k) {
      const Expression w = weight(i, k);
      if (w.is_zero()) continue;
      weights.emplace(std::pair(i, k), w);
      moved_by[k].push_back(i);
    }
  }
  // By what i moves with the force k: by itself, and by what that moves of the other half.
  const auto answer = [&](int i, int k) {
    std::vector<Expression> parts;
    if (const auto direct = weights.find({i, k}); direct != weights.end())
      parts.push_back(size_of(direct->second));
    for (const int t : moved_by[k]) {
      if (t == i) continue;
      const Expression& of_t = weights.at({t, k});
      for (auto of_i = weights.lower_bound({i, 0}); of_i != weights.end(); ++of_i) {
        if (of_i->first.first != i) break;
        const Expression& gradient =
            mechanics.gradient[static_cast<std::size_t>(of_i->first.second)];
        const Expression slope = slope_at_zero(derivative(gradient, mechanics.variable(t)), zero);
        parts.push_back(size_of(of_i->second * slope * of_t));
      }
    }
    return Expression::sum(std::move(parts));
  };
  std::vector<Expression> squares;
  for (int i = 0; i < mechanics.degrees_of_freedom - (mechanics.has_time ? 1 : 0); ++i)
    squares.push_back(Expression::power(mechanics.variable(i), Expression(2)));
  const Expression far = Expression::sum(std::move(squares));
  for (const auto& [k, force] : forces) {
    const Expression own = answer(k, k);
    const Expression near = nearness(far * force.reach());
    for (int i = 0; i < size; ++i) {
      const Expression moved = answer(i, k);
      if (moved.is_zero()) continue;
      result[static_cast<std::size_t>(i)] +=
          near * moved * force.terms / (Expression(1) + own * force.slope);
    }
  }
  return result;
}

}  // namespace hamgen
