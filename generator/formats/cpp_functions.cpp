#include "generator/formats/cpp_functions.hpp"

#include <fmt/format.h>

namespace hamgen {

namespace {

constexpr const char* kParameters = "[[maybe_unused]] const Parameters& par";
constexpr const char* kState = "[[maybe_unused]] const State& z";
constexpr const char* kArguments =
    "[[maybe_unused]] const Parameters& par, [[maybe_unused]] const State& z";

}  // namespace

void write_results(CodeWriter& out, const CppExpression& cpp, const Evaluation& evaluation) {
  for (std::size_t i = 0; i < evaluation.results.size(); ++i) {
    out.line(fmt::format("values[{}] = {};", i, cpp(evaluation.results[i])));
  }
}

void write_evaluation(CodeWriter& out, CppContext& context, const std::string& signature,
                      const Evaluation& evaluation,
                      const std::function<void(CodeWriter&, const CppExpression&)>& finish,
                      CppContext::StateForm form, const CoefficientText& coefficients) {
  Names names;
  names.reserve("values");
  for (const auto& [symbol, text] : coefficients) names.set(symbol, text);
  const CppExpression cpp = context.expression(names);
  std::set<std::string> used = used_symbols(evaluation.statements);
  for (const Expression& e : evaluation.results) collect_symbols(e, used);
  out.open(signature);
  context.load_state(out, names, used, form);
  write_statements(out, cpp, names, evaluation.statements);
  finish(out, cpp);
  out.close();
  out.line();
  context.note(cpp);
}

void write_functions(CodeWriter& out, CppContext& context) {
  const Program& program = context.program;
  out.line(context.mechanics.has_time
               ? "// H(q, p, t) + p_t, which is constant where H(q, p, t) is not."
               : "// H(q, p).");
  write_evaluation(out, context, "inline Real energy(" + std::string(kArguments) + ")",
                   program.energy, [&](CodeWriter& w, const CppExpression& cpp) {
                     w.line("return " + cpp(program.energy.results[0]) + ";");
                   });
  write_invariants(out, context);
  write_modified_energies(out, context);
  if (!context.options.gradient) return;
  out.line("// grad H, the derivatives by q first.");
  write_evaluation(
      out, context,
      fmt::format("inline void gradient({}, Real (&values)[{}])", kArguments, 2 * context.n()),
      program.gradient,
      [&](CodeWriter& w, const CppExpression& cpp) { write_results(w, cpp, program.gradient); });
}

void write_invariants(CodeWriter& out, CppContext& context) {
  const auto& invariants = context.mechanics.invariants;
  if (invariants.empty()) return;
  std::string list;
  for (const NamedExpression& i : invariants) list += (list.empty() ? "" : ", ") + i.name;
  out.remark("// The model's invariants: ", list + ".");
  write_evaluation(
      out, context,
      fmt::format("inline void invariants({}, Real (&values)[{}])", kArguments, invariants.size()),
      context.program.invariants, [&](CodeWriter& w, const CppExpression& cpp) {
        write_results(w, cpp, context.program.invariants);
      });
}

void write_modified_energies(CodeWriter& out, CppContext& context) {
  const std::vector<int>& powers = context.program.modified_powers;
  if (powers.empty()) return;
  std::string list;
  for (const int power : powers) list += fmt::format("{}h^{}", list.empty() ? "" : ", ", power);
  out.lines(
      fmt::format("// The modified Hamiltonian H + h^{} (...) + ..., which steps of size h "
                  "conserve as a formal\n// series, cut off after {}.\n",
                  powers.front(), list));
  write_evaluation(out, context,
                   fmt::format("inline void modified_energies({}, [[maybe_unused]] Real h, {}, "
                               "Real (&values)[{}])",
                               kParameters, kState, powers.size()),
                   context.program.modified_energies, [&](CodeWriter& w, const CppExpression& cpp) {
                     write_results(w, cpp, context.program.modified_energies);
                   });
  out.line(fmt::format("// Cut off after h^{}.", powers.back()));
  out.open("inline Real modified_energy(const Parameters& par, Real h, const State& z)");
  out.line(fmt::format("Real values[{}];", powers.size()));
  out.line("modified_energies(par, h, z, values);");
  out.line(fmt::format("return values[{}];", powers.size() - 1));
  out.close();
  out.line();
}

}  // namespace hamgen
