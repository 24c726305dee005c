#include "generator/algebra/expression.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "generator/algebra/functions.hpp"
#include "generator/base/budget.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

struct Expression::Node {
  Kind kind = Kind::number;
  Rational number;
  std::string name;
  int rank = 0;
  std::vector<Expression> operands;
  std::size_t hash = 0;
  std::uint64_t serial = 0;  // of no other node, ever
};

namespace {

// Words of numerator and denominator.
double words(const Rational& value) {
  return static_cast<double>(mpz_size(value.get_num_mpz_t()) + mpz_size(value.get_den_mpz_t()));
}

// Comparisons already made, as many as there is room for: in sums of products of nested functions
// the same two are compared again and again, each time down to where they differ.
class Comparisons {
 public:
  static Comparisons& mine() {
    thread_local Comparisons comparisons;
    return comparisons;
  }
  [[nodiscard]] std::optional<std::strong_ordering> find(std::uint64_t a, std::uint64_t b) const {
    const Made& made = made_[place(a, b)];
    if (made.a == a && made.b == b) return made.order;
    return std::nullopt;
  }
  void add(std::uint64_t a, std::uint64_t b, std::strong_ordering order) {
    made_[place(a, b)] = {.a = a, .b = b, .order = order};
  }

 private:
  struct Made {
    std::uint64_t a = 0;  // no node
    std::uint64_t b = 0;
    std::strong_ordering order = std::strong_ordering::equal;
  };
  static constexpr std::size_t room = 1U << 16U;
  static std::size_t place(std::uint64_t a, std::uint64_t b) {
    return (a * 0x9e3779b97f4a7c15ULL + b * 0xc2b2ae3d27d4eb4fULL) >> 48U;
  }
  std::vector<Made> made_ = std::vector<Made>(room);
};

std::size_t mix(std::size_t seed, std::size_t value) {
  return seed ^ (value + 0x9e3779b97f4a7c15ULL + (seed << 6) + (seed >> 2));
}

std::size_t hash_number(const Rational& value) {
  const std::size_t over = mpz_get_ui(value.get_num_mpz_t());
  return mix(mix(over, mpz_get_ui(value.get_den_mpz_t())),
             static_cast<std::size_t>(sgn(value) + 1));
}

}  // namespace

// Note [one node an expression]: equal expressions with equal ranks share one node, so that graphs
// are compared by address and no algorithm meets a subexpression under two addresses; a comparison
// operand by operand would take time exponential in the depth of a graph with shared nodes.  The
// pool is invisible: it holds what is alive anyhow, and no result depends on it.
class Expression::Pool {
 public:
  static Pool& instance() {
    static Pool* const pool = new Pool;  // outlives every static expression
    return *pool;
  }

  std::shared_ptr<const Node> intern(std::shared_ptr<const Node> node) {
    const std::scoped_lock lock(mutex_);
    if (known_.size() > 2 * alive_ + 4096) sweep();
    std::weak_ptr<const Node>* free = nullptr;
    const auto [first, last] = known_.equal_range(node->hash);
    for (auto it = first; it != last; ++it) {
      const auto known = it->second.lock();
      if (known && same(*known, *node)) return known;
      if (!known) free = &it->second;
    }
    if (free != nullptr) {  // what is made and dropped over and over does not pile up
      *free = node;
    } else {
      known_.emplace_hint(first, node->hash, node);
    }
    return node;
  }

 private:
  static bool same(const Node& a, const Node& b) {
    return a.kind == b.kind && a.rank == b.rank && a.number == b.number && a.name == b.name &&
           std::ranges::equal(a.operands, b.operands, {}, &Expression::identity,
                              &Expression::identity);
  }
  void sweep() {
    std::erase_if(known_, [](const auto& candidate) { return candidate.second.expired(); });
    alive_ = known_.size();
  }

  std::mutex mutex_;
  std::unordered_multimap<std::size_t, std::weak_ptr<const Node>> known_;  // by hash
  std::size_t alive_ = 0;
};

Expression Expression::make(Kind kind, Rational number, std::string name, int rank,
                            std::vector<Expression> operands) {
  auto node = std::make_shared<Node>();
  node->kind = kind;
  std::size_t hash = mix(0, static_cast<std::size_t>(kind));
  if (kind == Kind::number) hash = mix(hash, hash_number(number));
  if (!name.empty()) hash = mix(hash, std::hash<std::string>{}(name));
  for (const Expression& operand : operands) hash = mix(hash, operand.hash());
  node->number = std::move(number);
  node->name = std::move(name);
  node->rank = rank;
  node->operands = std::move(operands);
  node->hash = hash;
  spend(Resource::nodes, 1 + static_cast<double>(node->operands.size()));
  spend(Resource::work, 8 + 2 * static_cast<double>(node->operands.size()));
  static std::atomic<std::uint64_t> serials = 0;
  node->serial = ++serials;
  return Expression(Pool::instance().intern(std::move(node)));
}

Expression::Expression() : Expression(Rational(0)) {}
Expression::Expression(long value) : Expression(Rational(value)) {}
Expression::Expression(Rational value) {
  value.canonicalize();
  *this = make(Kind::number, std::move(value), {}, 0, {});
}

Expression Expression::symbol(std::string name, int rank) {
  return make(Kind::symbol, 0, std::move(name), rank, {});
}

Expression Expression::apply(std::string function, std::vector<Expression> arguments) {
  // sqrt and powers are one thing.
  if (function == "sqrt") return power(arguments.at(0), Rational(1, 2));
  // sin(-x) and sin(x) share one evaluation.
  const Function* row = find_function(function);
  const Parity parity = row == nullptr ? Parity::none : row->parity;
  if (parity != Parity::none && arguments.at(0).split_coefficient().first < 0) {
    const Expression positive = apply(function, {-arguments[0]});
    return parity == Parity::odd ? -positive : positive;
  }
  return make(Kind::function, 0, std::move(function), 0, std::move(arguments));
}

Kind Expression::kind() const { return node_->kind; }
bool Expression::is_zero() const { return is_number() && node_->number == 0; }
bool Expression::is_one() const { return is_number() && node_->number == 1; }
const Rational& Expression::number() const { return node_->number; }
const std::string& Expression::name() const { return node_->name; }
int Expression::rank() const { return node_->rank; }
std::span<const Expression> Expression::operands() const { return node_->operands; }
std::size_t Expression::hash() const { return node_->hash; }

bool operator==(const Expression& a, const Expression& b) {
  if (a.node_ == b.node_) return true;
  // What differs in the ranks of its symbols only has two nodes, and is equal.
  if (a.node_->hash != b.node_->hash || a.node_->kind != b.node_->kind) return false;
  return a.node_->number == b.node_->number && a.node_->name == b.node_->name &&
         a.node_->operands == b.node_->operands;
}

std::strong_ordering operator<=>(const Expression& a, const Expression& b) {
  if (a.node_ == b.node_) return std::strong_ordering::equal;
  if (auto c = a.node_->kind <=> b.node_->kind; c != 0) return c;
  const int number = cmp(a.node_->number, b.node_->number);
  if (number != 0) return number < 0 ? std::strong_ordering::less : std::strong_ordering::greater;
  if (auto c = a.node_->rank <=> b.node_->rank; c != 0) return c;
  if (auto c = a.node_->name.compare(b.node_->name) <=> 0; c != 0) return c;
  if (auto c = a.node_->operands.size() <=> b.node_->operands.size(); c != 0) return c;
  if (a.node_->operands.empty()) return std::strong_ordering::equal;
  if (const auto known = Comparisons::mine().find(a.node_->serial, b.node_->serial)) return *known;
  spend(Resource::work, 1);
  std::strong_ordering order = std::strong_ordering::equal;
  for (std::size_t i = 0; i < a.node_->operands.size() && order == 0; ++i)
    order = a.node_->operands[i] <=> b.node_->operands[i];
  Comparisons::mine().add(a.node_->serial, b.node_->serial, order);
  return order;
}

std::pair<Rational, Expression> Expression::split_coefficient() const {
  if (is_number()) return {number(), Expression(1)};
  if (kind() == Kind::product && operands()[0].is_number()) {
    std::vector<Expression> rest(operands().begin() + 1, operands().end());
    Expression without =
        rest.size() == 1 ? rest[0] : make(Kind::product, 0, {}, 0, std::move(rest));
    return {operands()[0].number(), without};
  }
  return {Rational(1), *this};
}

Expression Expression::sum(std::vector<Expression> terms) {
  // Collect like terms: constant + sum of coefficient * term.
  Rational constant = 0;
  std::vector<std::pair<Expression, Rational>> collected;
  ExpressionMap<std::size_t> place;
  auto add = [&](auto&& self, const Expression& term, const Rational& factor) -> void {
    if (term.kind() == Kind::sum) {
      for (const Expression& inner : term.operands()) self(self, inner, factor);
      return;
    }
    auto [coefficient, rest] = term.split_coefficient();
    coefficient *= factor;
    spend(Resource::work, 1 + words(coefficient));
    if (rest.is_one()) {
      constant += coefficient;
    } else if (rest.kind() == Kind::sum) {
      for (const Expression& inner : rest.operands()) self(self, inner, coefficient);
    } else if (auto [it, fresh] = place.try_emplace(rest, collected.size()); fresh) {
      collected.emplace_back(rest, coefficient);
    } else {
      collected[it->second].second += coefficient;
    }
  };
  for (const Expression& term : terms) add(add, term, Rational(1));
  std::erase_if(collected, [](const auto& entry) { return entry.second == 0; });
  std::ranges::sort(collected, [](const auto& a, const auto& b) { return a.first < b.first; });
  if (collected.empty()) return Expression(constant);
  if (collected.size() == 1 && constant == 0) {
    return product({Expression(collected[0].second), collected[0].first});
  }
  // Note [sign of a sum]: the leading term (a constant comes first) is made positive, and a factor
  // common to all coefficients is taken out when they are equal in size, so that h/2*a - h/2*b and
  // b - a share the node a - b.
  const Rational leading = constant != 0 ? constant : collected[0].second;
  Rational outer = leading < 0 ? -1 : 1;
  const bool same_size =
      (constant == 0 || abs(constant) == abs(leading)) &&
      std::ranges::all_of(collected, [&](const auto& e) { return abs(e.second) == abs(leading); });
  if (same_size) outer = leading;
  std::vector<Expression> operands;
  if (constant != 0) operands.emplace_back(Rational(constant / outer));
  for (auto& [term, coefficient] : collected) {
    const Rational scaled = coefficient / outer;
    if (scaled == 1) {
      operands.push_back(term);
    } else if (term.kind() == Kind::product) {
      std::vector<Expression> factors{Expression(scaled)};
      factors.insert(factors.end(), term.operands().begin(), term.operands().end());
      operands.push_back(make(Kind::product, 0, {}, 0, std::move(factors)));
    } else {
      operands.push_back(make(Kind::product, 0, {}, 0, {Expression(scaled), term}));
    }
  }
  Expression total = make(Kind::sum, 0, {}, 0, std::move(operands));
  if (outer == 1) return total;
  return make(Kind::product, 0, {}, 0, {Expression(outer), total});
}

Expression Expression::product(std::vector<Expression> factors) {
  // Collect numbers, and equal bases with rational exponents: x * x^(1/2) = x^(3/2).
  Rational coefficient = 1;
  std::map<Expression, Rational> exponents;
  std::vector<Expression> others;
  auto multiply = [&](auto&& self, const Expression& factor) -> void {
    spend(Resource::work, 1);
    if (factor.is_number()) {
      spend(Resource::work, words(factor.number()) + words(coefficient));
      coefficient *= factor.number();
    } else if (factor.kind() == Kind::product) {
      for (const Expression& inner : factor.operands()) self(self, inner);
    } else if (factor.kind() == Kind::power && factor.operands()[1].is_number()) {
      exponents[factor.operands()[0]] += factor.operands()[1].number();
    } else if (factor.kind() == Kind::power) {
      others.push_back(factor);
    } else {
      exponents[factor] += 1;
    }
  };
  for (const Expression& factor : factors) multiply(multiply, factor);
  if (coefficient == 0) return Expression(0);
  for (const auto& [base, exponent] : exponents) {
    if (exponent == 0) continue;
    const Expression raised = power(base, Expression(exponent));
    if (raised.is_number()) {
      coefficient *= raised.number();
    } else if (raised.kind() == Kind::product) {
      for (const Expression& inner : raised.operands()) {
        if (inner.is_number()) {
          coefficient *= inner.number();
        } else {
          others.push_back(inner);
        }
      }
    } else {
      others.push_back(raised);
    }
  }
  if (others.empty()) return Expression(coefficient);
  std::ranges::sort(others);
  if (others.size() == 1 && coefficient == 1) return others[0];
  std::vector<Expression> operands;
  if (coefficient != 1) operands.emplace_back(coefficient);
  operands.insert(operands.end(), others.begin(), others.end());
  return make(Kind::product, 0, {}, 0, std::move(operands));
}

Expression Expression::power(const Expression& base, const Expression& exponent) {
  if (!exponent.is_number()) return make(Kind::power, 0, {}, 0, {base, exponent});
  const Rational& e = exponent.number();
  if (e == 0) return Expression(1);
  if (e == 1) return base;
  const bool integer = e.get_den() == 1;
  if (base.is_one()) return base;
  if (base.is_number() && integer && e.get_num().fits_slong_p()) {
    if (auto value = integer_power(base.number(), e.get_num().get_si())) return Expression(*value);
  }
  // (x^a)^n = x^(a n) and (c x y)^n = c^n x^n y^n hold for integer n only.
  if (integer && base.kind() == Kind::power && base.operands()[1].is_number()) {
    return power(base.operands()[0], Expression(Rational(base.operands()[1].number() * e)));
  }
  if (integer && base.kind() == Kind::product) {
    std::vector<Expression> factors;
    for (const Expression& factor : base.operands()) factors.push_back(power(factor, exponent));
    return product(std::move(factors));
  }
  return make(Kind::power, 0, {}, 0, {base, exponent});
}

Expression with_operands(const Expression& e, std::vector<Expression> operands) {
  switch (e.kind()) {
    case Kind::sum:
      return Expression::sum(std::move(operands));
    case Kind::product:
      return Expression::product(std::move(operands));
    case Kind::power:
      return Expression::power(operands[0], operands[1]);
    case Kind::function:
      return Expression::apply(e.name(), std::move(operands));
    case Kind::number:
    case Kind::symbol:
      break;
  }
  return e;
}

Expression square_root(const Expression& e) {
  return Expression::power(e, Expression(Rational(1, 2)));
}

Expression operator+(const Expression& a, const Expression& b) { return Expression::sum({a, b}); }
Expression operator-(const Expression& a) { return Expression::product({Expression(-1), a}); }
Expression operator-(const Expression& a, const Expression& b) { return a + (-b); }
Expression operator*(const Expression& a, const Expression& b) {
  return Expression::product({a, b});
}
Expression operator/(const Expression& a, const Expression& b) {
  if (b.is_zero()) internal_error("division of expressions by zero");
  return a * Expression::power(b, Expression(-1));
}

}  // namespace hamgen
