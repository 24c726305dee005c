#include "generator/language/check_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "generator/language/check_names.hpp"
#include "generator/language/constant.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

using enum SymbolKind;

// A lone name that is no size is a free index: q[i] = ...
void find_free_index(Setting& setting, Symbols& symbols) {
  if (!setting.element) return;
  const auto* name = std::get_if<NameNode>(&setting.element->value);
  if (name == nullptr || name->subscript || symbols.find(name->name) != nullptr) return;
  if (const std::string meaning = reserved_meaning(name->name); !meaning.empty()) {
    symbols.report(setting.element->span, fmt::format("'{}' is reserved: {}", name->name, meaning),
                   "choose another index, such as i");
  }
  setting.index = name->name;
  setting.element = nullptr;
}

void check_shape(const Setting& setting, const Symbol& symbol, const KnownValues& known,
                 Symbols& symbols) {
  const std::string& name = setting.name;
  if (!symbol.range) {
    if (setting.element || !setting.index.empty() || setting.is_list) {
      symbols.report(setting.span, fmt::format("'{}' is one number, not an array", name),
                     fmt::format("write {} = 1", name));
    }
    return;
  }
  const IndexRange range = *symbol.range;
  const long given = static_cast<long>(setting.values.size());
  if (setting.is_list && (setting.element || !setting.index.empty())) {
    symbols.report(setting.span, "a list sets a whole array",
                   fmt::format("write {} = [...]", name));
  } else if (setting.is_list && given != range.size()) {
    symbols.report(
        setting.span,
        fmt::format("'{}' has {} elements, but {} values are given", name, range.size(), given),
        fmt::format("give one value for each of {}[{}..{}]", name, range.first, range.last));
  }
  if (!setting.element) return;
  Role role = size_role(std::nullopt);
  role.what = "a subscript";
  if (!check_names(setting.element, role, symbols)) return;
  const auto at = check_values(setting.element, known, symbols);
  if (!at) return;
  if (at->get_den() != 1 || *at < range.first || *at > range.last) {
    symbols.report(setting.element->span,
                   fmt::format("'{}[{}]' is outside {}[{}..{}]", name, short_text(*at), name,
                               range.first, range.last),
                   fmt::format("subscripts run from {} to {}", range.first, range.last));
  }
}

void check_twice(const Scene& scene, Symbols& symbols) {
  std::map<std::string, Span> whole;  // set so far
  for (const Setting& setting : scene.settings) {
    if (setting.element) continue;
    const auto [first, is_new] = whole.emplace(setting.name, setting.span);
    if (is_new) continue;
    symbols.report(
        setting.span, fmt::format("'{}' is set twice", setting.name),
        fmt::format("line {} sets it first", position(symbols.source(), first->second.begin).line));
  }
}

void check_number(const NodePtr& node, Symbols& symbols) {
  if (node) check_names(node, parameter_role(std::nullopt), symbols);
}

// radius = ...
void check_new_name(const Observed& observed, const Symbol* symbol, Symbols& symbols) {
  const std::string meaning = reserved_meaning(observed.name);
  if (symbol != nullptr) {
    symbols.report(observed.span,
                   fmt::format("'{}' is {}", observed.name, description(symbol->kind)),
                   "what is observed gets a name of its own: observe radius = ...");
  } else if (!meaning.empty() || observed.element) {
    symbols.report(observed.span,
                   meaning.empty() ? "a quantity that is observed is one number"
                                   : fmt::format("'{}' is reserved: {}", observed.name, meaning),
                   "choose another name, as in observe radius = sqrt(x^2 + y^2)");
  }
}

void check_element(const Observed& observed, const Symbol& symbol, const KnownValues& known,
                   Symbols& symbols) {
  if (!observed.element) return;
  if (!symbol.range) {
    symbols.report(observed.span, fmt::format("'{}' is one number, not an array", observed.name));
    return;
  }
  Role role = size_role(std::nullopt);
  role.what = "a subscript";
  if (!check_names(observed.element, role, symbols)) return;
  const auto at = check_values(observed.element, known, symbols);
  if (!at) return;
  if (at->get_den() != 1 || *at < symbol.range->first || *at > symbol.range->last) {
    symbols.report(observed.element->span,
                   fmt::format("'{}[{}]' is outside {}[{}..{}]", observed.name, short_text(*at),
                               observed.name, symbol.range->first, symbol.range->last));
  }
}

// energy, an invariant, a coordinate or a momentum
void check_known_name(const Observed& observed, const Symbol* symbol, const KnownValues& known,
                      Symbols& symbols) {
  const bool is_state =
      symbol != nullptr && (symbol->kind == coordinate || symbol->kind == momentum);
  if (is_state) {
    check_element(observed, *symbol, known, symbols);
  } else if (symbol == nullptr || symbol->kind != invariant) {
    std::vector<std::string> candidates = symbols.names({invariant, coordinate, momentum});
    candidates.emplace_back("energy");
    symbols.report(observed.span,
                   symbol == nullptr
                       ? fmt::format("'{}' is no coordinate, momentum or invariant", observed.name)
                       : fmt::format("'{}' is {}: nothing to observe", observed.name,
                                     description(symbol->kind)),
                   symbols.suggestion(observed.name, candidates));
  }
}

// Settings of other programs.
struct OtherSetting {
  std::string_view name, help;
};
constexpr std::string_view kLength =
    "a scene is so many steps long: steps = 1000; --time T takes as many as T has room for";
constexpr std::string_view kStep = "the step size is h: h = 0.1";
constexpr OtherSetting kOtherSettings[] = {
    {"time", kLength}, {"T", kLength},        {"t_end", kLength},
    {"tmax", kLength}, {"duration", kLength}, {"dt", kStep},
    {"step", kStep},   {"timestep", kStep},   {"step_size", kStep}};

std::string help_for_setting(const std::string& name, const Symbols& symbols) {
  const auto* const other = std::ranges::find(kOtherSettings, name, &OtherSetting::name);
  if (other != std::end(kOtherSettings)) return std::string(other->help);
  std::vector<std::string> candidates = symbols.names({coordinate, momentum, parameter});
  candidates.insert(candidates.end(), {"h", "steps", "every", "observe"});
  return symbols.suggestion(name, candidates);
}

}  // namespace

void check_setting(Setting& setting, const KnownValues& known, Symbols& symbols) {
  const Span name_span{setting.span.begin, setting.span.begin + setting.name.size()};
  find_free_index(setting, symbols);
  const Symbol* symbol = symbols.find(setting.name);
  const bool settable =
      symbol != nullptr &&
      (symbol->kind == coordinate || symbol->kind == momentum || symbol->kind == parameter);
  if (symbol == nullptr) {
    if (symbols.is_spoiled(setting.name)) return;
    symbols.report(name_span, fmt::format("unknown name '{}'", setting.name),
                   help_for_setting(setting.name, symbols));
  } else if (!settable) {
    symbols.report(
        name_span,
        fmt::format("'{}' is {}: a scene cannot set it", setting.name, description(symbol->kind)),
        symbol->kind == size ? fmt::format("set it on the command line: --set {}=...", setting.name)
                             : "a scene sets coordinates, momenta and parameters");
  } else {
    check_shape(setting, *symbol, known, symbols);
  }
  const bool is_parameter = symbol != nullptr && symbol->kind == parameter;
  const Role role = parameter_role(is_parameter ? std::optional(symbol->span.begin) : std::nullopt);
  std::vector<std::string> indices;
  if (!setting.index.empty()) indices.push_back(setting.index);
  for (const NodePtr& value : setting.values) check_names(value, role, symbols, indices);
}

void check_observed(const std::vector<Observed>& list, const KnownValues& known, Symbols& symbols) {
  std::set<std::string> names;
  for (const Observed& each : list) {
    const Symbol* symbol = symbols.find(each.name);
    if (symbols.is_spoiled(each.name)) continue;
    const std::string subscript = each.element ? to_text(each.element) : "";
    if (!names.insert(each.name + "[" + subscript).second) {
      symbols.report(each.span, fmt::format("'{}' is observed twice", each.name));
    } else if (each.value) {
      check_new_name(each, symbol, symbols);
      if (check_names(each.value, formula_role(std::nullopt), symbols)) {
        check_values(each.value, known, symbols);
      }
    } else if (each.name != "energy") {
      check_known_name(each, symbol, known, symbols);
    }
  }
}

Scene check_scene(const SceneStatement& statement, const KnownValues& known, Symbols& symbols) {
  Scene scene = statement.scene;
  for (Setting& setting : scene.settings) check_setting(setting, known, symbols);
  check_twice(scene, symbols);
  check_number(scene.h, symbols);
  check_number(scene.steps, symbols);
  check_number(scene.every, symbols);
  check_observed(scene.observe, known, symbols);
  return scene;
}

}  // namespace hamgen
