#include "generator/algebra/latex.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "generator/algebra/functions.hpp"

namespace hamgen {

namespace {

constexpr std::array<std::string_view, 22> kGreek = {
    "alpha", "beta",  "gamma",  "delta", "epsilon", "zeta", "eta", "theta",
    "iota",  "kappa", "lambda", "mu",    "nu",      "xi",   "pi",  "rho",
    "sigma", "tau",   "phi",    "chi",   "psi",     "omega"};

std::string letter(const std::string& name) {
  if (name.size() == 1) return name;
  if (std::ranges::find(kGreek, name) != kGreek.end()) return "\\" + name;
  std::string text = "\\mathrm{";
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text + "}";
}

// q1, q[1]: q with a subscript.
std::string symbol(const std::string& name) {
  std::size_t end = name.find('[');
  if (end == std::string::npos) {
    end = name.size();
    while (end > 1 && name[end - 1] >= '0' && name[end - 1] <= '9') --end;
  }
  if (end == name.size()) return letter(name);
  std::string index = name.substr(end);
  std::erase_if(index, [](char c) { return c == '[' || c == ']'; });
  return letter(name.substr(0, end)) + "_{" + index + "}";
}

std::string print(const Expression& e);

std::string bracketed(const Expression& e) { return "\\left(" + print(e) + "\\right)"; }

std::string power(const Expression& base, const Rational& exponent) {
  if (exponent == 1) return base.kind() == Kind::sum ? bracketed(base) : print(base);
  if (exponent == Rational(1, 2)) return "\\sqrt{" + print(base) + "}";
  // q^2, \cos(q)^2; \mathrm{eps}^{2}.
  const bool plain = base.kind() == Kind::symbol || base.kind() == Kind::function ||
                     (base.is_number() && base.number() >= 0);
  return (plain ? print(base) : bracketed(base)) + "^{" + to_text(exponent) + "}";
}

std::string product(const Expression& e) {
  const auto [coefficient, rest] = e.split_coefficient();
  std::vector<std::string> over;
  std::vector<std::string> under;
  const Rational size = abs(coefficient);
  if (size.get_num() != 1) over.push_back(size.get_num().get_str());
  if (size.get_den() != 1) under.push_back(size.get_den().get_str());
  const auto factors = rest.kind() == Kind::product ? rest.operands() : std::span(&rest, 1);
  for (const Expression& factor : factors) {
    if (factor.is_number()) continue;
    const bool raised = factor.kind() == Kind::power && factor.operands()[1].is_number();
    const Expression& base = raised ? factor.operands()[0] : factor;
    const Rational exponent = raised ? factor.operands()[1].number() : Rational(1);
    (exponent < 0 ? under : over).push_back(power(base, abs(exponent)));
  }
  auto joined = [](const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : " ") + part;
    return text.empty() ? std::string("1") : text;
  };
  const std::string sign = coefficient < 0 ? "-" : "";
  // A fraction's bar brackets what is alone above it.
  if (!under.empty() && over.size() == 1 && rest.kind() == Kind::sum) over[0] = print(rest);
  if (under.empty()) return sign + joined(over);
  return sign + "\\frac{" + joined(over) + "}{" + joined(under) + "}";
}

std::string function(const Expression& e) {
  const Function* row = find_function(e.name());
  const bool named = row != nullptr && row->has_latex_name;
  std::string arguments;
  for (const Expression& x : e.operands()) arguments += (arguments.empty() ? "" : ", ") + print(x);
  return (named ? "\\" + e.name() : "\\operatorname{" + e.name() + "}") + "\\left(" + arguments +
         "\\right)";
}

std::string print(const Expression& e) {
  switch (e.kind()) {
    case Kind::symbol:
      return symbol(e.name());
    case Kind::function:
      return function(e);
    case Kind::power:
      if (!e.operands()[1].is_number()) {
        return "{" + bracketed(e.operands()[0]) + "}^{" + print(e.operands()[1]) + "}";
      }
      return product(e);
    case Kind::number:
    case Kind::product:
      return product(e);
    case Kind::sum: {
      std::string text;
      for (const Expression& term : e.operands()) {
        const std::string piece = print(term);
        if (text.empty()) {
          text = piece;
        } else if (piece.starts_with('-')) {
          text += " - " + piece.substr(1);
        } else {
          text += " + " + piece;
        }
      }
      return text;
    }
  }
  return "";
}

}  // namespace

std::string to_latex(const Expression& e) { return print(e); }

}  // namespace hamgen
