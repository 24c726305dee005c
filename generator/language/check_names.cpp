#include "generator/language/check_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "generator/algebra/functions.hpp"
#include "generator/language/words.hpp"

namespace hamgen {
namespace {

// Functions of other languages whose derivatives jump.
constexpr std::string_view kJumping[] = {"min",       "max",       "sign",  "sgn",
                                         "floor",     "ceil",      "round", "step",
                                         "heaviside", "piecewise", "mod",   "clamp"};

// And what is written for others.
struct OtherName {
  std::string_view name, help;
};
constexpr OtherName kWritten[] = {{"ln", "did you mean 'log', the natural logarithm?"},
                                  {"log10", "write log(x)/log(10); log is the natural logarithm"},
                                  {"log2", "write log(x)/log(2); log is the natural logarithm"},
                                  {"pow", "write a power as q^2"},
                                  {"hypot", "write sqrt(x^2 + y^2)"},
                                  {"cbrt", "write x^(1/3), for x > 0"},
                                  {"sec", "write 1/cos(x)"},
                                  {"csc", "write 1/sin(x)"},
                                  {"cot", "write 1/tan(x)"}};

using enum SymbolKind;

class NameCheck {
 public:
  NameCheck(const Role& role, Symbols& symbols, std::vector<std::string> indices)
      : role_(role), symbols_(symbols), indices_(std::move(indices)) {}

  bool run(const NodePtr& node) {
    check(node);
    return good_;
  }

 private:
  void fail(Span span, std::string message, std::string help = {}) {
    symbols_.report(span, std::move(message), std::move(help));
    good_ = false;
  }

  void check(const NodePtr& node) {
    std::visit([&](const auto& each) { check(*node, each); }, node->value);
  }

  void check(const Node&, const NumberNode&) {}
  void check(const Node&, const NegateNode& negate) { check(negate.operand); }
  void check(const Node&, const BinaryNode& binary) {
    check(binary.left);
    check(binary.right);
  }

  bool is_index(const std::string& name) const {
    return std::ranges::find(indices_, name) != indices_.end();
  }

  void check(const Node& node, const NameNode& name) {
    if (name.subscript) check_subscript(name.subscript, "a subscript");
    if (is_index(name.name) || name.name == "pi") {
      if (name.subscript) fail(node.span, fmt::format("'{}' has no subscript", name.name));
      return;
    }
    const Symbol* symbol = symbols_.find(name.name);
    if (symbol == nullptr) return unknown(node, name.name);
    if (!role_.kinds.contains(symbol->kind)) return not_allowed(node, name.name, symbol->kind);
    const bool ordered =
        symbol->kind == parameter || symbol->kind == definition || symbol->kind == size;
    if (ordered && role_.before && symbol->span.begin >= *role_.before) {
      const std::size_t line = position(symbols_.source(), symbol->span.begin).line;
      return fail(node.span, fmt::format("'{}' is declared only on line {}", name.name, line),
                  "declare it before it is used here");
    }
    check_shape(node, name, *symbol);
  }

  void check_shape(const Node& node, const NameNode& name, const Symbol& symbol) {
    if (symbol.range && !name.subscript) {
      fail(node.span, fmt::format("'{}' is an array: which element?", name.name),
           fmt::format("write {}[{}], or a sum over its index", name.name, symbol.range->first));
    } else if (!symbol.range && name.subscript) {
      fail(node.span, fmt::format("'{}' is not an array", name.name),
           fmt::format("write {}, or declare {}[1..N]", name.name, name.name));
    }
  }

  void not_allowed(const Node& node, const std::string& name, SymbolKind kind) {
    const bool counts = kind == parameter && role_.kinds == std::set{size};
    fail(node.span, fmt::format("{} cannot use '{}', {}", role_.what, name, description(kind)),
         counts ? fmt::format("a number of elements is a size: size {} = 8", name)
                : fmt::format("it may use {}", role_.allows));
  }

  void unknown(const Node& node, const std::string& name) {
    good_ = false;
    if (symbols_.is_spoiled(name)) return;
    if (const auto kind = symbols_.announced(name); kind && !role_.kinds.contains(*kind))
      return not_allowed(node, name, *kind);
    if (const std::string meaning = reserved_meaning(name); !meaning.empty()) {
      return fail(node.span, fmt::format("'{}' is reserved: {}", name, meaning),
                  fmt::format("{} may use {}", role_.what, role_.allows));
    }
    if (name == "nan" || name == "inf" || name == "infinity") {
      return fail(node.span, fmt::format("'{}' is not a finite number", name), "give a number");
    }
    if ((name == "t" || name == "time") && role_.kinds.contains(SymbolKind::coordinate)) {
      return fail(node.span, fmt::format("unknown name '{}'", name),
                  fmt::format("a line of its own declares it: time {}", name));
    }
    std::vector<std::string> candidates = symbols_.names(role_.kinds);
    candidates.insert(candidates.end(), indices_.begin(), indices_.end());
    fail(node.span, fmt::format("unknown name '{}'", name), symbols_.suggestion(name, candidates));
  }

  void check(const Node& node, const CallNode& call) {
    for (const NodePtr& argument : call.arguments) check(argument);
    const Span span{node.span.begin, node.span.begin + call.function.size()};
    const Function* function = find_function(call.function);
    if (function == nullptr) return unknown_function(span, call.function);
    const auto given = static_cast<int>(call.arguments.size());
    if (given == function->arity) return;
    fail(node.span,
         fmt::format("{} takes {} argument{}, got {}", call.function, function->arity,
                     function->arity == 1 ? "" : "s", given),
         function->arity == 1
             ? fmt::format("write {}(x), the {}", call.function, function->description)
             : fmt::format("{}: {}", call.function, function->description));
  }

  void unknown_function(Span span, const std::string& name) {
    if (const Symbol* symbol = symbols_.find(name); symbol != nullptr || is_index(name)) {
      const std::string_view kind = symbol != nullptr ? description(symbol->kind) : "an index";
      return fail(span, fmt::format("'{}' is {}, not a function", name, kind),
                  fmt::format("write {}*(...) for a product", name));
    }
    std::vector<std::string> names;
    for (const Function& function : all_functions()) names.emplace_back(function.name);
    std::string help = "functions are " + fmt::format("{}", fmt::join(names, ", "));
    const std::string near = nearest(name, names);
    const auto written = std::ranges::find(kWritten, name, &OtherName::name);
    if (std::ranges::find(kJumping, name) != std::end(kJumping)) {
      help = "H needs two derivatives: a smooth step, say, is tanh(q/width)";
    } else if (written != std::end(kWritten)) {
      help = written->help;
    } else if (!near.empty() && name.size() > 1) {
      help = fmt::format("did you mean '{}'?", near);
    }
    fail(span, fmt::format("unknown function '{}'", name), help);
  }

  void check(const Node&, const SumNode& sum) {
    const std::size_t outer = indices_.size();
    for (const SumRange& range : sum.ranges) {
      check_subscript(range.lower, "the range of a sum");
      check_subscript(range.upper, "the range of a sum");
      if (const Symbol* symbol = symbols_.find(range.index); symbol != nullptr) {
        fail(range.span,
             fmt::format("the index '{}' is already {}", range.index, description(symbol->kind)),
             "choose another index");
      } else if (is_index(range.index)) {
        fail(range.span, fmt::format("the index '{}' is already an index here", range.index),
             "choose another index");
      }
      indices_.push_back(range.index);
    }
    check(sum.body);
    indices_.resize(outer);
  }

  // Subscripts and ranges: c0 + c1*i + c2*j ..., with integers made of sizes and numbers.
  void check_subscript(const NodePtr& node, std::string_view what) {
    Role role = size_role(role_.before);
    role.what = what;
    NameCheck inner(role, symbols_, indices_);
    if (!inner.run(node)) {
      good_ = false;
    } else if (degree(node) > 1) {
      fail(node->span, fmt::format("{} must be of the form 2*i + 1", what),
           "multiply an index by constants only, and use no functions of it");
    }
  }

  // 0 for a constant, 1 for an affine function of the indices, 2 for anything else.
  int degree(const NodePtr& node) const {
    return std::visit([&](const auto& each) { return degree(each); }, node->value);
  }
  static int degree(const NumberNode&) { return 0; }
  int degree(const NameNode& name) const { return is_index(name.name) ? 1 : 0; }
  int degree(const NegateNode& negate) const { return degree(negate.operand); }
  int degree(const BinaryNode& binary) const {
    const int left = degree(binary.left);
    const int right = degree(binary.right);
    switch (binary.operation) {
      case BinaryOperator::add:
      case BinaryOperator::subtract:
        return std::max(left, right);
      case BinaryOperator::multiply:
        return left + right;
      case BinaryOperator::divide:
      case BinaryOperator::power:
        return left + right == 0 ? 0 : 2;
    }
    internal_error("unknown operator");
  }
  static int degree(const CallNode&) { return 2; }
  static int degree(const SumNode&) { return 2; }

  const Role& role_;
  Symbols& symbols_;
  std::vector<std::string> indices_;
  bool good_ = true;
};

void collect(const NodePtr& node, std::set<std::string>& names) {
  if (const auto* name = std::get_if<NameNode>(&node->value)) {
    names.insert(name->name);
    if (name->subscript) collect(name->subscript, names);
  } else if (const auto* negate = std::get_if<NegateNode>(&node->value)) {
    collect(negate->operand, names);
  } else if (const auto* binary = std::get_if<BinaryNode>(&node->value)) {
    collect(binary->left, names);
    collect(binary->right, names);
  } else if (const auto* call = std::get_if<CallNode>(&node->value)) {
    for (const NodePtr& argument : call->arguments) collect(argument, names);
  } else if (const auto* sum = std::get_if<SumNode>(&node->value)) {
    for (const SumRange& range : sum->ranges) {
      collect(range.lower, names);
      collect(range.upper, names);
    }
    collect(sum->body, names);
  }
}

}  // namespace

Role size_role(std::optional<std::size_t> before) {
  return {"the value of a size", "sizes and numbers", {size}, before};
}

Role parameter_role(std::optional<std::size_t> before) {
  return {before ? "the value of a parameter" : "this value",
          before ? "earlier parameters, sizes and numbers" : "parameters, sizes and numbers",
          {size, parameter},
          before};
}

Role formula_role(std::optional<std::size_t> before) {
  return {"a formula",
          "coordinates, momenta, parameters, definitions and sizes",
          {size, coordinate, momentum, parameter, definition},
          before};
}

bool check_names(const NodePtr& node, const Role& role, Symbols& symbols,
                 std::vector<std::string> indices) {
  return NameCheck(role, symbols, std::move(indices)).run(node);
}

std::set<std::string> names_in(const NodePtr& node) {
  std::set<std::string> names;
  collect(node, names);
  return names;
}

}  // namespace hamgen
