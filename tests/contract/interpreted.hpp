// The contract of interpreted steps: no compiler is asked.
#pragma once

#include <memory>
#include <string>

#include "tests/contract/case.hpp"

namespace hamgen::contract {

// A model made ready for many methods.
class Interpretable {
 public:
  explicit Interpretable(SourceText model);
  ~Interpretable();
  [[nodiscard]] const Model& model() const;

  // Runs of interpreted steps in double, float or long double against interpreted quad steps, for
  // the method, solver and scalar of one request.  Throws UsageError where the model has no such
  // method.
  [[nodiscard]] std::vector<Defects> measure(const Request& request,
                                             const std::vector<Case>& cases) const;
  [[nodiscard]] Defects measure(const Case& c) const { return measure(c.request, {c}).front(); }

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace hamgen::contract
