// What the methods need of the arithmetic, that every operation is rounded as IEEE 754 says, and
// the two ways in which a plugin could take it away: its compiler's flags, and the environment of
// the thread that loads it.
#pragma once

#include <cfenv>
#include <optional>
#include <span>
#include <string>

namespace hamgen::runtime {

// Why a compiler's argument is refused, or nothing: "'-ffast-math' changes what the arithmetic
// means", then how to go on.  `@file` is refused because it may hold such a flag, and because the
// cache would not see that it changed.
[[nodiscard]] std::optional<std::string> refused_flag(std::span<const std::string> arguments);

// Are operations of this thread rounded to nearest, and are numbers below 2^-1022 kept (no "flush
// to zero", no "denormals are zero")?
[[nodiscard]] bool environment_is_ieee();

// Holds the thread's floating-point environment and puts it back at the end of its life.
class KeptEnvironment {
 public:
  KeptEnvironment();
  KeptEnvironment(const KeptEnvironment&) = delete;
  KeptEnvironment& operator=(const KeptEnvironment&) = delete;
  ~KeptEnvironment();

 private:
  std::fenv_t environment_;
};

}  // namespace hamgen::runtime
