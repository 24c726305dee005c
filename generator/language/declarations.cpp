#include "generator/language/declarations.hpp"

#include <fmt/format.h>

#include <utility>

#include "generator/language/check_names.hpp"
#include "generator/language/constant.hpp"

namespace hamgen {
namespace {

class Declarations {
 public:
  Declarations(const Syntax& syntax, Model& model, Symbols& symbols, KnownValues& known)
      : syntax_(syntax), model_(model), symbols_(symbols), known_(known) {}

  void run(const std::map<std::string, long>& overrides) {
    for (const std::string& name : syntax_.spoiled) symbols_.spoil(name);
    for (const ParameterStatement& each : syntax_.parameters)
      symbols_.announce(each.declarator.name.text, SymbolKind::parameter);
    for (const Formula& size : syntax_.sizes) declare_size(size, overrides);
    declare_variables(syntax_.coordinates, SymbolKind::coordinate, model_.coordinates);
    declare_variables(syntax_.momenta, SymbolKind::momentum, model_.momenta);
    declare_time();
    for (const ParameterStatement& each : syntax_.parameters) declare_parameter(each);
    for (const Formula& each : syntax_.definitions) {
      symbols_.declare(each.name, {.kind = SymbolKind::definition, .span = each.name.span});
    }
    for (const Formula& each : syntax_.invariants) {
      symbols_.declare(each.name, {.kind = SymbolKind::invariant, .span = each.name.span});
    }
    for (const ModelEvent& each : syntax_.events) {
      symbols_.declare({each.name, each.span}, {.kind = SymbolKind::event, .span = each.span});
    }
    // Values may use names declared further down.
    check_boundaries();
    check_parameters();
    if (syntax_.variables_are_read && pairs_are_known_) check_pairs();
  }

 private:
  // The value of an integer expression in sizes, if nothing is wrong with it.
  std::optional<long> integer(const NodePtr& node, const Role& role) {
    if (!check_names(node, role, symbols_)) return std::nullopt;
    const auto value = check_values(node, known_, symbols_);
    if (!value) return std::nullopt;
    if (value->get_den() != 1 || abs(*value) > largest_count) {
      symbols_.report(node->span, fmt::format("{} is not a usable integer", short_text(*value)),
                      fmt::format("an integer between -{0} and {0} is needed", largest_count));
      return std::nullopt;
    }
    return value->get_num().get_si();
  }

  void declare_size(const Formula& size, const std::map<std::string, long>& overrides) {
    symbols_.declare(size.name, {.kind = SymbolKind::size, .span = size.name.span});
    std::optional<long> value = integer(size.value, size_role(size.name.span.begin));
    if (const auto other = overrides.find(size.name.text); other != overrides.end()) {
      value = other->second;
    }
    if (!value) return symbols_.spoil(size.name.text);
    known_[size.name.text] = *value;
    model_.sizes.push_back({.name = size.name.text,
                            .value = *value,
                            .number = *value,
                            .comment = size.comment,
                            .span = size.name.span});
  }

  std::optional<IndexRange> range_of(const Declarator& declarator) {
    if (!declarator.range) return std::nullopt;
    Role role = size_role(std::nullopt);
    role.what = "a range";
    const auto first = integer(declarator.range->first, role);
    const auto last = integer(declarator.range->last, role);
    if (!first || !last) return IndexRange{.first = 1, .last = largest_array};  // already reported
    if (*first <= *last && *last - *first < largest_array) return IndexRange{*first, *last};
    symbols_.report(declarator.range->span,
                    fmt::format("the range {}..{} has {} elements", *first, *last,
                                *first > *last ? "no" : "too many"),
                    fmt::format("an array has between 1 and {} elements", largest_array));
    return IndexRange{.first = 1, .last = largest_array};
  }

  void declare_variables(const std::vector<VariableStatement>& statements, SymbolKind kind,
                         std::vector<Variable>& variables) {
    for (const VariableStatement& statement : statements) {
      for (const Declarator& each : statement.declarators) {
        Variable variable{.name = each.name.text,
                          .range = range_of(each),
                          .unit = each.unit,
                          .comment = statement.comment,
                          .periodic = statement.periodic,
                          .beyond = {},
                          .is_time = false,
                          .span = each.name.span};
        if (statement.periodic && !variable.range) {
          symbols_.report(
              each.name.span,
              fmt::format("'{}' is not an array: it cannot be periodic", each.name.text),
              fmt::format("write {}[1..N] periodic", each.name.text));
        }
        const bool is_new = symbols_.declare(each.name, {.kind = kind,
                                                         .span = each.name.span,
                                                         .range = variable.range,
                                                         .periodic = statement.periodic,
                                                         .beyond = {}});
        pairs_are_known_ = pairs_are_known_ && is_new;
        variables.push_back(std::move(variable));
      }
    }
  }

  // time t: t and p_t are the last degree of freedom, and H + p_t moves t at rate 1.
  void declare_time() {
    if (syntax_.times.empty()) return;
    for (std::size_t i = 1; i < syntax_.times.size(); ++i) {
      symbols_.report(syntax_.times[i].declarators.front().name.span, "time is declared twice",
                      "keep one");
    }
    const VariableStatement& statement = syntax_.times.front();
    const Declarator& time = statement.declarators.front();
    symbols_.declare(time.name, {.kind = SymbolKind::coordinate, .span = time.name.span});
    if (const Symbol* taken = symbols_.find("p_t"); taken != nullptr) {
      symbols_.report(taken->span, "'p_t' is reserved: the momentum that belongs to time",
                      "choose another name");
      pairs_are_known_ = false;
    } else {
      symbols_.declare({"p_t", time.name.span},
                       {.kind = SymbolKind::momentum, .span = time.name.span});
    }
    time_coordinate_ = Variable{.name = time.name.text,
                                .range = {},
                                .unit = time.unit,
                                .comment = statement.comment.empty() ? "time" : statement.comment,
                                .periodic = false,
                                .beyond = {},
                                .is_time = true,
                                .span = time.name.span};
  }

  void declare_parameter(const ParameterStatement& statement) {
    const Declarator& declarator = statement.declarator;
    Parameter parameter{.name = declarator.name.text,
                        .range = range_of(declarator),
                        .values = statement.values,
                        .unit = declarator.unit,
                        .comment = statement.comment,
                        .folded = false,
                        .span = declarator.name.span};
    symbols_.declare(
        declarator.name,
        {.kind = SymbolKind::parameter, .span = declarator.name.span, .range = parameter.range});
    if (statement.is_list && !parameter.range) {
      symbols_.report(
          statement.value_span, fmt::format("'{}' is one number, not a list", parameter.name),
          fmt::format("declare it as {}[1..{}]", parameter.name, parameter.values.size()));
    } else if (parameter.range && !statement.is_list) {
      parameter.values.resize(static_cast<std::size_t>(parameter.range->size()),
                              statement.values.front());
    } else if (parameter.range &&
               static_cast<long>(parameter.values.size()) != parameter.range->size()) {
      symbols_.report(statement.value_span,
                      fmt::format("'{}' has {} elements, but {} values are given", parameter.name,
                                  parameter.range->size(), parameter.values.size()),
                      "give one value for each element, or one number for all");
    }
    model_.parameters.push_back(std::move(parameter));
  }

  void check_parameters() {
    for (const ParameterStatement& statement : syntax_.parameters) {
      const Role role = parameter_role(statement.declarator.name.span.begin);
      for (const NodePtr& value : statement.values) {
        if (check_names(value, role, symbols_)) check_values(value, known_, symbols_);
      }
    }
  }

  void check_boundaries() {
    for (const VariableStatement& statement : syntax_.coordinates) {
      for (const BoundarySyntax& each : statement.boundary) {
        check_boundary(statement, each, model_.coordinates);
      }
    }
    for (const VariableStatement& statement : syntax_.momenta) {
      for (const BoundarySyntax& each : statement.boundary) {
        check_boundary(statement, each, model_.momenta);
      }
    }
  }

  void check_boundary(const VariableStatement& statement, const BoundarySyntax& boundary,
                      std::vector<Variable>& variables) {
    Variable* variable = nullptr;
    for (const Declarator& each : statement.declarators) {
      if (each.name.text != boundary.name.text || !each.range) continue;
      for (Variable& candidate : variables) {
        if (candidate.span == each.name.span) variable = &candidate;
      }
    }
    if (variable == nullptr) {
      symbols_.report(boundary.name.span,
                      fmt::format("'{}' is not an array of this line", boundary.name.text),
                      "'with' gives values beyond the ends of the arrays declared before it");
      return;
    }
    Role role = size_role(std::nullopt);
    role.what = "a subscript";
    const auto at = integer(boundary.subscript, role);
    if (check_names(boundary.value, parameter_role(std::nullopt), symbols_)) {
      check_values(boundary.value, known_, symbols_);
    }
    if (!at) return;
    if (*at >= variable->range->first && *at <= variable->range->last) {
      symbols_.report(boundary.subscript->span,
                      fmt::format("'{}[{}]' is inside the array", boundary.name.text, *at),
                      "'with' gives values outside the range; a scene sets the others");
      return;
    }
    if (variable->beyond.contains(*at)) {
      symbols_.report(boundary.name.span,
                      fmt::format("'{}[{}]' has a value already", boundary.name.text, *at),
                      "give it one value");
      return;
    }
    variable->beyond[*at] = boundary.value;
    symbols_.find(boundary.name.text)->beyond.insert(*at);
  }

  static std::string text(const std::string& name, const std::optional<IndexRange>& range) {
    return range ? fmt::format("{}[{}..{}]", name, range->first, range->last) : name;
  }

  void check_pairs() {
    const std::size_t pairs = std::min(model_.coordinates.size(), model_.momenta.size());
    for (std::size_t i = 0; i < pairs; ++i) {
      const Variable& q = model_.coordinates[i];
      const Variable& p = model_.momenta[i];
      if (q.range == p.range) continue;
      symbols_.report(
          p.span,
          fmt::format("momentum '{}' does not match coordinate '{}'", text(p.name, p.range),
                      text(q.name, q.range)),
          fmt::format("momenta belong to coordinates in the order of declaration: momentum {}",
                      text(p.name, q.range)));
    }
    for (std::size_t i = pairs; i < model_.coordinates.size(); ++i) {
      const Variable& q = model_.coordinates[i];
      symbols_.report(q.span, fmt::format("coordinate '{}' has no momentum", q.name),
                      fmt::format("declare one: momentum {}", text("p_" + q.name, q.range)));
    }
    for (std::size_t i = pairs; i < model_.momenta.size(); ++i) {
      symbols_.report(model_.momenta[i].span,
                      fmt::format("momentum '{}' has no coordinate", model_.momenta[i].name),
                      "declare a coordinate for each momentum");
    }
    add_time();
  }

  void add_time() {
    if (!time_coordinate_) return;
    Variable momentum = *time_coordinate_;
    momentum.name = "p_t";
    momentum.unit.clear();
    momentum.comment = "momentum of time: minus the energy, up to a constant";
    model_.coordinates.push_back(*time_coordinate_);
    model_.momenta.push_back(std::move(momentum));
  }

  const Syntax& syntax_;
  Model& model_;
  Symbols& symbols_;
  KnownValues& known_;
  std::optional<Variable> time_coordinate_;
  bool pairs_are_known_ = true;  // no declaration of a variable is in doubt
};

}  // namespace

void declare_all(const Syntax& syntax, const std::map<std::string, long>& overrides, Model& model,
                 Symbols& symbols, KnownValues& known) {
  Declarations(syntax, model, symbols, known).run(overrides);
}

}  // namespace hamgen
