#include "generator/language/end_condition.hpp"

#include <algorithm>

#include "generator/language/check_names.hpp"
#include "generator/language/check_values.hpp"
#include "generator/language/parser.hpp"

namespace hamgen {
namespace {

constexpr const char* kEnergyError = "energy_error";

bool is_energy_error(const NodePtr& node, const Symbols& symbols) {
  const auto* name = std::get_if<NameNode>(&node->value);
  return name != nullptr && name->name == kEnergyError && !name->subscript &&
         symbols.find(kEnergyError) == nullptr;
}

NodePtr negative(const NodePtr& node) {
  return std::make_shared<const Node>(Node{node->span, NegateNode{node}});
}

NodePtr difference(const NodePtr& left, const NodePtr& right) {
  return std::make_shared<const Node>(
      Node{{left->span.begin, right->span.end}, BinaryNode{BinaryOperator::subtract, left, right}});
}

// The larger side minus the smaller one.
EndCondition comparison(const EndSyntax& syntax, const Symbols& symbols) {
  NodePtr larger = syntax.less ? syntax.right : syntax.crossing.value;
  NodePtr smaller = syntax.less ? syntax.crossing.value : syntax.right;
  EndCondition result{.event = syntax.crossing, .holds = true};
  if (is_energy_error(larger, symbols)) {
    result.energy_error = 1;
    result.event.value = negative(smaller);
  } else if (is_energy_error(smaller, symbols)) {
    result.energy_error = -1;
    result.event.value = larger;
  } else {
    result.event.value = difference(larger, smaller);
  }
  return result;
}

void check(const EndCondition& condition, const Model& model, Symbols& symbols) {
  const NodePtr& value = condition.event.value;
  if (names_in(value).contains(kEnergyError) && symbols.find(kEnergyError) == nullptr) {
    symbols.report(value->span, "energy_error, |H - H(0)|, stands alone on one side",
                   "compare it with a value: energy_error > 1e-6");
    return;
  }
  KnownValues known;
  for (const Size& each : model.sizes) known[each.name] = each.value;
  Role role = formula_role(std::nullopt);
  role.what = "what ends a run";
  if (check_names(value, role, symbols)) check_values(value, known, symbols);
}

}  // namespace

EndCondition read_end_condition(const Model& model, const std::string& option,
                                const std::string& text) {
  const SourceText source = make_source(option, text);
  std::vector<Diagnostic> mistakes;
  Symbols symbols(source, mistakes);
  declare_names(model, symbols);
  EndCondition result;
  try {
    const EndSyntax syntax = parse_end_of_run(source);
    const auto* name = std::get_if<NameNode>(&syntax.crossing.value->value);
    if (name != nullptr && !syntax.right && !name->subscript) {
      const auto event = std::ranges::find(model.events, name->name, &ModelEvent::name);
      if (event != model.events.end()) {
        result.event = *event;
        // One direction that is asked for is that, whatever the event's own.
        if (syntax.crossing.rising != syntax.crossing.falling) {
          result.event.rising = syntax.crossing.rising;
          result.event.falling = syntax.crossing.falling;
        }
        return result;
      }
    }
    result = syntax.right ? comparison(syntax, symbols) : EndCondition{.event = syntax.crossing};
    result.event.text = one_line(source, {0, source.text.size()});
    check(result, model, symbols);
  } catch (const ModelError& error) {
    throw OptionError(error);
  }
  if (!mistakes.empty()) throw OptionError(ModelError(mistakes, source));
  return result;
}

}  // namespace hamgen
