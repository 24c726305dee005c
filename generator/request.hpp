// What is asked, as values: texts of the user's are read where they come in.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/scalar.hpp"
#include "generator/base/asked.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/language/scene.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "generator/solvers/all_solvers.hpp"
#include "generator/specialise/specialisation.hpp"
#include "generator/verify/required.hpp"

namespace hamgen {

// Elementary functions of a batch: own, the default, or libm.
struct MathWish {
  bool of_library = false;
  [[nodiscard]] static MathWish read(const std::string& name);
};

// Fixed blocks: own of every header, the default, or shared.
struct SupportWish {
  bool shared = false;
  [[nodiscard]] static SupportWish read(const std::string& name);
};

// What the user asks of the generator.
struct Request {
  Asked<SchemeWish> scheme;  // a name of `hamgen list schemes`; empty: the member below
  // Numbers, expressions in h, parameters, E0, or lists; by their own names: run-time parameters.
  Asked<AlphaFormula> alpha;
  Asked<BetaFormula> beta;
  Asked<GammaFormula> gamma;
  int order = 0;           // of a member by its generating function; 0: its own
  Asked<GaugeWish> gauge;  // locally-exact or all of C, instead of alpha, beta, gamma
  // Where locally-exact is exact: state (0 if not given) and parameters (the model's defaults).
  std::vector<std::pair<std::string, std::string>> reference;
  // Further names that alpha, beta, gamma may use: run-time parameters, 0 by default.
  std::vector<std::string> scheme_parameters;
  bool observe_curvature = false;     // invariants are energy_curvature instead of the model's
  SolverChoice solver;                // newton, fixed-point, sweeps:K
  Asked<ScalarWish> scalar;           // float, double, long-double, quad
  Asked<FormatWish> format;           // cpp-header, cpp-plugin, cmake-package
  std::string name_space;             // SYSTEM::METHOD of the emitted code, or one for both
  int batch = 0;                      // trajectories that are stepped together; 0: one alone
  Asked<MathWish> math;               // elementary functions of a batch: own (default) or libm
  Asked<SupportWish> support;         // of fixed blocks: own (of every header) or shared
  std::vector<std::string> fold;      // parameters to burn in
  bool tangent = false;               // the linearised step too, where it can be written
  bool events = false;                // the model's events, and a way to find them along the steps
  bool plain_sums = false;            // what rounding takes from the state is not carried along
  Asked<Requirements> require;        // symplectic,symmetric,order:P,conserves:NAME,emitted-code
  std::map<std::string, long> sizes;  // other integer constants than the file's
  // What one of them is where it is a number of a formula, unless it is itself.
  std::map<std::string, long> numbers_of_sizes = {};
  bool in_loops = false;  // sums of H stay loops however few elements there are
  // Terms of the modified Hamiltonian, as many for a symmetric step are even powers of h: emitted
  // as functions of h, which a plugin adds to its invariants at this step.
  int watch_modified = 0;
  Rational step;
  // The scene the integrator is made for: what that does not need is left out.
  std::optional<SceneFacts> scene;
  std::string command;       // as the user typed it, for the header; may be empty
  std::string model_digest;  // SHA-256 of the model's text, for the header; may be empty

  // Is a member named by its parameters?
  [[nodiscard]] bool names_member() const {
    return !alpha.empty() || !beta.empty() || !gamma.empty() || !gauge.empty();
  }
};

}  // namespace hamgen
