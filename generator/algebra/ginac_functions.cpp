#include "generator/algebra/ginac_functions.hpp"

#include <map>
#include <stdexcept>
#include <string>

namespace hamgen {

namespace {

using Maker = GiNaC::ex (*)(const GiNaC::exvector&);

const std::map<std::string_view, Maker>& makers() {
  using V = const GiNaC::exvector&;
  static const std::map<std::string_view, Maker> table = {
      {"abs", [](V a) -> GiNaC::ex { return GiNaC::abs(a[0]); }},
      {"acos", [](V a) -> GiNaC::ex { return GiNaC::acos(a[0]); }},
      {"acosh", [](V a) -> GiNaC::ex { return GiNaC::acosh(a[0]); }},
      {"asin", [](V a) -> GiNaC::ex { return GiNaC::asin(a[0]); }},
      {"asinh", [](V a) -> GiNaC::ex { return GiNaC::asinh(a[0]); }},
      {"atan", [](V a) -> GiNaC::ex { return GiNaC::atan(a[0]); }},
      {"atan2", [](V a) -> GiNaC::ex { return GiNaC::atan2(a[0], a[1]); }},
      {"atanh", [](V a) -> GiNaC::ex { return GiNaC::atanh(a[0]); }},
      {"cos", [](V a) -> GiNaC::ex { return GiNaC::cos(a[0]); }},
      {"cosh", [](V a) -> GiNaC::ex { return GiNaC::cosh(a[0]); }},
      {"exp", [](V a) -> GiNaC::ex { return GiNaC::exp(a[0]); }},
      {"log", [](V a) -> GiNaC::ex { return GiNaC::log(a[0]); }},
      {"sin", [](V a) -> GiNaC::ex { return GiNaC::sin(a[0]); }},
      {"sinh", [](V a) -> GiNaC::ex { return GiNaC::sinh(a[0]); }},
      {"sqrt", [](V a) -> GiNaC::ex { return GiNaC::sqrt(a[0]); }},
      {"tan", [](V a) -> GiNaC::ex { return GiNaC::tan(a[0]); }},
      {"tanh", [](V a) -> GiNaC::ex { return GiNaC::tanh(a[0]); }},
  };
  return table;
}

}  // namespace

GiNaC::ex ginac_function(std::string_view name, const GiNaC::exvector& arguments) {
  const auto it = makers().find(name);
  if (it == makers().end()) throw std::domain_error("unknown function " + std::string(name));
  GiNaC::ex value = it->second(arguments);
  if (GiNaC::is_a<GiNaC::numeric>(value) && !GiNaC::ex_to<GiNaC::numeric>(value).is_real()) {
    throw std::domain_error(std::string(name) + " is not real here");
  }
  return value;
}

}  // namespace hamgen
