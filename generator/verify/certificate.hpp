// What is proved of a step, written so that another program can check it: polynomials over named
// atoms.  scripts/check-certificate reads it, and shares no code with this.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"

namespace hamgen {

// What is no polynomial in variables, parameters and other atoms: the value of a function, or a
// root of a sum, of which a reciprocal is the power -1.
struct CertificateAtom {
  std::string name;                                              // "a1"
  std::string function;                                          // "cos", or "root"
  int degree = 1;                                                // of a root
  std::string argument;                                          // a polynomial
  std::vector<std::pair<std::string, std::string>> derivatives;  // by variables, but for zeros
};

struct CertificateInvariant {
  std::string name;
  std::string value;
  std::vector<std::string> bracket;  // dI/dq_i dH/dp_i - dI/dp_i dH/dq_i: their sum is zero
};

// Polynomials are texts such as "1/2*p^2 - eps*a1"; z = (q, p).
struct ProofCertificate {
  std::string name;  // of the system
  std::vector<std::string> coordinates, momenta, parameters;
  std::vector<CertificateAtom> atoms;
  std::string hamiltonian;
  std::vector<std::string> gradient;
  std::map<std::pair<int, int>, std::string> hessian;  // i <= j, but for zeros
  std::string scheme;
  std::vector<std::vector<std::string>> c;  // of zbar = (z + Z)/2 + C (Z - z)
  bool symmetric = false;                   // C(-h) = -C(h)
  int order = 1;                            // 2 where C(0) = 0
  std::vector<CertificateInvariant> invariants;
};

// Of a member of the family, for a system that is written out.  `invariants` are those that are
// conserved along the flow.  Throws UsageError for what there is no certificate of.
[[nodiscard]] ProofCertificate make_certificate(const Mechanics& mechanics, const Scheme& scheme,
                                                bool symmetric,
                                                const std::vector<NamedExpression>& invariants);

// Throws UsageError for a system that is too large: C has (2n)^2 entries.
void require_certified_size(const Mechanics& mechanics);

}  // namespace hamgen
