#include "generator/algebra/ginac_functions.hpp"

#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "generator/algebra/from_ginac.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {
namespace {

// A formula of the table at one of GiNaC's values.
GiNaC::ex formula_at(Function::Formula formula, const GiNaC::ex& x) {
  SymbolTable symbols;
  const GiNaC::ex place = symbols.symbol("x", 0);
  const Expression argument = Expression::symbol("x");
  return to_ginac(formula(std::span(&argument, 1)), symbols).subs(place == x);
}

// GiNaC calls functions that know nothing of what they are for: there is one for each row.
template <std::size_t Row>
GiNaC::ex value_by_row(const GiNaC::ex& x) {
  const Function& function = all_functions()[Row];
  if (!GiNaC::is_a<GiNaC::numeric>(x))
    return GiNaC::function(ginac_serial(function), GiNaC::exvector{x}).hold();
  return formula_at(function.by_others, x).evalf();
}
template <std::size_t Row>
GiNaC::ex slope_by_row(const GiNaC::ex& x, unsigned) {
  return formula_at(all_functions()[Row].slopes[0], x);
}

struct Callbacks {
  GiNaC::evalf_funcp_1 value;
  GiNaC::derivative_funcp_1 slope;
};
constexpr std::size_t kMostRows = 64;
template <std::size_t... Rows>
constexpr std::array<Callbacks, sizeof...(Rows)> callbacks_of(std::index_sequence<Rows...>) {
  return {Callbacks{value_by_row<Rows>, slope_by_row<Rows>}...};
}

// Of those that are new to GiNaC, by their names.
std::map<std::string_view, unsigned> registered() {
  static constexpr auto callbacks = callbacks_of(std::make_index_sequence<kMostRows>());
  if (all_functions().size() > kMostRows) internal_error("more functions than kMostRows");
  std::map<std::string_view, unsigned> serials;
  for (std::size_t row = 0; row < all_functions().size(); ++row) {
    const Function& function = all_functions()[row];
    if (function.by_others == nullptr) continue;
    GiNaC::function_options options(std::string(function.name), 1);
    options.evalf_func(callbacks[row].value).derivative_func(callbacks[row].slope);
    serials.emplace(function.name, GiNaC::function::register_new(options));
  }
  return serials;
}

}  // namespace

unsigned ginac_serial(const Function& function) {
  static const std::map<std::string_view, unsigned> own = registered();
  if (const auto it = own.find(function.name); it != own.end()) return it->second;
  return GiNaC::function::find_function(std::string(function.name),
                                        static_cast<unsigned>(function.arity));
}

// A square root is a power of GiNaC's.
GiNaC::ex ginac_function(std::string_view name, const GiNaC::exvector& arguments) {
  const Function* row = find_function(name);
  if (row == nullptr || arguments.size() != static_cast<std::size_t>(row->arity))
    throw std::domain_error("unknown function " + std::string(name));
  GiNaC::ex value = GiNaC::sqrt(arguments[0]);
  if (name != "sqrt") value = GiNaC::function(ginac_serial(*row), arguments);
  if (GiNaC::is_a<GiNaC::numeric>(value) && !GiNaC::ex_to<GiNaC::numeric>(value).is_real()) {
    throw std::domain_error(std::string(name) + " is not real here");
  }
  return value;
}

}  // namespace hamgen
