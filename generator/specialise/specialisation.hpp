// What a scene does not need is left out of its integrator: parameters whose values make terms
// vanish, and degrees of freedom that rest.
//
// Each stage here is a pure function: `fold` of the Model, before derivatives are taken, so that
// sums that stay loops have no path of their own; `resting` and `restrict_to` of the Mechanics and
// of the Scheme.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/specialise/linear_change.hpp"
#include "generator/specialise/scene_facts.hpp"

namespace hamgen {

// A parameter whose value is part of the code.
struct FoldedParameter {
  std::string name;  // "m[2]"
  Rational value;
  bool operator==(const FoldedParameter&) const = default;
};

// What has been left out of a model, and why.
struct Folding {
  std::vector<FoldedParameter> values;
  std::vector<std::pair<std::string, std::string>> same;  // a name, and the one it is now
  std::vector<std::string> left_out;                      // one line each
};

struct FoldedModel {
  Model model;
  Folding folding;
};

// The model with its structural values put in.  Of the parameters that are not kept
//   0, 1 and -1 are put in, so are integers and halves of odd numbers that stand in an exponent;
//   an array of equal entries becomes one number;
//   one that equals another becomes that one where their difference stands in H.
// All others stay what they are.  `burnt` are parameters to be put in whatever they are.
[[nodiscard]] FoldedModel fold(const Model& model, const SceneFacts& scene,
                               const std::vector<std::string>& burnt = {});

// The pairs (q_i, p_i) that start at zero and stay there, by the number of their degree of freedom:
// the largest set D such that H_q and H_p of its members vanish identically where all its variables
// are zero, and that the step respects:
//
// Note [the restricted step]
// Let W be the states whose variables in D are zero.  If J grad H maps W into itself, so does every
// stage of a Runge-Kutta method, and so do kicks and drifts, for H_q(q, p) = V'(q) and
// H_p(q, p) = T'(p) vanish one by one.  The rows of a member's
//   zbar = z + h (I/2 + C) J grad H(zbar)
// in D are zbar_d = 0 + h sum over k outside D of C_dk (J grad H)_k, which vanish if C maps W into
// itself, C_dk = 0; then Z is in W with zbar.  What is left are the equations of the member with
// the block of C outside D, for H on W.  W is symplectic, being made of pairs, so that this block
// is in sp(2m) if C is in sp(2n).  A member of higher order takes K in place of H, whose terms are
// made of derivatives of J grad H along itself and C, and a composition is made of members.
//
// Empty if everything rests.  Where H or a derivative has a corner or a pole on W nothing is said.
[[nodiscard]] std::vector<int> resting(const Mechanics& mechanics, const Scheme& scheme,
                                       const SceneFacts& scene);

// The model that computes what the scene observes: its invariants are those that are named and the
// formulas of the scene; all of them if it does not say.
[[nodiscard]] Model observed(Model model, const SceneValues& scene);

// Pairs of which nothing observed knows, by their number.
struct Unobserved {
  std::vector<int> dropped;  // nothing observed depends on either
  std::vector<int> cyclic;   // q_i does not occur, p_i is a constant
  bool operator==(const Unobserved&) const = default;
};
// A variable z_i is needed if it is observed, or stands in the component of J grad H that moves one
// that is, or in a component that its stage value takes a multiple of by C.  A p_i whose q_i is not
// needed is a constant if H_{q_i} = 0 and row p_i of C takes nothing that moves: pbar_i = p_i.
// Where sums stay loops arrays are left out as a whole, and a momentum that is a constant stays: a
// loop over momenta that are parameters would be another one.  Nothing is left out where
// `observed`, names of variables and "energy", is empty.
[[nodiscard]] Unobserved unobserved(const Mechanics& mechanics, const Scheme& scheme,
                                    const std::set<std::string>& observed);
[[nodiscard]] std::vector<std::string> to_text(const Unobserved& left, const Mechanics& mechanics);

// The system, or the scheme, of the kept degrees of freedom, in their order.  The variables of the
// others are zero, but momenta of the `cyclic` ones are parameters.  Terms of H in what is not
// observed are gone: its gradient is right, its value is another.
[[nodiscard]] Mechanics restrict_to(const Mechanics& mechanics, const std::vector<int>& kept,
                                    const Unobserved& left = {});
[[nodiscard]] Scheme restrict_to(const Scheme& scheme, const std::vector<int>& kept);
// H in the variables of the whole system in those of the restricted one, without the terms of what
// is not observed.
[[nodiscard]] Expression restrict_to(const Expression& e, const Mechanics& whole,
                                     const std::vector<int>& kept, const Unobserved& left);

// A system and its scheme as a scene needs them.
struct Specialised {
  Mechanics given;  // all degrees of freedom, as the model has them
  Scheme given_scheme;
  std::vector<LinearChange> changes;  // of variables, one after the other
  Mechanics whole;                    // after these
  Scheme whole_scheme;
  Mechanics mechanics;
  Scheme scheme;
  // Degrees of freedom of `whole`.
  std::vector<int> kept, resting;
  Unobserved left;
  std::vector<std::string> left_out;  // one line each
};
// All of them without a scene.  `model` is that of `whole`.
enum class Variables { changed, as_they_are };
[[nodiscard]] Specialised specialise(const Model& model, Mechanics whole, Scheme scheme,
                                     const std::optional<SceneFacts>& scene,
                                     Variables variables = Variables::changed);

// How the model's variables are those of the step, and the other way round.
struct StateMap {
  struct Sum {
    bool known = true;                      // else nothing observed depends on it
    std::map<int, Rational> of = {};        // variables of the step
    std::map<int, Rational> at_start = {};  // variables of the model, where the scene begins
  };
  std::vector<Sum> model;  // 2n
  std::vector<Sum> step;   // 2m, where the scene begins
  std::vector<std::string> step_names;
  std::map<std::string, Sum> constants;  // momenta that are parameters of the step
};
[[nodiscard]] StateMap state_map(const Specialised& system);

// "z, pz: they start at 0 and nothing moves them", one line for arrays that rest as a whole.
[[nodiscard]] std::string to_text(const std::vector<int>& resting, const Mechanics& mechanics);

}  // namespace hamgen
