#include "generator/formats/print_code.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/routine_printer.hpp"

namespace hamgen {

std::string joined_texts(const std::vector<std::string>& items, const char* separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

RoutinePrinter::RoutinePrinter(CodeWriter& out, const Routine& routine, const Dialect& dialect,
                               Used& used)
    : out_(out),
      routine_(routine),
      dialect_(dialect),
      used_(used),
      cpp_(dialect, [this](const std::string& symbol) { return name(symbol); }) {
  // What iterations declare.
  for (const char* local :
       {"size", "scale", "iteration", "verdict", "progress", "length", "increment", "sweep", "part",
        "i", "j", "rule", "more", "lack", "slope", "point", "distance"}) {
    names_.reserve(local);
  }
  for (const std::string& taken : dialect.taken_names()) names_.reserve(taken);
  // Of a system in loops the length of its arrays, and the type of its matrix.
  if (dialect.n > 0) {
    for (const char* global : {"n", "Matrix"}) names_.reserve(global);
  }
  name_objects();
}

// An argument makes way for a quantity of that name: the user's z stays z.
void RoutinePrinter::name_objects() {
  std::set<std::string> symbols;
  collect_symbols(routine_.body, symbols);
  for (const Argument& argument : routine_.arguments) {
    const std::string& name = argument.name;
    const bool number = argument.record.empty() && argument.sizes.empty();
    const bool is_free = !symbols.contains(name) || routine_.places.contains(name);
    if (number || name == "start" || is_free) {
      names_.reserve(name);
      continue;
    }
    std::string other = name + "_";
    while (symbols.contains(other)) other += "_";
    names_.reserve(other);
    objects_[name] = other;
    names_.set(name, name);
  }
}

void RoutinePrinter::reserve(const written::Body& body) {
  for (const written::Statement& statement : body) {
    if (const auto* declare = std::get_if<Declare>(&statement.value)) {
      for (const std::string& object : declare->objects) names_.reserve(object);
      records_.insert(declare->objects.begin(), declare->objects.end());
    }
    if (const auto* define = std::get_if<written::Define>(&statement.value)) {
      const bool number = define->type == "Real" || define->type == "Lanes";
      if (!number && define->type != "StepReport") records_.insert(define->name);
      if (!written::is_number(*define)) names_.reserve(written::name_in_text(define->name));
    }
    if (const auto* loop = std::get_if<written::For>(&statement.value))
      names_.reserve(loop->range.index);
    if (const written::Body* inner = written::inner_body(statement)) reserve(*inner);
  }
}

void RoutinePrinter::print() {
  const written::Body body =
      written::body_of(routine_, {.references = dialect_.has_references(),
                                  .lanes = dialect_.has_lanes(),
                                  // Eigen knows neither quad numbers nor packs.
                                  .eigen = dialect_.scalar.digits != 113 && !dialect_.has_lanes()});
  reserve(body);
  for (const std::string& line : routine_.remark) out_.remark("// ", line);
  std::vector<std::string> arguments;
  for (const Argument& argument : routine_.arguments) arguments.push_back(declaration(argument));
  out_.open(dialect_.head(routine_, arguments));
  for (const Argument& argument : routine_.arguments) {
    const bool used = !argument.count.empty() || uses_object(routine_, argument.name);
    if (!dialect_.has_references() && !used) out_.line("(void)" + object(argument.name) + ";");
  }
  print(body);
  out_.close();
  out_.line();
  used_.functions.insert(cpp_.functions().begin(), cpp_.functions().end());
}

void RoutinePrinter::print(const written::Body& body) {
  for (const written::Statement& statement : body) {
    for (const std::string& line : statement.remark) out_.remark("// ", line);
    if (const std::optional<std::string> text = line(statement)) {
      out_.line(*text);
      continue;
    }
    std::visit(
        [this](const auto& node) {
          if constexpr (requires { node.lanes; }) {
            if (node.lanes > 0) set_lanes(node.range.index);
          }
          if constexpr (requires { node.shape; }) {
            print_inside(head(node), node.body, node.shape);
          } else if constexpr (requires { node.body; }) {
            print_inside(head(node), node.body, written::Shape::braces);
          }
          if constexpr (requires { node.lanes; }) {
            if (node.lanes > 0) set_lanes("");
          }
        },
        statement.value);
  }
}

void RoutinePrinter::print_inside(const std::string& head, const written::Body& body,
                                  written::Shape shape) {
  const bool simple = body.size() == 1 && body[0].remark.empty() && body[0].is_short;
  if (shape == written::Shape::fitting && simple) {
    const std::optional<std::string> text = line(body[0]);
    if (text && out_.fits(head + " " + *text + "\n")) return out_.lines(head + " " + *text);
  }
  out_.open(head);
  print(body);
  out_.close();
}

std::optional<std::string> RoutinePrinter::line(const written::Statement& statement) {
  return std::visit(
      [this](const auto& node) -> std::optional<std::string> {
        if constexpr (requires { node.shape; }) {
          if (node.shape != written::Shape::line) return {};
          const std::string begin = head(node);
          return begin + " " + line(node.body[0]).value();
        } else if constexpr (requires { node.body; }) {
          return {};
        } else {
          return line(node);
        }
      },
      statement.value);
}

std::string RoutinePrinter::line(const Declare& declare) {
  std::vector<std::string> names;
  for (const std::string& name : declare.objects) names.push_back(written::name_in_text(name));
  return fmt::format("{} {}{};", dialect_.type(declare.record), joined_texts(names, ", "),
                     dialect_.has_references() ? "" : " = {0}");
}

std::string RoutinePrinter::line(const written::Define& define) {
  const std::string text = value(define.value);
  const bool number = written::is_number(define);
  const std::string name = number && !written::is_of_text(define.name)
                               ? names_.local(define.name)
                               : written::name_in_text(define.name);
  return fmt::format("{}{} {}{} = {};", define.varies ? "" : "const ", dialect_.type(define.type),
                     name, sizes(define.sizes), text);
}

// x += value, or x -= what follows a minus, if that is one product.
std::string RoutinePrinter::line(const written::Set& set) {
  std::string text = value(set.value);
  const std::string to = value(set.to);
  const bool negative = set.sign == "+=" && text.starts_with('-') &&
                        text.find_first_of("+-(", 1) == std::string::npos;
  return fmt::format("{} {} {};", to, negative ? "-=" : set.sign, text.substr(negative ? 1 : 0));
}

// From 0 on as C++ has it.
std::string RoutinePrinter::head(const written::For& loop) {
  const KernelRange& range = loop.range;
  const bool counts = range.lower == AffineIndex{} && range.upper.factors.empty();
  const std::string next =
      loop.lanes > 0 ? fmt::format("{} += {}", range.index, loop.lanes) : "++" + range.index;
  if (counts) {
    return fmt::format("for (int {0} = 0; {0} < {1}; {2})", range.index,
                       count_text(range.upper.constant + 1), next);
  }
  return fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", range.index, text(range.lower),
                     text(range.upper));
}
std::string RoutinePrinter::head(const written::Loop& loop) {
  const std::string index = written::name_in_text(loop.index);
  const std::string until = loop.limit.empty() ? "" : fmt::format(" {} < {}", index, loop.limit);
  return fmt::format("for ({0} {1} = {2};{3}; ++{1})", loop.type, index, loop.first, until);
}
std::string RoutinePrinter::head(const written::While& /*loop*/) {
  return "for (bool more = true; more;)";
}
std::string RoutinePrinter::head(const written::Each& loop) {
  return fmt::format("for ({}& {} : {})", loop.type, loop.name, dialect_.kept(loop.name));
}

std::string RoutinePrinter::declaration(const Argument& argument) const {
  // C wants a name for every argument.
  const bool named =
      !dialect_.has_references() || !argument.count.empty() || uses_object(routine_, argument.name);
  return dialect_.argument(argument, named ? object(argument.name) : "", sizes(argument.sizes));
}

void print(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used) {
  RoutinePrinter(out, routine, dialect, used).print();
}

}  // namespace hamgen
