// Routines evaluated in double: an oracle that shares nothing with the proof.
#include "tests/verify/evaluator.hpp"

#include <cmath>
#include <map>
#include <numeric>

#include "generator/program/arithmetic.hpp"

namespace hamgen::verify_test {

namespace {

// The code's results in double at one point: an oracle that shares nothing with the proof. Unknowns
// of iterations are numbers that depend on their names, and so is whatever nobody has assigned;
// what is observed are the functions' values, the increments, and at every iteration what it
// solves.
class Evaluator {
 public:
  explicit Evaluator(const Program& code) : code_(code) {}

  std::vector<double> operator()() {
    for (const Routine& routine : code_.routines) {
      const bool inner = routine.name == "prepare" || routine.name == "evaluate" ||
                         routine.name == "fixed_point" || routine.name == "newton" ||
                         (routine.name == "hessian" && !is_called("hessian"));
      // The tangent of a composition takes its steps with others: those are looked at.
      const bool composed =
          routine.name == "tangent" && code_.routine("substep_tangent") != nullptr;
      if (inner || composed) continue;
      for (const bool known : {false, true}) {
        if (known && (routine.name != "solve" || code_.unknowns > 0)) continue;
        run(routine, known);
      }
    }
    for (const Rational& length : code_.substeps) results_.push_back(length.get_d());
    return std::move(results_);
  }

 private:
  struct Object {
    std::string root;
    long offset = 0;
    std::vector<int> sizes = {};
  };
  struct Frame {
    const Routine* routine;
    std::map<std::string, Object> objects = {};
    std::map<std::string, double> locals = {};
    std::map<std::string, long> indices = {};
    std::set<std::string> rounded = {};
    bool ended = false;
  };

  [[nodiscard]] bool is_called(const std::string& name) const {
    for (const Routine& routine : code_.routines) {
      if (called_routines(routine.body).contains(name)) return true;
    }
    return false;
  }
  void run(const Routine& routine, bool known) {
    cells_.clear();
    zeroed_.clear();
    matrices_.clear();
    flags_.clear();
    flags_["start.known"] = known;
    if (code_.routine("prepare") != nullptr && routine.name != "prepare") {
      start(*code_.routine("prepare"));
    }
    for (const Argument& argument : routine.arguments) {
      if (argument.name == "values") zeroed_.insert("values");
    }
    start(routine);
    for (const auto& [name, value] : cells_) {
      if (!name.starts_with("start.") && !name.starts_with("k.")) results_.push_back(value);
    }
    for (const auto& [place, value] : matrices_["matrix"]) observe_entry(place, value);
  }
  void start(const Routine& routine) {
    Frame frame{.routine = &routine};
    for (const Argument& argument : routine.arguments) {
      frame.objects[argument.name] = {.root = argument.name, .sizes = argument.sizes};
    }
    frame.locals["h"] = 0.1;
    if (routine.name == "solve") {
      for (const Place& place : code_.changed) {
        // Not every component has a rest.
        cells_.try_emplace("dz." + place.field + subscript(place), 0);
      }
    }
    run(frame, routine.body);
    // What is large and what is small make one increment.
    if (routine.name != "solve") return;
    for (auto& [name, value] : cells_) {
      if (!name.starts_with("dz.")) continue;
      const auto rest = cells_.find("rest." + name.substr(3));
      if (rest == cells_.end()) continue;
      value += rest->second;
      rest->second = 0;
    }
  }
  static std::string subscript(const Place& place) {
    return place.indices.empty() ? "" : "[" + std::to_string(place.indices[0].constant) + "]";
  }

  void run(Frame& frame, const Body& body) {
    for (std::size_t i = 0; i < body.size(); ++i) {
      const auto* let = std::get_if<Let>(&body[i].value);
      if (let == nullptr || let->value.kind() != Kind::function) continue;
      if (!is_rounding_error(let->value.name())) continue;
      const Expression& x = let->value.operands()[0];
      const Expression& y = let->value.operands()[1];
      const Expression exact = let->value.name() == kProductError ? x * y : x - y;
      for (std::size_t j = i; j-- > 0;) {
        const auto* before = std::get_if<Let>(&body[j].value);
        if (before == nullptr || before->value != exact) continue;
        frame.rounded.insert(before->symbol);
        break;
      }
    }
    for (const Instruction& instruction : body) {
      if (frame.ended) return;
      std::visit([&](const auto& node) { run(frame, node); }, instruction.value);
    }
  }
  void run(Frame& f, const Let& let) {
    const double x = value(f, let.value);
    f.locals[let.symbol] = f.rounded.contains(let.symbol) ? x * (1 - kLost) : x;
  }
  void run(Frame& f, const Assign& a) { number(f, a.symbol) = value(f, a.value); }
  void run(Frame& f, const Accumulate& a) {
    const double x = value(f, a.value);
    number(f, a.symbol) += x;
  }
  void run(Frame& f, const Collect& c) { run(f, Accumulate{c.symbol, c.value}); }
  void run(Frame& f, const CollectStages& c) {
    number(f, c.symbol) = sum_from(f, c.in("slope"), c.count);
    number(f, c.lost) += sum_from(f, c.in("change"), c.count);
  }
  double sum_from(Frame& f, Place place, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i, ++place.indices.back().constant) sum += cell(name(f, place));
    return sum;
  }
  void run(Frame& f, const Array& array) {
    const std::string root = std::to_string(++objects_) + array.name;
    f.objects[array.name] = {.root = root, .sizes = array.sizes};
    zeroed_.insert(root);
    long i = 0;
    for (const Expression& e : array.values) {
      const double x = value(f, e);
      cells_[root + "[" + std::to_string(i++) + "]"] = x;
    }
  }
  void run(Frame& f, const Matrix& matrix) {
    f.objects[matrix.name] = {.root = std::to_string(++objects_) + matrix.name};
  }
  void run(Frame& f, const Copy& copy) {
    if (copy.declares) f.objects[copy.to] = {.root = std::to_string(++objects_) + copy.to};
    const std::string to = object(f, copy.to).root;
    for (const Field& field : code_.record(copy.record)->fields) {
      long count = 1;
      for (const int size : field.sizes) count *= size;
      for (long i = 0; i < count; ++i) {
        const std::string end =
            "." + field.name + (field.sizes.empty() ? "" : "[" + std::to_string(i) + "]");
        cells_[to + end] = copy.from.empty() ? 0 : cell(object(f, copy.from).root + end);
      }
    }
  }
  void run(Frame& f, const Clear& clear) { matrices_[name(f, clear.matrix)].clear(); }
  void run(Frame& f, const Put& put) {
    matrices_[name(f, put.matrix)][{at(f, put.row), at(f, put.column)}] += value(f, put.value);
  }
  void run(Frame& f, const SetFlag& set) { flags_[name(f, set.flag)] = set.value; }
  void run(Frame& f, const For& loop) {
    const long last = at(f, loop.range.upper);
    for (long i = at(f, loop.range.lower); i <= last; ++i) {
      f.indices[loop.range.index] = i;
      run(f, loop.body);
    }
  }
  void run(Frame& f, const Scope& scope) { run(f, scope.body); }
  void run(Frame& f, const If& branch) {
    if (flags_[name(f, branch.flag)] == branch.set) run(f, branch.then);
  }
  void run(Frame& f, const Call& call) {
    const Routine& routine = *code_.routine(call.routine);
    Frame inner{.routine = &routine};
    for (std::size_t i = 0; i < routine.arguments.size(); ++i) {
      const Argument& argument = routine.arguments[i];
      const Place& place = call.arguments.at(i);
      if (argument.record.empty() && argument.sizes.empty()) {
        inner.locals[argument.name] = number(f, place.object);
        continue;
      }
      const auto known = f.objects.find(place.object);
      Object object = known != f.objects.end() ? known->second : Object{.root = place.object};
      if (!place.field.empty()) object.root += "." + place.field;
      if (!place.indices.empty()) object.offset += at(f, place.indices[0]);
      object.sizes = argument.sizes;
      inner.objects[argument.name] = object;
    }
    run(inner, routine.body);
  }
  void run(Frame& f, const Alternate& two) {
    run(f, two.first);
    run(f, two.between);
    run(f, two.second);
  }
  void run(Frame&, const Factorise&) {}
  void run(Frame& f, const SolveFactorised& solve) {
    for (const auto& [place, x] : matrices_[name(f, solve.matrix)]) observe_entry(place, x);
    const Object& object = f.objects[solve.vector.object];
    const std::string stem =
        object.root + (solve.vector.field.empty() ? "" : "." + solve.vector.field);
    long size = 1;
    for (const int s : object.sizes) size *= s;
    if (!solve.vector.field.empty()) {
      for (const Field& field : code_.record("Start")->fields) {
        if (field.name == solve.vector.field) size = field.sizes.at(0);
      }
    }
    for (long i = 0; i < size; ++i) {
      double& x = cell(stem + "[" + std::to_string(i) + "]");
      results_.push_back(x);
      x = spread("solution " + std::to_string(i));
    }
  }
  void run(Frame& f, const Invert& invert) {
    for (const auto& [place, x] : matrices_[f.objects[invert.matrix].root]) observe_entry(place, x);
    flags_[name(f, invert.regular)] = true;
  }
  void observe_entry(const std::pair<long, long>& place, double x) {
    if (x == 0) return;
    results_.push_back(static_cast<double>(1000 * place.first + place.second));
    results_.push_back(x);
  }
  void pass(Frame& f, const std::vector<Unknown>& unknowns, const Body& body) {
    for (const Unknown& u : unknowns) {
      results_.push_back(value(f, u.start));
      f.locals[u.symbol] = spread(u.symbol);
    }
    run(f, body);
    for (const Unknown& u : unknowns) results_.push_back(value(f, u.correction));
  }
  void run(Frame& f, const Iterate& iterate) { pass(f, iterate.unknowns, iterate.body); }
  void run(Frame& f, const Sweep& sweep) {
    if (sweep.unknowns.empty()) {
      for (int i = 0; i < sweep.count; ++i) run(f, sweep.body);
    }
    pass(f, sweep.unknowns, sweep.unknowns.empty() ? Body{} : sweep.body);
    for (const std::string& result : sweep.results) f.locals[result] = spread(result);
  }
  void run(Frame& f, const Refine& refine) {
    for (const Expression& e : refine.gradient) results_.push_back(value(f, e));
  }
  void for_unknowns(Frame& f, const IterateArray& iterate,
                    const std::function<void(const UnknownArray&)>& use) {
    for_each_instance(iterate.ranges, [&](const std::vector<long>& indices) {
      for (std::size_t i = 0; i < indices.size(); ++i)
        f.indices[iterate.ranges[i].index] = indices[i];
      for (const UnknownArray& u : iterate.unknowns) use(u);
    });
  }
  void run(Frame& f, const IterateArray& iterate) {
    for_unknowns(f, iterate, [&](const UnknownArray& u) {
      results_.push_back(number(f, u.value));
      number(f, u.value) = spread(name(f, f.routine->places.at(u.value)));
    });
    run(f, iterate.body);
    for_unknowns(f, iterate,
                 [&](const UnknownArray& u) { results_.push_back(number(f, u.increment)); });
  }
  void run(Frame& f, const RefineArray& refine) {
    run(f, refine.first.empty() ? refine.body : refine.first);
    for (long i = 0; i < refine.components; ++i) {
      const std::string end = "[" + std::to_string(i) + "]";
      const double slope =
          cell(f.objects[refine.gradient.object].root + "." + refine.gradient.field + end);
      results_.push_back(slope);
      cell(name(f, refine.refinement) + ".slope" + end) = slope;
    }
    if (refine.first.empty()) return;
    const std::string lack = f.objects[refine.lack.object].root + "." + refine.lack.field;
    const auto add_lack = [&] {
      for (long i = 0; i < refine.count; ++i)
        results_.push_back(cell(lack + "[" + std::to_string(i) + "]"));
    };
    add_lack();
    run(f, refine.body);
    add_lack();
  }
  void run(Frame&, const InstructionOfRun auto&) {}  // routines of steps have none
  void run(Frame& f, const Return& end) {
    if (end.value) results_.push_back(value(f, *end.value));
    f.ended = true;
  }

  static long at(const Frame& f, const AffineIndex& index) {
    long x = index.constant;
    for (const auto& [symbol, factor] : index.factors) x += factor * f.indices.at(symbol);
    return x;
  }
  // A free number that depends on the name: from 1/2 to 3/2, but a carry is small.
  static double spread(const std::string& name) {
    return (name.starts_with("carry") ? 0.01 : 1) *
           (0.5 + static_cast<double>(std::hash<std::string>{}(name) % 1000) / 1000);
  }
  // A record that nobody has handed over is one of its own.
  static Object object(const Frame& f, const std::string& name) {
    const auto known = f.objects.find(name);
    return known != f.objects.end() ? known->second : Object{.root = name};
  }
  std::string name(Frame& f, const Place& place) {
    Object object = this->object(f, place.object);
    std::vector<int> sizes = object.sizes;
    if (!place.field.empty()) {
      object.root += "." + place.field;
      for (const Record& record : code_.records) {
        for (const Field& field : record.fields) {
          if (field.name == place.field && field.sizes.size() == place.indices.size())
            sizes = field.sizes;
        }
      }
    }
    if (place.indices.empty()) return object.root;
    long linear = 0;
    for (std::size_t i = 0; i < place.indices.size(); ++i) {
      linear = (i == 0 ? 0 : linear * sizes.at(i)) + at(f, place.indices[i]);
    }
    return object.root + "[" + std::to_string(object.offset + linear) + "]";
  }
  double& cell(const std::string& name) {
    const std::string root = name.substr(0, name.find_first_of(".["));
    return cells_.try_emplace(name, zeroed_.contains(root) ? 0 : spread(name)).first->second;
  }
  double& number(Frame& f, const std::string& symbol) {
    const auto local = f.locals.find(symbol);
    if (local != f.locals.end()) return local->second;
    const auto place = f.routine->places.find(symbol);
    if (place == f.routine->places.end())
      return f.locals.try_emplace(symbol, spread(symbol)).first->second;
    if (!place->second.object.empty()) return cell(name(f, place->second));
    return index_ = static_cast<double>(at(f, place->second.indices.at(0)));
  }
  double value(Frame& f, const Expression& e) {
    std::vector<double> x;
    for (const Expression& operand : e.operands()) x.push_back(value(f, operand));
    switch (e.kind()) {
      case Kind::number:
        return e.number().get_d();
      case Kind::symbol:
        return number(f, e.name());
      case Kind::sum:
        return std::accumulate(x.begin(), x.end(), 0.0);
      case Kind::product:
        return std::accumulate(x.begin(), x.end(), 1.0, std::multiplies<>());
      case Kind::power:
        return std::pow(x[0], x[1]);
      case Kind::function:
        if (e.name() == kProductError) return kLost * x[0] * x[1];
        if (e.name() == kDifferenceError) return kLost * (x[0] - x[1]);
        return e.name() == "sin" ? std::sin(x[0]) : std::cos(x[0]);
    }
    return 0;
  }

  // Of a product or a difference that comes with its error, a part: the two of them are exact.
  static constexpr double kLost = 0.1;
  const Program& code_;
  std::map<std::string, double> cells_;
  std::set<std::string> zeroed_;
  std::map<std::string, std::map<std::pair<long, long>, double>> matrices_;
  std::map<std::string, bool> flags_;
  std::vector<double> results_;
  double index_ = 0;
  int objects_ = 0;
};

}  // namespace

bool computes_the_same(const Program& a, const Program& b) {
  const std::vector<double> of_a = Evaluator(a)();
  const std::vector<double> of_b = Evaluator(b)();
  if (of_a.size() != of_b.size()) return false;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    // Rounding errors stay below 1e-12; a mutation moves a value by at least 1e-3 of one of its
    // terms.
    if (!(std::abs(of_a[i] - of_b[i]) <= 1e-12 * (1 + std::abs(of_a[i])))) return false;
  }
  return true;
}

}  // namespace hamgen::verify_test
