// What an instruction looks like.
#include "generator/program/written_code.hpp"

#include <fmt/format.h>

#include "generator/program/written_run.hpp"

namespace hamgen::written {

namespace {

const std::vector<std::string> kOfLength = {"False for infinities and NaN alike."};

// May it stand on the line of a head?
bool is_short(const Instruction& instruction) {
  const auto& value = instruction.value;
  const auto* end = std::get_if<hamgen::Return>(&value);
  return std::holds_alternative<Assign>(value) || std::holds_alternative<Accumulate>(value) ||
         std::holds_alternative<Put>(value) || std::holds_alternative<Call>(value) ||
         std::holds_alternative<Use>(value) || std::holds_alternative<Break>(value) ||
         std::holds_alternative<Factorise>(value) || (end != nullptr && !end->report.empty());
}

class RoutineWriter : public RunWriter {
 public:
  using RunWriter::RunWriter;
  using RunWriter::operator();

  Body run() {
    const Result& result = routine_.result;
    if (!result.object.empty()) add(Declare{result.type, {result.object}});
    write(routine_.body);
    const bool filled = !result.object.empty() && result.type != "StepReport";
    if (filled) add(Return{object({result.object})});
    return std::move(body_);
  }

  void operator()(const Let& let) {
    const char* type = lane_index_.empty() ? "Real" : "Lanes";
    add(Define{type, let.symbol, formula(let.value), let.varies});
  }
  void operator()(const Array& array) {
    std::vector<Value> values;
    for (const Expression& e : array.values) values.push_back(formula(e));
    // C has no empty lists.
    if (values.empty() && !form_.references) values.push_back(integer(0));
    add(Define{"Real", array.name, list(std::move(values)), true, array.sizes});
  }
  void operator()(const Matrix& matrix) {
    const char* dense = matrix.symmetric              ? "SymmetricMatrix"
                        : matrix.large && form_.eigen ? "EigenDenseMatrix"
                                                      : "DenseMatrix";
    add(Declare{matrix.patterned ? "Matrix" : fmt::format("{}<{}>", dense, matrix.size),
                {matrix.name}});
  }
  void operator()(const Copy& copy) {
    Value from = copy.from.empty() ? zeros(copy.record) : at({copy.from});
    if (!copy.declares) return set(at({copy.to}), std::move(from));
    add(Define{copy.record, copy.to, std::move(from), true});
  }
  void operator()(const Assign& assign) {
    if (!put_lanes("Lanes::put", assign.symbol, assign.value))
      set_number(symbol(assign.symbol), formula(assign.value), is_in_turn(assign.symbol));
  }
  void operator()(const Collect& sum) {
    std::vector<Value> numbers = {symbol(sum.symbol), symbol(sum.lost), formula(sum.value)};
    const bool in_turn = is_in_turn(sum.symbol);
    if (in_turn) numbers.insert(numbers.begin(), lanes_in_turn());
    Value collect = call(in_turn ? "collect_lanes" : "collect", std::move(numbers));
    collect.changed = 2;
    add(Do{std::move(collect)});
  }
  void operator()(const CollectStages& sum) {
    Value collect =
        call("collect_stages", {symbol(sum.symbol), symbol(sum.lost), object(sum.refinement),
                                index(sum.first), integer(sum.count)});
    collect.changed = 2;
    add(Do{std::move(collect)});
  }
  void operator()(const Accumulate& sum) {
    if (!put_lanes("Lanes::add", sum.symbol, sum.value)) increase(sum.symbol, formula(sum.value));
  }
  void operator()(const Clear& clear) { add(Do{action("Matrix", clear.matrix, "clear")}); }
  void operator()(const Put& put) {
    add(Do{action("Matrix", put.matrix, "put",
                  {index(put.row), index(put.column), formula(put.value)})});
  }
  void operator()(const SetFlag& flag) {
    if (!is_in_turn(flag.flag)) return set(at(flag.flag), word(flag.value ? "true" : "false"));
    Value lanes = flag.value ? lanes_in_turn() : prefix("!", lanes_in_turn());
    set(at(flag.flag), joined(flag.value ? "|" : "&", {at(flag.flag), std::move(lanes)}));
  }
  void operator()(const hamgen::For& loop) {
    if (loop.lanes > 0) lane_index_ = loop.range.index;
    add(For{loop.range, inside(loop.body), Shape::fitting, loop.lanes});
    if (loop.lanes > 0) lane_index_.clear();
  }
  void operator()(const Scope& scope) { add(Block{inside(scope.body)}); }
  void operator()(const hamgen::If& node) {
    Value condition = node.any ? call("any", {object(node.flag)}) : at(node.flag);
    if (!node.set) condition = prefix("!", std::move(condition));
    if (!routine_.in_turn.empty())
      return narrow(std::move(condition), Shape::fitting, [&] { write(node.then); });
    if (node.also) condition = joined("&&", {std::move(condition), at(*node.also)});
    branch(std::move(condition), Shape::fitting, [&] { write(node.then); });
  }

  void operator()(const Call& call) {
    Value value = called(call);
    if (call.must_succeed) {
      if (call.record == "StepReport")
        value = with_parts(Value::Kind::member, "converged", {std::move(value)});
      return branch(prefix("!", std::move(value)), Shape::line, [this] { fail(); });
    }
    if (call.object.empty()) {
      if (!call.record.empty()) value = unused(std::move(value));
      add(Do{std::move(value)});
    } else if (call.again) {
      set(object({call.object}), std::move(value));
    } else {
      add(Define{call.record, call.object, std::move(value), call.varies});
    }
  }

  void operator()(const Alternate& node) {
    const Value patience = at(node.patience);
    if (form_.lanes) return alternate_in_lanes(node);
    const auto turn_to_second = [&] {
      add(Do{prefix("--", patience)});
      branch(prefix("!", called(node.second)), Shape::line, [this] { fail(); });
    };
    const bool once = node.attempts() == 1;
    branch(joined("==", {patience, integer(0)}), Shape::braces, [&] {
      if (once) {
        write(node.before);
        branch(called(node.first), Shape::braces, [&] { (*this)(hamgen::Return{}); });
      }
      set(patience, integer(node.steps));
      if (once) return write(node.between);
      attempt([&] {
        branch(called(node.first), Shape::braces, [&] {
          set(patience, integer(0));
          add(Break{});
        });
        write(node.between);
      });
    });
    if (once) return turn_to_second();
    branch(joined(">", {patience, integer(0)}), Shape::braces, turn_to_second);
  }

  void operator()(const Factorise& node) {
    if (node.compared > 0) {
      add(Do{
          action("NewtonRule", rule_, "compare", {object(node.matrix), integer(node.compared)})});
    }
    std::vector<Value> lanes;
    if (is_in_turn(node.matrix)) lanes.push_back(lanes_in_turn());
    Value regular = action("Matrix", node.matrix, "factorise", std::move(lanes));
    if (form_.lanes) {
      const Value turn = object({"start", "turn"});
      return void(add(Do{action(rule_type_, rule_, "require", {turn, std::move(regular)})}));
    }
    branch(prefix("!", std::move(regular)), iterates_ ? Shape::braces : Shape::line, [this] {
      if (iterates_) {
        count_iterations();
        set(at({"report", "increment"}), call("Real", {call("__builtin_inf", {})}));
      }
      fail();
    });
  }
  void operator()(const SolveFactorised& solve) {
    std::vector<Value> given = {object(solve.vector)};
    if (is_in_turn(solve.matrix)) given.insert(given.begin(), lanes_in_turn());
    add(Do{action("Matrix", solve.matrix, "solve", std::move(given))});
  }
  void operator()(const Invert& node) {
    Value inverse = call("invert", {object({node.matrix}), object(node.inverse)});
    set(at(node.regular), joined(form_.lanes ? "&" : "&&", {std::move(inverse), at(node.regular)}));
  }

  void operator()(const hamgen::Return& end) {
    if (end.value) return void(add(Return{formula(*end.value)}));
    if (!end.report.empty()) return void(add(Return{object({end.report})}));
    if (!end.finite.empty()) length_of(end);
    if (form_.lanes) return return_lanes(end);
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
    if (loops) body_[first].remark = kOfLength;
  }

 private:
  void write(const hamgen::Body& body) override {
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

  Value called(const Call& call) {
    const Value::Kind kind = call.of_run ? Value::Kind::of_run : Value::Kind::routine;
    Value result{.kind = kind, .text = call.routine};
    for (const Place& place : call.arguments) result.parts.push_back(at(place, Value::Kind::given));
    return result;
  }

  // Nothing is wanted of it.
  Value unused(Value value) const {
    return form_.references ? written::call("static_cast<void>", {std::move(value)})
                            : prefix("(void)", std::move(value));
  }

  void length_of(const hamgen::Return& end) {
    std::vector<Value> squares;
    for (const std::vector<Place>& arrays : finite_arrays(routine_, end)) {
      std::vector<Value> sum;
      for (const Place& array : arrays) sum.push_back(object(array));
      squares.push_back(call("squares_of", std::move(sum)));
    }
    const bool whole = !squares.empty();
    for (const std::vector<std::string>& symbols : finite_sums(routine_, end)) {
      if (whole) break;
      std::vector<Value> parts;
      for (const std::string& each : symbols) parts.push_back(symbol(each));
      Value sum = joined("+", std::move(parts));
      if (symbols.size() > 1) sum = in_parentheses(std::move(sum));
      squares.push_back(joined("*", {sum, sum}));
    }
    Value sum = joined("+", std::move(squares));
    if (end.ranges.empty() || whole) {
      Statement& defined = add(Define{"Real", "length ", std::move(sum)});
      if (!form_.lanes) defined.remark = kOfLength;
      return;
    }
    add(Define{"Real", "length ", integer(0), true});
    over(
        end.ranges, [&] { set(at({"length "}), std::move(sum), "+="); }, Shape::line);
  }

  void report_success(const hamgen::Return& end, const Value& success) {
    const Value converged = at({"report", "converged"});
    set(converged, success);
    if (!end.finite.empty()) {
      branch(prefix("!", converged), Shape::line, [this] {
        set(at({"report", "increment"}), at({"length "}));
      });
    }
    if (end.flag) set(at(*end.flag), converged);
  }

  // --- of trajectories in lanes --------------------------------------------------------------

  // A routine ends where all lanes have come to its end.
  void return_lanes(const hamgen::Return& end) {
    const Value converged = at({"report", "converged"});
    if (!end.success) return set(converged, joined("&", {converged, prefix("!", lanes_in_turn())}));
    const bool in_turn = !routine_.in_turn.empty();
    if (!end.finite.empty()) {
      std::vector<Value> given = {object({"report"}), at({"length "})};
      if (in_turn) given.insert(given.begin() + 1, lanes_in_turn());
      add(Do{call("require_finite", std::move(given))});
    }
    if (end.flag && in_turn) {
      Value lanes = in_parentheses(joined("&", {converged, lanes_in_turn()}));
      set(at(*end.flag), joined("|", {at(*end.flag), std::move(lanes)}));
    } else if (end.flag) {
      // Of a lane that has failed nothing is asked any more.
      set(at(*end.flag), call("any", {converged}));
    }
    add(Return{routine_.result.type == "StepReport" ? object({"report"}) : converged});
  }

  // The first of two routines, and once more.
  void attempt(const Lines& lines) {
    add(Loop{"int", "attempt", 0, "2", inside(lines), Shape::braces});
  }

  // Lanes that the first routine fails in go on to the second.
  void alternate_in_lanes(const Alternate& node) {
    const Value patience = at(node.patience);
    const Value converged = at({"report", "converged"});
    const auto is_zero = [&](const char* sign) {
      return in_parentheses(joined(sign, {patience, integer(0)}));
    };
    const bool once = node.attempts() == 1;
    const auto try_first = [&] {
      add(Define{"Mask", "tried ", lanes_in_turn()});
      add(Define{"Mask", "found ", called(node.first)});
      set(lanes_in_turn(), joined("&", {at({"tried "}), prefix("!", at({"found "}))}));
      const Value none = prefix("!", call("any", {lanes_in_turn()}));
      if (!once) branch(none, Shape::line, [&] { add(Break{}); });
      write(node.between);
      set(converged, joined("|", {converged, lanes_in_turn()}));
    };
    narrow(is_zero("<="), Shape::braces, [&] {
      write(node.before);
      once ? try_first() : attempt(try_first);
      set_number(patience, integer(node.steps), true);
    });
    narrow(is_zero(">"), Shape::braces, [&] {
      set_number(patience, joined("-", {patience, integer(1)}), true);
      add(Do{unused(called(node.second))});
    });
  }

  // To numbers of the stages side by side, if it is that.
  bool put_lanes(const char* how, const std::string& to, const Expression& value) {
    const auto place = routine_.places.find(to);
    if (place == routine_.places.end() || !is_of_lanes(place->second, lane_index_)) return false;
    add(Do{call(how, {at(place->second, Value::Kind::given), formula(value)})});
    return true;
  }

  std::string lane_index_;  // of a loop over stages in lanes
};

}  // namespace

Body body_of(const Routine& routine, const Form& form) {
  return RoutineWriter(routine, form).run();
}

bool is_of_lanes(const Place& place, const std::string& index) {
  return !index.empty() && !place.indices.empty() && place.indices.back().factors.contains(index);
}

std::string type_of(const ArrayMatrix& matrix) {
  if (matrix.kept) {
    ArrayMatrix plain = matrix;
    plain.kept = false;
    return fmt::format("KeptMatrix<{}>", type_of(plain));
  }
  const auto plain = [&](const char* name) { return fmt::format("{}<{}>", name, matrix.size); };
  if (matrix.kind == MatrixKind::dense) return plain("DenseMatrix");
  const bool eigen = !matrix.in_lanes;
  if (matrix.kind == MatrixKind::eigen_dense)
    return plain(eigen ? "EigenDenseMatrix" : "DenseMatrix");
  if (matrix.kind == MatrixKind::eigen_sparse)
    return plain(eigen ? "EigenSparseMatrix" : "SparseMatrix");
  const std::string inside =
      matrix.bandwidth == 0
          ? fmt::format("DiagonalMatrix<{}>", matrix.inside())
          : fmt::format("{}BandMatrix<{}, {}>", matrix.symmetric ? "Symmetric" : "",
                        matrix.inside(), matrix.bandwidth);
  if (matrix.border.empty() && (matrix.bandwidth == 0 || matrix.in_natural_order())) return inside;
  const std::string order =
      fmt::format("{}, {}, {}", matrix.arrays, matrix.length(), matrix.folded);
  if (matrix.border.empty())
    return fmt::format("ReorderedMatrix<{}, ElementOrder<{}>>", inside, order);
  const std::string whole = fmt::format("BorderedMatrix<{}, {}>", inside, matrix.border.size());
  if (matrix.in_natural_order()) return whole;
  return fmt::format("ReorderedMatrix<{}, BorderOrder<{}, {}, {}>>", whole, matrix.inside(), order,
                     fmt::join(matrix.border, ", "));
}

const Body* inner_body(const Statement& statement) {
  return std::visit(
      [](const auto& node) -> const Body* {
        if constexpr (requires { node.body; }) return &node.body;
        return nullptr;
      },
      statement.value);
}

}  // namespace hamgen::written
