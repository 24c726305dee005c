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

std::string components(const ShellFacts& facts) {
  if (facts.arrays)
    return "for (int i = 0; i < n; ++i) {" + component("q[i]", "n + i") + component("p[i]", "-i") +
           "}";
  std::string text;
  const std::size_t n = facts.state.size() / 2;
  for (std::size_t i = 0; i < n; ++i) text += component(facts.state[i], std::to_string(n + i));
  for (std::size_t i = 0; i < n; ++i)
    text += component(facts.state[n + i], "-" + std::to_string(i));
  return text;
}

}  // namespace

Pattern event_pattern(const ShellFacts& facts) {
  std::string names;
  for (const EventName& each : facts.code.events) names += each.name + ",";
  return {"enum class Event {" + names + "};"};
}

Pattern watched_pattern(const ShellFacts& facts) {
  std::vector<bool> rising;
  std::vector<bool> falling;
  for (const EventName& each : facts.code.events) {
    rising.push_back(each.rising);
    falling.push_back(each.falling);
  }
  return {fmt::format(
      "struct Watched {{ static constexpr int variables = {}; static constexpr int events = {};"
      "static constexpr bool rising[events] = {{{}}};"
      "static constexpr bool falling[events] = {{{}}};"
      "static State cubic(Real s, Real h, const State& a, const Real (&at_a)[variables],"
      "const State& b, const Real (&at_b)[variables]) {{ State z; {} return z; }} }};",
      facts.arrays ? "2 * n" : std::to_string(facts.state.size()), rising.size(),
      fmt::join(rising, ", "), fmt::join(falling, ", "), components(facts))};
}

Pattern watched_propagator_pattern() {
  return {std::string(tested_text("shells/watched_propagator"))};
}

}  // namespace hamgen
