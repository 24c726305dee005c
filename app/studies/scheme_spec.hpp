// A method in one word, for options that take several of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

// "implicit-midpoint", "alpha=1/2:beta=-h/400:gamma=-h/12", "gauss-4:solver=fixed-point": a name of
// `hamgen list schemes`, or nothing, and method options without their dashes, joined by colons:
// "implicit-midpoint:order=6".
// Fills these fields of a copy of `base`.  Throws UsageError naming the nearest scheme or option.
[[nodiscard]] Request request_of_spec(std::string_view spec, const Request& base);

// The method of a plugin in words, for a title: "implicit-midpoint", and that sweeps are not it.
[[nodiscard]] std::string method_text(const PluginSource& plugin);

// Is there a scheme of this name, and has this system what it needs?
[[nodiscard]] bool suits(std::string_view name, const Mechanics& mechanics);

// Splits at commas outside of parentheses: the value of --schemes.
[[nodiscard]] std::vector<std::string> split_specs(std::string_view text);

// The methods compared when nobody names any: of each kind and order that suits this system the one
// that is usually best; the last is a baseline that is not symplectic.
[[nodiscard]] std::vector<std::string> default_specs(const Mechanics& mechanics);

}  // namespace hamgen::app
