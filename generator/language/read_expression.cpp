#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "generator/language/check_names.hpp"
#include "generator/language/check_values.hpp"
#include "generator/language/parser.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

// Declares "m" or "m[2]"; elements of an array widen its range.
void declare(const std::string& name, Symbols& symbols) {
  const std::size_t bracket = name.find('[');
  const std::string base = name.substr(0, bracket);
  Symbol* known = symbols.find(base);
  std::optional<IndexRange> range;
  if (bracket != std::string::npos) {
    long at = 0;
    std::from_chars(name.data() + bracket + 1, name.data() + name.size(), at);
    range = IndexRange{at, at};
    if (known != nullptr && known->range) {
      range = IndexRange{std::min(at, known->range->first), std::max(at, known->range->last)};
    }
  }
  if (known != nullptr) {
    known->range = range;
  } else {
    symbols.declare({base, {}}, {.kind = SymbolKind::parameter, .span = {}, .range = range});
  }
}

}  // namespace

NodePtr read_grammar(const std::string& what, const std::string& text) {
  const SourceText source = make_source(what, text);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw ModelError({{Severity::error, {}, "no expression given", "give a number"}}, source);
  return parse_expression(source);
}

void require_names(const NodePtr& node, const std::string& what, const std::string& text,
                   const std::vector<std::string>& names) {
  const SourceText source = make_source(what, text);
  std::vector<Diagnostic> diagnostics;
  Symbols symbols(source, diagnostics);
  for (const std::string& name : names) declare(name, symbols);
  Role role = parameter_role(std::nullopt);
  role.what = "this value";
  role.allows = "the names that are known here";
  if (check_names(node, role, symbols)) check_values(node, {}, symbols);
  if (!diagnostics.empty()) throw ModelError(diagnostics, source);
}

NodePtr read_expression(const std::string& what, const std::string& text,
                        const std::vector<std::string>& names) {
  NodePtr node = read_grammar(what, text);
  require_names(node, what, text, names);
  return node;
}

}  // namespace hamgen
