// What finds events along the steps.
#include <fmt/format.h>

#include "generator/formats/cpp_pieces.hpp"
#include "generator/formats/numerics.hpp"

namespace hamgen {

namespace {

void write_flags(CodeWriter& out, const std::string& name, const std::vector<EventName>& events,
                 bool EventName::*flag) {
  std::vector<std::string> list;
  for (const EventName& each : events) list.emplace_back(each.*flag ? "true" : "false");
  out.line(
      fmt::format("static constexpr bool {}[events] = {{{}}};", name, joined_texts(list, ", ")));
}

// q' = H_p and p' = -H_q at both ends.
void write_component(CodeWriter& out, const std::string& field, const std::string& place,
                     const char* sign) {
  out.line(fmt::format("z.{0} = cubic_between(s, h, a.{0}, {2}at_a[{1}], b.{0}, {2}at_b[{1}]);",
                       field, place, sign));
}

void write_cubic(CodeWriter& out, const EmitContext& context) {
  const int n = context.n();
  out.line("// Through the states a and b, with grad H at both.");
  out.open(
      "static State cubic(Real s, Real h, const State& a, const Real (&at_a)[variables], const "
      "State& b, const Real (&at_b)[variables])");
  out.line("State z;");
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    write_component(out, "q[i]", "n + i", "");
    write_component(out, "p[i]", "i", "-");
    out.close();
  }
  for (int i = 0; i < (context.arrays() ? 0 : 2 * n); ++i)
    write_component(out, context.state_field(i), std::to_string(i < n ? n + i : i - n),
                    i < n ? "" : "-");
  out.line("return z;");
  out.close();
}

}  // namespace

void write_watch(CodeWriter& out, const EmitContext& context, const Watch& watch) {
  const std::vector<EventName>& events = watch.events;
  out.line("// In the order of their values.");
  out.open("enum class Event");
  for (const EventName& each : events) out.line(each.name + ",");
  out.close(";");
  out.line();
  out.line("// What a WatchedPropagator knows of the system and its events.");
  out.open("struct Watched");
  out.line(fmt::format("static constexpr int variables = {};",
                       context.arrays() ? "2 * n" : std::to_string(2 * context.n())));
  out.line(fmt::format("static constexpr int events = {};", events.size()));
  write_flags(out, "rising", events, &EventName::rising);
  write_flags(out, "falling", events, &EventName::falling);
  write_cubic(out, context);
  out.close(";");
  out.line();
  out.lines(cpp_numerics("shells/watched_propagator"));
  out.line();
}

}  // namespace hamgen
