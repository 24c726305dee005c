// Where and when a measurement was made: what its times depend on.
#pragma once

#include <atomic>
#include <string>

#include "runtime/compile.hpp"
#include "runtime/compiler.hpp"

namespace hamgen::runtime {

struct Provenance {
  std::string machine;   // processor and number of threads
  std::string compiler;  // of the integrators
  std::string flags;     // of the integrators, without what a model adds
  std::string date;      // "2026-01-31", UTC
};

// Does not wait for the compiler to say its version any longer once `stop` is set, if given.
[[nodiscard]] Provenance provenance_of(const Compiler& compiler,
                                       const std::atomic<bool>* stop = nullptr,
                                       const CompileOptions& options = {});

}  // namespace hamgen::runtime
