// What a step conserves instead of H: its modified Hamiltonian, printed and watched.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/command_line.hpp"
#include "generator/language/scene.hpp"

namespace hamgen::app {

struct ModifiedOptions {
  std::string terms;  // K
  bool latex = false;
};

// 1 to 8; throws UsageError naming the option.
[[nodiscard]] int modified_term_count(const std::string& option, const std::string& text);

// The terms of Ht and, for a scene, how constant it is along the numerical orbit with 1, 2, ... of
// them: as text and as one JSON object.
struct ModifiedReport {
  std::string text;
  nlohmann::ordered_json json;
};
[[nodiscard]] ModifiedReport modified_report(const SourceText& source, const Request& request,
                                             const ModifiedOptions& options,
                                             const std::optional<SceneValues>& scene);

}  // namespace hamgen::app
