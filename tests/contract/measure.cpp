#include "tests/contract/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "generator/algebra/scalar.hpp"
#include "generator/choose_scheme.hpp"
#include "generator/mechanics/derive.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"

namespace hamgen::contract {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// A plugin's text without the interface to the runtime, or a batch's header.  Its members are
// looked at.
std::string inside(const Case& c, const std::string& name_space, const std::string& scalar) {
  Request request = c.request;
  request.scalar = scalar;
  request.name_space = name_space;
  // A slow fixed point has not the iterations for the digits of quad; Newton has.
  if (scalar == "quad" && request.solver == "fixed-point") request.solver = "";
  if (scalar == "quad") request.batch = 0;
  std::string text;
  if (request.batch > 0) {
    text = emit(c.model, request).at(0).text;
  } else {
    text = generate_plugin(c.model, request).text;
    text.erase(text.find("// The interface of plugin.h."));
  }
  replace_all(text, " private:\n", " public:\n");
  return text;
}

// The names that compiled_run.hpp wants.
std::string adapter(const std::string& name, const std::string& name_space,
                    const ScalarType& scalar, int batch) {
  return fmt::format(R"(struct {0} {{
  static constexpr int lanes = {3};
  using Number = {1}::Real;
  using Real = {4};
  using State = {1}::State;
  using Parameters = {1}::Parameters;
  using Propagator = {1}::Propagator;
  static constexpr Real epsilon = {2};
  static void gradient(const Parameters& par, const State& z, Real* g) {{
    constexpr int size = sizeof(State) / sizeof(Number);
    Number values[size];
    {1}::gradient(par, z, values);
    for (int i = 0; i < size; ++i) g[i] = first_number<Real>(values[i]);
  }}
}};
)",
                     name, name_space, scalar.cpp == "__float128" ? "0" : scalar.epsilon,
                     std::max(batch, 1), batch > 0 ? "double" : name_space + "::Real");
}

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{:a}, ", value);
  return text;
}

// In two parts, 106 of the 113 digits.
std::string number(Quad x) {
  const auto high = static_cast<double>(x);
  return fmt::format("Quad({:a}) + Quad({:a})", high, static_cast<double>(x - Quad(high)));
}
std::string list(const Vector& values) {
  std::string text;
  for (const Quad value : values) text += number(value) + ", ";
  return "{" + text + "}";
}
std::string list(const Matrix& rows) {
  std::string text;
  for (const Vector& row : rows) text += list(row) + ", ";
  return "{" + text + "}";
}

// Both codes start from the same numbers, with the same parameters.
std::string call(const Case& c, std::size_t i) {
  const Start start = start_of(c);
  std::vector<double> parameters;
  Request alone = c.request;
  alone.batch = 0;
  for (const std::string& name : generate_plugin(c.model, alone).parameter_names) {
    const auto found =
        std::ranges::find(start.parameters, name, &std::pair<std::string, double>::first);
    if (found == start.parameters.end()) {
      throw std::runtime_error("a parameter of no value: " + name);
    }
    parameters.push_back(found->second);
  }
  const Model model = read_request(c.model, c.request);
  const Mechanics mechanics = derive(model, false);
  const Equations e = equations_of(choose_scheme(model, mechanics, c.request),
                                   mechanics.degrees_of_freedom, start, start.h);
  const std::string equations = e.is_member() ? "member(" + list(e.c) + ")"
                                : e.stages() > 0
                                    ? "runge_kutta(" + list(e.a) + ", " + list(e.b) + ")"
                                    : "Equations()";
  return fmt::format(R"(  {{
    Defects found = run<Measured_{0}, Exact_{0}>(Vector{{{3}}}, {4}, {5:a}, Vector{{{2}}}, {6}, {7});
    print("{1}", found);
  }}
)",
                     i, c.name, list(start.state), list(parameters), equations, start.h,
                     start.steps, has_cancelling_forces(c.model));
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
    const ScalarType& scalar = *cases[i].request.scalar->type;
    const std::string measured = fmt::format("case_{}_measured", i);
    const std::string exact = fmt::format("case_{}_exact", i);
    std::string code = inside(cases[i], measured, std::string(scalar.name));
    if (edit) code = edit(std::move(code));
    const std::string quad = inside(cases[i], exact, "quad");
    text += code + quad +
            adapter(fmt::format("Measured_{}", i), measured, scalar, cases[i].request.batch) +
            adapter(fmt::format("Exact_{}", i), exact, find_scalar("quad"), 0);
    calls += call(cases[i], i);
  }
  return "#include \"tests/contract/compiled_run.hpp\"\nusing namespace hamgen::contract;\n" +
         text + "int main() {\n" + calls + "}\n";
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
      run({"g++", "-std=gnu++20", "-O1", "-ffp-contract=off", "-fno-math-errno", "-w", "-I",
           HAMGEN_SOURCE_DIR, "-isystem", "/usr/include/eigen3", source, "-o", executable,
           "-lquadmath"});
  if (!compiled.succeeded()) throw std::runtime_error("does not compile:\n" + compiled.output);
  const runtime::ProcessResult ran = run({executable});
  if (!ran.succeeded()) throw std::runtime_error("does not run:\n" + ran.output);
  std::vector<Defects> found = read_defects(ran.output);
  if (found.size() != cases.size()) throw std::runtime_error("not all ran:\n" + ran.output);
  return found;
}

}  // namespace hamgen::contract
