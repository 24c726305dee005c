#include "generator/language/symbols.hpp"

#include <fmt/format.h>

#include <utility>

#include "generator/base/utf8.hpp"

namespace hamgen {
namespace {

template <typename Declared>
void declare_arrays(const std::vector<Declared>& declared, SymbolKind kind, Symbols& symbols) {
  for (const Declared& each : declared) {
    if (symbols.find(each.name) != nullptr) continue;
    symbols.declare({each.name, each.span}, {.kind = kind, .span = each.span, .range = each.range});
  }
}

}  // namespace

std::string_view description(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::size:
      return "a size";
    case SymbolKind::coordinate:
      return "a coordinate";
    case SymbolKind::momentum:
      return "a momentum";
    case SymbolKind::parameter:
      return "a parameter";
    case SymbolKind::definition:
      return "a definition";
    case SymbolKind::invariant:
      return "an invariant";
    case SymbolKind::event:
      return "an event";
  }
  internal_error("unknown kind of symbol");
}

bool Symbols::declare(const Name& name, Symbol symbol) {
  const auto [place, is_new] = symbols_.emplace(name.text, std::move(symbol));
  if (is_new) return true;
  const Span first = place->second.span;
  std::string line = printable(line_text(source_, first.begin));
  line.erase(0, line.find_first_not_of(' '));
  if (line.size() > 60) line = line.substr(0, 60) + "...";
  report(name.span, fmt::format("'{}' is declared twice", name.text),
         fmt::format("line {} declares it first: {}", position(source_, first.begin).line, line));
  return false;
}

const Symbol* Symbols::find(const std::string& name) const {
  const auto place = symbols_.find(name);
  return place == symbols_.end() ? nullptr : &place->second;
}

Symbol* Symbols::find(const std::string& name) {
  const auto place = symbols_.find(name);
  return place == symbols_.end() ? nullptr : &place->second;
}

std::optional<SymbolKind> Symbols::announced(const std::string& name) const {
  const auto place = announced_.find(name);
  if (place == announced_.end()) return {};
  return place->second;
}

std::vector<std::string> Symbols::names(const std::set<SymbolKind>& kinds) const {
  std::vector<std::string> result;
  for (const auto& [name, symbol] : symbols_) {
    if (kinds.contains(symbol.kind)) result.push_back(name);
  }
  return result;
}

void Symbols::report(Span span, std::string message, std::string help) {
  diagnostics_.push_back({Severity::error, span, std::move(message), std::move(help)});
}

std::string Symbols::suggestion(const std::string& name,
                                const std::vector<std::string>& candidates) const {
  const std::string near = nearest(name, candidates);
  if (!near.empty()) {
    const Symbol* symbol = find(near);
    if (symbol == nullptr) return fmt::format("did you mean '{}'?", near);
    return fmt::format("did you mean '{}', the {} declared on line {}?", near,
                       description(symbol->kind).substr(description(symbol->kind).find(' ') + 1),
                       position(source_, symbol->span.begin).line);
  }
  if (candidates.empty() || candidates.size() > 12) return {};
  return fmt::format("declared are {}", fmt::join(candidates, ", "));
}

void declare_names(const Model& model, Symbols& symbols) {
  for (const Size& each : model.sizes)
    symbols.declare({each.name, each.span}, {.kind = SymbolKind::size, .span = each.span});
  declare_arrays(model.coordinates, SymbolKind::coordinate, symbols);
  declare_arrays(model.momenta, SymbolKind::momentum, symbols);
  declare_arrays(model.parameters, SymbolKind::parameter, symbols);
  for (const Definition& each : model.definitions)
    symbols.declare({each.name, each.span}, {.kind = SymbolKind::definition, .span = each.span});
  for (const Invariant& each : model.invariants) {
    if (each.is_event()) continue;
    symbols.declare({each.name, each.span}, {.kind = SymbolKind::invariant, .span = each.span});
  }
  for (const ModelEvent& each : model.events)
    symbols.declare({each.name, each.span}, {.kind = SymbolKind::event, .span = each.span});
}

}  // namespace hamgen
