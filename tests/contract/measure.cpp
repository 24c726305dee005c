#include "tests/contract/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "generator/algebra/exact.hpp"
#include "generator/base/source_text.hpp"
#include "generator/formats/scalar.hpp"
#include "generator/language/scene.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"
#include "tests/contract/models.hpp"

namespace hamgen::contract {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// A plugin's text without the interface to the runtime.  Its members are looked at.
std::string inside(const Case& c, const std::string& name_space, const std::string& scalar) {
  Request request = c.request;
  request.scalar = scalar;
  request.name_space = name_space;
  // A slow fixed point has not the iterations for the digits of quad; Newton has.
  if (scalar == "quad" && request.solver == "fixed-point") request.solver = "";
  std::string text = generate_plugin(c.model, request).text;
  text.erase(text.find("// The interface of plugin.h."));
  replace_all(text, "#include \"plugin.h\"\n", "");
  replace_all(text, " private:\n", " public:\n");
  return text;
}

// The names that step_defect.hpp wants.
std::string adapter(const std::string& name, const std::string& name_space,
                    const ScalarType& scalar) {
  return fmt::format(R"(struct {0} {{
  using Real = {1}::Real;
  using State = {1}::State;
  using Parameters = {1}::Parameters;
  using Propagator = {1}::Propagator;
  static constexpr Real epsilon = {2};
  static void gradient(const Parameters& par, const State& z, Real* g) {{
    constexpr int size = sizeof(State) / sizeof(Real);
    Real values[size];
    {1}::gradient(par, z, values);
    for (int i = 0; i < size; ++i) g[i] = values[i];
  }}
}};
)",
                     name, name_space, scalar.cpp == "__float128" ? "0" : scalar.epsilon);
}

std::string list(const std::vector<Rational>& values) {
  std::string text;
  for (const Rational& value : values) text += fmt::format("{:a}, ", to_double(value));
  return text;
}

// "3/10" as what Quad(...) makes a quotient in quad of.
std::string quotient(const std::string& value) {
  const auto slash = value.find('/');
  if (slash == std::string::npos) return value;
  return value.substr(0, slash) + ") / contract::Quad(" + value.substr(slash + 1);
}

// The scene's values, rounded: both codes start from the same numbers, with the same parameters.
std::string call(const Case& c, std::size_t i, bool runge_kutta) {
  const Model model = read_request(c.model, c.request);
  const SceneValues scene = scene_values(model, {.scene = c.scene});
  const std::vector<std::string> names = element_names(model.parameters);
  std::vector<Rational> parameters;
  for (const std::string& name : generate_plugin(c.model, c.request).parameter_names) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw std::runtime_error("a parameter of no value: " + name);
    parameters.push_back(scene.parameters[static_cast<std::size_t>(found - names.begin())]);
  }
  const std::string equations =
      runge_kutta ? fmt::format(
                        "contract::runge_kutta(case_{0}_exact::prepare("
                        "case_{0}_exact::Parameters(), 1))",
                        i)
                  : fmt::format(
                        "contract::member({}, contract::Quad({}), contract::Quad({}), "
                        "contract::Quad({}))",
                        scene.q.size(), quotient(c.alpha), quotient(c.beta), quotient(c.gamma));
  std::vector<Rational> state = scene.q;
  state.insert(state.end(), scene.p.begin(), scene.p.end());
  return fmt::format(R"(  {{
    using Code = Measured_{0};
    const contract::Vector state{{{2}}};
    const contract::Vector par{{{3}}};
    contract::print("{1}", contract::run<Code, Exact_{0}>(
        contract::state_of<Code::Real, Code::Parameters>(par), {4}, Code::Real({5:a}),
        contract::state_of<Code::Real, Code::State>(state), {6}));
  }}
)",
                     i, c.name, list(state), list(parameters), equations,
                     to_double(scene.h.value()), c.steps > 0 ? c.steps : scene.steps.value());
}

runtime::ProcessResult run(std::vector<std::string> command) {
  return runtime::run_process({.command = std::move(command),
                               .time_limit = std::chrono::minutes(20),
                               .output_limit = 1 << 22});
}

}  // namespace

std::string program(const std::vector<Case>& cases,
                    const std::function<std::string(std::string)>& edit) {
  std::string text;
  std::string calls;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const ScalarType& scalar = find_scalar(cases[i].request.scalar);
    const std::string measured = fmt::format("case_{}_measured", i);
    const std::string exact = fmt::format("case_{}_exact", i);
    std::string code = inside(cases[i], measured, std::string(scalar.name));
    if (edit) code = edit(std::move(code));
    const std::string quad = inside(cases[i], exact, "quad");
    const bool runge_kutta = code.find("k.coupling[") != std::string::npos;
    text += code + quad + adapter(fmt::format("Measured_{}", i), measured, scalar) +
            adapter(fmt::format("Exact_{}", i), exact, find_scalar("quad"));
    calls += call(cases[i], i, runge_kutta);
  }
  return fmt::format("#include \"{}/tests/contract/step_defect.hpp\"\n", HAMGEN_SOURCE_DIR) + text +
         "int main() {\n" + calls + "}\n";
}

std::vector<Defects> read_defects(const std::string& output) {
  std::vector<Defects> all;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    Defects d;
    std::getline(in, d.name, '\t');
    int failed = 0;
    std::string worst, units, reference;
    in >> d.steps >> d.solves >> d.iterations >> worst >> d.worst_step >> units >> reference >>
        failed >> d.broken >> d.unknown;
    if (!in) throw std::runtime_error("not understood: " + line);
    d.worst = std::stod(worst);
    d.units = std::stod(units);
    d.reference = std::stod(reference);
    d.failed = failed != 0;
    all.push_back(d);
  }
  return all;
}

std::vector<Defects> measure(const std::vector<Case>& cases,
                             const std::function<std::string(std::string)>& edit) {
  const runtime::TemporaryDirectory directory = runtime::private_directory();
  const std::string source = (directory.path() / "contract.cpp").string();
  const std::string executable = (directory.path() / "contract").string();
  std::ofstream(source) << program(cases, edit);
  // -O1 as the emitted code is compiled, but for speed: no value-changing flag.
  const runtime::ProcessResult compiled =
      run({"g++", "-std=gnu++20", "-O1", "-ffp-contract=off", "-fno-math-errno", "-w", "-isystem",
           "/usr/include/eigen3", source, "-o", executable, "-lquadmath"});
  if (!compiled.succeeded()) throw std::runtime_error("does not compile:\n" + compiled.output);
  const runtime::ProcessResult ran = run({executable});
  if (!ran.succeeded()) throw std::runtime_error("does not run:\n" + ran.output);
  std::vector<Defects> found = read_defects(ran.output);
  if (found.size() != cases.size()) throw std::runtime_error("not all ran:\n" + ran.output);
  return found;
}

SourceText model(const std::string& name) {
  for (const SteepModel& steep : kSteepModels) {
    if (name == steep.name) {
      return make_source(name + ".ham", "system " + name + "\n" + steep.text);
    }
  }
  return read_source(std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/" + name + ".ham");
}

}  // namespace hamgen::contract
