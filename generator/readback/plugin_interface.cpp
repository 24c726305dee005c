#include "generator/readback/plugin_interface.hpp"

#include <fmt/format.h>

#include "generator/base/quoted_text.hpp"
#include "generator/readback/fixed_text.hpp"

namespace hamgen {

namespace {

class InterfaceText {
 public:
  explicit InterfaceText(const InterfaceFacts& facts)
      : facts_(facts),
        program_(facts.program),
        arrays_(program_.environment.arrays),
        parameters_(place_texts(program_.environment.parameter_layout)),
        state_(place_texts(program_.environment.state_layout)),
        size_(2 * program_.environment.degrees_of_freedom),
        modified_(static_cast<int>(program_.facts.modified_powers.size())),
        invariants_(static_cast<int>(program_.facts.invariants.size()) - modified_) {}

  std::vector<InterfacePiece> pieces() {
    add("the record of a run",
        {fmt::format("struct hamgen_run {{ {}::Propagator propagator; {}::Real start_time = 0; }};",
                     facts_.space, facts_.system)});
    add("the interface", {fmt::format("namespace {} {{ namespace {{", facts_.space)});
    add("for_parameters", walk("for_parameters", "Record&", "par", "", "", parameters()));
    add("for_state", walk("for_state", "Record&", "z", "const State&", "beside", state()));
    add("for_invariants",
        walk("for_invariants", "const Parameters&", "par", "const State&", "z", invariants()));
    add("for_gradient",
        walk("for_gradient", "const Parameters&", "par", "const State&", "z", gradient()));
    add("carry_of", {program_.has_carry()
                         ? "const State& carry_of(const Propagator& run) { return run.carry(); }"
                         : "State carry_of(const Propagator&) { return State(); }"});
    add("never_fails", {fmt::format("constexpr bool never_fails = {};", program_.unchecked)});
    if (facts_.tangent) add("variables", {fmt::format("constexpr int variables = {};", size_)});
    add("numerics/shells/plugin_run.hpp", {std::string(tested_text("shells/plugin_run"))});
    if (facts_.tangent) {
      add("numerics/shells/plugin_tangent.hpp",
          {std::string(tested_text("shells/plugin_tangent"))});
    }
    add("the list of the variables", list("variable", program_.environment.variables));
    add("the list of the parameters", list("parameter", names_of(program_.environment.parameters)));
    add("the list of the invariants", list("invariant", names_of(program_.facts.invariants)));
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

  // What shows `each` the places of a record, or values: unnamed where nothing is shown.
  static Pattern walk(const std::string& name, const std::string& type, const std::string& object,
                      const std::string& other, const std::string& beside, Pattern body) {
    const bool any = !body.text.empty();
    const auto named = [any](const std::string& a_type, const std::string& a_name) {
      return a_type + (any ? " " + a_name : "") + ", ";
    };
    body.text =
        fmt::format("template <{}class Each> void {}({}{}const Each&{}) {{{}}}",
                    type == "Record&" ? "class Record, " : "", name, named(type, object),
                    other.empty() ? "" : named(other, beside), any ? " each" : "", body.text);
    return body;
  }

  [[nodiscard]] Pattern parameters() const {
    std::string text;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      text += fmt::format("each({}, par.{});", i, parameters_[i]);
    return {text};
  }

  [[nodiscard]] Pattern state() const {
    const auto both = [](const std::string& i, const std::string& field) {
      return fmt::format("each({0}, z.{1}, beside.{1});", i, field);
    };
    if (arrays_)
      return {"for (int i = 0; i < n; ++i) {" + both("i", "q[i]") + both("n + i", "p[i]") + "}"};
    std::string text;
    for (int i = 0; i < size_; ++i)
      text += both(std::to_string(i), state_[static_cast<std::size_t>(i)]);
    return {text};
  }

  static std::string values(const std::string& array, int count, int first,
                            const std::string& call) {
    if (count == 0) return {};
    return fmt::format("Real {0}[{1}]; {2} for (int i = 0; i < {1}; ++i) each({3}, {0}[i]);", array,
                       count, call, first == 0 ? "i" : fmt::format("{} + i", first));
  }

  // The invariants of the model, and behind them the modified energies.
  [[nodiscard]] Pattern invariants() const {
    Pattern pattern{values("result", invariants_, 0, "invariants(par, z, result);") +
                    values("modified", modified_, invariants_,
                           fmt::format("modified_energies(par, {}, z, modified);", kConstant))};
    if (modified_ > 0) pattern.constants.push_back(facts_.watched_step);
    return pattern;
  }

  [[nodiscard]] Pattern gradient() const {
    return {values("result", size_, 0, "gradient(par, z, result);")};
  }

  // Elements of an array that follow each other are one entry.
  [[nodiscard]] static Pattern list(const std::string& of, const QuantityList& all) {
    std::string text = fmt::format("const hamgen_quantity {}_list[] = {{", of);
    for (const QuantityList::Run& run : all.runs())
      text += fmt::format("{{{}, {}, {}, {}, {}, {}}},", cpp_string(run.of.name),
                          cpp_string(run.of.unit), cpp_string(run.of.comment), run.indexed ? 1 : 0,
                          run.first, run.count);
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
        size_ / 2, parameters_.size(), invariants_ + modified_, facts_.precision.bits,
        cpp_string(fmt::format("{}, {}", program_.facts.system, program_.facts.scheme)),
        cpp_string(program_.facts.solver), facts_.tangent ? "tangent_of" : "nullptr")};
  }

  const InterfaceFacts& facts_;
  const Program& program_;
  bool arrays_;
  std::vector<std::string> parameters_, state_;  // places in their records
  int size_;                                     // 2n
  int modified_, invariants_;                    // how many there are
  std::vector<InterfacePiece> pieces_;
};

}  // namespace

std::vector<InterfacePiece> plugin_interface(const InterfaceFacts& facts) {
  return InterfaceText(facts).pieces();
}

}  // namespace hamgen
