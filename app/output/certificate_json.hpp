// A certificate as JSON: what scripts/check-certificate reads.
#pragma once

#include <map>
#include <string>

#include "generator/verify/certificate.hpp"

namespace hamgen::app {

// With the digests of the model's and the header's texts, and the header's name.
[[nodiscard]] std::string certificate_json(const ProofCertificate& certificate,
                                           const std::map<std::string, long>& sizes,
                                           const std::string& model, const std::string& header_name,
                                           const std::string& header);

}  // namespace hamgen::app
