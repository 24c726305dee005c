#include "generator/readback/event_shell.hpp"

#include <fmt/format.h>

#include "generator/readback/fixed_text.hpp"

namespace hamgen {

namespace {

// A component of the cubic: its derivative is plus or minus this place of grad H.
std::string component(const std::string& place, const std::string& derivative) {
  const std::size_t sign = derivative.starts_with('-') ? 1 : 0;
  const std::string index = "[" + derivative.substr(sign) + "]";
  const char* minus = sign == 1 ? "-" : "";
  return fmt::format("z.{0} = cubic_between(s, h, a.{0}, {1}at_a{2}, b.{0}, {1}at_b{2});", place,
                     minus, index);
}

std::string components(bool arrays, const std::vector<std::string>& state) {
  if (arrays)
    return "for (int i = 0; i < n; ++i) {" + component("q[i]", "n + i") + component("p[i]", "-i") +
           "}";
  std::string text;
  const std::size_t n = state.size() / 2;
  for (std::size_t i = 0; i < n; ++i) text += component(state[i], std::to_string(n + i));
  for (std::size_t i = 0; i < n; ++i) text += component(state[n + i], "-" + std::to_string(i));
  return text;
}

}  // namespace

Pattern watch_pattern(const Watch& watch, const Environment& environment) {
  std::string names;
  std::vector<bool> rising;
  std::vector<bool> falling;
  for (const EventName& each : watch.events) {
    names += each.name + ",";
    rising.push_back(each.rising);
    falling.push_back(each.falling);
  }
  const std::vector<std::string> state = place_texts(environment.state_layout);
  return {
      fmt::format(
          "enum class Event {{{}}};"
          "struct Watched {{ static constexpr int variables = {}; static constexpr int events = {};"
          "static constexpr bool rising[events] = {{{}}};"
          "static constexpr bool falling[events] = {{{}}};"
          "static State cubic(Real s, Real h, const State& a, const Real (&at_a)[variables],"
          "const State& b, const Real (&at_b)[variables]) {{ State z; {} return z; }} }};",
          names, environment.arrays ? "2 * n" : std::to_string(state.size()), rising.size(),
          fmt::join(rising, ", "), fmt::join(falling, ", "),
          components(environment.arrays, state)) +
      std::string(tested_text("shells/watched_propagator"))};
}

}  // namespace hamgen
