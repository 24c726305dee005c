// The numbers a run starts from, in the order the plugin takes them.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "generator/algebra/scalar.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"
#include "runtime/library.hpp"

namespace hamgen::app {

// The scene's values with the user's changes, of a run that has an initial state, h and steps.
// Throws UsageError with an example if something is missing;
// `length` says how this command is told how long a run is.
[[nodiscard]] SceneValues complete_scene(const Model& model, const SceneRequest& request,
                                         const char* length = "--steps 1000");

// Throws UsageError, naming it, if one of the scene's values has no number of the scalar: a step
// size that becomes 0 would run, and go nowhere.
void require_in_range(const Model& model, const SceneValues& scene, const ScalarType& scalar);

// A locally exact gauge is taken at the run's own initial state and parameters, where the user has
// not said otherwise: what differs from the origin and the model's defaults is added to the
// request's reference; of the state, if it names no coordinate and no momentum.
void take_gauge_at(const SceneValues& scene, const Model& model, Request& request);

// The values of the plugin's parameters are looked up by name; E0 = H(q0, p0), if the method needs
// it, is computed by the plugin.  Throws
// UsageError if the run would change a folded parameter, its step is at a pole of the scheme or a
// value is outside the range of its scalar, and ModelError naming the component if H or its
// gradient is not defined at the initial state.
[[nodiscard]] runtime::InitialValues initial_values(const PluginSource& plugin,
                                                    const SceneValues& scene,
                                                    const runtime::Library& library);

// The same where H need not be defined, with E0 still 0: no ModelError.
[[nodiscard]] runtime::InitialValues values_in_order(const PluginSource& plugin,
                                                     const SceneValues& scene,
                                                     const runtime::Library& library);

// All parameters of the run that are not folded, those too that only its initial values depend on,
// and E0 if the step needs it.
[[nodiscard]] std::vector<std::pair<std::string, double>> parameter_values(
    const PluginSource& plugin, const SceneValues& scene, const runtime::InitialValues& start);

// Is H computed along the run?  Not where the scene names what it observes and energy is not among
// it, nor where the step lacks degrees of freedom that H depends on.
[[nodiscard]] bool watches_energy(const PluginSource& plugin, const SceneValues& scene);

// The state of all degrees of freedom, where the step has some of them: those left out rest.  What
// nobody observes is not a number.
[[nodiscard]] std::vector<runtime::Wide> whole_state(const PluginSource& plugin,
                                                     const SceneValues& scene,
                                                     const std::vector<runtime::Wide>& state);
// What of a sum does not depend on the step.
[[nodiscard]] Rational value_at_start(const StateMap::Sum& sum, const SceneValues& scene);
// Of a state of all degrees of freedom what is known of it from the step.
[[nodiscard]] std::vector<runtime::Wide> known_state(const PluginSource& plugin,
                                                     const std::vector<runtime::Wide>& whole);
// Of a state of all degrees of freedom what the step has, in its variables.
[[nodiscard]] std::vector<runtime::Wide> kept_state(const PluginSource& plugin,
                                                    const std::vector<runtime::Wide>& whole);

// The value as hi + lo: 106 bits.
[[nodiscard]] runtime::Wide wide(const Rational& value);
// The upper halves.
[[nodiscard]] std::vector<double> rounded(const std::vector<runtime::Wide>& values);

}  // namespace hamgen::app
