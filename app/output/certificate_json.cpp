#include "app/output/certificate_json.hpp"

#include <nlohmann/json.hpp>

#include "runtime/sha256.hpp"

namespace hamgen::app {

namespace {

using CertificateJson = nlohmann::ordered_json;

CertificateJson json_of(const std::vector<CertificateAtom>& atoms) {
  auto list = CertificateJson::array();
  for (const CertificateAtom& atom : atoms) {
    auto derivatives = CertificateJson::object();
    for (const auto& [variable, value] : atom.derivatives) derivatives[variable] = value;
    list.push_back({{"name", atom.name},
                    {"function", atom.function},
                    {"degree", atom.degree},
                    {"argument", atom.argument},
                    {"derivatives", derivatives}});
  }
  return list;
}

}  // namespace

std::string certificate_json(const ProofCertificate& certificate,
                             const std::map<std::string, long>& sizes, const std::string& model,
                             const std::string& header_name, const std::string& header) {
  auto hessian = CertificateJson::array();
  for (const auto& [place, value] : certificate.hessian)
    hessian.push_back({{"row", place.first}, {"column", place.second}, {"value", value}});
  auto invariants = CertificateJson::array();
  for (const CertificateInvariant& invariant : certificate.invariants) {
    invariants.push_back(
        {{"name", invariant.name}, {"value", invariant.value}, {"bracket", invariant.bracket}});
  }
  auto size_values = CertificateJson::object();
  for (const auto& [name, value] : sizes) size_values[name] = value;
  const CertificateJson document = {
      {"format", "hamgen certificate 1"},
      {"model",
       {{"name", certificate.name},
        {"sha256", runtime::sha256_hex(model)},
        {"sizes", size_values},
        {"coordinates", certificate.coordinates},
        {"momenta", certificate.momenta},
        {"parameters", certificate.parameters}}},
      {"atoms", json_of(certificate.atoms)},
      {"H", certificate.hamiltonian},
      {"gradient", certificate.gradient},
      {"hessian", hessian},
      {"scheme",
       {{"name", certificate.scheme},
        {"C", certificate.c},
        {"symmetric", certificate.symmetric},
        {"order", certificate.order}}},
      {"invariants", invariants},
      {"emitted", {{"file", header_name}, {"sha256", runtime::sha256_hex(header)}}}};
  return document.dump(1) + "\n";
}

}  // namespace hamgen::app
