#include "generator/formats/print_code.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/cpp_expression.hpp"
#include "generator/program/names.hpp"

namespace hamgen {

namespace {

std::string joined(const std::vector<std::string>& items, const char* separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

std::string magnitude(const std::string& x) {
  return "magnitude(" + (x.starts_with('-') ? x.substr(1) : x) + ")";
}

class RoutinePrinter {
 public:
  RoutinePrinter(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used)
      : out_(out),
        routine_(routine),
        dialect_(dialect),
        used_(used),
        cpp_(
            dialect.scalar, [this](const std::string& symbol) { return name(symbol); },
            dialect.builtins) {
    // What iterations declare.
    for (const char* local :
         {"size", "scale", "iteration", "verdict", "progress", "length", "increment", "sweep",
          "part", "i", "j", "rule", "more", "lack", "slope", "point"}) {
      names_.reserve(local);
    }
    for (const Argument& argument : routine.arguments) names_.reserve(argument.name);
    reserve_arrays(routine.body);
  }

  void print() {
    for (const std::string& line : routine_.remark) out_.remark("// ", line);
    if (std::ranges::find(routine_.arguments, "Put", &Argument::record) !=
        routine_.arguments.end()) {
      out_.line("template <class Put>");
    }
    out_.open(signature());
    if (!routine_.result.object.empty()) {
      out_.line(routine_.result.type + " " + routine_.result.object + ";");
    }
    print(routine_.body);
    const bool filled = !routine_.result.object.empty() && routine_.result.type != "StepReport";
    if (filled) out_.line("return " + routine_.result.object + ";");
    out_.close();
    out_.line();
    used_.functions.insert(cpp_.functions().begin(), cpp_.functions().end());
  }

  void operator()(const Let& let) {
    const std::string value = cpp_(let.value);
    out_.line(fmt::format("{}Real {} = {};",
                          let.varies || kept_.contains(let.symbol) ? "" : "const ",
                          names_.local(let.symbol), value));
  }
  void operator()(const Array& array) {
    std::string sizes;
    for (const int size : array.sizes) sizes += fmt::format("[{}]", size);
    std::vector<std::string> values;
    for (const Expression& e : array.values) values.push_back(cpp_(e));
    out_.line(fmt::format("Real {}{} = {{{}}};", array.name, sizes, joined(values, ", ")));
  }
  void operator()(const Assign& assign) {
    const std::string value = cpp_(assign.value);
    out_.line(fmt::format("{} = {};", name(assign.symbol), value));
  }
  void operator()(const Collect& sum) {
    const std::string value = cpp_(sum.value);
    out_.line(fmt::format("collect({}, {}, {});", name(sum.symbol), name(sum.lost), value));
  }
  // target += value, or target -= what follows a minus, if that is one product.
  void operator()(const Accumulate& sum) {
    const std::string value = cpp_(sum.value);
    const bool negative =
        value.starts_with('-') && value.find_first_of("+-(", 1) == std::string::npos;
    out_.line(fmt::format("{} {}= {};", name(sum.symbol), negative ? '-' : '+',
                          value.substr(negative ? 1 : 0)));
  }
  void operator()(const For& loop) { print_inside(head(loop.range), loop.body); }
  void operator()(const Scope& scope) {
    out_.open("");
    print(scope.body);
    out_.close();
  }
  void operator()(const If& branch) {
    print_inside(fmt::format("if ({}{})", branch.set ? "" : "!", text(branch.flag)), branch.then);
  }
  void operator()(const Call& call) {
    std::vector<std::string> arguments;
    for (const Place& place : call.arguments) arguments.push_back(given(place));
    out_.line(fmt::format("{}({});", call.routine, joined(arguments, ", ")));
  }
  void operator()(const Matrix& matrix) {
    // Eigen does not know quad numbers.
    const bool eigen = matrix.large && dialect_.scalar.digits != 113;
    out_.line(fmt::format("{}<{}> {};", eigen ? "EigenDenseMatrix" : "DenseMatrix", matrix.size,
                          matrix.name));
  }
  void operator()(const Copy& copy) {
    const std::string from = copy.from.empty() ? copy.record + "()" : copy.from;
    out_.line(fmt::format("{}{} = {};", copy.declares ? copy.record + " " : "", copy.to, from));
  }
  void operator()(const Put& put) {
    const std::string value = cpp_(put.value);
    out_.line(fmt::format("{}{}({}, {}, {});", put.matrix, is_put(put.matrix) ? "" : ".put",
                          text(put.row), text(put.column), value));
  }
  void operator()(const SetFlag& set) {
    out_.line(fmt::format("{} = {};", text(set.flag), set.value));
  }
  void operator()(const Factorise& factorise) {
    const std::string condition = fmt::format("if (!{}.factorise())", factorise.matrix);
    if (routine_.result.type != "StepReport") return out_.line(condition + " return false;");
    if (!iterates_) return out_.line(condition + " return report;");
    out_.open(condition);
    out_.line("report.iterations += iteration;");
    out_.line("return report;");
    out_.close();
  }
  void operator()(const SolveFactorised& solve) {
    out_.line(fmt::format("{}.solve({});", solve.matrix, solve.vector));
  }
  void operator()(const Invert& invert) {
    out_.line(fmt::format("{0} = invert({1}, {2}) && {0};", text(invert.regular), invert.matrix,
                          text(invert.inverse)));
  }
  void operator()(const Iterate& iterate) {
    for (const std::string& symbol : iterate.kept) {
      out_.line(fmt::format("Real {} = {};", names_.local(symbol), literal(0, dialect_.scalar)));
    }
    for (const Unknown& u : iterate.unknowns) {
      const std::string start = cpp_(u.start);
      out_.line(fmt::format("Real {} = start.known ? start.value[{}] : {};", names_.local(u.symbol),
                            u.memory, start));
    }
    kept_.insert(iterate.kept.begin(), iterate.kept.end());
    iterates_ = true;
    iterate.rule == Rule::newton ? newton(iterate) : fixed_point(iterate);
    iterates_ = false;
    for (const Unknown& u : iterate.unknowns) {
      std::string value = names_.local(u.symbol);
      if (iterate.rule == Rule::newton) value += " + " + cpp_(u.correction);
      out_.line(fmt::format("start.value[{}] = {};", u.memory, value));
    }
  }
  void operator()(const Refine& refine) {
    const std::string kept = kept_name(refine);
    const auto list = [&](const auto& items, const auto& item) {
      std::vector<std::string> texts;
      for (const auto& each : items) texts.push_back(item(each));
      return joined(texts, ", ");
    };
    out_.line(fmt::format("Refinement<{}, {}> {};", refine.unknowns.size(), refine.gradient.size(),
                          refine.name));
    if (!refine.kept.empty())
      out_.line(fmt::format("Real {}[{}] = {{}};", kept, refine.kept.size()));
    out_.open("for (bool more = true; more;)");
    print(refine.body);
    out_.line(fmt::format("const Real lack[{}] = {{{}}};", refine.unknowns.size(),
                          list(refine.unknowns, [&](const Unknown& u) {
                            return cpp_(u.correction - Expression::symbol(u.symbol));
                          })));
    out_.line(fmt::format("const Real slope[{}] = {{{}}};", refine.gradient.size(),
                          list(refine.gradient, [&](const Expression& e) { return cpp_(e); })));
    if (!refine.kept.empty()) {
      out_.open(fmt::format("if ({}.rounds == 0)", refine.name));
      for (std::size_t j = 0; j < refine.kept.size(); ++j) {
        out_.line(fmt::format("{}[{}] = {};", kept, j, names_.local(refine.kept[j])));
      }
      out_.close();
    }
    out_.line(fmt::format(
        "Real point[{}] = {{{}}};", refine.unknowns.size(),
        list(refine.unknowns, [&](const Unknown& u) { return names_.local(u.symbol); })));
    out_.line(fmt::format("more = {}(point, lack, slope);", refine.name));
    for (std::size_t j = 0; j < refine.unknowns.size(); ++j) {
      out_.line(fmt::format("{} = point[{}];", names_.local(refine.unknowns[j].symbol), j));
    }
    out_.close();
    for (std::size_t j = 0; j < refine.kept.size(); ++j) {
      out_.line(fmt::format("{} = {}[{}];", names_.local(refine.kept[j]), kept, j));
    }
  }
  void operator()(const Sweep& sweep) {
    for (const Unknown& u : sweep.unknowns) {
      const std::string start = cpp_(u.start);
      out_.line(fmt::format("Real {} = {};", names_.local(u.symbol), start));
    }
    out_.open(fmt::format("for (int sweep = 0; sweep < {}; ++sweep)", sweep.count));
    print(sweep.body);
    std::vector<std::string> next;
    for (const Unknown& u : sweep.unknowns) {
      const std::string value = cpp_(u.correction);
      next.push_back(names_.unique(names_.local(u.symbol) + "_next"));
      out_.line(fmt::format("const Real {} = {};", next.back(), value));
    }
    for (std::size_t j = 0; j < next.size(); ++j) {
      out_.line(fmt::format("{} = {};", names_.local(sweep.unknowns[j].symbol), next[j]));
    }
    out_.close();
    for (std::size_t j = 0; j < sweep.results.size(); ++j) {
      out_.line(fmt::format("const Real {} = {};", names_.local(sweep.results[j]),
                            names_.local(sweep.unknowns[j].symbol)));
    }
    out_.line(fmt::format("report.iterations = {};", sweep.count));
  }
  void operator()(const Return& end) {
    if (end.value) return out_.line("return " + cpp_(*end.value) + ";");
    if (!end.finite.empty()) length_of(end);
    const std::string success = end.finite.empty()
                                    ? fmt::format("{}", end.success)
                                    : fmt::format("length <= {}", dialect_.scalar.largest);
    if (routine_.result.type != "StepReport") return out_.line("return " + success + ";");
    if (end.success) {
      out_.line("report.converged = " + success + ";");
      if (!end.finite.empty()) out_.line("if (!report.converged) report.increment = length;");
      if (end.flag) out_.line(text(*end.flag) + " = report.converged;");
    }
    out_.line("return report;");
  }

 private:
  void print(const Body& body) {
    for (const Instruction& node : body) {
      // What an iteration declares stands above its comment.
      const auto* iterate = std::get_if<Iterate>(&node.value);
      if (iterate == nullptr) {
        for (const std::string& line : node.remark) out_.remark("// ", line);
      } else {
        remark_ = &node.remark;
      }
      const auto* let = std::get_if<Let>(&node.value);
      if (let != nullptr && kept_.contains(let->symbol)) {
        (*this)(Assign{let->symbol, let->value});
      } else {
        std::visit(*this, node.value);
      }
    }
  }

  // A single statement on the line of its head, if that has room for it.
  void print_inside(const std::string& head, const Body& body) {
    const bool simple = body.size() == 1 && body[0].remark.empty() &&
                        (std::holds_alternative<Assign>(body[0].value) ||
                         std::holds_alternative<Accumulate>(body[0].value) ||
                         std::holds_alternative<Call>(body[0].value) ||
                         std::holds_alternative<Factorise>(body[0].value));
    if (simple) {
      CodeWriter line;
      std::swap(line, out_);
      print(body);
      std::swap(line, out_);
      const std::string& text = line.text();
      if (std::ranges::count(text, '\n') == 1 && out_.fits(head + " " + text)) {
        return out_.lines(head + " " + text);
      }
    }
    out_.open(head);
    print(body);
    out_.close();
  }

  // Where the values of the body at the rounded unknowns wait: kept_0 beside refinement_0.
  [[nodiscard]] static std::string kept_name(const Refine& refine) {
    return "kept" + refine.name.substr(refine.name.rfind('_'));
  }

  void newton(const Iterate& iterate) {
    const std::string rule = "start." + iterate.name;
    for (const std::string& line : *remark_) out_.remark("// ", line);
    out_.line(rule + ".begin();");
    out_.open("for (int iteration = 1;; ++iteration)");
    print(iterate.body);
    std::vector<std::string> corrections;
    std::vector<std::string> sizes;
    for (const Unknown& u : iterate.unknowns) {
      corrections.push_back(cpp_(u.correction));
      sizes.push_back(magnitude(corrections.back()));
    }
    out_.line("const Real size = " + joined(sizes, " + ") + ";");
    out_.line("const Real scale = " + scale(iterate) + ";");
    out_.line(fmt::format("const Verdict verdict = {}(size, scale, iteration);", rule));
    out_.open("if (verdict == Verdict::failed)");
    out_.line("report.iterations += iteration;");
    out_.line("report.increment = size;");
    out_.line("return report;");
    out_.close();
    out_.open("if (verdict == Verdict::done)");
    out_.line("report.iterations += iteration;");
    out_.line("break;");
    out_.close();
    for (std::size_t j = 0; j < corrections.size(); ++j) {
      out_.line(fmt::format("{} += {};", names_.local(iterate.unknowns[j].symbol), corrections[j]));
    }
    out_.close();
  }

  void fixed_point(const Iterate& iterate) {
    const std::size_t m = iterate.unknowns.size();
    out_.line(fmt::format("FixedPointRule<{}, 2> {};", m, iterate.name));
    out_.open("for (int iteration = 1;; ++iteration)");
    print(iterate.body);
    std::vector<std::string> values;
    std::vector<std::string> lengths;
    std::vector<std::string> parts;
    for (const Unknown& u : iterate.unknowns) {
      values.push_back(cpp_(u.correction - Expression::symbol(u.symbol)));
      lengths.push_back(length(u));
      parts.push_back(fmt::format("length[{}]", parts.size()));
    }
    out_.line(fmt::format("const Real increment[{}] = {{{}}};", m, joined(values, ", ")));
    out_.line(fmt::format("const Real length[{}] = {{{}}};", m, joined(lengths, ", ")));
    out_.line("const Real scale = " + joined(parts, " + ") + ";");
    for (std::size_t j = 0; j < m; ++j) {
      out_.line(fmt::format("{} += increment[{}];", names_.local(iterate.unknowns[j].symbol), j));
    }
    out_.line("const Verdict verdict = " + iterate.name + "(increment, length, scale, iteration);");
    out_.line("if (verdict == Verdict::go_on && " + iterate.name +
              ".size > 64 * epsilon * scale) continue;");
    out_.line("report.iterations += iteration;");
    out_.line("if (verdict != Verdict::failed) break;");
    out_.line("report.increment = " + iterate.name + ".size;");
    out_.line("return report;");
    out_.close();
  }

  // The sum of the squares of what should be finite.
  void length_of(const Return& end) {
    std::vector<std::string> squares;
    for (const std::string& symbol : end.finite) {
      squares.push_back(fmt::format("{0} * {0}", name(symbol)));
    }
    const std::string sum = joined(squares, " + ");
    if (!end.ranges.empty()) {
      out_.line("Real length = 0;");
      for (std::size_t i = 0; i + 1 < end.ranges.size(); ++i) out_.open(head(end.ranges[i]));
      out_.line(head(end.ranges.back()) + " length += " + sum + ";");
      for (std::size_t i = 0; i + 1 < end.ranges.size(); ++i) out_.close();
    }
    out_.line("// False for infinities and NaN alike.");
    if (end.ranges.empty()) out_.line("const Real length = " + sum + ";");
  }

  [[nodiscard]] std::string head(const KernelRange& range) const {
    // From 0 on as C++ has it.
    const bool counts = range.lower == AffineIndex{} && range.upper.factors.empty();
    if (counts) {
      const long count = range.upper.constant + 1;
      return fmt::format("for (int {0} = 0; {0} < {1}; ++{0})", range.index,
                         count == dialect_.n ? "n" : std::to_string(count));
    }
    return fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", range.index, text(range.lower),
                       text(range.upper));
  }

  // What an unknown is rounded with.
  [[nodiscard]] std::string length(const Unknown& u) {
    return magnitude(names_.local(u.symbol)) + " + " + magnitude(cpp_(u.start));
  }
  [[nodiscard]] std::string scale(const Iterate& iterate) {
    std::vector<std::string> parts;
    for (const Unknown& u : iterate.unknowns) parts.push_back(length(u));
    return joined(parts, " + ");
  }

  std::string name(const std::string& symbol) {
    if (symbol == "pi") {
      used_.pi = true;
      return "pi";
    }
    const auto place = routine_.places.find(symbol);
    if (place != routine_.places.end()) return text(place->second);
    const bool number = std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
      return argument.name == symbol && argument.record.empty() && argument.sizes.empty();
    });
    return number ? symbol : names_.local(symbol);
  }

  [[nodiscard]] static std::string text(const AffineIndex& a) {
    std::string text;
    for (const auto& [index, factor] : a.factors) {
      text += text.empty() ? "" : " + ";
      text += factor == 1 ? index : fmt::format("{} * {}", factor, index);
    }
    if (text.empty()) return std::to_string(a.constant);
    if (a.constant > 0) text += fmt::format(" + {}", a.constant);
    if (a.constant < 0) text += fmt::format(" - {}", -a.constant);
    return text;
  }
  // Is it what takes the entries of a matrix?
  [[nodiscard]] bool is_put(const std::string& object) const {
    return std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
      return argument.name == object && argument.record == "Put";
    });
  }

  // An argument of a call: of an element, the array from there on.
  [[nodiscard]] static std::string given(const Place& place) {
    if (place.indices.empty()) return text(place);
    return text(Place{place.object, place.field}) + " + " + text(place.indices.front());
  }
  [[nodiscard]] static std::string text(const Place& place) {
    if (place.object.empty()) return "Real(" + text(place.indices.front()) + ")";
    std::string result = place.object + (place.field.empty() ? "" : "." + place.field);
    for (const AffineIndex& index : place.indices) result += "[" + text(index) + "]";
    return result;
  }

  [[nodiscard]] std::string declaration(const Argument& argument) const {
    const std::string name = uses_object(routine_, argument.name) ? argument.name : "";
    const std::string constant = argument.changes ? "" : "const ";
    const std::string type = argument.record.empty() ? "Real" : argument.record;
    if (argument.sizes.empty() && argument.record.empty()) {
      return name.empty() ? "Real" : "Real " + name;
    }
    const std::string named = name.empty() ? "" : " " + name;
    if (argument.record == "Put") return "Put" + named;
    if (argument.decays) return constant + "Real*" + named;
    if (argument.sizes.empty()) return constant + type + "&" + named;
    std::string text = constant + type + " (&" + name + ")";
    for (const int size : argument.sizes) text += fmt::format("[{}]", size);
    return text;
  }

  [[nodiscard]] std::string signature() const {
    std::vector<std::string> list;
    for (const Argument& argument : routine_.arguments) list.push_back(declaration(argument));
    const std::string type = routine_.result.type.empty() ? "void" : routine_.result.type;
    return fmt::format("{}inline {} {}({})", type == "StepReport" ? "[[nodiscard]] " : "", type,
                       routine_.name, joined(list, ", "));
  }

  void reserve_arrays(const Body& body) {
    for (const Instruction& node : body) {
      if (const auto* array = std::get_if<Array>(&node.value)) names_.reserve(array->name);
      if (const auto* matrix = std::get_if<Matrix>(&node.value)) names_.reserve(matrix->name);
      if (const auto* copy = std::get_if<Copy>(&node.value)) names_.reserve(copy->to);
      if (const auto* loop = std::get_if<For>(&node.value)) names_.reserve(loop->range.index);
      if (const auto* refine = std::get_if<Refine>(&node.value)) {
        names_.reserve(refine->name);
        names_.reserve(kept_name(*refine));
      }
      for (const Body* inner : inner_bodies(node)) reserve_arrays(*inner);
    }
  }

  CodeWriter& out_;
  const Routine& routine_;
  const Dialect& dialect_;
  Used& used_;
  Names names_;
  CppExpression cpp_;
  std::set<std::string> kept_;  // locals that an iteration changes
  bool iterates_ = false;
  const std::vector<std::string>* remark_ = nullptr;
};

}  // namespace

void print(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used) {
  RoutinePrinter(out, routine, dialect, used).print();
}

}  // namespace hamgen
