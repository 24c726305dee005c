#include "generator/verify/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr std::size_t kMostTermsOfCertificate = 20000;
constexpr int kMostCertified = 64;  // degrees of freedom

// Functions whose derivatives are polynomials in themselves and these.
constexpr std::string_view kCertified[] = {"sin", "cos",  "tan",  "exp",
                                           "log", "sinh", "cosh", "tanh"};

[[noreturn]] void refuse_certificate(const std::string& why) {
  throw UsageError(fmt::format(
      "--certificate: {}\nhelp: there are certificates of members of the family, of systems of up "
      "to {} degrees of freedom made of powers, roots, sin, cos, tan, exp, log, sinh, cosh, tanh",
      why, kMostCertified));
}

// The common denominator of the powers of every base.
void collect_roots(const Expression& e, ExpressionMap<long>& roots) {
  for (const Expression& operand : e.operands()) collect_roots(operand, roots);
  if (e.kind() != Kind::power) return;
  if (!e.operands()[1].is_number()) refuse_certificate(to_text(e) + " has a power that varies");
  const long under = e.operands()[1].number().get_den().get_si();
  const auto [it, fresh] = roots.try_emplace(e.operands()[0], under);
  it->second = std::lcm(it->second, under);
}

// Is the expression a polynomial in h?
bool is_polynomial_in_step(const Expression& e) {
  if (e.kind() == Kind::function) return !depends_on(e, "h");
  if (e.kind() == Kind::power) {
    const Expression& exponent = e.operands()[1];
    const bool integer = exponent.is_number() && exponent.number().get_den() == 1;
    if (depends_on(e, "h") && (!integer || exponent.number() < 0)) return false;
  }
  return std::ranges::all_of(e.operands(), is_polynomial_in_step);
}

// exp(2 x) as exp(x)^2, for all exponentials whose arguments are multiples of each other.
class Exponentials {
 public:
  void collect(const Expression& e) {
    for (const Expression& operand : e.operands()) collect(operand);
    if (!is_exponential(e)) return;
    const auto [factor, rest] = e.operands()[0].split_coefficient();
    const auto [it, fresh] = units_.try_emplace(rest, factor);
    if (!fresh) it->second = common_unit(it->second, factor);
  }
  [[nodiscard]] Expression unified(const Expression& e) const {
    std::vector<Expression> operands;
    for (const Expression& operand : e.operands()) operands.push_back(unified(operand));
    if (!is_exponential(e)) return with_operands(e, std::move(operands));
    const auto [factor, rest] = e.operands()[0].split_coefficient();
    const Rational unit = units_.at(rest);
    const Expression argument = unified(Expression(unit) * rest);
    return Expression::power(Expression::apply("exp", {argument}),
                             Expression(Rational(factor / unit)));
  }

 private:
  static bool is_exponential(const Expression& e) {
    return e.kind() == Kind::function && e.name() == "exp";
  }
  // The largest number of which both are integer multiples.
  static Rational common_unit(const Rational& a, const Rational& b) {
    Integer over;
    Integer under;
    const Integer left = a.get_num() * b.get_den();
    const Integer right = b.get_num() * a.get_den();
    mpz_gcd(over.get_mpz_t(), left.get_mpz_t(), right.get_mpz_t());
    under = a.get_den() * b.get_den();
    Rational unit(over, under);
    unit.canonicalize();
    return unit;
  }

  ExpressionMap<Rational> units_;
};

// The system with its exponentials unified.
void unify_exponentials(Mechanics& mechanics, std::vector<NamedExpression>& invariants) {
  Exponentials exponentials;
  const auto each = [&](const auto& visit) {
    visit(mechanics.energy);
    for (Expression& e : mechanics.gradient) visit(e);
    for (auto& [place, e] : mechanics.hessian) visit(e);
    for (NamedExpression& invariant : invariants) visit(invariant.value);
  };
  each([&](const Expression& e) { exponentials.collect(e); });
  each([&](Expression& e) { e = exponentials.unified(e); });
}

class CertificateWriter {
 public:
  CertificateWriter(const Mechanics& mechanics, const Scheme& scheme)
      : mechanics_(mechanics), scheme_(scheme), ring_(kMostTermsOfCertificate) {}

  ProofCertificate write(bool symmetric, const std::vector<NamedExpression>& invariants) {
    certificate_.name = mechanics_.name;
    certificate_.scheme = scheme_.name;
    certificate_.symmetric = symmetric;
    const auto n = static_cast<std::size_t>(mechanics_.degrees_of_freedom);
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const std::string& name = mechanics_.variables.name(i);
      (i < n ? certificate_.coordinates : certificate_.momenta).push_back(name);
    }
    for (const Quantity& parameter : mechanics_.parameters)
      certificate_.parameters.push_back(parameter.name);
    prepare_roots(invariants);
    write_hamiltonian();
    write_scheme();
    for (const NamedExpression& invariant : invariants) write_invariant(invariant);
    write_atoms();
    return std::move(certificate_);
  }

 private:
  // One atom a base: its root of the highest degree.
  void prepare_roots(const std::vector<NamedExpression>& invariants) {
    ExpressionMap<long> roots;
    collect_roots(mechanics_.energy, roots);
    for (const Expression& e : mechanics_.gradient) collect_roots(e, roots);
    for (const auto& [place, e] : mechanics_.hessian) collect_roots(e, roots);
    for (const NamedExpression& invariant : invariants) collect_roots(invariant.value, roots);
    for (const auto& [place, e] : scheme_.member().c) collect_roots(e, roots);
    for (const auto& [base, degree] : roots) {
      if (degree > 1)
        static_cast<void>(ring_.expand(Expression::power(base, Expression(Rational(1, degree)))));
    }
  }

  void write_hamiltonian() {
    certificate_.hamiltonian = text(ring_.expand(mechanics_.energy));
    for (const Expression& e : mechanics_.gradient) {
      gradient_.push_back(ring_.expand(e));
      certificate_.gradient.push_back(text(gradient_.back()));
    }
    for (const auto& [place, e] : mechanics_.hessian) {
      const Polynomial value = ring_.expand(e);
      if (!value.empty()) certificate_.hessian[place] = text(value);
    }
  }

  void write_scheme() {
    const int size = 2 * mechanics_.degrees_of_freedom;
    bool vanishes = true;
    for (int i = 0; i < size; ++i) {
      certificate_.c.emplace_back();
      for (int j = 0; j < size; ++j) {
        const auto found = scheme_.member().c.find({i, j});
        const Expression entry = found == scheme_.member().c.end() ? Expression(0) : found->second;
        if (!is_polynomial_in_step(entry)) refuse_certificate("C is no polynomial in h");
        certificate_.c.back().push_back(text(ring_.expand(entry)));
        vanishes = vanishes && substitute(entry, {{"h", Expression(0)}}).is_zero();
      }
    }
    certificate_.order = vanishes ? 2 : 1;
  }

  void write_invariant(const NamedExpression& invariant) {
    const Polynomial value = ring_.expand(invariant.value);
    CertificateInvariant result{.name = invariant.name, .value = text(value), .bracket = {}};
    const auto n = static_cast<std::size_t>(mechanics_.degrees_of_freedom);
    const auto slope = [&](std::size_t i) {
      const Quantity& variable = mechanics_.variables[i];
      return ring_.derivative(value, variable_symbol(variable.name));
    };
    for (std::size_t i = 0; i < n; ++i) {
      Polynomial term = ring_.product(slope(i), gradient_[n + i]);
      accumulate(term, ring_.product(slope(n + i), gradient_[i]), Rational(-1));
      result.bracket.push_back(text(term));
    }
    certificate_.invariants.push_back(std::move(result));
  }

  // The symbol as H has it, with its rank.
  [[nodiscard]] Expression variable_symbol(const std::string& name) const {
    const auto at = std::ranges::find(mechanics_.variables, name, &Quantity::name);
    return Expression::symbol(
        name, kRankOfVariable + static_cast<int>(at - mechanics_.variables.begin()));
  }

  // Derivatives may need more atoms: until there are no new ones.
  void write_atoms() {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const Expression atom = ring_.atom(i);
      if (atom.kind() == Kind::symbol) continue;
      CertificateAtom result{
          .name = name_of(i), .function = "root", .argument = {}, .derivatives = {}};
      Polynomial value;
      if (atom.kind() == Kind::function) {
        result.function = atom.name();
        if (std::ranges::find(kCertified, result.function) == std::end(kCertified))
          refuse_certificate(result.function + " is not among its functions");
        value = ring_.expand(atom.operands()[0]);
      } else {
        const bool power = atom.kind() == Kind::power && atom.operands()[1].is_number();
        const Expression base = power ? atom.operands()[0] : atom;
        const Rational exponent = power ? atom.operands()[1].number() : Rational(1);
        if (exponent.get_num() != 1) refuse_certificate(to_text(atom) + " is no root");
        result.degree = static_cast<int>(exponent.get_den().get_si());
        value = argument_of_root(base);
      }
      result.argument = text(value);
      for (const Quantity& variable : mechanics_.variables) {
        const Polynomial slope =
            ring_.derivative({{single_atom(i), Rational(1)}}, variable_symbol(variable.name));
        if (!slope.empty()) result.derivatives.emplace_back(variable.name, text(slope));
      }
      inside_.push_back(atoms_in(value));
      places_.push_back(i);
      certificate_.atoms.push_back(std::move(result));
    }
    order_atoms();
  }

  // Those first that others are made of.
  void order_atoms() {
    std::vector<CertificateAtom> ordered;
    std::set<std::size_t> done;
    while (ordered.size() < certificate_.atoms.size()) {
      const std::size_t before = ordered.size();
      for (std::size_t k = 0; k < places_.size(); ++k) {
        if (done.contains(places_[k]) || !std::ranges::includes(done, inside_[k])) continue;
        ordered.push_back(certificate_.atoms[k]);
        done.insert(places_[k]);
      }
      if (ordered.size() == before) internal_error("atoms that are made of each other");
    }
    certificate_.atoms = std::move(ordered);
  }

  // The atoms of a polynomial that are no symbols.
  [[nodiscard]] std::set<std::size_t> atoms_in(const Polynomial& p) const {
    std::set<std::size_t> found;
    for (const auto& [monomial, coefficient] : p) {
      for (std::size_t i = 0; i < monomial.size(); ++i) {
        const bool plain = plain_.contains(i) || monomial[i] == 0;
        if (!plain && ring_.atom(i).kind() != Kind::symbol) found.insert(i);
      }
    }
    return found;
  }

  // The base of a root: a sum, term by term, or a single symbol or function.
  Polynomial argument_of_root(const Expression& base) {
    if (base.kind() != Kind::sum) {
      if (base.is_number()) return ring_.expand(base);
      if (base.kind() != Kind::symbol) refuse_certificate("a root of " + to_text(base));
      // The root of a symbol stands for it: the symbol by its own name.
      return {{single_atom(symbol_atom(base.name())), Rational(1)}};
    }
    Polynomial sum;
    for (const Expression& term : base.operands()) accumulate(sum, ring_.expand(term));
    return sum;
  }

  // A place for a symbol that itself occurs as a root only.
  std::size_t symbol_atom(const std::string& name) {
    for (const auto& [place, known] : plain_) {
      if (known == name) return place;
    }
    const std::size_t place = kPlain + plain_.size();
    plain_[place] = name;
    return place;
  }

  static Monomial single_atom(std::size_t i) {
    Monomial m(i + 1);
    m[i] = 1;
    return m;
  }

  [[nodiscard]] std::string name_of(std::size_t i) const {
    if (const auto found = plain_.find(i); found != plain_.end()) return found->second;
    const Expression& atom = ring_.atom(i);
    return atom.kind() == Kind::symbol ? atom.name() : fmt::format("_{}", i + 1);
  }

  [[nodiscard]] std::string text(const Polynomial& p) const {
    std::string result;
    for (const auto& [monomial, coefficient] : p) {
      const Rational size = abs(coefficient);
      std::string term = size == 1 ? "" : size.get_str();
      for (std::size_t i = 0; i < monomial.size(); ++i) {
        if (monomial[i] == 0) continue;
        term += (term.empty() ? "" : "*") + name_of(i);
        if (monomial[i] != 1) term += fmt::format("^{}", monomial[i]);
      }
      if (term.empty()) term = "1";
      const bool negative = coefficient < 0;
      result += result.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
      result += term;
    }
    return result.empty() ? "0" : result;
  }

  static constexpr std::size_t kPlain = 4000;  // beyond all atoms

  const Mechanics& mechanics_;
  const Scheme& scheme_;
  PolynomialRing ring_;
  ProofCertificate certificate_;
  std::vector<Polynomial> gradient_;
  std::map<std::size_t, std::string> plain_;
  std::vector<std::size_t> places_;            // of the certificate's atoms in the ring
  std::vector<std::set<std::size_t>> inside_;  // the atoms that their arguments have
};

}  // namespace

void require_certified_size(const Mechanics& mechanics) {
  const int n = mechanics.degrees_of_freedom;
  if (n > kMostCertified) refuse_certificate(fmt::format("{} degrees of freedom", n));
}

ProofCertificate make_certificate(const Mechanics& mechanics, const Scheme& scheme, bool symmetric,
                                  const std::vector<NamedExpression>& invariants) {
  if (!scheme.is_member()) refuse_certificate(scheme.name + " is no member of the family");
  if (scheme.member().generating_order > 0) refuse_certificate("a step that takes K in place of H");
  require_certified_size(mechanics);
  if (!mechanics.constants.empty())
    refuse_certificate("parameters whose values are part of the code");
  Mechanics unified = mechanics;
  std::vector<NamedExpression> conserved = invariants;
  unify_exponentials(unified, conserved);
  try {
    return CertificateWriter(unified, scheme).write(symmetric, conserved);
  } catch (const TooManyTerms&) {
    refuse_certificate(fmt::format("polynomials of more than {} terms", kMostTermsOfCertificate));
  }
}

}  // namespace hamgen
