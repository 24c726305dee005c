// A loaded plugin.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/plugin.h"
#include "runtime/wide.hpp"

namespace hamgen::runtime {

// Keeps the shared object loaded as long as it lives.  Integrators share it.
class Library {
 public:
  // Throws ToolError if the object cannot be loaded, is no plugin, or is of another version; and if
  // its arithmetic is not IEEE 754's, or that of the calling thread is not (the thread's
  // floating-point environment stays what it was).
  explicit Library(const std::filesystem::path& object);
  // Of a table that is here already; `owner` lives as long as the library.  Throws ToolError as
  // above.
  Library(const hamgen_plugin& plugin, std::shared_ptr<const void> owner);
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library();

  // The table of its C interface, which plugin.h declares.
  [[nodiscard]] const hamgen_plugin& plugin() const { return *plugin_; }
  // n: a state has 2n values.
  [[nodiscard]] std::size_t degrees_of_freedom() const;
  // Run-time parameters; those that were folded are not among them.
  [[nodiscard]] std::size_t parameter_count() const;
  // What the plugin has besides H: the model's invariants, events and what is observed.
  [[nodiscard]] std::size_t invariant_count() const;

  // Has the scalar more digits than a double?
  [[nodiscard]] bool is_wide() const;

  // H at a state (2n values: q then p), not finite outside the domain of H, with the digits of the
  // scalar.  These throw std::invalid_argument if a size is wrong.
  [[nodiscard]] Wide energy(std::span<const Wide> parameters, std::span<const Wide> state) const;
  // invariant_count values.
  [[nodiscard]] std::vector<Wide> invariants(std::span<const Wide> parameters,
                                             std::span<const Wide> state) const;
  // Of doubles, rounded to double.
  [[nodiscard]] double energy(std::span<const double> parameters,
                              std::span<const double> state) const;
  // The same of doubles, invariant_count values.
  [[nodiscard]] std::vector<double> invariants(std::span<const double> parameters,
                                               std::span<const double> state) const;
  // 2n values: H_q then H_p.
  [[nodiscard]] std::vector<double> gradient(std::span<const double> parameters,
                                             std::span<const double> state) const;

  // Throws std::invalid_argument unless there are parameter_count parameters and 2n values.
  void check_sizes(std::size_t parameters, std::size_t state) const;

 private:
  struct Close {
    void operator()(void* handle) const;
  };
  std::unique_ptr<void, Close> handle_;
  std::shared_ptr<const void> owner_;
  const hamgen_plugin* plugin_ = nullptr;
};

}  // namespace hamgen::runtime
