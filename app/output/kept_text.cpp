#include "app/output/kept_text.hpp"

#include <fmt/format.h>

namespace hamgen::app {

std::string kept_text(double error, double scale) {
  if (!(scale > 0.0)) return fmt::format("{:.1e}", error);
  return fmt::format("{:.1e} of its scale {:.3g}", error / scale, scale);
}

}  // namespace hamgen::app
