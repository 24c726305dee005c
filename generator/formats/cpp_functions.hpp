// The functions of the state alone in an emitted file.
#pragma once

#include <functional>

#include "generator/formats/cpp_context.hpp"
#include "generator/formats/cpp_member.hpp"

namespace hamgen {

// energy(par, z), and gradient(par, z, values) if the options ask for it.
void write_functions(CodeWriter& out, CppContext& context);
// invariants(par, z, values), if the model has any.
void write_invariants(CodeWriter& out, CppContext& context);
// modified_energies(par, h, z, values) and modified_energy(par, h, z), if the program has them.
void write_modified_energies(CodeWriter& out, CppContext& context);

// values[i] = result i.
void write_results(CodeWriter& out, const CppExpression& cpp, const Evaluation& evaluation);

// A function with this signature: the evaluation's statements, then what `finish` makes of the
// results.
void write_evaluation(CodeWriter& out, CppContext& context, const std::string& signature,
                      const Evaluation& evaluation,
                      const std::function<void(CodeWriter&, const CppExpression&)>& finish,
                      CppContext::StateForm form = CppContext::StateForm::fields,
                      const CoefficientText& coefficients = {});

}  // namespace hamgen
