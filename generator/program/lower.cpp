#include "generator/program/lower.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

bool is_trivial(const Expression& e) {
  if (e.is_number() || e.kind() == Kind::symbol) return true;
  if (e.kind() != Kind::product || e.operands().size() != 2) return false;
  return e.operands()[0] == Expression(-1) && e.operands()[1].kind() == Kind::symbol;
}

Lowering::Lowering(std::vector<Section> sections) : sections_(std::move(sections)) {
  output_.resize(sections_.size());
  levels_["pi"] = 0;
}

void Lowering::declare(const std::string& name, int section) { levels_[name] = section; }

void Lowering::define(std::string name, Expression value, int section, Keep keep) {
  definitions_.push_back({std::move(name), std::move(value), section, keep});
}

std::size_t Lowering::want(Expression value, int section) {
  wants_.push_back({std::move(value), section, {}});
  return wants_.size() - 1;
}

const std::vector<Statement>& Lowering::statements(int section) const {
  return output_[static_cast<std::size_t>(section)];
}

const Expression& Lowering::wanted(std::size_t handle) const { return wants_[handle].result; }

void Lowering::inline_trivial() {
  Substitution replacements;
  std::vector<WantedValue> kept;
  for (WantedValue& definition : definitions_) {
    definition.value = substitute(definition.value, replacements);
    const Expression& value = definition.value;
    // A multiple of one symbol is cheaper used than stored.
    const auto [coefficient, rest] = value.split_coefficient();
    const bool is_number_apart = value.is_number() && definition.keep == Keep::apart;
    if ((is_trivial(value) && !is_number_apart) ||
        (rest.kind() == Kind::symbol && definition.keep == Keep::no)) {
      replacements[definition.name] = value;
    } else {
      kept.push_back(std::move(definition));
    }
  }
  definitions_ = std::move(kept);
  for (Want& want : wants_) want.value = substitute(want.value, replacements);
}

void Lowering::drop_unused() {
  std::set<std::string> used;
  for (const Want& want : wants_) collect_symbols(want.value, used);
  std::vector<WantedValue> kept;
  for (auto it = definitions_.rbegin(); it != definitions_.rend(); ++it) {
    if (!used.contains(it->name)) continue;
    collect_symbols(it->value, used);
    kept.push_back(std::move(*it));
  }
  std::ranges::reverse(kept);
  definitions_ = std::move(kept);
}

namespace {

// The smaller powers that rewrite_power makes x^exponent of, x itself left out.
std::vector<Rational> parts_of_power(const Rational& exponent) {
  if (exponent.get_den() != 1 || !exponent.get_num().fits_slong_p()) return {};
  const long over = exponent.get_num().get_si();
  if (over > 2) return {Rational(over % 2 == 0 ? over / 2 : over - 1)};
  if (over >= -1) return {};
  std::vector<Rational> parts = {-1};
  if (over < -2) parts.emplace_back(over % 2 == 0 ? over / 2 : over + 1);
  return parts;
}

}  // namespace

// Counts from how many places each node is used; the inside of a node counts once.
void Lowering::count(const Expression& e) {
  if (is_trivial(e)) return;
  if (++uses_[e] > 1) return;
  if (e.kind() == Kind::power && e.operands()[1].is_number()) {
    const Expression& base = e.operands()[0];
    count(base);
    for (const Rational& part : parts_of_power(e.operands()[1].number())) {
      count(Expression::power(base, Expression(part)));
    }
    return;
  }
  for (const Expression& operand : e.operands()) count(operand);
}

int Lowering::level(const Expression& e) {
  if (e.is_number()) return 0;
  if (e.kind() == Kind::symbol) {
    const auto it = levels_.find(e.name());
    if (it == levels_.end()) internal_error("undeclared symbol " + e.name());
    return it->second;
  }
  if (const auto it = level_cache_.find(e.identity()); it != level_cache_.end()) return it->second;
  int result = 0;
  for (const Expression& operand : e.operands()) result = std::max(result, level(operand));
  level_cache_[e.identity()] = result;
  keep_alive_.push_back(e);  // its address is a key
  return result;
}

// The section a value of this expression belongs in when `section` wants it: as early as its
// symbols allow, but never inside a loop that does not need it.
int Lowering::place(const Expression& e, int section) {
  const int natural = level(e);
  if (natural > section) internal_error("a value is used before it is known: " + to_text(e));
  if (natural == section) return section;
  return sections_[static_cast<std::size_t>(natural)].is_loop ? section : natural;
}

Expression Lowering::temporary(const Expression& value, const Expression& key, int section) {
  const std::string name = fmt::format("#{}", next_++);
  const int where = place(value, section);
  output_[static_cast<std::size_t>(where)].push_back({name, value});
  levels_[name] = where;
  Expression symbol = Expression::symbol(name, kRankOfTemporary - 1);
  named_.insert_or_assign(key, symbol);
  return symbol;
}

Expression Lowering::rewrite(const Expression& e, int section) {
  if (e.kind() == Kind::symbol) {
    const auto it = aliases_.find(e.name());
    return it == aliases_.end() ? e : it->second;
  }
  if (e.is_number()) return e;
  if (const auto it = named_.find(e); it != named_.end()) return it->second;
  if (is_trivial(e)) {
    return Expression::product({e.operands()[0], rewrite(e.operands()[1], section)});
  }
  const int where = place(e, section);
  const auto used = uses_.find(e);
  const bool shared = used != uses_.end() && used->second > 1;
  Expression value = rewrite_operands(e, where);
  if (is_trivial(value) || (!shared && where == section)) return value;
  return temporary(value, e, section);
}

Expression Lowering::rewrite_operands(const Expression& e, int section) {
  if (e.kind() == Kind::power && e.operands()[1].is_number()) {
    return rewrite_power(e.operands()[0], e.operands()[1].number(), section);
  }
  std::vector<Expression> operands(e.operands().begin(), e.operands().end());
  if (e.kind() == Kind::sum || e.kind() == Kind::product) {
    // Operands that are known earlier are combined there: (h/2 * eps) * cos(q).
    std::map<int, std::vector<Expression>> groups;
    for (const Expression& operand : operands) groups[place(operand, section)].push_back(operand);
    operands.clear();
    std::vector<Expression> carried;  // numbers join the first group that is more than a number
    const auto combine = [&](const std::vector<Expression>& members) {
      return e.kind() == Kind::sum ? Expression::sum(members) : Expression::product(members);
    };
    for (auto& [where, group] : groups) {
      // What has a name has it by the values that it had before they were rewritten.
      std::vector<Expression> whole = group;
      whole.insert(whole.end(), carried.begin(), carried.end());
      const auto known = named_.find(combine(whole));
      if (known != named_.end() && where != groups.rbegin()->first) {
        operands.push_back(known->second);
        carried.clear();
        continue;
      }
      std::vector<Expression> members;
      for (const Expression& member : group) members.push_back(rewrite(member, where));
      members.insert(members.end(), carried.begin(), carried.end());
      carried.clear();
      Expression combined = combine(members);
      const bool last = where == groups.rbegin()->first;
      if (!last && combined.is_number()) {
        carried.push_back(combined);
      } else if (last || is_trivial(combined)) {
        if (last) {
          operands.insert(operands.end(), members.begin(), members.end());
        } else {
          operands.push_back(combined);
        }
      } else if (const auto it = named_.find(combined); it != named_.end()) {
        operands.push_back(it->second);
      } else {
        // A sign stays with the user: -(h*eps) and h*eps share one coefficient.
        auto [coefficient, rest] = combined.split_coefficient();
        if (coefficient == -1) {
          const auto found = named_.find(rest);
          operands.push_back(
              -(found != named_.end() ? found->second : temporary(rest, rest, where)));
        } else {
          operands.push_back(temporary(combined, combined, where));
        }
      }
    }
    return combine(operands);
  }
  for (Expression& operand : operands) operand = rewrite(operand, section);
  if (e.kind() == Kind::power) return Expression::power(operands[0], operands[1]);
  return Expression::apply(e.name(), std::move(operands));
}

// x^n by repeated squaring, x^(k/2) from one square root, negative powers from one reciprocal.
Expression Lowering::rewrite_power(const Expression& base, const Rational& exponent, int section) {
  const Integer& over = exponent.get_num();
  const bool integer = exponent.get_den() == 1;
  const bool half = exponent.get_den() == 2;
  auto shared_power = [&](const Rational& e) -> Expression {
    const Expression key = Expression::power(base, Expression(e));
    if (e == 1) {
      const Expression b = rewrite(base, section);
      if (b.kind() == Kind::symbol) return b;
      return temporary(b, base, section);
    }
    if (const auto it = named_.find(key); it != named_.end()) return it->second;
    const Expression value = rewrite_power(base, e, section);
    return temporary(value, key, section);
  };
  if ((!integer && !half) || !over.fits_slong_p()) {
    return Expression::power(rewrite(base, section), Expression(exponent));
  }
  if (exponent == 1) return rewrite(base, section);
  if (exponent == Rational(1, 2)) return square_root(rewrite(base, section));
  if (exponent == -1) return Expression::power(rewrite(base, section), Expression(-1));
  if (exponent == 2) return Expression::power(shared_power(1), Expression(2));
  if (half) {
    if (over > 0) return shared_power(Rational(1, 2)) * shared_power((over - 1) / 2);
    if (exponent == Rational(-1, 2)) {
      // With other negative powers about, 1/x is there already; alone, 1/sqrt(x) is one division.
      const bool alone = std::ranges::none_of(
          std::vector<Rational>{-1, -2, -3, Rational(-3, 2), Rational(-5, 2), Rational(-7, 2)},
          [&](const Rational& other) {
            return uses_.contains(Expression::power(base, Expression(other)));
          });
      if (alone) return Expression::power(shared_power(Rational(1, 2)), Expression(-1));
      return shared_power(Rational(1, 2)) * shared_power(-1);
    }
    return shared_power(Rational(-1, 2)) * shared_power((over + 1) / 2);
  }
  if (over < 0) {
    const Expression reciprocal = shared_power(-1);
    if (over == -2) return Expression::power(reciprocal, Expression(2));
    if (over % 2 == 0) return Expression::power(shared_power(over / 2), Expression(2));
    return reciprocal * shared_power(over + 1);
  }
  if (over % 2 == 0) return Expression::power(shared_power(over / 2), Expression(2));
  return shared_power(1) * shared_power(over - 1);
}

void Lowering::run() {
  inline_trivial();
  drop_unused();
  for (const WantedValue& definition : definitions_) count(definition.value);
  for (const Want& want : wants_) count(want.value);
  for (const WantedValue& definition : definitions_) {
    const int where = place(definition.value, definition.section);
    const Expression symbol = Expression::symbol(definition.name, kRankOfTemporary);
    const bool apart = definition.keep == Keep::apart;
    if (const auto known = named_.find(definition.value); known != named_.end() && !apart) {
      aliases_[definition.name] = known->second;
      levels_[definition.name] = level(known->second);
      continue;
    }
    const bool is_number = definition.value.is_number();  // and apart, or it is inlined
    const Expression value =
        is_number ? definition.value : rewrite_operands(definition.value, where);
    if (is_trivial(value) && !is_number) {
      aliases_[definition.name] = value;
      levels_[definition.name] = level(value);
      continue;
    }
    output_[static_cast<std::size_t>(where)].push_back({definition.name, value});
    levels_[definition.name] = where;
    if (!apart) named_.try_emplace(definition.value, symbol);
  }
  for (Want& want : wants_) want.result = rewrite(want.value, want.section);
}

}  // namespace hamgen
