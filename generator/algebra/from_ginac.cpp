#include "generator/algebra/from_ginac.hpp"

#include <cmath>
#include <stdexcept>

#include "generator/algebra/functions.hpp"
#include "generator/algebra/ginac_functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr double kMostTerms = 10'000;

using TermCounts = std::map<GiNaC::ex, double, GiNaC::ex_is_less>;

// At most so many terms has the expanded expression: of t terms, the n-th power has as many as
// there are monomials of degree n in t variables, (t + n - 1 over n).
double expanded_terms(const GiNaC::ex& e, TermCounts& known) {
  if (e.nops() == 0 || GiNaC::is_a<GiNaC::function>(e)) return 1;
  if (const auto it = known.find(e); it != known.end()) return it->second;
  const bool sum = GiNaC::is_a<GiNaC::add>(e);
  double terms = sum ? 0 : 1;
  if (GiNaC::is_a<GiNaC::power>(e)) {
    const double base = expanded_terms(e.op(0), known);
    const GiNaC::ex exponent = e.op(1);
    terms = base * expanded_terms(exponent, known);
    if (exponent.info(GiNaC::info_flags::integer)) {
      const double n = std::abs(GiNaC::ex_to<GiNaC::numeric>(exponent).to_double());
      for (double i = 1; base > 1 && i <= n && (i == 1 || terms <= kMostTerms); ++i)
        terms = i == 1 ? base : terms * (base + i - 1) / i;
    }
  } else {
    for (std::size_t i = 0; i < e.nops(); ++i) {
      const double part = expanded_terms(e.op(i), known);
      terms = sum ? terms + part : terms * part;
    }
  }
  known.emplace(e, terms);
  return terms;
}

}  // namespace

GiNaC::ex SymbolTable::symbol(const std::string& name, int rank) {
  const auto it = symbols_.find(name);
  if (it != symbols_.end()) return it->second.first;
  return symbols_.emplace(name, std::pair(GiNaC::realsymbol(name), rank)).first->second.first;
}

int SymbolTable::rank(const std::string& name) const {
  const auto it = symbols_.find(name);
  if (it == symbols_.end()) internal_error("GiNaC returned an unknown symbol");
  return it->second.second;
}

const GiNaC::symbol& SymbolTable::find(const std::string& name) const {
  const auto it = symbols_.find(name);
  if (it == symbols_.end()) internal_error("unknown symbol " + name);
  return it->second.first;
}

// Integers cross as text in base 10: neither side depends on the other's representation.
Rational to_rational(const GiNaC::numeric& value) {
  if (!value.is_rational()) throw std::domain_error("a number that is not rational");
  auto integer = [](const GiNaC::numeric& n) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << n;
    return Integer(out.str());
  };
  Rational result(integer(value.numer()), integer(value.denom()));
  result.canonicalize();
  return result;
}

GiNaC::numeric to_ginac(const Rational& value) {
  const GiNaC::numeric over(value.get_num().get_str().c_str());
  const GiNaC::numeric under(value.get_den().get_str().c_str());
  return over / under;
}

// Note [real values]
// GiNaC cannot know that log(q) is real where H has a value.  So it takes abs(u) for the absolute
// value of a complex number, whose derivative has the conjugate of u, and abs(exp(u)) for the
// exponential of the real part.  All values are real here: u is its own conjugate and real part.
Expression from_ginac(const GiNaC::ex& e, const SymbolTable& table) {
  std::map<GiNaC::ex, Expression, GiNaC::ex_is_less> done;
  auto convert = [&](auto&& self, const GiNaC::ex& node) -> Expression {
    if (GiNaC::is_a<GiNaC::numeric>(node)) {
      return Expression(to_rational(GiNaC::ex_to<GiNaC::numeric>(node)));
    }
    if (GiNaC::is_a<GiNaC::symbol>(node)) {
      const std::string name = GiNaC::ex_to<GiNaC::symbol>(node).get_name();
      return Expression::symbol(name, table.rank(name));
    }
    if (node.is_equal(GiNaC::Pi)) return Expression::symbol("pi", -1);
    if (const auto it = done.find(node); it != done.end()) return it->second;
    std::vector<Expression> operands;
    for (std::size_t i = 0; i < node.nops(); ++i) operands.push_back(self(self, node.op(i)));
    Expression result;
    if (GiNaC::is_a<GiNaC::add>(node)) {
      result = Expression::sum(std::move(operands));
    } else if (GiNaC::is_a<GiNaC::mul>(node)) {
      result = Expression::product(std::move(operands));
    } else if (GiNaC::is_a<GiNaC::power>(node)) {
      result = Expression::power(operands[0], operands[1]);
    } else if (GiNaC::is_a<GiNaC::function>(node)) {
      const std::string name = GiNaC::ex_to<GiNaC::function>(node).get_name();
      // See Note [real values].
      if (name == "conjugate" || name == "real_part") return operands[0];
      if (name == "imag_part") return Expression(0);
      if (find_function(name) == nullptr) throw std::domain_error("the function " + name);
      result = Expression::apply(name, std::move(operands));
    } else {
      throw std::domain_error("something that is not a real scalar expression");
    }
    done.emplace(node, result);
    return result;
  };
  return convert(convert, e);
}

GiNaC::ex to_ginac(const Expression& e, SymbolTable& table) {
  std::map<const void*, GiNaC::ex> done;
  auto convert = [&](auto&& self, const Expression& node) -> GiNaC::ex {
    if (node.is_number()) return to_ginac(node.number());
    if (node.kind() == Kind::symbol) {
      if (node.name() == "pi") return GiNaC::Pi;
      return table.symbol(node.name(), node.rank());
    }
    if (const auto it = done.find(node.identity()); it != done.end()) return it->second;
    GiNaC::exvector operands;
    for (const Expression& operand : node.operands()) operands.push_back(self(self, operand));
    GiNaC::ex result;
    switch (node.kind()) {
      case Kind::sum:
        result = GiNaC::add(operands);
        break;
      case Kind::product:
        result = GiNaC::mul(operands);
        break;
      case Kind::power:
        result = GiNaC::pow(operands[0], operands[1]);
        break;
      case Kind::function:
        result = ginac_function(node.name(), operands);
        break;
      case Kind::number:
      case Kind::symbol:
        internal_error("handled above");
    }
    done.emplace(node.identity(), result);
    return result;
  };
  return convert(convert, e);
}

bool vanishes_when_expanded(const GiNaC::ex& e) {
  TermCounts known;
  return e.is_zero() || (expanded_terms(e, known) <= kMostTerms && e.expand().is_zero());
}

bool vanishes(const Expression& e) {
  if (e.is_zero()) return true;
  if (e.is_number()) return false;
  SymbolTable table;
  return to_ginac(e, table).expand().is_zero();
}

}  // namespace hamgen
