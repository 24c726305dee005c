#include "app/output/certify_output.hpp"

#include <fmt/format.h>

#include "app/output/plain_number.hpp"

namespace hamgen::app {
namespace {

std::string map_of(const Certificate& certificate) {
  return certificate.symplectic
             ? "an exactly symplectic map"
             : fmt::format("the exact map of {}, which is not symplectic", certificate.method);
}

// Two digits, and no fewer units than there are.
std::string units_text(double units) {
  const std::string text = units < 0.01 ? "0.01" : terminal_number(units * 1.05, 2);
  return text + (text == "1" ? " unit" : " units");
}

}  // namespace

std::string certificate_sample(const Certificate& certificate) {
  const long looked_at = certificate.certified + certificate.failed;
  if (certificate.every == 1 || looked_at < 2)
    return fmt::format("{} of {} steps", looked_at, certificate.steps);
  return fmt::format("steps 1, {}, {}... of {}", 1 + certificate.every,
                     looked_at > 2 ? fmt::format("{}, ", 1 + 2 * certificate.every) : "",
                     certificate.steps);
}

std::string certificate_sentence(const Certificate& certificate) {
  if (certificate.failed > 0)
    return fmt::format("of {} steps looked at {} could not be certified, the first is step {}: {}",
                       certificate.certified + certificate.failed, certificate.failed,
                       certificate.first_failed, certificate.failure);
  if (certificate.certified == 0) return "no step was looked at";
  return fmt::format("each of {} steps{} lies within {} of rounding of {}", certificate.certified,
                     certificate.certified < certificate.steps ? " looked at" : "",
                     units_text(certificate.units), map_of(certificate));
}

std::string certificate_text(const Certificate& certificate) {
  std::string text = fmt::format("  certified   {}\n", certificate_sentence(certificate));
  text += fmt::format("  looked at   {}\n", certificate_sample(certificate));
  if (certificate.certified > 0) {
    text +=
        fmt::format("  farthest    step {}: {:.3g} units of {:.3g} in {}\n", certificate.worst_step,
                    certificate.units, certificate.epsilon, certificate.worst_component);
    if (certificate.solves)
      text += fmt::format(
          "  unique      no other solution of a step's equations within {:.2g} of its size\n",
          certificate.radius);
  }
  if (!certificate.ended.empty())
    text += fmt::format("  ended       {} after {} steps\n", certificate.ended, certificate.steps);
  return text;
}

nlohmann::ordered_json certificate_json(const Certificate& certificate) {
  using Json = nlohmann::ordered_json;
  const bool any = certificate.certified > 0;
  return {
      {"sentence", certificate_sentence(certificate)},
      {"method", certificate.method},
      {"symplectic", certificate.symplectic},
      {"holds", certificate.holds()},
      {"steps", certificate.steps},
      {"every", certificate.every},
      {"certified", certificate.certified},
      {"failed", certificate.failed},
      {"units", any ? Json(certificate.units) : Json(nullptr)},
      {"epsilon", certificate.epsilon},
      {"worst_step", any ? Json(certificate.worst_step) : Json(nullptr)},
      {"worst_component", any ? Json(certificate.worst_component) : Json(nullptr)},
      {"uniqueness_radius", any && certificate.solves ? Json(certificate.radius) : Json(nullptr)},
      {"first_failed", certificate.failed > 0 ? Json(certificate.first_failed) : Json(nullptr)},
      {"failure", certificate.failed > 0 ? Json(certificate.failure) : Json(nullptr)},
      {"ended", certificate.ended.empty() ? Json("done") : Json(certificate.ended)}};
}

}  // namespace hamgen::app
