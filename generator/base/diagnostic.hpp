// What is said of a user's mistake: where, what, and what would work.
#pragma once

#include <exception>
#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/source_text.hpp"

namespace hamgen {

enum class Severity { error, warning };

struct Diagnostic {
  Severity severity = Severity::error;
  Span span;
  std::string message;  // lower case, no full stop: "unknown name 'thta'"
  std::string help;     // empty if there is none
  bool operator==(const Diagnostic&) const = default;
};

// "path:line:col: error: message", the source line, a caret line, "help: ...".
// Long lines are cut around the span; a span over several lines is marked to the end of its first.
[[nodiscard]] std::string render(const Diagnostic& diagnostic, const SourceText& source);
[[nodiscard]] std::string render(const std::vector<Diagnostic>& diagnostics,
                                 const SourceText& source);

// Where a diagnostic points, for other programs: the end is behind the last character.
struct Location {
  std::string file;
  Position begin, end;
};
[[nodiscard]] Location location_of(const Diagnostic& diagnostic, const SourceText& source);

// A model that cannot be used: all the mistakes a stage found, in source order.
class ModelError : public std::exception {
 public:
  ModelError(std::vector<Diagnostic> diagnostics, const SourceText& source);
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  // Of each, in its source: the model or the text of an option.
  [[nodiscard]] const std::vector<Location>& locations() const { return locations_; }

 private:
  std::vector<Diagnostic> diagnostics_;
  std::vector<Location> locations_;
  std::string text_;
};

// A request that makes no sense, whatever the model (exit status 2).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The same, of a mistake inside an option's text: what is said of it, and where.
class OptionError : public UsageError {
 public:
  explicit OptionError(const ModelError& error)
      : UsageError(error.what()),
        diagnostics_(error.diagnostics()),
        locations_(error.locations()) {}
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const std::vector<Location>& locations() const { return locations_; }

 private:
  std::vector<Diagnostic> diagnostics_;
  std::vector<Location> locations_;
};

// A broken invariant of hamgen itself.
[[noreturn]] void internal_error(std::string_view what,
                                 std::source_location where = std::source_location::current());

// The nearest of the candidates by edit distance, empty if none is near enough to be meant.
[[nodiscard]] std::string nearest(std::string_view name,
                                  const std::vector<std::string>& candidates);

}  // namespace hamgen
