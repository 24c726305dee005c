// What an instruction looks like.
#include "generator/program/written_code.hpp"

#include <fmt/format.h>

#include "generator/program/written_routine.hpp"

namespace hamgen::written {

namespace {

// May it stand on the line of a head?
bool is_short(const Instruction& instruction) {
  const auto& value = instruction.value;
  const auto* end = std::get_if<hamgen::Return>(&value);
  return std::holds_alternative<Assign>(value) || std::holds_alternative<Accumulate>(value) ||
         std::holds_alternative<Put>(value) || std::holds_alternative<Call>(value) ||
         std::holds_alternative<Use>(value) || std::holds_alternative<Break>(value) ||
         std::holds_alternative<Factorise>(value) || (end != nullptr && !end->report.empty());
}

}  // namespace

Body body_of(const Routine& routine, const Form& form) {
  return RoutineWriter(routine, form).run();
}

const Body* inner_body(const Statement& statement) {
  return std::visit(
      [](const auto& node) -> const Body* {
        if constexpr (requires { node.body; }) return &node.body;
        return nullptr;
      },
      statement.value);
}

Body RoutineWriter::run() {
  const Result& result = routine_.result;
  if (!result.object.empty()) add(Declare{result.type, {result.object}});
  write(routine_.body);
  const bool filled = !result.object.empty() && result.type != "StepReport";
  if (filled) add(Return{object({result.object})});
  return std::move(body_);
}

void RoutineWriter::write(const hamgen::Body& body) {
  for (const Instruction& node : body) {
    const std::size_t first = body_.size();
    remark_ = &node.remark;
    const auto* let = std::get_if<Let>(&node.value);
    if (let != nullptr && kept_.contains(let->symbol)) {
      (*this)(Assign{let->symbol, let->value});
    } else {
      std::visit(*this, node.value);
    }
    if (body_.size() == first) continue;
    Statement& begin = body_[first];
    begin.is_short = body_.size() == first + 1 && is_short(node);
    // What an iteration declares stands above its comment.
    if (!std::holds_alternative<Iterate>(node.value))
      begin.remark.insert(begin.remark.begin(), node.remark.begin(), node.remark.end());
  }
}

Body RoutineWriter::inside(const Lines& lines) {
  Body outer;
  std::swap(outer, body_);
  lines();
  std::swap(outer, body_);
  return outer;
}

void RoutineWriter::over(const std::vector<KernelRange>& ranges, const Lines& lines,
                         Shape innermost, std::size_t depth) {
  if (depth == ranges.size()) return lines();
  Body body = inside([&] { over(ranges, lines, innermost, depth + 1); });
  const bool last = depth + 1 == ranges.size();
  add(For{ranges[depth], std::move(body), last ? innermost : Shape::braces});
}

void RoutineWriter::fail() {
  add(Return{routine_.result.type == "StepReport" ? object({"report"}) : word("false")});
}

void RoutineWriter::operator()(const Let& let) {
  add(Define{"Real", let.symbol, formula(let.value), let.varies});
}
void RoutineWriter::operator()(const Array& array) {
  Value values{.kind = Value::Kind::list};
  for (const Expression& e : array.values) values.parts.push_back(formula(e));
  add(Define{"Real", array.name, std::move(values), true, array.sizes});
}
void RoutineWriter::operator()(const Matrix& matrix) {
  const char* dense = matrix.large && form_.eigen ? "EigenDenseMatrix" : "DenseMatrix";
  add(Declare{matrix.patterned ? "Matrix" : fmt::format("{}<{}>", dense, matrix.size),
              {matrix.name}});
}
void RoutineWriter::operator()(const Copy& copy) {
  Value from = at({copy.from});
  if (copy.from.empty()) from = {.kind = Value::Kind::zeros, .text = copy.record};
  if (!copy.declares) return set(at({copy.to}), std::move(from));
  add(Define{copy.record, copy.to, std::move(from), true});
}
void RoutineWriter::operator()(const Assign& assign) {
  set(symbol(assign.symbol), formula(assign.value));
}
void RoutineWriter::operator()(const Collect& sum) {
  Value collect = call("collect", {symbol(sum.symbol), symbol(sum.lost), formula(sum.value)});
  collect.changed = 2;
  add(Do{std::move(collect)});
}
void RoutineWriter::operator()(const Accumulate& sum) {
  set(symbol(sum.symbol), formula(sum.value), "+=");
}
void RoutineWriter::operator()(const Clear& clear) {
  add(Do{action("Matrix", clear.matrix, "clear")});
}
void RoutineWriter::operator()(const Put& put) {
  add(Do{action("Matrix", put.matrix, "put",
                {index(put.row), index(put.column), formula(put.value)})});
}
void RoutineWriter::operator()(const SetFlag& flag) {
  set(at(flag.flag), word(flag.value ? "true" : "false"));
}
void RoutineWriter::operator()(const hamgen::For& loop) {
  add(For{loop.range, inside(loop.body), Shape::fitting});
}
void RoutineWriter::operator()(const Scope& scope) { add(Block{inside(scope.body)}); }
void RoutineWriter::operator()(const hamgen::If& node) {
  Value condition = node.any ? call("any", {object(node.flag)}) : at(node.flag);
  if (!node.set) condition = prefix("!", std::move(condition));
  if (node.also) condition = joined("&&", {std::move(condition), at(*node.also)});
  branch(std::move(condition), Shape::fitting, [&] { write(node.then); });
}

Value RoutineWriter::called(const Call& call) {
  const Value::Kind kind = call.of_run ? Value::Kind::of_run : Value::Kind::routine;
  Value result{.kind = kind, .text = call.routine};
  for (const Place& place : call.arguments) result.parts.push_back(at(place, Value::Kind::given));
  return result;
}

void RoutineWriter::operator()(const Call& call) {
  Value value = called(call);
  if (call.must_succeed) {
    if (call.record == "StepReport")
      value = with_parts(Value::Kind::member, "converged", {std::move(value)});
    return branch(prefix("!", std::move(value)), Shape::line, [this] { fail(); });
  }
  if (call.object.empty()) {
    if (!call.record.empty()) value = with_parts(Value::Kind::unused, "", {std::move(value)});
    add(Do{std::move(value)});
  } else if (call.again) {
    set(object({call.object}), std::move(value));
  } else {
    add(Define{call.record, call.object, std::move(value), call.varies});
  }
}

void RoutineWriter::operator()(const Alternate& node) {
  const Value patience = at(node.patience);
  branch(joined("&&", {joined("==", {patience, integer(0)}), prefix("!", called(node.first))}),
         Shape::braces, [&] {
           write(node.between);
           set(patience, integer(node.steps));
         });
  branch(joined(">", {patience, integer(0)}), Shape::braces, [&] {
    add(Do{prefix("--", patience)});
    branch(prefix("!", called(node.second)), Shape::line, [this] { fail(); });
  });
}

void RoutineWriter::operator()(const Factorise& node) {
  Value regular = action("Matrix", node.matrix, "factorise");
  if (form_.lanes) {
    if (iterates_) return void(add(Do{action("NewtonRule", rule_, "require", {regular})}));
    const Value converged = at({"report", "converged"});
    return set(converged, joined("&", {converged, std::move(regular)}));
  }
  branch(prefix("!", std::move(regular)), iterates_ ? Shape::braces : Shape::line, [this] {
    if (iterates_) count_iterations();
    fail();
  });
}
void RoutineWriter::operator()(const SolveFactorised& solve) {
  add(Do{action("Matrix", solve.matrix, "solve", {object(solve.vector)})});
}
void RoutineWriter::operator()(const Invert& node) {
  Value inverse = call("invert", {object({node.matrix}), object(node.inverse)});
  set(at(node.regular), joined("&&", {std::move(inverse), at(node.regular)}));
}

void RoutineWriter::length_of(const hamgen::Return& end) {
  static const std::vector<std::string> remark = {"False for infinities and NaN alike."};
  std::vector<Value> squares;
  if (!form_.lanes) {
    for (const Place& array : finite_arrays(routine_, end))
      squares.push_back(call("squares_of", {object(array)}));
  }
  const bool whole = !squares.empty();
  for (std::size_t i = 0; i < end.finite.size() && !whole; ++i)
    squares.push_back(joined("*", {symbol(end.finite[i]), symbol(end.finite[i])}));
  Value sum = joined("+", std::move(squares));
  if (end.ranges.empty() || whole) {
    Statement& defined = add(Define{"Real", "length ", std::move(sum)});
    if (!form_.lanes) defined.remark = remark;
    return;
  }
  add(Define{"Real", "length ", integer(0), true});
  over(
      end.ranges, [&] { set(at({"length "}), std::move(sum), "+="); }, Shape::line);
}

void RoutineWriter::operator()(const hamgen::Return& end) {
  if (end.value) return void(add(Return{formula(*end.value)}));
  if (!end.report.empty()) return void(add(Return{object({end.report})}));
  if (!end.finite.empty()) length_of(end);
  const std::size_t first = body_.size();
  Value success = word(end.success ? "true" : "false");
  if (!end.finite.empty()) success = joined("<=", {at({"length "}), word("largest")});
  if (routine_.result.type == "StepReport") {
    if (end.success) report_success(end, success);
    add(Return{object({"report"})});
  } else {
    add(Return{std::move(success)});
  }
  const bool loops = !end.finite.empty() && std::holds_alternative<For>(body_[first - 1].value);
  if (loops && !form_.lanes) body_[first].remark = {"False for infinities and NaN alike."};
}

void RoutineWriter::report_success(const hamgen::Return& end, const Value& success) {
  const Value converged = at({"report", "converged"});
  if (form_.lanes && !end.finite.empty())
    add(Do{call("require_finite", {object({"report"}), at({"length "})})});
  if (!form_.lanes) {
    set(converged, success);
    if (!end.finite.empty()) {
      branch(prefix("!", converged), Shape::line, [this] {
        set(at({"report", "increment"}), at({"length "}));
      });
    }
  }
  // Of a lane that has failed nothing is asked any more.
  if (end.flag) set(at(*end.flag), form_.lanes ? call("any", {converged}) : converged);
}

}  // namespace hamgen::written
