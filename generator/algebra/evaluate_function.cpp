#include <ginac/ginac.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "generator/algebra/from_ginac.hpp"
#include "generator/algebra/ginac_functions.hpp"

namespace hamgen {
namespace {

// Beyond this the exponential leaves every floating-point scalar but is still quick to compute.
constexpr long largest_argument_of_exp = 20000;

// Sets GiNaC's global precision for as long as it lives: enough digits to keep 60 after the
// argument of a periodic function has lost its multiples of 2 pi, or exp(x) - 1 its 1.
class Precision {
 public:
  explicit Precision(std::span<const Rational> arguments) : before_(GiNaC::Digits) {
    std::size_t digits = 60;
    for (const Rational& x : arguments) {
      const Rational size = abs(x) < 1 && x != 0 ? Rational(1 / x) : x;
      digits = std::max(digits, 60 + Integer(size).get_str().size());
    }
    set(static_cast<long>(digits));
  }
  ~Precision() { set(before_); }
  Precision(const Precision&) = delete;
  Precision& operator=(const Precision&) = delete;

 private:
  static void set(long digits) {
    if (static_cast<long>(GiNaC::Digits) != digits) GiNaC::Digits = digits;
  }
  long before_;
};

// CLN prints a float as 1.25E-3 (or 1.25L-3), whatever the locale.
std::optional<Rational> from_numeric(const GiNaC::numeric& value) {
  if (!value.is_real()) return std::nullopt;
  std::ostringstream out;
  value.print(GiNaC::print_dflt(out));
  std::string text = out.str();
  if (value.is_rational()) {
    Rational exact(text);
    exact.canonicalize();
    return exact;
  }
  const bool negative = text.starts_with('-');
  if (negative) text.erase(0, 1);
  long exponent = 0;
  const auto is_letter = [](char c) { return c >= 'A'; };
  if (const auto mark = std::ranges::find_if(text, is_letter); mark != text.end()) {
    exponent = std::strtol(&*mark + 1, nullptr, 10);
    text.erase(mark, text.end());
  }
  if (std::abs(exponent) > largest_argument_of_exp) return std::nullopt;
  std::optional<Rational> result = parse_decimal(text);
  if (!result) return std::nullopt;
  Integer scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(exponent)));
  if (exponent >= 0) {
    *result *= scale;
  } else {
    *result /= scale;
  }
  if (negative) *result = -*result;
  return result;
}

std::optional<Rational> exact_square_root(const Rational& x) {
  if (mpz_perfect_square_p(x.get_num_mpz_t()) == 0) return std::nullopt;
  if (mpz_perfect_square_p(x.get_den_mpz_t()) == 0) return std::nullopt;
  return Rational(sqrt(x.get_num()), sqrt(x.get_den()));
}

// A multiple of pi by name, whose sine GiNaC knows, where x is one of the number that stands for
// pi.
GiNaC::ex argument(const Rational& x) {
  static const Rational pi = evaluate_function("pi", {}).value();
  const Rational multiple = x / pi;
  return multiple.get_den() <= 6 ? to_ginac(multiple) * GiNaC::Pi : GiNaC::ex(to_ginac(x));
}

GiNaC::ex call(const Function& function, std::span<const Rational> arguments) {
  if (function.name == "sqrt") return GiNaC::sqrt(to_ginac(arguments.front()));
  GiNaC::exvector values;
  for (const Rational& x : arguments) values.push_back(argument(x));
  const GiNaC::ex exact = GiNaC::function(ginac_serial(function), values);
  return exact.evalf();
}

std::optional<Rational> real_value(const GiNaC::ex& value) {
  const GiNaC::ex number = value.evalf();
  if (!GiNaC::is_a<GiNaC::numeric>(number)) return std::nullopt;
  return from_numeric(GiNaC::ex_to<GiNaC::numeric>(number));
}

}  // namespace

std::optional<Rational> evaluate_function(std::string_view name,
                                          std::span<const Rational> arguments) {
  const Precision precision(arguments);
  if (name == "pi" && arguments.empty()) return real_value(GiNaC::Pi);
  const Function* function = find_function(name);
  if (function == nullptr || arguments.size() != static_cast<std::size_t>(function->arity)) {
    return std::nullopt;
  }
  const auto is_zero = [](const Rational& x) { return x == 0; };
  if (function->is_undefined_at_zero && std::ranges::all_of(arguments, is_zero))
    return std::nullopt;
  const Rational& x = arguments.front();
  if (name == "abs") return Rational(abs(x));
  if (name == "sqrt") {
    if (const auto exact = exact_square_root(x)) return exact;
  }
  if (function->is_exponential && abs(x) > largest_argument_of_exp) {
    const double limit = function->numbers.real(to_double(x), 0);
    return std::isfinite(limit) ? std::optional(from_double(limit)) : std::nullopt;
  }
  try {
    return real_value(call(*function, arguments));
  } catch (const std::exception&) {  // a pole or an overflow GiNaC or CLN reports
    return std::nullopt;
  }
}

std::optional<Rational> evaluate_power(const Rational& base, const Rational& exponent) {
  if (sgn(base) == 0) {
    if (sgn(exponent) <= 0) return std::nullopt;
    return Rational(0);
  }
  const bool integral = exponent.get_den() == 1;
  if (integral && exponent.get_num().fits_slong_p()) {
    if (const auto exact = integer_power(base, exponent.get_num().get_si())) return exact;
  }
  if (base < 0 && !integral) return std::nullopt;
  if (exponent == Rational(1, 2)) return evaluate_function("sqrt", std::span(&base, 1));
  const Rational magnitude = abs(base);
  const std::array<Rational, 1> argument = {magnitude};
  const std::optional<Rational> logarithm = evaluate_function("log", argument);
  if (!logarithm) return std::nullopt;
  const std::array<Rational, 1> product = {*logarithm * exponent};
  std::optional<Rational> result = evaluate_function("exp", product);
  if (result && base < 0 && mpz_odd_p(exponent.get_num_mpz_t()) != 0) *result = -*result;
  return result;
}

}  // namespace hamgen
