// What is certified of a run's steps, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/studies/certify.hpp"

namespace hamgen::app {

// "each of 1000 steps lies within 0.5 units of rounding of an exactly symplectic map", or what
// could not be shown, and where.
[[nodiscard]] std::string certificate_sentence(const Certificate& certificate);
// "steps 1, 101, ... of 100000"
[[nodiscard]] std::string certificate_sample(const Certificate& certificate);

[[nodiscard]] std::string certificate_text(const Certificate& certificate);
[[nodiscard]] nlohmann::ordered_json certificate_json(const Certificate& certificate);

}  // namespace hamgen::app
