// What a program needs to know of a plugin besides its code: names, defaults, scenes.  The command
// writes it as text beside the plugin, load() reads it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/event.hpp"
#include "runtime/library.hpp"

namespace hamgen {

struct SceneStart {
  std::vector<runtime::Wide> parameters;  // in the plugin's order, without E0
  std::vector<runtime::Wide> state;       // 2n values: q then p
  std::optional<runtime::Wide> h;
  std::optional<long long> steps;
};

struct EventFacts {
  std::size_t place = 0;  // among what the plugin computes as invariants
  runtime::Direction direction = runtime::Direction::both;
};

struct SystemFacts {
  std::string name, scheme;
  int order = 1;
  bool uses_eigen = false, uses_quadmath = false;
  bool needs_initial_energy = false;  // E0 is the last parameter of the plugin
  bool defined_everywhere = false;
  std::vector<std::string> coordinates, momenta, parameters;
  std::vector<std::string> invariants;  // in the plugin's order, from its first
  std::vector<std::string> event_names;
  std::vector<EventFacts> events;
  std::vector<std::string> scene_names;
  std::vector<SceneStart> scenes;  // of these names; without any, one of the defaults
  std::shared_ptr<const runtime::Library> library = nullptr;  // not in the text
};

// A line for each: a key and its values, numbers so that they read back to the same ones.
[[nodiscard]] std::string to_text(const SystemFacts& facts);
// Throws ToolError if the text is something else, or of another version.
[[nodiscard]] SystemFacts read_facts(std::string_view text);

}  // namespace hamgen
