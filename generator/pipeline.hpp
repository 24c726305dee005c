// The whole of hamgen in one function: a Hamiltonian's text in, files out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/base/source_text.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/language/model.hpp"
#include "generator/language/scene.hpp"
#include "generator/program/program.hpp"
#include "generator/readback/read_back.hpp"
#include "generator/request.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/specialise/specialisation.hpp"
#include "generator/verify/certificate.hpp"
#include "generator/verify/corners.hpp"
#include "generator/verify/linear_stability.hpp"
#include "generator/verify/required.hpp"

namespace hamgen {

// The model with what the request changes of it: sizes, folded parameters, and alpha, beta, gamma
// as run-time parameters where the request uses them by name.
[[nodiscard]] Model read_request(const SourceText& source, const Request& request);

// Throws ProofError if something required does not hold.
[[nodiscard]] OutputFiles generate(const SourceText& source, const Request& request);

// The same but for the lines that say what is proved: nothing is, and nothing that is required is
// looked at.
[[nodiscard]] OutputFiles emit(const SourceText& source, const Request& request);

// The value of one stage as text: "model", "mechanics", "equations", "plan", "program",
// "origins": the program with what each of its lines is there for.
[[nodiscard]] std::string show_stage(const SourceText& source, const Request& request,
                                     const std::string& stage);

// Goes through all stages and writes nothing: throws what they throw.
void check_step(const SourceText& source, const Request& request);

// What algebra can say of the step: one finding a property.  What it leaves open is tried around
// the model's scenes, and around `scene`, of a run that changes one.
//
// The emitted code is a C++ header, read back: one that is there, or else the one that `generate`
// would write.
struct EmittedHeader {
  std::string path;  // as the user named it
  std::string text;
  std::map<std::string, std::string> beside = {};  // texts it may include, by their names
};
[[nodiscard]] Proof verify_step(const SourceText& source, const Request& request,
                                const std::optional<SceneValues>& scene = {},
                                const std::optional<EmittedHeader>& header = {});
// The reading alone, without any proof.
[[nodiscard]] ReadBack read_emitted(const SourceText& source, const Request& request,
                                    const std::optional<EmittedHeader>& header = {});

// What another program can check of a proof: of the whole system, by what `proof` says of it.
// Throws UsageError where there is none.
[[nodiscard]] ProofCertificate certificate_of(const SourceText& source, const Request& request,
                                              const Proof& proof);

// Where H is defined but has no derivatives: a step across it is not what is proved of the step.
[[nodiscard]] std::vector<Corner> corners_of_hamiltonian(const SourceText& source,
                                                         const Request& request);

// A point at which H has a value though its text in the file has none, because something cancels in
// it: (q^(1/3))^3.  Empty if none was met.
[[nodiscard]] std::string point_beyond_text(const SourceText& source, const Request& request);

// H_0, H_1, ... of the Hamiltonian sum of h^j H_j whose flow the step follows: `count` of them that
// do not vanish for reasons of symmetry.  Throws UsageError for a scheme that is no member.
[[nodiscard]] std::vector<Expression> modified_hamiltonian(const SourceText& source,
                                                           const Request& request, int count);

// The linear part of H at the scene's initial state, and at the origin where that is an
// equilibrium, and what a step of the scene's h makes of it.
[[nodiscard]] std::vector<LinearPoint> linear_points(const SourceText& source,
                                                     const Request& request,
                                                     const SceneValues& scene);

// The method that the request means for the model's system.
[[nodiscard]] Scheme request_scheme(const SourceText& source, const Request& request);

// The step as records and routines: what the formats print and the interpreter runs.
[[nodiscard]] Program make_program(const SourceText& source, const Request& request);

// What a run needs to know of an emitted plugin, without reading its text.
struct PluginSource {
  Model model;
  std::string text;                   // one translation unit, self-contained
  OutputFile header;                  // the same mathematics as a header for the user, if asked for
  std::string scheme_name;            // "implicit-midpoint", "alpha = 3/10, ..."
  int order = 1;                      // of the method
  std::string solver;                 // "Newton of size 1, ..." one line
  bool is_swept = false;              // a number of sweeps stands in for the solution
  std::vector<std::string> left_out;  // what the planner left out and why
  std::size_t left_out_for_scene = 0;        // the first so many of them: the scene needs less
  std::vector<std::string> parameter_names;  // run-time parameters in interface order
  std::vector<std::string> invariant_names;
  StateMap state;
  std::vector<std::pair<std::string, std::string>> same;  // parameters that others stand for
  bool whole_energy = true;  // else that of the degrees of freedom that are kept
  bool for_scene = false;    // some of the model's parameters may have the scene's values
  bool needs_energy_parameter = false;  // the last parameter is E0
  std::string without_tangent;          // why --tangent was not heeded
  std::vector<double> singular_steps;   // the scheme has poles at their multiples
  bool in_loops = false;                // over degrees of freedom
  bool needs_eigen = false;
  bool needs_quadmath = false;
  double operations_per_step = 0;  // about: additions and multiplications, others for some of these
  bool has_stages = false;         // is the method an implicit one of Runge and Kutta?
};
// The header as generate() emits it, with what is proved in its first lines, or without, or none: a
// proof can take longer than all else, and the header as long as the plugin.
enum class HeaderText { none, without_proof, with_proof };
[[nodiscard]] PluginSource generate_plugin(const SourceText& source, const Request& request,
                                           HeaderText header = HeaderText::none);

}  // namespace hamgen
