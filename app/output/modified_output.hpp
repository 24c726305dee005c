// A modified Hamiltonian as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/studies/modified_energy.hpp"

namespace hamgen::app {

// A term as it is shown: multiplied out where that is not much longer, for nested brackets hide
// what it consists of.
[[nodiscard]] Expression shown_term(const Expression& term);

[[nodiscard]] std::string modified_text(const ModifiedEnergy& modified, bool latex);
[[nodiscard]] nlohmann::ordered_json modified_json(const ModifiedEnergy& modified, bool latex);

}  // namespace hamgen::app
