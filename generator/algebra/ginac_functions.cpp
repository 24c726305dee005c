#include "generator/algebra/ginac_functions.hpp"

#include <stdexcept>
#include <string>

#include "generator/algebra/functions.hpp"

namespace hamgen {

// The table names its functions as GiNaC does, so GiNaC finds the function by its name; its square
// root is a power.
GiNaC::ex ginac_function(std::string_view name, const GiNaC::exvector& arguments) {
  const Function* row = find_function(name);
  if (row == nullptr || arguments.size() != static_cast<std::size_t>(row->arity))
    throw std::domain_error("unknown function " + std::string(name));
  GiNaC::ex value = GiNaC::sqrt(arguments[0]);
  if (name != "sqrt") {
    const unsigned serial = GiNaC::function::find_function(row->name.data(), arguments.size());
    value = GiNaC::function(serial, arguments);
  }
  if (GiNaC::is_a<GiNaC::numeric>(value) && !GiNaC::ex_to<GiNaC::numeric>(value).is_real()) {
    throw std::domain_error(std::string(name) + " is not real here");
  }
  return value;
}

}  // namespace hamgen
