// NAME=LOW:HIGH:COUNT, as several commands take it.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/language/scene.hpp"

namespace hamgen::app {

struct AxisOption {
  std::string name;
  double low = 0.0, high = 0.0;
  long long count = 1;
};

// Elements of coordinates, momenta and parameters.
[[nodiscard]] std::set<std::string> varied_names(const Model& model);
// Throws UsageError, with the nearest name, if it is not among them; `text` is the option's value.
void require_varied(const std::string& option, const std::string& text, const std::string& name,
                    const std::set<std::string>& names);

// Throws UsageError if --set or --initial gives one of these a value, too.
void require_set_once(const SceneRequest& scene, const std::vector<std::string>& varied);

// Throws UsageError if --fold burns one of these in.
void require_not_folded(const std::vector<std::string>& folded,
                        const std::vector<std::string>& varied);

// Throws UsageError; the count is within [least, most].
[[nodiscard]] AxisOption read_axis_option(const std::string& text,
                                          const std::set<std::string>& names, long least,
                                          long most);

}  // namespace hamgen::app
