#include "runtime/facts.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

#include "runtime/csv_writer.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen {
namespace {

constexpr std::string_view kFirstLine = "hamgen-facts 1";

std::string number_list(const std::vector<runtime::Wide>& values) {
  std::string text;
  for (const runtime::Wide& value : values)
    text += " " + runtime::number_text(value.hi) + " " + runtime::number_text(value.lo);
  return text;
}

std::string direction_text(runtime::Direction direction) {
  if (direction == runtime::Direction::both) return "both";
  return direction == runtime::Direction::rising ? "rising" : "falling";
}

std::string scene_text(const SceneStart& scene, const std::string& name) {
  std::string text = fmt::format("scene {}\nvalues{}\nstate{}\n", name,
                                 number_list(scene.parameters), number_list(scene.state));
  if (scene.h) text += fmt::format("h{}\n", number_list({*scene.h}));
  if (scene.steps) text += fmt::format("steps {}\n", *scene.steps);
  return text;
}

class FactsReader {
 public:
  SystemFacts run(std::string_view text) {
    std::istringstream in{std::string(text)};
    std::string line;
    std::getline(in, line);
    if (line != kFirstLine) fail(line);
    bool ended = false;
    while (!ended && std::getline(in, line)) {
      const std::size_t blank = line.find(' ');
      ended = line == "end";
      const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
      if (!ended && !read(line.substr(0, blank), rest)) fail(line);
    }
    if (!ended || facts_.scenes.empty()) fail("the end");
    return std::move(facts_);
  }

 private:
  [[noreturn]] static void fail(const std::string& line) {
    throw runtime::ToolError(
        {.message = fmt::format("what `hamgen plugin` wrote is not understood at '{}': is the "
                                "command of the same version as the library?",
                                line.substr(0, 60)),
         .command = {},
         .exit_status = {},
         .output_tail = {}});
  }

  template <typename Number>
  static Number number(const std::string& text) {
    Number value{};
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec == std::errc::invalid_argument || end.ptr != text.data() + text.size()) fail(text);
    return value;
  }

  static std::vector<std::string> words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> result;
    for (std::string word; in >> word;) result.push_back(word);
    return result;
  }

  static std::vector<runtime::Wide> numbers(const std::string& text) {
    const std::vector<std::string> all = words(text);
    std::vector<runtime::Wide> result;
    for (std::size_t i = 0; i + 1 < all.size(); i += 2)
      result.push_back({number<double>(all[i]), number<double>(all[i + 1])});
    return result;
  }

  bool read(const std::string& key, const std::string& rest) {
    if (key == "model")
      facts_.name = rest;
    else if (key == "scheme")
      facts_.scheme = rest;
    else if (key == "order")
      facts_.order = number<int>(rest);
    else if (key == "eigen")
      facts_.uses_eigen = rest == "1";
    else if (key == "quadmath")
      facts_.uses_quadmath = rest == "1";
    else if (key == "initial-energy")
      facts_.needs_initial_energy = rest == "1";
    else if (key == "everywhere")
      facts_.defined_everywhere = rest == "1";
    else if (key == "coordinate")
      facts_.coordinates.push_back(rest);
    else if (key == "momentum")
      facts_.momenta.push_back(rest);
    else if (key == "parameter")
      facts_.parameters.push_back(rest);
    else if (key == "invariant")
      facts_.invariants.push_back(rest);
    else if (key == "event")
      return read_event(words(rest));
    else
      return read_scene(key, rest);
    return true;
  }

  bool read_event(const std::vector<std::string>& parts) {
    if (parts.size() != 3) return false;
    facts_.event_names.push_back(parts[0]);
    facts_.events.push_back(
        {number<std::size_t>(parts[1]), parts[2] == "rising"    ? runtime::Direction::rising
                                        : parts[2] == "falling" ? runtime::Direction::falling
                                                                : runtime::Direction::both});
    return true;
  }

  bool read_scene(const std::string& key, const std::string& rest) {
    if (key == "scene") {
      if (!rest.empty()) facts_.scene_names.push_back(rest);
      facts_.scenes.emplace_back();
      return true;
    }
    if (facts_.scenes.empty()) return false;
    SceneStart& scene = facts_.scenes.back();
    if (key == "values")
      scene.parameters = numbers(rest);
    else if (key == "state")
      scene.state = numbers(rest);
    else if (key == "h")
      scene.h = numbers(rest).at(0);
    else if (key == "steps")
      scene.steps = number<long long>(rest);
    else
      return false;
    return true;
  }

  SystemFacts facts_;
};

}  // namespace

std::string to_text(const SystemFacts& facts) {
  std::string text = fmt::format(
      "{}\nmodel {}\nscheme {}\norder {}\neigen {:d}\nquadmath {:d}\ninitial-energy {:d}\n"
      "everywhere {:d}\n",
      kFirstLine, facts.name, facts.scheme, facts.order, facts.uses_eigen, facts.uses_quadmath,
      facts.needs_initial_energy, facts.defined_everywhere);
  for (const auto& [key, names] : {std::pair{"coordinate", &facts.coordinates},
                                   {"momentum", &facts.momenta},
                                   {"parameter", &facts.parameters},
                                   {"invariant", &facts.invariants}}) {
    for (const std::string& name : *names) text += fmt::format("{} {}\n", key, name);
  }
  for (std::size_t i = 0; i < facts.events.size(); ++i)
    text += fmt::format("event {} {} {}\n", facts.event_names[i], facts.events[i].place,
                        direction_text(facts.events[i].direction));
  for (std::size_t i = 0; i < facts.scenes.size(); ++i)
    text += scene_text(facts.scenes[i], i < facts.scene_names.size() ? facts.scene_names[i] : "");
  return text + "end\n";
}

SystemFacts read_facts(std::string_view text) { return FactsReader().run(text); }

}  // namespace hamgen
