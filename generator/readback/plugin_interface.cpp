#include "generator/readback/plugin_interface.hpp"

#include <fmt/format.h>

#include "generator/base/quoted_text.hpp"

namespace hamgen {

namespace {

class InterfaceText {
 public:
  explicit InterfaceText(const InterfaceFacts& facts)
      : facts_(facts),
        arrays_(facts.shell.arrays),
        wide_(facts.precision.bits > 53),
        size_(static_cast<int>(facts.state.size())) {}

  std::vector<InterfacePiece> pieces() {
    add("the record of a run",
        {fmt::format("struct hamgen_run {{ {}::Propagator propagator; {}::Real start_time = 0; }};",
                     facts_.space, facts_.system)});
    add("the interface", {fmt::format("namespace {} {{ namespace {{", facts_.space)});
    add("read_parameters", parameters());
    add("read_state", state());
    add("high_part",
        {"double high_part(Real value, double* lo) { const double hi = static_cast<double>(value);"
         "if (lo) *lo = static_cast<double>(value - static_cast<Real>(hi)); return hi; }"});
    add("carried",
        {"Real carried(Real value, Real carry) { double lo; const double hi = high_part(value, "
         "&lo); return (value - static_cast<Real>(hi) - static_cast<Real>(lo)) + carry; }"});
    add("create",
        {"hamgen_run* create(const double* parameters, const double* parameters_lo, double h,"
         "double h_lo, const double* state, const double* state_lo) {"
         "void* const memory = __builtin_malloc(sizeof(hamgen_run));"
         "if (!memory) return nullptr;"
         "return new (memory) hamgen_run{Propagator(read_parameters(parameters, parameters_lo),"
         "static_cast<Real>(h) + static_cast<Real>(h_lo), read_state(state, state_lo)), 0}; }"});
    add("destroy", {"void destroy(hamgen_run* run) { if (!run) return; run->~hamgen_run();"
                    "__builtin_free(run); }"});
    add("advance", advance());
    add("get_state", get_state());
    add("get_carry", get_carry());
    add("save_run", {"long long save_run(const hamgen_run* run, void* bytes) {"
                     "if (!__is_trivially_copyable(hamgen_run)) return 0;"
                     "if (bytes) __builtin_memcpy(bytes, run, sizeof *run);"
                     "return static_cast<long long>(sizeof *run); }"});
    add("restore_run",
        {"int restore_run(hamgen_run* run, const void* bytes, long long size) {"
         "if (size == 0 || size != save_run(run, nullptr)) return 0;"
         "__builtin_memcpy(static_cast<void*>(run), bytes, sizeof *run); return 1; }"});
    add("energy_of",
        {"double energy_of(const double* parameters, const double* parameters_lo,"
         "const double* state, const double* state_lo, double* energy_lo) { return high_part("
         "energy(read_parameters(parameters, parameters_lo), read_state(state, state_lo)),"
         "energy_lo); }"});
    add("invariants_of", invariants_of());
    add("gradient_of", gradient_of());
    if (facts_.tangent) add("tangent_of", tangent_of());
    add("give_parameters", give_parameters());
    add("default_parameters",
        {"void default_parameters(double* parameters, double* parameters_lo) {"
         "give_parameters(Parameters(), parameters, parameters_lo); }"});
    add("get_time",
        {"Real time_of(const hamgen_run* run) { return run->start_time + run->propagator.time(); }"
         "double get_time(const hamgen_run* run, double* t_lo) {"
         "return high_part(time_of(run), t_lo); }"});
    add("get_h", {"double get_h(const hamgen_run* run, double* h_lo) {"
                  "return high_part(run->propagator.h(), h_lo); }"});
    add("get_parameters",
        {"void get_parameters(const hamgen_run* run, double* parameters, double* parameters_lo) {"
         "give_parameters(run->propagator.parameters(), parameters, parameters_lo); }"});
    add("set_state",
        {"void set_state(hamgen_run* run, double t, double t_lo, const double* state,"
         "const double* state_lo) { run->start_time = static_cast<Real>(t) +"
         "static_cast<Real>(t_lo); run->propagator.reset(read_state(state, state_lo)); }"});
    add("go_on_with",
        {"void go_on_with(hamgen_run* run, const Parameters& par, Real h) {"
         "run->start_time = time_of(run); const State z = run->propagator.state();"
         "run->propagator.~Propagator(); new (&run->propagator) Propagator(par, h, z); }"});
    add("set_h", {"void set_h(hamgen_run* run, double h, double h_lo) {"
                  "const Parameters par = run->propagator.parameters();"
                  "go_on_with(run, par, static_cast<Real>(h) + static_cast<Real>(h_lo)); }"});
    add("set_parameters",
        {"void set_parameters(hamgen_run* run, const double* parameters,"
         "const double* parameters_lo) {"
         "go_on_with(run, read_parameters(parameters, parameters_lo), run->propagator.h()); }"});
    add("the list of the variables", list("variable", facts_.named.variables));
    add("the list of the parameters", list("parameter", facts_.named.parameters));
    add("the list of the invariants", list("invariant", facts_.named.invariants));
    add("the table of the interface", table());
    add("the entry of the plugin",
        {fmt::format("extern \"C\" const hamgen_plugin* hamgen_plugin_entry() {{"
                     "return hamgen_arithmetic_is_ieee() ? &{}::plugin : nullptr; }}",
                     facts_.space)});
    return std::move(pieces_);
  }

 private:
  void add(const std::string& name, Pattern pattern) {
    pieces_.push_back({name, std::move(pattern)});
  }

  // The number that element `i` of an array of the host holds; of two arrays where the scalar is
  // wider than double.
  [[nodiscard]] std::string read(const std::string& array, const std::string& i) const {
    if (!wide_) return fmt::format("static_cast<Real>({}[{}])", array, i);
    const char* high = arrays_ && array == "state" ? "static_cast<Real>" : "Real";
    return fmt::format("{0}({1}[{2}]) + ({1}_lo ? Real({1}_lo[{2}]) : Real(0))", high, array, i);
  }

  // const double* parameters, const double* parameters_lo: unnamed where nothing reads them.
  [[nodiscard]] std::string arguments(const std::string& array, bool any) const {
    return fmt::format("const double*{}, const double*{}", any ? " " + array : "",
                       any && wide_ ? " " + array + "_lo" : "");
  }

  Pattern parameters() {
    std::string text = fmt::format("Parameters read_parameters({}) {{ Parameters result;",
                                   arguments("parameters", !facts_.parameters.empty()));
    for (std::size_t i = 0; i < facts_.parameters.size(); ++i)
      text += fmt::format("result.{} = {};", facts_.parameters[i],
                          read("parameters", std::to_string(i)));
    return {text + "return result; }"};
  }

  Pattern state() {
    std::string text =
        fmt::format("State read_state({}) {{ State result;", arguments("state", size_ > 0));
    if (arrays_) {
      text += fmt::format("for (int i = 0; i < n; ++i) {{ result.q[i] = {}; result.p[i] = {}; }}",
                          read("state", "i"), read("state", "n + i"));
    }
    for (int i = 0; i < (arrays_ ? 0 : size_); ++i)
      text += fmt::format("result.{} = {};", place(i), read("state", std::to_string(i)));
    return {text + "return result; }"};
  }

  [[nodiscard]] Pattern advance() const {
    std::string text =
        "void advance(hamgen_run* run, long long steps, int watch_energy, hamgen_report* report) {"
        "hamgen_report total{}; Real energy_min{}, energy_max{}, energy_last{};"
        "for (long long i = 0; i < steps; ++i) {"
        "const StepReport last = run->propagator.step();"
        "total.last_iterations = static_cast<int>(last.iterations);"
        "total.last_increment = static_cast<double>(last.increment);"
        "if (!last.converged) {"
        "const bool finite = total.last_increment - total.last_increment == 0.0;"
        "total.status = finite ? HAMGEN_NOT_CONVERGED : HAMGEN_NOT_FINITE; break; }"
        "total.iterations += last.iterations; ++total.steps_done;"
        "if (watch_energy) {"
        "energy_last = energy(run->propagator.parameters(), run->propagator.state());"
        "if (i == 0 || energy_last < energy_min) energy_min = energy_last;"
        "if (i == 0 || energy_last > energy_max) energy_max = energy_last;"
        "const double now = static_cast<double>(energy_last);"
        "if (!(now - now == 0.0)) { total.status = HAMGEN_NOT_FINITE; break; } } }";
    if (facts_.shell.code.unchecked) {
      text +=
          "const bool ends = !run->propagator.advance(0).converged;"
          "if (total.status == HAMGEN_DONE && ends) total.status = HAMGEN_NOT_FINITE;";
    }
    for (const char* which : {"min", "max", "last"})
      text += fmt::format("total.energy_{0} = high_part(energy_{0}, &total.energy_{0}_lo);", which);
    return {text + "*report = total; }"};
  }

  [[nodiscard]] Pattern get_state() const {
    std::string text =
        "void get_state(const hamgen_run* run, double* state, double* state_lo) {"
        "const State& z = run->propagator.state();";
    const auto give = [](const std::string& i, const std::string& value) {
      return fmt::format("state[{0}] = high_part({1}, state_lo ? state_lo + {0} : nullptr);", i,
                         value);
    };
    if (arrays_) {
      text += "for (int i = 0; i < 2 * n; ++i) { const Real value = i < n ? z.q[i] : z.p[i - n];" +
              give("i", "value") + "}";
    }
    for (int i = 0; i < (arrays_ ? 0 : size_); ++i)
      text += give(std::to_string(i), "z." + place(i));
    return {text + "}"};
  }

  [[nodiscard]] Pattern get_carry() const {
    std::string text =
        "void get_carry(const hamgen_run* run, double* carry, double* carry_lo) {"
        "const State& z = run->propagator.state();";
    text += facts_.shell.code.has_carry() ? "const State& c = run->propagator.carry();"
                                          : "const State c;";
    const auto give = [](const std::string& i, const std::string& field) {
      return fmt::format("carry[{0}] = high_part(carried(z.{1}, c.{1}), carry_lo + {0});", i,
                         field);
    };
    if (arrays_) {
      text += "for (int i = 0; i < n; ++i) {" + give("i", "q[i]") + give("n + i", "p[i]") + "}";
    }
    for (int i = 0; i < (arrays_ ? 0 : size_); ++i) text += give(std::to_string(i), place(i));
    return {text + "}"};
  }

  // The invariants of the model, and behind them the modified energies.
  [[nodiscard]] Pattern invariants_of() const {
    const int modified = facts_.shell.modified;
    if (facts_.invariants + modified == 0) {
      return {
          "void invariants_of(const double*, const double*, const double*, const double*, double*,"
          "double*) { }"};
    }
    Pattern pattern{
        "void invariants_of(const double* parameters, const double* parameters_lo,"
        "const double* state, const double* state_lo, double* values, double* values_lo) {"};
    const auto give = [&pattern](const std::string& array, int count, int first) {
      const std::string at = first == 0 ? "i" : fmt::format("{} + i", first);
      pattern.text += fmt::format(
          "for (int i = 0; i < {}; ++i) values[{}] = high_part({}[i], values_lo ? values_lo + {} "
          ": nullptr);",
          count, at, array, at);
    };
    if (facts_.invariants > 0) {
      pattern.text += fmt::format(
          "Real result[{}]; invariants(read_parameters(parameters, parameters_lo),"
          "read_state(state, state_lo), result);",
          facts_.invariants);
      give("result", facts_.invariants, 0);
    }
    if (modified > 0) {
      pattern.text += fmt::format(
          "Real modified[{}]; modified_energies(read_parameters(parameters, parameters_lo), {},"
          "read_state(state, state_lo), modified);",
          modified, kConstant);
      pattern.constants.push_back(facts_.watched_step);
      give("modified", modified, facts_.invariants);
    }
    pattern.text += "}";
    return pattern;
  }

  [[nodiscard]] Pattern gradient_of() const {
    if (size_ == 0) return {"void gradient_of(const double*, const double*, double*) { }"};
    return {fmt::format(
        "void gradient_of(const double* parameters, const double* state, double* values) {{"
        "Real result[{0}];"
        "gradient(read_parameters(parameters, nullptr), read_state(state, nullptr), result);"
        "for (int i = 0; i < {0}; ++i) values[i] = static_cast<double>(result[i]); }}",
        size_)};
  }

  [[nodiscard]] Pattern tangent_of() const {
    std::string text =
        "int tangent_of(const double* parameters, double h, const double* state,"
        "double* new_state, double* matrix) {"
        "const Parameters par = read_parameters(parameters, nullptr);"
        "const State z = read_state(state, nullptr);"
        "Propagator propagator(par, static_cast<Real>(h), z);"
        "if (!propagator.step().converged) return 0;"
        "const State& end = propagator.state(); State dz;";
    const auto moved = [](const std::string& x) {
      return fmt::format("dz.{0} = end.{0} - z.{0};", x);
    };
    const auto given = [](const std::string& i, const std::string& x) {
      return fmt::format("new_state[{}] = static_cast<double>(end.{});", i, x);
    };
    if (arrays_) {
      text += "for (int i = 0; i < n; ++i) {" + moved("q[i]") + moved("p[i]") + "}";
      text += "for (int i = 0; i < n; ++i) {" + given("i", "q[i]") + given("n + i", "p[i]") + "}";
    }
    for (int i = 0; i < (arrays_ ? 0 : size_); ++i) text += moved(place(i));
    for (int i = 0; i < (arrays_ ? 0 : size_); ++i) text += given(std::to_string(i), place(i));
    text += fmt::format(
        "Real m[{0}][{0}]; if (!tangent(par, static_cast<Real>(h), z, dz, m)) return 0;"
        "for (int i = 0; i < {0}; ++i) {{ for (int j = 0; j < {0}; ++j)"
        "matrix[i * {0} + j] = static_cast<double>(m[i][j]); }} return 1; }}",
        size_);
    return {text};
  }

  [[nodiscard]] Pattern give_parameters() const {
    const bool any = !facts_.parameters.empty();
    std::string text = any ? "void give_parameters(const Parameters& par, double* parameters,"
                             "double* parameters_lo) {"
                           : "void give_parameters(const Parameters&, double*, double*) {";
    for (std::size_t i = 0; i < facts_.parameters.size(); ++i)
      text += fmt::format(
          "parameters[{0}] = high_part(par.{1}, parameters_lo ? parameters_lo + {0} : nullptr);", i,
          facts_.parameters[i]);
    return {text + "}"};
  }

  // Elements of an array that follow each other are one entry.
  [[nodiscard]] static Pattern list(const std::string& of,
                                    const std::vector<InterfaceQuantity>& all) {
    std::string text = fmt::format("const hamgen_quantity {}_list[] = {{", of);
    for (std::size_t i = 0; i < all.size();) {
      const auto bracket = all[i].name.find('[');
      const std::string base = all[i].name.substr(0, bracket);
      const long first =
          bracket == std::string::npos ? 0 : std::stol(all[i].name.substr(bracket + 1));
      std::size_t end = i + 1;
      while (bracket != std::string::npos && end < all.size() &&
             all[end].name == fmt::format("{}[{}]", base, first + static_cast<long>(end - i)))
        ++end;
      text += fmt::format("{{{}, {}, {}, {}, {}, {}}},", cpp_string(base), cpp_string(all[i].unit),
                          cpp_string(all[i].comment), bracket == std::string::npos ? 0 : 1, first,
                          end - i);
      i = end;
    }
    return {text + "{}};"};
  }

  // In the order of struct hamgen_plugin, and the end of both namespaces.
  [[nodiscard]] Pattern table() const {
    return {fmt::format(
        "const hamgen_plugin plugin = {{HAMGEN_PLUGIN_VERSION, {}, {}, {}, {}, {}, {}, create,"
        "destroy, advance, get_state, get_carry, energy_of, invariants_of, gradient_of, {},"
        "save_run, restore_run, variable_list, parameter_list, invariant_list,"
        "default_parameters, get_time, get_h, get_parameters, set_state, set_h, set_parameters}};"
        "}} }}",
        facts_.degrees_of_freedom, facts_.parameters.size(),
        facts_.invariants + facts_.shell.modified, facts_.precision.bits,
        cpp_string(facts_.description), cpp_string(facts_.solver),
        facts_.tangent ? "tangent_of" : "nullptr")};
  }

  [[nodiscard]] const std::string& place(int i) const {
    return facts_.state[static_cast<std::size_t>(i)];
  }

  const InterfaceFacts& facts_;
  bool arrays_, wide_;
  int size_;  // 2n
  std::vector<InterfacePiece> pieces_;
};

}  // namespace

std::vector<InterfacePiece> plugin_interface(const InterfaceFacts& facts) {
  return InterfaceText(facts).pieces();
}

}  // namespace hamgen
