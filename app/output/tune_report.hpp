// What `hamgen tune` says of the gauges it compared.
#pragma once

#include <string>

#include "app/studies/tune.hpp"

namespace hamgen::app {

[[nodiscard]] std::string tune_text(const TuneReport& report);
[[nodiscard]] std::string tune_json(const TuneReport& report);
// One or two sentences on whether it is worth while.
[[nodiscard]] std::string verdict_of(const TuneReport& report);

}  // namespace hamgen::app
