#include "app/output/json_document.hpp"

namespace hamgen::app {

std::string json_document(const nlohmann::ordered_json& value) {
  constexpr bool ascii_only = true;
  return value.dump(2, ' ', ascii_only, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace hamgen::app
