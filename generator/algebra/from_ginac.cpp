#include "generator/algebra/from_ginac.hpp"

#include <cmath>
#include <stdexcept>

#include "generator/algebra/functions.hpp"
#include "generator/algebra/ginac_functions.hpp"
#include "generator/algebra/ginac_parts.hpp"
#include "generator/base/budget.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr double kMostTerms = 10'000;

// To look a subexpression up and to remember what it became.
constexpr double steps_of_conversion = 20;

// How many terms an expression has at most when it is expanded, and those on the way there.
class ExpandedTerms {
 public:
  double operator()(const GiNaC::ex& e) {
    if (e.nops() == 0 || GiNaC::is_a<GiNaC::function>(e)) return 1;
    spend(Resource::work, 1);
    if (const double* const count = known_.find(e)) return *count;
    double terms = 1;
    if (GiNaC::is_a<GiNaC::add>(e)) {
      const auto& sum = GiNaC::ex_to<GiNaC::add>(e);
      terms = GinacSum::number(sum).is_zero() ? 0 : 1;
      for (const GiNaC::expair& term : GinacSum::pairs(sum)) terms += (*this)(term.rest);
    } else if (GiNaC::is_a<GiNaC::mul>(e)) {
      for (const GiNaC::expair& factor : GinacProduct::pairs(GiNaC::ex_to<GiNaC::mul>(e)))
        terms *= of_power(factor.rest, factor.coeff);
    } else if (GiNaC::is_a<GiNaC::power>(e)) {
      terms = of_power(e.op(0), e.op(1));
    }
    known_.emplace(e, terms);
    return terms;
  }

  // Of what stays in roots and denominators, which are one factor each.
  [[nodiscard]] double within() const { return within_; }

 private:
  // Of t terms, the n-th power has as many as there are monomials of degree n in t variables,
  // (t + n - 1 over n).
  double of_power(const GiNaC::ex& base, const GiNaC::ex& exponent) {
    const double terms = (*this)(base);
    if (!exponent.info(GiNaC::info_flags::posint)) {
      within_ += terms + (*this)(exponent);
      return 1;
    }
    const double n = GiNaC::ex_to<GiNaC::numeric>(exponent).to_double();
    double result = terms;
    for (double i = 2; terms > 1 && i <= n && result <= kMostTerms; ++i)
      result *= (terms + i - 1) / i;
    return result;
  }

  ByIdentity<double> known_;
  double within_ = 0;
};

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

// Of the integers, those that are long cross as text in base 10.
Rational to_rational(const GiNaC::numeric& value) {
  if (!value.is_rational()) throw std::domain_error("a number that is not rational");
  auto integer = [](const GiNaC::numeric& n) {
    constexpr int short_length = 60;  // bits
    if (n.int_length() < short_length) return Integer(n.to_long());
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << n;
    return Integer(out.str());
  };
  if (value.is_integer()) return Rational(integer(value));
  Rational result(integer(value.numer()), integer(value.denom()));
  result.canonicalize();
  return result;
}

cln::cl_I to_cln(const Integer& value) {
  if (value.fits_slong_p()) return value.get_si();
  cln::cl_I result = 0;
  for (std::size_t i = mpz_size(value.get_mpz_t()); i-- > 0;)
    result = cln::ash(result, GMP_NUMB_BITS) + cln::cl_I(mpz_getlimbn(value.get_mpz_t(), i));
  return sgn(value) < 0 ? -result : result;
}

cln::cl_RA to_cln(const Rational& value) {
  const cln::cl_I over = to_cln(value.get_num());
  if (value.get_den() == 1) return over;
  return over / to_cln(value.get_den());
}

GiNaC::numeric to_ginac(const Rational& value) { return GiNaC::numeric(cln::cl_N(to_cln(value))); }

// Note [real values]
// GiNaC cannot know that log(q) is real where H has a value.  So it takes abs(u) for the absolute
// value of a complex number, whose derivative has the conjugate of u, and abs(exp(u)) for the
// exponential of the real part.  All values are real here: u is its own conjugate and real part.
Expression FromGinac::operator()(const GiNaC::ex& node) {
  spend(Resource::work, 1);
  if (GiNaC::is_a<GiNaC::numeric>(node)) return number(node);
  if (GiNaC::is_a<GiNaC::symbol>(node)) {
    const std::string name = GiNaC::ex_to<GiNaC::symbol>(node).get_name();
    return Expression::symbol(name, table_.rank(name));
  }
  if (node.is_equal(GiNaC::Pi)) return Expression::symbol("pi", -1);
  if (const Expression* const known = done_.find(node)) return *known;
  spend(Resource::work, steps_of_conversion);
  Expression result;
  if (GiNaC::is_a<GiNaC::add>(node)) {
    const auto& sum = GiNaC::ex_to<GiNaC::add>(node);
    std::vector<Expression> terms{number(GinacSum::number(sum))};
    for (const GiNaC::expair& term : GinacSum::pairs(sum))
      terms.push_back(Expression::product({number(term.coeff), (*this)(term.rest)}));
    result = Expression::sum(std::move(terms));
  } else if (GiNaC::is_a<GiNaC::mul>(node)) {
    const auto& product = GiNaC::ex_to<GiNaC::mul>(node);
    std::vector<Expression> factors{number(GinacProduct::number(product))};
    for (const GiNaC::expair& factor : GinacProduct::pairs(product))
      factors.push_back(Expression::power((*this)(factor.rest), number(factor.coeff)));
    result = Expression::product(std::move(factors));
  } else if (GiNaC::is_a<GiNaC::power>(node)) {
    result = Expression::power((*this)(node.op(0)), (*this)(node.op(1)));
  } else if (GiNaC::is_a<GiNaC::function>(node)) {
    result = function(node);
  } else {
    throw std::domain_error("something that is not a real scalar expression");
  }
  done_.emplace(node, result);
  return result;
}

Expression FromGinac::number(const GiNaC::ex& value) {
  return Expression(to_rational(GiNaC::ex_to<GiNaC::numeric>(value)));
}

Expression FromGinac::function(const GiNaC::ex& node) {
  const std::string name = GiNaC::ex_to<GiNaC::function>(node).get_name();
  std::vector<Expression> arguments;
  for (std::size_t i = 0; i < node.nops(); ++i) arguments.push_back((*this)(node.op(i)));
  // See Note [real values].
  if (name == "conjugate" || name == "real_part") return arguments[0];
  if (name == "imag_part") return Expression(0);
  if (find_function(name) == nullptr) throw std::domain_error("the function " + name);
  return Expression::apply(name, std::move(arguments));
}

Expression from_ginac(const GiNaC::ex& e, const SymbolTable& table) { return FromGinac(table)(e); }

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

double expanded_terms(const GiNaC::ex& e) {
  ExpandedTerms terms;
  const double outside = terms(e);
  return outside + terms.within();
}

bool vanishes_when_expanded(const GiNaC::ex& e) {
  if (e.is_zero()) return true;
  const double count = expanded_terms(e);
  if (count > kMostTerms) return false;
  spend(Resource::work, count);
  return e.expand().is_zero();
}

bool vanishes(const Expression& e) {
  if (e.is_zero()) return true;
  if (e.is_number()) return false;
  SymbolTable table;
  return vanishes_when_expanded(to_ginac(e, table));
}

}  // namespace hamgen
