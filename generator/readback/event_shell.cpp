#include "generator/readback/event_shell.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

std::string joined(const std::vector<std::string>& items) {
  return fmt::format("{}", fmt::join(items, ", "));
}

// A component of the cubic: its derivative is plus or minus this place of grad H.
std::string component(const std::string& place, const std::string& derivative) {
  return fmt::format("z.{0} = cubic_between(s, h, before_.state.{0}, {1}, after_.state.{0}, {2});",
                     place, fmt::format(fmt::runtime(derivative), "before_"),
                     fmt::format(fmt::runtime(derivative), "after_"));
}

std::string cubic(const ShellFacts& facts) {
  std::string text = "State cubic(Real s) const { const Real h = propagator_.h(); State z;";
  if (facts.arrays)
    return text + "for (int i = 0; i < n; ++i) {" + component("q[i]", "{}.gradient[n + i]") +
           component("p[i]", "-{}.gradient[i]") + "} return z; }";
  const std::size_t n = facts.state.size() / 2;
  for (std::size_t i = 0; i < n; ++i)
    text += component(facts.state[i], fmt::format("{{}}.gradient[{}]", n + i));
  for (std::size_t i = 0; i < n; ++i)
    text += component(facts.state[n + i], fmt::format("-{{}}.gradient[{}]", i));
  return text + "return z; }";
}

constexpr const char* kSteps =
    "template <class Visit> StepReport step(const Visit& visit) {"
    "before_ = after_; ended_ = false; const StepReport report = propagator_.step();"
    "if (!report.converged) return report; read(); look(visit); return report; }"
    "template <class Visit> StepReport advance(long long steps, const Visit& visit) {"
    "StepReport total; total.converged = true; for (long long i = 0; i < steps; ++i) {"
    "const StepReport report = step(visit); total.iterations += report.iterations;"
    "total.increment = report.increment; total.converged = report.converged;"
    "if (!report.converged || ended_) break; } return total; }"
    "[[nodiscard]] StepReport at(Real theta, State& z) const {"
    "Propagator part(propagator_.parameters(), theta * propagator_.h(), before_.state);"
    "StepReport report; report.converged = theta == 0; if (theta != 0) report = part.step();"
    "if (report.converged) z = part.state(); return report; }"
    "void reset(const State& z) { propagator_.reset(z); begin(); }"
    "[[nodiscard]] const Propagator& propagator() const { return propagator_; }"
    "[[nodiscard]] bool ended() const { return ended_; }";

constexpr const char* kReads =
    "void begin() { read(); before_ = after_; ended_ = false; }"
    "void read() { after_.state = propagator_.state(); after_.time = propagator_.time();"
    "gradient(propagator_.parameters(), after_.state, after_.gradient);"
    "events(propagator_.parameters(), after_.state, after_.values); }";

std::string look(const std::vector<std::string>& rising, const std::vector<std::string>& falling) {
  return fmt::format(
      "template <class Visit> void look(const Visit& visit) {{"
      "constexpr bool rising[{0}] = {{{1}}}; constexpr bool falling[{0}] = {{{2}}};"
      "CrossingList<{0}> list; for (int i = 0; i < {0}; ++i) {{"
      "const auto value = [&](Real theta, Real& result) {{ State z;"
      "if (!at(theta, z).converged) return false; result = value_of(i, z);"
      "return magnitude(result) <= largest; }};"
      "const auto on_cubic = [&](Real s) {{ return value_of(i, cubic(s)); }};"
      "find_crossings(value, on_cubic, before_.values[i], after_.values[i], rising[i], falling[i],"
      "[&](Real theta) {{ list.insert(i, theta); }}); }}"
      "for (int k = 0; k < list.count && !ended_; ++k) {{ const Real theta = list.theta[k];"
      "Crossing crossing = {{static_cast<Event>(list.event[k]), theta,"
      "before_.time + theta * propagator_.h(), after_.state}};"
      "if (theta < 1 && !at(theta, crossing.state).converged) continue;"
      "ended_ = visit(static_cast<const Crossing&>(crossing)); }} }}",
      rising.size(), joined(rising), joined(falling));
}

}  // namespace

Pattern event_pattern(const ShellFacts& facts) {
  std::string names;
  for (const EventName& each : facts.code.events) names += each.name + ",";
  return {"enum class Event {" + names + "};"};
}

Pattern crossing_pattern() {
  return {"struct Crossing { Event event; Real theta; Real time; State state; };"};
}

Pattern watched_propagator_pattern(const ShellFacts& facts) {
  std::vector<std::string> rising;
  std::vector<std::string> falling;
  for (const EventName& each : facts.code.events) {
    rising.emplace_back(each.rising ? "true" : "false");
    falling.emplace_back(each.falling ? "true" : "false");
  }
  const std::size_t count = rising.size();
  const std::string components = facts.arrays ? "2 * n" : std::to_string(facts.state.size());
  return {
      "class WatchedPropagator { public:"
      "explicit WatchedPropagator(const Propagator& propagator) : propagator_(propagator) {"
      "begin(); }" +
      std::string(kSteps) +
      fmt::format("private: struct Side {{ State state; Real time; Real gradient[{}];"
                  "Real values[{}]; }};",
                  components, count) +
      kReads + look(rising, falling) +
      fmt::format("Real value_of(int i, const State& z) const {{ Real values[{}];"
                  "events(propagator_.parameters(), z, values); return values[i]; }}",
                  count) +
      cubic(facts) + "Propagator propagator_; Side before_, after_; bool ended_ = false; };"};
}

}  // namespace hamgen
