#include "generator/formats/print_code.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/routine_printer.hpp"

namespace hamgen {

namespace {

bool returns_report(const Instruction& instruction) {
  const auto* end = std::get_if<Return>(&instruction.value);
  return end != nullptr && !end->report.empty();
}

}  // namespace

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
  name_objects();
  reserve_arrays(routine.body);
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

bool RoutinePrinter::is_address(const std::string& object) const {
  return !dialect_.has_references() &&
         std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
           return argument.name == object && !argument.record.empty();
         });
}

std::string RoutinePrinter::of(const std::string& object_name) const {
  return object(object_name) + (is_address(object_name) ? "->" : ".");
}

std::string RoutinePrinter::value_of(const std::string& object_name) const {
  return (is_address(object_name) ? "*" : "") + object(object_name);
}

std::string RoutinePrinter::object(const std::string& name) const {
  if (name.starts_with("self.")) return dialect_.kept(name.substr(5));
  if (name.starts_with("new ")) return dialect_.empty_record(name.substr(4));
  const auto other = objects_.find(name);
  return other == objects_.end() ? name : other->second;
}

void RoutinePrinter::print() {
  for (const std::string& line : routine_.remark) out_.remark("// ", line);
  out_.open(signature());
  for (const Argument& argument : routine_.arguments) {
    const bool used = !argument.count.empty() || uses_object(routine_, argument.name);
    if (!dialect_.has_references() && !used) {
      out_.line("(void)" + object(argument.name) + ";");
    }
  }
  if (!routine_.result.object.empty()) {
    out_.line(dialect_.declaration(routine_.result.type, routine_.result.object));
  }
  print(routine_.body);
  const bool filled = !routine_.result.object.empty() && routine_.result.type != "StepReport";
  if (filled) out_.line("return " + routine_.result.object + ";");
  out_.close();
  out_.line();
  used_.functions.insert(cpp_.functions().begin(), cpp_.functions().end());
}

void RoutinePrinter::print(const Body& body) {
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

void RoutinePrinter::print_inside(const std::string& head, const Body& body) {
  const bool simple =
      body.size() == 1 && body[0].remark.empty() &&
      (std::holds_alternative<Assign>(body[0].value) ||
       std::holds_alternative<Accumulate>(body[0].value) ||
       std::holds_alternative<Put>(body[0].value) || std::holds_alternative<Call>(body[0].value) ||
       std::holds_alternative<Use>(body[0].value) || std::holds_alternative<Break>(body[0].value) ||
       returns_report(body[0]) || std::holds_alternative<Factorise>(body[0].value));
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

void RoutinePrinter::operator()(const Let& let) {
  const std::string value = cpp_(let.value);
  out_.line(fmt::format("{}{} {} = {};", let.varies || kept_.contains(let.symbol) ? "" : "const ",
                        lane_index_.empty() ? dialect_.real() : "Lanes", names_.local(let.symbol),
                        value));
}
void RoutinePrinter::operator()(const Array& array) {
  std::string sizes;
  for (const int size : array.sizes) sizes += "[" + count_text(size) + "]";
  std::vector<std::string> values;
  for (const Expression& e : array.values) values.push_back(cpp_(e));
  const std::string text =
      values.empty() ? dialect_.empty_array() : "{" + joined_texts(values, ", ") + "}";
  out_.line(fmt::format("{} {}{} = {};", dialect_.real(), array.name, sizes, text));
}
void RoutinePrinter::operator()(const Matrix& matrix) {
  if (matrix.patterned) return out_.line("Matrix " + matrix.name + ";");
  // Eigen knows neither quad numbers nor packs.
  const bool eigen = matrix.large && dialect_.scalar.digits != 113 && !dialect_.has_lanes();
  out_.line(fmt::format("{}<{}> {};", eigen ? "EigenDenseMatrix" : "DenseMatrix", matrix.size,
                        matrix.name));
}
void RoutinePrinter::operator()(const Copy& copy) {
  const std::string from =
      copy.from.empty() ? dialect_.empty_record(copy.record) : value_of(copy.from);
  const std::string to =
      copy.declares ? dialect_.record(copy.record) + " " + copy.to : value_of(copy.to);
  out_.line(to + " = " + from + ";");
}
void RoutinePrinter::operator()(const Assign& assign) {
  const std::string value = cpp_(assign.value);
  const auto place = routine_.places.find(assign.symbol);
  if (place != routine_.places.end() && is_pack(place->second))
    return out_.line(fmt::format("Lanes::put({}, {});", given(place->second), value));
  out_.line(fmt::format("{} = {};", name(assign.symbol), value));
}
void RoutinePrinter::operator()(const Collect& sum) {
  const std::string value = cpp_(sum.value);
  const char* by = dialect_.has_references() ? "" : "&";
  out_.line(fmt::format("{0}({1}{2}, {1}{3}, {4});", dialect_.block("collect"), by,
                        name(sum.symbol), name(sum.lost), value));
}
// target += value, or target -= what follows a minus, if that is one product.
void RoutinePrinter::operator()(const Accumulate& sum) {
  const std::string value = cpp_(sum.value);
  const auto place = routine_.places.find(sum.symbol);
  if (place != routine_.places.end() && is_pack(place->second))
    return out_.line(fmt::format("Lanes::add({}, {});", given(place->second), value));
  const bool negative =
      value.starts_with('-') && value.find_first_of("+-(", 1) == std::string::npos;
  out_.line(fmt::format("{} {}= {};", name(sum.symbol), negative ? '-' : '+',
                        value.substr(negative ? 1 : 0)));
}
void RoutinePrinter::operator()(const Clear& clear) { out_.line(text(clear.matrix) + ".clear();"); }
void RoutinePrinter::operator()(const Put& put) {
  const std::string value = cpp_(put.value);
  out_.line(
      fmt::format("{}.put({}, {}, {});", text(put.matrix), text(put.row), text(put.column), value));
}
void RoutinePrinter::operator()(const SetFlag& set) {
  out_.line(fmt::format("{} = {};", text(set.flag), set.value));
}
void RoutinePrinter::operator()(const For& loop) {
  if (loop.lanes == 0) return print_inside(head(loop.range), loop.body);
  lane_index_ = loop.range.index;
  cpp_.set_lanes(true);
  print_inside(head(loop.range, loop.lanes), loop.body);
  cpp_.set_lanes(false);
  lane_index_.clear();
}
void RoutinePrinter::operator()(const Scope& scope) {
  out_.open("");
  print(scope.body);
  out_.close();
}
void RoutinePrinter::operator()(const If& branch) {
  const std::string flag = branch.any ? "any(" + text(branch.flag) + ")" : text(branch.flag);
  print_inside(fmt::format("if ({}{}{})", branch.set ? "" : "!", flag,
                           branch.also ? " && " + text(*branch.also) : ""),
               branch.then);
}
void RoutinePrinter::operator()(const Alternate& alternate) {
  const std::string patience = text(alternate.patience);
  out_.open(fmt::format("if ({} == 0 && !{})", patience, call_text(alternate.first)));
  print(alternate.between);
  out_.line(fmt::format("{} = {};", patience, alternate.steps));
  out_.close();
  out_.open(fmt::format("if ({} > 0)", patience));
  out_.line("--" + patience + ";");
  out_.line(fmt::format("if (!{}) {}", call_text(alternate.second), failure()));
  out_.close();
}
void RoutinePrinter::operator()(const Factorise& factorise) {
  if (dialect_.has_lanes()) return factorise_lanes(factorise);
  const std::string condition = fmt::format("if (!{}.factorise())", text(factorise.matrix));
  if (!iterates_) return out_.line(condition + " " + failure());
  out_.open(condition);
  out_.line("report.iterations += iteration;");
  out_.line(failure());
  out_.close();
}
void RoutinePrinter::factorise_lanes(const Factorise& factorise) {
  const std::string regular = text(factorise.matrix) + ".factorise()";
  out_.line(iterates_ ? fmt::format("{}.require({});", rule_, regular)
                      : fmt::format("report.converged = report.converged & {};", regular));
}
void RoutinePrinter::operator()(const SolveFactorised& solve) {
  out_.line(fmt::format("{}.solve({});", text(solve.matrix), text(solve.vector)));
}
void RoutinePrinter::operator()(const Invert& invert) {
  out_.line(fmt::format("{0} = invert({1}, {2}) && {0};", text(invert.regular), invert.matrix,
                        text(invert.inverse)));
}
void RoutinePrinter::operator()(const Return& end) {
  if (end.value) return out_.line("return " + cpp_(*end.value) + ";");
  if (!end.report.empty()) return out_.line("return " + end.report + ";");
  if (!end.finite.empty()) length_of(end);
  const std::string success = end.finite.empty()
                                  ? fmt::format("{}", end.success)
                                  : fmt::format("length <= {}", dialect_.scalar.largest);
  if (routine_.result.type != "StepReport") return out_.line("return " + success + ";");
  if (end.success) {
    const bool lanes = dialect_.has_lanes();
    if (lanes && !end.finite.empty()) {
      out_.line("require_finite(report, length);");
    } else if (!lanes) {
      out_.line("report.converged = " + success + ";");
      if (!end.finite.empty()) out_.line("if (!report.converged) report.increment = length;");
    }
    // Of a lane that has failed nothing is asked any more.
    const char* known = lanes ? " = any(report.converged);" : " = report.converged;";
    if (end.flag) out_.line(text(*end.flag) + known);
  }
  out_.line("return report;");
}

std::string RoutinePrinter::failure() const {
  return routine_.result.type == "StepReport" ? "return report;" : "return false;";
}

std::string RoutinePrinter::count_text(long count) const {
  if (dialect_.n == 0 || count % dialect_.n != 0 || count > 2L * dialect_.n) {
    return std::to_string(count);
  }
  return count == dialect_.n ? "n" : count == 0 ? "0" : "2 * n";
}

bool RoutinePrinter::is_pack(const Place& place) const {
  return !lane_index_.empty() && !place.indices.empty() &&
         place.indices.back().factors.contains(lane_index_);
}

std::string RoutinePrinter::head(const KernelRange& range, int step) const {
  // From 0 on as C++ has it.
  const bool counts = range.lower == AffineIndex{} && range.upper.factors.empty();
  if (counts) {
    const std::string next =
        step == 1 ? "++" + range.index : fmt::format("{} += {}", range.index, step);
    return fmt::format("for (int {0} = 0; {0} < {1}; {2})", range.index,
                       count_text(range.upper.constant + 1), next);
  }
  return fmt::format("for (int {0} = {1}; {0} <= {2}; ++{0})", range.index, text(range.lower),
                     text(range.upper));
}

std::string RoutinePrinter::name(const std::string& symbol) {
  if (symbol == "pi") {
    used_.pi = true;
    return dialect_.constant("pi");
  }
  const auto place = routine_.places.find(symbol);
  if (place != routine_.places.end()) {
    if (is_pack(place->second)) return "Lanes::at(" + given(place->second) + ")";
    return text(place->second);
  }
  const bool number = std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
    return argument.name == symbol && argument.record.empty() && argument.sizes.empty();
  });
  return number ? symbol : names_.local(symbol);
}

std::string RoutinePrinter::text(const AffineIndex& a) const {
  std::string text;
  for (const auto& [index, factor] : a.factors) {
    text += text.empty() ? "" : " + ";
    text += factor == 1 ? index : fmt::format("{} * {}", factor, index);
  }
  if (text.empty()) return std::to_string(a.constant);
  if (dialect_.n > 0 && a.constant == dialect_.n) return "n + " + text;
  if (a.constant > 0) text += fmt::format(" + {}", a.constant);
  if (a.constant < 0) text += fmt::format(" - {}", -a.constant);
  return text;
}

std::string RoutinePrinter::text(const Place& place) const {
  if (place.object.empty()) return dialect_.number(text(place.indices.front()));
  if (place.object == "self") return dialect_.kept(place.field);
  std::string result = place.field.empty() ? object(place.object) : of(place.object) + place.field;
  for (const AffineIndex& index : place.indices) result += "[" + text(index) + "]";
  return result;
}

std::string RoutinePrinter::given(const Place& place) const {
  const bool ours = records_.contains(place.object) || place.object.starts_with("self.") ||
                    place.object.starts_with("new ");
  const bool record = place.field.empty() && ours;
  if (record && !dialect_.has_references()) return "&" + object(place.object);
  if (place.indices.empty()) return text(place);
  Place array = place;
  array.indices.pop_back();
  const AffineIndex& index = place.indices.back();
  const std::string offset = index.factors.empty() ? count_text(index.constant) : text(index);
  return text(array) + " + " + offset;
}

std::string RoutinePrinter::declaration(const Argument& argument) const {
  // C wants a name for every argument.
  const bool named =
      !dialect_.has_references() || !argument.count.empty() || uses_object(routine_, argument.name);
  const std::string name = named ? object(argument.name) : "";
  std::string sizes;
  for (const int size : argument.sizes) sizes += "[" + count_text(size) + "]";
  return dialect_.argument(argument, name, sizes);
}

std::string RoutinePrinter::signature() const {
  std::vector<std::string> list;
  for (const Argument& argument : routine_.arguments) list.push_back(declaration(argument));
  return dialect_.head(routine_, list);
}

void RoutinePrinter::reserve_arrays(const Body& body) {
  for (const Instruction& node : body) {
    if (const auto* array = std::get_if<Array>(&node.value)) names_.reserve(array->name);
    if (const auto* matrix = std::get_if<Matrix>(&node.value)) names_.reserve(matrix->name);
    if (const auto* copy = std::get_if<Copy>(&node.value)) {
      names_.reserve(copy->to);
      if (copy->declares) records_.insert(copy->to);
    }
    if (const auto* declare = std::get_if<Declare>(&node.value))
      records_.insert(declare->objects.begin(), declare->objects.end());
    if (const auto* call = std::get_if<Call>(&node.value)) {
      if (!call->object.empty() && call->record != "StepReport") records_.insert(call->object);
    }
    if (const auto* call = std::get_if<Call>(&node.value)) names_.reserve(call->object);
    if (const auto* loop = std::get_if<For>(&node.value)) names_.reserve(loop->range.index);
    if (const auto* refine = std::get_if<Refine>(&node.value)) {
      names_.reserve(refine->name);
      names_.reserve(kept_name(*refine));
    }
    for (const Body* inner : inner_bodies(node)) reserve_arrays(*inner);
  }
}

void print(CodeWriter& out, const Routine& routine, const Dialect& dialect, Used& used) {
  RoutinePrinter(out, routine, dialect, used).print();
}

}  // namespace hamgen
