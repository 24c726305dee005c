#include "generator/formats/cpp_interface.hpp"

#include <fmt/format.h>

#include "generator/formats/plugin_quantities.hpp"

namespace hamgen {

namespace {

// Copies an array of doubles into a struct's fields.
void write_fill(CodeWriter& out, const EmitContext& context, const std::string& target,
                const std::vector<std::string>& names, const std::string& values) {
  if (context.arrays() && target == "result" && values == "state") {
    const std::string low =
        context.scalar.digits <= 53 ? "" : " + (state_lo ? Real(state_lo[{0}]) : Real(0))";
    out.open("for (int i = 0; i < n; ++i)");
    out.line("result.q[i] = static_cast<Real>(state[i])" + fmt::format(fmt::runtime(low), "i") +
             ";");
    out.line("result.p[i] = static_cast<Real>(state[n + i])" +
             fmt::format(fmt::runtime(low), "n + i") + ";");
    out.close();
    return;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (context.scalar.digits <= 53) {
      out.line(fmt::format("{}.{} = static_cast<Real>({}[{}]);", target, names[i], values, i));
    } else {
      out.line(fmt::format("{0}.{1} = Real({2}[{3}]) + ({2}_lo ? Real({2}_lo[{3}]) : Real(0));",
                           target, names[i], values, i));
    }
  }
}

void write_tangent_interface(CodeWriter& out, const EmitContext& context) {
  const int size = 2 * context.n();
  std::string increments;
  std::string ends;
  if (context.arrays()) {
    increments = R"(  for (int i = 0; i < n; ++i) {
    dz.q[i] = end.q[i] - z.q[i];
    dz.p[i] = end.p[i] - z.p[i];
  }
)";
    ends = R"(  for (int i = 0; i < n; ++i) {
    new_state[i] = static_cast<double>(end.q[i]);
    new_state[n + i] = static_cast<double>(end.p[i]);
  }
)";
  }
  for (int i = 0; i < size && !context.arrays(); ++i) {
    increments += fmt::format("  dz.{0} = end.{0} - z.{0};\n", context.state_field(i));
    ends +=
        fmt::format("  new_state[{}] = static_cast<double>(end.{});\n", i, context.state_field(i));
  }
  out.lines(fmt::format(
      R"(int tangent_of(const double* parameters, double h, const double* state, double* new_state,
               double* matrix) {{
  const Parameters par = read_parameters(parameters, nullptr);
  const State z = read_state(state, nullptr);
  Propagator propagator(par, static_cast<Real>(h), z);
  if (!propagator.step().converged) return 0;
  const State& end = propagator.state();
  State dz;
{}{}  Real m[{}][{}];
  if (!tangent(par, static_cast<Real>(h), z, dz, m)) return 0;
  for (int i = 0; i < {}; ++i) {{
    for (int j = 0; j < {}; ++j) matrix[i * {} + j] = static_cast<double>(m[i][j]);
  }}
  return 1;
}}

)",
      increments, ends, size, size, size, size, size));
}

}  // namespace

void write_interface(CodeWriter& out, const EmitContext& context) {
  const std::string description =
      cpp_string(fmt::format("{}, {}", context.program.facts.system, context.program.facts.scheme));
  out.line();
  out.line("// The interface of plugin.h.");
  const std::string method = context.options.spaces.of_method();
  out.open("struct hamgen_run");
  out.line(method + "::Propagator propagator;");
  out.line(context.options.spaces.system + "::Real start_time = 0;  // of the propagator");
  out.close(";");
  out.line();
  out.line(fmt::format("namespace {} {{", method));
  out.line("namespace {");
  out.line();
  auto fill = [&](const std::string& name, const std::string& type,
                  const std::vector<std::string>& names, const std::string& values) {
    const bool low = context.scalar.digits > 53 && !names.empty();
    out.open(fmt::format("{} {}(const double*{}, const double*{})", type, name,
                         names.empty() ? "" : " " + values, low ? " " + values + "_lo" : ""));
    out.line(type + " result;");
    write_fill(out, context, "result", names, values);
    out.line("return result;");
    out.close();
    out.line();
  };
  fill("read_parameters", "Parameters", context.parameter_fields, "parameters");
  fill("read_state", "State", context.state_fields, "state");
  out.lines(
      R"(// The double nearest to the value; what it leaves of it is lo.
double high_part(Real value, double* lo) {
  const double hi = static_cast<double>(value);
  if (lo) *lo = static_cast<double>(value - static_cast<Real>(hi));
  return hi;
}

// What hi + lo leave of a state's value, and what rounding took from it.
Real carried(Real value, Real carry) {
  double lo;
  const double hi = high_part(value, &lo);
  return (value - static_cast<Real>(hi) - static_cast<Real>(lo)) + carry;
}

hamgen_run* create(const double* parameters, const double* parameters_lo, double h, double h_lo,
                   const double* state, const double* state_lo) {
  void* const memory = __builtin_malloc(sizeof(hamgen_run));
  if (!memory) return nullptr;
  return new (memory) hamgen_run{Propagator(read_parameters(parameters, parameters_lo),
                                            static_cast<Real>(h) + static_cast<Real>(h_lo),
                                            read_state(state, state_lo)),
                                 0};
}

void destroy(hamgen_run* run) {
  if (!run) return;
  run->~hamgen_run();
  __builtin_free(run);
}

void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {
  hamgen_report total{};
  Real energy_min{}, energy_max{}, energy_last{};
  for (long long i = 0; i < steps; ++i) {
    const StepReport last = run->propagator.step();
    total.last_iterations = static_cast<int>(last.iterations);
    total.last_increment = static_cast<double>(last.increment);
    if (!last.converged) {
      const bool finite = total.last_increment - total.last_increment == 0.0;
      total.status = finite ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE;
      break;
    }
    total.iterations += last.iterations;
    ++total.steps_done;
    if (watch_energy) {
      energy_last = energy(run->propagator.parameters(), run->propagator.state());
      if (i == 0 || energy_last < energy_min) energy_min = energy_last;
      if (i == 0 || energy_last > energy_max) energy_max = energy_last;
      const double now = static_cast<double>(energy_last);
      if (!(now - now == 0.0)) {
        total.status = HAMGEN_NOT_FINITE;
        break;
      }
    }
  }
)");
  if (context.program.unchecked) {
    out.indent();
    out.line("// No step fails, but where numbers end.");
    out.line("const bool ends = !run->propagator.advance(0).converged;");
    out.line("if (total.status == HAMGEN_DONE && ends) total.status = HAMGEN_NOT_FINITE;");
    out.dedent();
  }
  out.lines(R"(  total.energy_min = high_part(energy_min, &total.energy_min_lo);
  total.energy_max = high_part(energy_max, &total.energy_max_lo);
  total.energy_last = high_part(energy_last, &total.energy_last_lo);
  *report = total;
}
)");
  out.line();
  out.open("void get_state(const hamgen_run* run, double* state, double* state_lo)");
  out.line("const State& z = run->propagator.state();");
  if (context.arrays()) {
    out.open("for (int i = 0; i < 2 * n; ++i)");
    out.line("const Real value = i < n ? z.q[i] : z.p[i - n];");
    out.line("state[i] = high_part(value, state_lo ? state_lo + i : nullptr);");
    out.close();
  }
  for (int i = 0; i < (context.arrays() ? 0 : 2 * context.n()); ++i) {
    out.line(fmt::format("state[{0}] = high_part(z.{1}, state_lo ? state_lo + {0} : nullptr);", i,
                         context.state_field(i)));
  }
  out.close();
  out.line();
  out.open("void get_carry(const hamgen_run* run, double* carry, double* carry_lo)");
  out.line("const State& z = run->propagator.state();");
  out.line(context.program.has_carry() ? "const State& c = run->propagator.carry();"
                                       : "const State c;  // sums are plain");
  if (context.arrays()) {
    out.open("for (int i = 0; i < n; ++i)");
    out.line("carry[i] = high_part(carried(z.q[i], c.q[i]), carry_lo + i);");
    out.line("carry[n + i] = high_part(carried(z.p[i], c.p[i]), carry_lo + n + i);");
    out.close();
  }
  for (int i = 0; i < (context.arrays() ? 0 : 2 * context.n()); ++i)
    out.line(fmt::format("carry[{0}] = high_part(carried(z.{1}, c.{1}), carry_lo + {0});", i,
                         context.state_field(i)));
  out.close();
  out.line();
  out.lines(
      R"(// All that the run is, as bytes; with matrices of Eigen it is more than these.
long long save_run(const hamgen_run* run, void* bytes) {
  if (!__is_trivially_copyable(hamgen_run)) return 0;
  if (bytes) __builtin_memcpy(bytes, run, sizeof *run);
  return static_cast<long long>(sizeof *run);
}

int restore_run(hamgen_run* run, const void* bytes, long long size) {
  if (size == 0 || size != save_run(run, nullptr)) return 0;
  __builtin_memcpy(static_cast<void*>(run), bytes, sizeof *run);
  return 1;
}
)");
  out.line();
  out.lines(
      R"(double energy_of(const double* parameters, const double* parameters_lo, const double* state,
                 const double* state_lo, double* energy_lo) {
  return high_part(energy(read_parameters(parameters, parameters_lo), read_state(state, state_lo)),
                   energy_lo);
}
)");
  out.line();
  // Fills values from `first` on with what the call leaves in the named array.
  const auto fill_values = [&out](const std::string& array, std::size_t count, std::size_t first,
                                  const std::string& call) {
    if (count == 0) return;
    const std::string place = first == 0 ? "i" : fmt::format("{} + i", first);
    out.line(fmt::format("Real {}[{}];", array, count));
    out.line(call);
    out.line(
        fmt::format("for (int i = 0; i < {0}; ++i) values[{1}] = high_part({2}[i], values_lo ? "
                    "values_lo + {1} : nullptr);",
                    count, place, array));
  };
  const std::string arguments = "read_parameters(parameters, parameters_lo), ";
  const std::string state = "read_state(state, state_lo)";
  const auto size = static_cast<std::size_t>(2 * context.n());
  const std::size_t modified = context.program.facts.modified_powers.size();
  const std::size_t invariants = context.program.facts.invariants.size() - modified;
  out.open(invariants + modified == 0
               ? "void invariants_of(const double*, const double*, const double*, const double*, "
                 "double*, double*)"
               : "void invariants_of(const double* parameters, const double* parameters_lo, const "
                 "double* state, const double* state_lo, double* values, double* values_lo)");
  fill_values("result", invariants, 0, "invariants(" + arguments + state + ", result);");
  fill_values("modified", modified, invariants,
              fmt::format("modified_energies({}{}, {}, modified);", arguments,
                          literal(context.options.watched_step, context.scalar), state));
  out.close();
  out.line();
  if (size == 0) {
    out.open("void gradient_of(const double*, const double*, double*)");
  } else {
    out.open("void gradient_of(const double* parameters, const double* state, double* values)");
    out.line(fmt::format("Real result[{}];", size));
    out.line("gradient(read_parameters(parameters, nullptr), read_state(state, nullptr), result);");
    out.line(fmt::format("for (int i = 0; i < {}; ++i) values[i] = static_cast<double>(result[i]);",
                         size));
  }
  out.close();
  out.line();
  if (context.options.tangent) write_tangent_interface(out, context);
  write_setters(out, context);
  write_quantity_lists(out, context);
  out.line(
      fmt::format("const hamgen_plugin plugin = {{HAMGEN_PLUGIN_VERSION, {}, {}, {}, {}, {}, "
                  "{}, create, destroy, advance, get_state, get_carry, energy_of, invariants_of, "
                  "gradient_of, {}, save_run, restore_run, variable_list, parameter_list, "
                  "invariant_list, default_parameters, get_time, get_h, get_parameters, set_state, "
                  "set_h, set_parameters}};",
                  context.n(), context.program.environment.parameters.size(), invariants + modified,
                  context.scalar.digits, description, cpp_string(context.program.facts.solver),
                  context.options.tangent ? "tangent_of" : "nullptr"));
  out.line();
  out.line("}  // namespace");
  out.line(fmt::format("}}  // namespace {}", method));
  out.line();
  out.open("extern \"C\" const hamgen_plugin* hamgen_plugin_entry()");
  out.line(fmt::format("return hamgen_arithmetic_is_ieee() ? &{}::plugin : nullptr;", method));
  out.close();
}

}  // namespace hamgen
