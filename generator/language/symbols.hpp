// What the names of a model stand for.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/language/model.hpp"
#include "generator/language/syntax.hpp"

namespace hamgen {

enum class SymbolKind { size, coordinate, momentum, parameter, definition, invariant, event };

// "a coordinate"
[[nodiscard]] std::string_view description(SymbolKind kind);

struct Symbol {
  SymbolKind kind = SymbolKind::size;
  Span span = {};  // of the name where it is declared
  std::optional<IndexRange> range = {};
  bool periodic = false;
  std::set<long> beyond = {};  // subscripts outside the range that have a value
};

class Symbols {
 public:
  Symbols(const SourceText& source, std::vector<Diagnostic>& diagnostics)
      : source_(source), diagnostics_(diagnostics) {}

  // Reports a second declaration, naming the line of the first, and returns false.
  bool declare(const Name& name, Symbol symbol);
  [[nodiscard]] const Symbol* find(const std::string& name) const;
  [[nodiscard]] Symbol* find(const std::string& name);
  // Names of these kinds, for "did you mean".
  [[nodiscard]] std::vector<std::string> names(const std::set<SymbolKind>& kinds) const;

  // A name that is declared behind all that may use it.
  void announce(const std::string& name, SymbolKind kind) { announced_.emplace(name, kind); }
  [[nodiscard]] std::optional<SymbolKind> announced(const std::string& name) const;

  // A name on a line that could not be read: nothing is said of it.
  void spoil(const std::string& name) { spoiled_.insert(name); }
  [[nodiscard]] bool is_spoiled(const std::string& name) const { return spoiled_.contains(name); }

  void report(Span span, std::string message, std::string help = {});
  [[nodiscard]] const SourceText& source() const { return source_; }
  // "did you mean 'theta', the coordinate declared on line 3?", or what there is to choose from.
  [[nodiscard]] std::string suggestion(const std::string& name,
                                       const std::vector<std::string>& candidates) const;

 private:
  const SourceText& source_;
  std::vector<Diagnostic>& diagnostics_;
  std::map<std::string, Symbol> symbols_;
  std::map<std::string, SymbolKind> announced_;
  std::set<std::string> spoiled_;
};

// All names of a model.
void declare_names(const Model& model, Symbols& symbols);

}  // namespace hamgen
