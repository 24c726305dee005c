// A member whose derivatives may be ready before its step, Note [derivatives ahead]: with those
// that the routine `derivatives` leaves, the iteration is the same at their point as with those
// that it has evaluated itself.
#include "generator/verify/claim_list.hpp"

namespace hamgen {

namespace {

SymbolicMachine prepared(const StepUnderProof& step) {
  SymbolicMachine machine = step.machine();
  if (step.code.routine("prepare") != nullptr) machine.run("prepare");
  return machine;
}

}  // namespace

Identities ready_identities(const StepUnderProof& step) {
  SymbolicMachine own = prepared(step);
  own.run("solve");
  const IterationTrace& trace = own.iterations.at(0);
  SymbolicMachine ready = prepared(step);
  for (std::size_t j = 0; j < trace.unknowns.size(); ++j)
    ready.name({"at", "point", {{static_cast<long>(j), {}}}}, trace.unknowns[j].name());
  ready.run("derivatives");
  ready.set_flag({"at", "ready"}, true);
  ready.run("solve");
  Identities identities;
  const auto claim = [&](const std::string& what, const Expression& with,
                         const Expression& without) {
    identities.claims.push_back({what + " where derivatives are ready", written_out(ready, with),
                                 written_out(own, without)});
  };
  for (std::size_t j = 0; j < trace.unknowns.size(); ++j)
    claim("Newton's increment", ready.iterations.at(0).corrections.at(j), trace.corrections[j]);
  for (int i = 0; i < step.size(); ++i)
    claim("the increment of " + step.name(i), step.increment(ready, i), step.increment(own, i));
  return identities;
}

}  // namespace hamgen
