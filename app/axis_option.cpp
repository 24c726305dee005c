#include "app/axis_option.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/command_line.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {

std::set<std::string> varied_names(const Model& model) {
  std::set<std::string> names;
  for (const auto* variables : {&model.coordinates, &model.momenta})
    std::ranges::copy(element_names(*variables), std::inserter(names, names.end()));
  std::ranges::copy(element_names(model.parameters), std::inserter(names, names.end()));
  return names;
}

void require_varied(const std::string& option, const std::string& text, const std::string& name,
                    const std::set<std::string>& names) {
  if (names.contains(name)) return;
  const std::string near = nearest(name, {names.begin(), names.end()});
  throw UsageError(fmt::format("{} {}: the model has no such variable or parameter{}", option, text,
                               near.empty() ? "" : "; did you mean '" + near + "'?"));
}

void require_set_once(const SceneRequest& scene, const std::vector<std::string>& varied) {
  for (const std::string& name : varied) {
    for (const auto& [option, list] :
         {std::pair("--set", &scene.set), {"--initial", &scene.initial}}) {
      for (const auto& [other, value] : *list)
        if (other == name)
          throw UsageError(
              fmt::format("{} {}={}: {} is varied, and a name is set once\nhelp: leave out {}",
                          option, name, value, name, option));
    }
  }
}

void require_not_folded(const std::vector<std::string>& folded,
                        const std::vector<std::string>& varied) {
  for (const std::string& name : varied) {
    if (std::ranges::find(folded, name.substr(0, name.find('['))) != folded.end())
      throw UsageError(fmt::format(
          "--fold {0}: it is varied, and cannot be burnt in\nhelp: leave out --fold", name));
  }
}

AxisOption read_axis_option(const std::string& text, const std::set<std::string>& names, long least,
                            long most) {
  const std::string help = "\nhelp: for example --over q2=-0.5:0.7:50";
  const auto [name, range] = split_assignment("--over", text);
  require_varied("--over", text, name, names);
  const std::size_t first = range.find(':');
  const std::size_t second = first == std::string::npos ? first : range.find(':', first + 1);
  if (second == std::string::npos)
    throw UsageError(fmt::format("--over {}: LOW:HIGH:COUNT is wanted{}", text, help));
  const auto number = [&text](const std::string& piece) {
    return to_double(constant_option("--over " + text, piece));
  };
  const AxisOption axis{.name = name,
                        .low = number(range.substr(0, first)),
                        .high = number(range.substr(first + 1, second - first - 1)),
                        .count = integer_value("--over " + text, range.substr(second + 1), least)};
  if (!(axis.low < axis.high) || axis.count > most)
    throw UsageError(
        fmt::format("--over {}: LOW < HIGH and at most {} values are wanted{}", text, most, help));
  return axis;
}

}  // namespace hamgen::app
