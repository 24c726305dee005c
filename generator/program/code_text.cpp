// Routines as text: what `hamgen show --stage program` prints.
#include <fmt/format.h>

#include "generator/program/code.hpp"

namespace hamgen {

namespace {

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text;
}

std::string list_of(const std::vector<Expression>& values) {
  std::string text;
  for (const Expression& e : values) text += (text.empty() ? "" : ", ") + to_text(e);
  return text;
}

std::string list_of(const std::vector<Place>& places) {
  std::vector<std::string> items;
  for (const Place& place : places)
    items.push_back(place.object.empty() ? to_text(place.indices.front()) : to_text(place));
  return list_of(items);
}

class Printer {
 public:
  explicit Printer(std::string& text, bool origins = false) : text_(text), origins_(origins) {}

  void print(const Body& body) {
    for (const Instruction& node : body) {
      if (origins_) margin_ = fmt::format("{:<22}|", origin_text(node.origin));
      std::visit(*this, node.value);
    }
  }

  void operator()(const Let& let) {
    line(fmt::format("{}{} = {}", let.varies ? "variable " : "", let.symbol, to_text(let.value)));
  }
  void operator()(const Array& array) {
    std::string sizes;
    for (const int size : array.sizes) sizes += fmt::format("[{}]", size);
    line(fmt::format("array {}{} = {}", array.name, sizes,
                     array.values.empty() ? "0" : list_of(array.values)));
  }
  void operator()(const Matrix& matrix) {
    line(fmt::format("{}matrix {}[{}][{}] = 0", matrix.symmetric ? "symmetric " : "", matrix.name,
                     matrix.size, matrix.size));
  }
  void operator()(const Copy& copy) {
    line(fmt::format("{} <- {}", copy.to, copy.from.empty() ? "new " + copy.record : copy.from));
  }
  void operator()(const Clear& clear) { line(to_text(clear.matrix) + " <- 0"); }
  void operator()(const Put& put) {
    line(fmt::format("{}[{}][{}] += {}", to_text(put.matrix), to_text(put.row), to_text(put.column),
                     to_text(put.value)));
  }
  void operator()(const SetFlag& set) {
    line(fmt::format("{} <- {}", to_text(set.flag), set.value));
  }
  void operator()(const Invert& invert) {
    line(fmt::format("{} <- inverse of {}, {} if there is one", to_text(invert.inverse),
                     invert.matrix, to_text(invert.regular)));
  }
  void operator()(const Assign& assign) {
    line(fmt::format("{} <- {}", assign.symbol, to_text(assign.value)));
  }
  void operator()(const Collect& sum) {
    line(fmt::format("{}, {} += {}", sum.symbol, sum.lost, to_text(sum.value)));
  }
  void operator()(const CollectStages& sum) {
    line(fmt::format("{}, {} <- sum of {} from {} and {} on, {} at once", sum.symbol, sum.lost,
                     sum.count, to_text(sum.in("slope")), to_text(sum.in("change")), sum.lanes));
  }
  void operator()(const Accumulate& sum) {
    line(fmt::format("{} += {}", sum.symbol, to_text(sum.value)));
  }
  void operator()(const For& loop) {
    const std::string at_once = loop.lanes > 0 ? fmt::format(", {} at once", loop.lanes) : "";
    line(fmt::format("for {} = {}..{}{}:", loop.range.index, to_text(loop.range.lower),
                     to_text(loop.range.upper), at_once));
    inside(loop.body);
  }
  void operator()(const Scope& scope) {
    line("scope:");
    inside(scope.body);
  }
  void operator()(const If& branch) {
    line(fmt::format("if {}{}{}:", branch.set ? "" : "not ", to_text(branch.flag),
                     branch.also ? " and " + to_text(*branch.also) : ""));
    inside(branch.then);
  }
  void operator()(const Call& call) {
    line(fmt::format("{}{}({})", call.object.empty() ? "" : call.object + " <- ", call.routine,
                     list_of(call.arguments)));
  }
  void operator()(const Use& use) {
    const std::string action = use.action.empty() ? "" : "." + use.action;
    line(fmt::format("{}{}({})", use.block, action, list_of(use.arguments)));
  }
  void operator()(const Declare& declare) {
    line(fmt::format("new {}: {}", declare.record, list_of(declare.objects)));
  }
  void operator()(const Note& note) { line(fmt::format("{} = {}", note.name, to_text(note.from))); }
  void operator()(const Count& count) {
    line(fmt::format("{} += {}", to_text(count.count), count.by ? to_text(*count.by) : "1"));
  }
  void operator()(const Ask& ask) {
    line(fmt::format("{} <- {} > 0", to_text(ask.flag), to_text(ask.count)));
  }
  void operator()(const Forget& forget) {
    const bool number = forget.type == "int" || forget.type == "bool";
    line(fmt::format("{}{} <- {}", forget.each > 0 ? "each " : "", to_text(forget.what),
                     number ? "0" : "new " + forget.type));
  }
  void operator()(const Repeat& repeat) {
    line(fmt::format("{} times:", repeat.times));
    inside(repeat.body);
  }
  void operator()(const Break&) { line("break"); }
  void operator()(const RequireFinite& finite) {
    line(fmt::format("{} if finite: {}", finite.report, list_of(finite.numbers)));
  }
  void operator()(const Alternate& alternate) {
    line("try:");
    inside(alternate.before);
    inside({{alternate.first}});
    line(fmt::format("else, for {} steps:", alternate.steps));
    inside(alternate.between);
    inside({{alternate.second}});
  }
  void operator()(const Factorise& factorise) {
    line(fmt::format("{}factorise {}", factorise.compared > 0 ? "compare, " : "",
                     to_text(factorise.matrix)));
  }
  void operator()(const SolveFactorised& solve) {
    line(fmt::format("solve {} x = {}", to_text(solve.matrix), to_text(solve.vector)));
  }
  void operator()(const Iterate& iterate) {
    line(rule_text(iterate.rule));
    inside(iterate.body);
    unknowns(iterate.unknowns, iterate.rule == Rule::newton ? "correct" : "next");
  }
  void operator()(const IterateArray& iterate) {
    line(rule_text(iterate.rule));
    inside(iterate.body);
    ++depth_;
    for (const UnknownArray& u : iterate.unknowns) {
      line(fmt::format("correct {} by {}, beside {}", u.value, u.increment, to_text(u.beside)));
    }
    --depth_;
  }
  void operator()(const RefineArray& refine) {
    line(fmt::format("refine the fixed point {}, {}:", to_text(refine.point),
                     to_text(refine.refinement)));
    if (!refine.first.empty()) {
      inside(refine.first);
    }
    if (refine.begun || !refine.first.empty()) line("then, where it has been moved:");
    inside(refine.body);
    rounded_beside(refine.beside);
    if (refine.gives_up) line("fail where it contracts slowly");
    if (refine.patience) {
      line(fmt::format("where it is not found, {} = {}", to_text(*refine.patience), refine.steps));
    }
  }
  void operator()(const Refine& refine) {
    line(fmt::format("refine the fixed point, {}:", refine.name));
    inside(refine.body);
    rounded_beside(refine.beside);
    unknowns(refine.unknowns, "next");
  }
  void operator()(const Sweep& sweep) {
    line(fmt::format("{} sweeps:", sweep.count));
    inside(sweep.body);
    unknowns(sweep.unknowns, "next");
  }
  void operator()(const Return& end) {
    std::string text = "return";
    if (end.value) text += " " + to_text(*end.value);
    if (!end.report.empty()) text += " " + end.report;
    if (!end.value && end.report.empty()) text += end.success ? " success" : " failure";
    if (!end.finite.empty()) text += " if finite: " + list_of(end.finite);
    line(text);
  }

 private:
  static const char* rule_text(Rule rule) {
    switch (rule) {
      case Rule::newton:
        return "iterate with Newton's rule:";
      case Rule::simplified_newton:
        return "iterate with Newton's rule, the matrix of an earlier step:";
      case Rule::linear:
        return "solve linear equations for what they lack:";
      case Rule::fixed_point:
        break;
    }
    return "iterate to the fixed point:";
  }
  static std::string origin_text(const Origin& origin) {
    std::string text;
    switch (origin.when) {
      case When::called:
        break;
      case When::run:
        text = "run";
        break;
      case When::step_size:
        text = "step size";
        break;
      case When::step:
        text = "step";
        break;
      case When::iteration:
        text = "iteration";
        break;
    }
    if (origin.terms.empty()) return text;
    text = fmt::format("{:<10}H", text);
    for (const int term : origin.terms) text += fmt::format(" {}", term + 1);
    return text;
  }
  void line(const std::string& text) {
    text_ += margin_;
    if (origins_) margin_ = fmt::format("{:<22}|", "");
    text_.append(static_cast<std::size_t>(2 * depth_), ' ');
    text_ += text + '\n';
  }
  void inside(const Body& body) {
    ++depth_;
    print(body);
    --depth_;
  }
  void rounded_beside(const Expression& length) {
    if (!length.is_zero()) line("rounded beside " + to_text(length));
  }
  void unknowns(const std::vector<Unknown>& unknowns, const char* what) {
    ++depth_;
    for (const Unknown& u : unknowns) {
      const std::string beside =
          u.beside == u.start ? "" : fmt::format(", beside {}", to_text(u.beside));
      line(fmt::format("{} {} by {}, from {}{}", what, u.symbol, to_text(u.correction),
                       to_text(u.start), beside));
    }
    --depth_;
  }

  std::string& text_;
  bool origins_;
  std::string margin_;
  int depth_ = 1;
};

std::string routine_text(const Routine& routine, bool origins) {
  std::vector<std::string> arguments;
  for (const Argument& argument : routine.arguments) {
    arguments.push_back((argument.changes ? "&" : "") + argument.name);
  }
  std::string text = fmt::format("{}({}):\n", routine.name, list_of(arguments));
  Printer(text, origins).print(routine.body);
  return text;
}

}  // namespace

std::string to_text(const Place& place) {
  std::string text = place.object + (place.field.empty() ? "" : "." + place.field);
  for (const AffineIndex& index : place.indices) text += "[" + to_text(index) + "]";
  return text;
}

std::string to_text(const Record& record) {
  std::string text = "record " + record.name + ":\n";
  for (const Field& field : record.fields) {
    std::string line = "  " + field.name;
    for (const int size : field.sizes) line += fmt::format("[{}]", size);
    if (field.type != "Real") line += ": " + field.type;
    if (!field.remark.empty()) line += "  (" + field.remark + ")";
    text += line + "\n";
  }
  return text;
}

std::string to_text(const Routine& routine) { return routine_text(routine, false); }
std::string text_with_origins(const Routine& routine) { return routine_text(routine, true); }

}  // namespace hamgen
