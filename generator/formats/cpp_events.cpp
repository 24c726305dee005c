#include "generator/formats/cpp_events.hpp"

#include <fmt/format.h>

#include <functional>

namespace hamgen {

namespace {

constexpr const char* kStepping =
    R"(// One step, then visit(crossing) for each event within it, in the order of time: true ends the
// run there.  In a step that fails nothing is looked for.
template <class Visit>
StepReport step(const Visit& visit) {
  before_ = after_;
  ended_ = false;
  const StepReport report = propagator_.step();
  if (!report.converged) return report;
  read();
  look(visit);
  return report;
}

// Up to `steps` steps, the last one that in which visit(crossing) is true; stops at the first
// failure.  The report sums the iterations.
template <class Visit>
StepReport advance(long long steps, const Visit& visit) {
  StepReport total;
  total.converged = true;
  for (long long i = 0; i < steps; ++i) {
    const StepReport report = step(visit);
    total.iterations += report.iterations;
    total.increment = report.increment;
    total.converged = report.converged;
    if (!report.converged || ended_) break;
  }
  return total;
}

// The state after a part theta of the last step, from 0 to 1, or of one that failed: one step of
// length theta h from the state before.  On failure z is left unchanged.
[[nodiscard]] StepReport at(Real theta, State& z) const {
  Propagator part(propagator_.parameters(), theta * propagator_.h(), before_.state);
  StepReport report;
  report.converged = theta == 0;
  if (theta != 0) report = part.step();
  if (report.converged) z = part.state();
  return report;
}

// Begins anew at z.
void reset(const State& z) {
  propagator_.reset(z);
  begin();
}

[[nodiscard]] const Propagator& propagator() const { return propagator_; }
// Did visit(crossing) end the run, in the last step?
[[nodiscard]] bool ended() const { return ended_; }

)";

constexpr const char* kReading = R"(void begin() {
  read();
  before_ = after_;
  ended_ = false;
}

void read() {
  after_.state = propagator_.state();
  after_.time = propagator_.time();
  gradient(propagator_.parameters(), after_.state, after_.gradient);
  events(propagator_.parameters(), after_.state, after_.values);
}

)";

class EventWriter {
 public:
  EventWriter(CodeWriter& out, EmitContext& context)
      : out_(out), context_(context), count_(context.program.events.size()) {}

  void write() {
    context_.write_with_callees(out_, "events");
    write_types();
    out_.line("// A Propagator whose steps are looked into; they are its own, whatever is found.");
    out_.open("class WatchedPropagator");
    access(" public:");
    out_.line(
        "explicit WatchedPropagator(const Propagator& propagator) : propagator_(propagator) { "
        "begin(); }");
    out_.line();
    out_.lines(kStepping);
    access(" private:");
    write_side();
    out_.lines(kReading);
    write_look();
    write_value();
    write_cubic();
    for (const char* line : {"Propagator propagator_;", "Side before_, after_;  // the last step",
                             "bool ended_ = false;"})
      out_.line(line);
    out_.close(";");
    out_.line();
  }

 private:
  void access(const char* line) {
    out_.dedent();
    out_.line(line);
    out_.indent();
  }

  [[nodiscard]] std::string list_of(
      const std::function<std::string(const EventName&)>& text) const {
    std::string list;
    for (const EventName& each : context_.program.events)
      list += (list.empty() ? "" : ", ") + text(each);
    return list;
  }

  void write_types() {
    out_.line("// In the order of their values.");
    out_.open("enum class Event");
    for (const EventName& each : context_.program.events) out_.line(each.name + ",");
    out_.close(";");
    out_.line();
    out_.lines(R"(// Where the value of an event is zero: after a part theta, in (0, 1], of a step.
struct Crossing {
  Event event;
  Real theta;
  Real time;
  State state;  // after one step of length theta h from the state before
};

)");
  }

  void write_side() {
    out_.open("struct Side");
    out_.line("State state;");
    out_.line("Real time;");
    out_.line(context_.arrays() ? "Real gradient[2 * n];"
                                : fmt::format("Real gradient[{}];", 2 * context_.n()));
    out_.line(fmt::format("Real values[{}];  // of the events", count_));
    out_.close(";");
    out_.line();
  }

  void write_flags(const char* name, bool EventName::*flag) {
    const auto text = [&](const EventName& each) { return each.*flag ? "true" : "false"; };
    out_.line(fmt::format("constexpr bool {}[{}] = {{{}}};", name, count_, list_of(text)));
  }

  void write_look() {
    out_.line("template <class Visit>");
    out_.open("void look(const Visit& visit)");
    write_flags("rising", &EventName::rising);
    write_flags("falling", &EventName::falling);
    out_.line(fmt::format("CrossingList<{}> list;", count_));
    out_.lines(fmt::format(R"(for (int i = 0; i < {}; ++i) {{
  const auto value = [&](Real theta, Real& result) {{
    State z;
    if (!at(theta, z).converged) return false;
    result = value_of(i, z);
    return magnitude(result) <= largest;
  }};
  const auto on_cubic = [&](Real s) {{ return value_of(i, cubic(s)); }};
  find_crossings(value, on_cubic, before_.values[i], after_.values[i], rising[i], falling[i],
                 [&](Real theta) {{ list.insert(i, theta); }});
}}
for (int k = 0; k < list.count && !ended_; ++k) {{
  const Real theta = list.theta[k];
  Crossing crossing = {{static_cast<Event>(list.event[k]), theta,
                       before_.time + theta * propagator_.h(), after_.state}};
  if (theta < 1 && !at(theta, crossing.state).converged) continue;
  ended_ = visit(static_cast<const Crossing&>(crossing));
}}
)",
                           count_));
    out_.close();
    out_.line();
  }

  void write_value() {
    out_.open("Real value_of(int i, const State& z) const");
    out_.line(fmt::format("Real values[{}];", count_));
    out_.line("events(propagator_.parameters(), z, values);");
    out_.line("return values[i];");
    out_.close();
    out_.line();
  }

  // q' = H_p and p' = -H_q at both ends.
  void write_component(const std::string& field, const std::string& place, const char* sign) {
    out_.line(
        fmt::format("z.{0} = cubic_between(s, h, before_.state.{0}, {2}before_.gradient[{1}], "
                    "after_.state.{0}, {2}after_.gradient[{1}]);",
                    field, place, sign));
  }

  void write_cubic() {
    const int n = context_.n();
    out_.line("// Through both states, with their derivatives J grad H.");
    out_.open("State cubic(Real s) const");
    out_.line("const Real h = propagator_.h();");
    out_.line("State z;");
    if (context_.arrays()) {
      out_.open("for (int i = 0; i < n; ++i)");
      write_component("q[i]", "n + i", "");
      write_component("p[i]", "i", "-");
      out_.close();
    } else {
      for (int i = 0; i < 2 * n; ++i)
        write_component(context_.state_field(i), std::to_string(i < n ? n + i : i - n),
                        i < n ? "" : "-");
    }
    out_.line("return z;");
    out_.close();
    out_.line();
  }

  CodeWriter& out_;
  EmitContext& context_;
  std::size_t count_;
};

}  // namespace

void write_events(CodeWriter& out, EmitContext& context) {
  if (!context.program.events.empty()) EventWriter(out, context).write();
}

}  // namespace hamgen
