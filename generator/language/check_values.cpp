#include "generator/language/check_values.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

#include "generator/language/constant.hpp"

namespace hamgen {
namespace {

constexpr long short_range = 12;          // ranges up to this size are checked element by element
constexpr long most_instances = 20000;    // of bodies of sums; later ones go unchecked
constexpr long most_terms = 100'000'000;  // of one index
constexpr long largest_bound = 1'000'000'000;

class ValueCheck {
 public:
  ValueCheck(const KnownValues& known, Symbols& symbols) : known_(known), symbols_(symbols) {}

  using Value = std::optional<Rational>;

  Value value(const NodePtr& node) {
    return std::visit([&](const auto& each) { return of(*node, each); }, node->value);
  }

 private:
  // Each place is reported once, however many values of an index meet it.
  void report(Span span, std::string message, std::string help) {
    if (!reported_.insert(span.begin).second) return;
    symbols_.report(span, std::move(message), std::move(help));
  }

  Value take(const Node& node, const Constant& constant) {
    if (const auto* result = std::get_if<Rational>(&constant)) return *result;
    const auto& mistake = std::get<Undefined>(constant);
    report(node.span, mistake.message + for_indices(), mistake.help);
    return std::nullopt;
  }

  // " for i = 3, j = 4"
  std::string for_indices() const {
    std::string text;
    for (const auto& [name, at] : indices_) {
      text += fmt::format("{}{} = {}", text.empty() ? " for " : ", ", name, at);
    }
    return text;
  }

  static Value of(const Node&, const NumberNode& number) { return number.value; }

  Value of(const Node& node, const NameNode& name) {
    if (name.subscript) {
      check_element(node, name);
      return std::nullopt;
    }
    if (name.name == "pi") return pi();
    for (const auto& [index, at] : indices_) {
      if (index == name.name) return Rational(at);
    }
    const auto place = known_.find(name.name);
    return place == known_.end() ? Value() : Value(place->second);
  }

  Value of(const Node&, const NegateNode& negate) {
    const Value operand = value(negate.operand);
    return operand ? Value(Rational(-*operand)) : std::nullopt;
  }

  Value of(const Node& node, const BinaryNode& binary) {
    const Value left = value(binary.left);
    const Value right = value(binary.right);
    if (left && right) return take(node, combine(binary.operation, *left, *right));
    if (right && binary.operation == BinaryOperator::divide && sgn(*right) == 0) {
      report(binary.right->span, "division by zero" + for_indices(), "the divisor is 0");
    }
    if (right && binary.operation == BinaryOperator::power) {
      if (const auto mistake = check_exponent(*right)) {
        report(binary.right->span, mistake->message + for_indices(), mistake->help);
      }
    }
    return std::nullopt;
  }

  Value of(const Node& node, const CallNode& call) {
    std::vector<Rational> arguments;
    for (const NodePtr& argument : call.arguments) {
      if (const Value known = value(argument)) arguments.push_back(*known);
    }
    if (arguments.size() < call.arguments.size()) return std::nullopt;
    return take(node, call_function(call.function, arguments));
  }

  Value of(const Node&, const SumNode& sum) {
    walk(sum, 0);
    return std::nullopt;
  }

  void walk(const SumNode& sum, std::size_t depth) {
    if (depth == sum.ranges.size()) {
      if (++instances_ <= most_instances) value(sum.body);
      return;
    }
    const SumRange& range = sum.ranges[depth];
    const auto first = integer(range.lower);
    const auto last = integer(range.upper);
    if (!first || !last || instances_ > most_instances) return;
    if (*last - *first >= most_terms) {
      report(range.span, fmt::format("a sum of more than {} terms", most_terms), "take fewer");
      return;
    }
    const bool all = *last - *first < short_range;
    for (long i = *first; i <= *last; ++i) {
      indices_.emplace_back(range.index, i);
      walk(sum, depth + 1);
      indices_.pop_back();
      if (!all && i == *first + 2) i = *last - 3;
    }
  }

  std::optional<long> integer(const NodePtr& node) {
    const Value result = value(node);
    if (!result) return std::nullopt;
    if (result->get_den() != 1 || abs(*result) > largest_bound) {
      report(node->span, fmt::format("{} is not an integer{}", short_text(*result), for_indices()),
             "subscripts and ranges are integers");
      return std::nullopt;
    }
    return result->get_num().get_si();
  }

  void check_element(const Node& node, const NameNode& name) {
    const auto at = integer(name.subscript);
    const Symbol* symbol = symbols_.find(name.name);
    if (!at || symbol == nullptr || !symbol->range || symbol->periodic) return;
    const IndexRange range = *symbol->range;
    if ((*at >= range.first && *at <= range.last) || symbol->beyond.contains(*at)) return;
    const bool variable =
        symbol->kind == SymbolKind::coordinate || symbol->kind == SymbolKind::momentum;
    report(node.span,
           fmt::format("'{0}[{1}]' is outside {0}[{2}..{3}]{4}", name.name, *at, range.first,
                       range.last, for_indices()),
           variable
               ? fmt::format("change the subscript or the sum, or end the declaration of '{0}' "
                             "with 'periodic' or 'with {0}[{1}] = 0'",
                             name.name, *at)
               : "change the subscript or the range of the sum");
  }

  const KnownValues& known_;
  Symbols& symbols_;
  std::vector<std::pair<std::string, long>> indices_;
  std::set<std::size_t> reported_;
  long instances_ = 0;
};

}  // namespace

std::optional<Rational> check_values(const NodePtr& node, const KnownValues& known,
                                     Symbols& symbols) {
  return ValueCheck(known, symbols).value(node);
}

}  // namespace hamgen
