// Requests for a scene, as `hamgen run` makes them.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/pipeline.hpp"

namespace hamgen {

struct Changes {
  Request request = {};
  std::string scene = {};  // empty: the first
  std::set<std::string> kept = {};
  std::vector<std::pair<std::string, std::string>> set = {};
  std::string observe = {};
};

inline Request for_scene(const SourceText& source, const Changes& changes = {}) {
  Request request = changes.request;
  SceneRequest asked{.scene = changes.scene, .set = changes.set};
  if (!changes.observe.empty()) asked.observe = changes.observe;
  request.scene = SceneFacts{.asked = asked,
                             .values = scene_values(read_request(source, request), asked),
                             .kept = changes.kept};
  return request;
}

}  // namespace hamgen
