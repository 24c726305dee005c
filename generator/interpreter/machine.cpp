#include "generator/interpreter/machine.hpp"

#include <algorithm>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

using Quad = numerics_of_quad::Real;

long product(const std::vector<int>& sizes) {
  long result = 1;
  for (const int size : sizes) result *= size;
  return result;
}

template <class Real>
bool is_finite(Real sum_of_squares) {
  return sum_of_squares <= NumericsOf<Real>::most;
}

}  // namespace

long offset_of(const Record& record, const std::string& field) {
  long offset = 0;
  for (const Field& candidate : record.fields) {
    if (candidate.name == field) return offset;
    if (candidate.type == "Real") offset += product(candidate.sizes);
  }
  internal_error("no field " + field + " in " + record.name);
}

template <class Real>
Object<Real> make_object(const Record& record) {
  Object<Real> object;
  for (const Field& field : record.fields) {
    if (field.type == "Real") {
      const auto size = static_cast<std::size_t>(product(field.sizes));
      for (std::size_t i = 0; i < size; ++i) {
        const bool given = i < field.values.size();
        object.numbers.push_back(given ? nearest_number<Real>(field.values[i]) : Real(0));
      }
    } else if (field.type == "bool") {
      object.flags[field.name] = !field.values.empty() && field.values[0] != 0;
    } else {
      object.rules[field.name] = make_newton_rule<Real>(field.type == "NewtonRule<1>" ? 1 : 2);
    }
  }
  return object;
}

// Makes the steps of a machine from the instructions of its routine.
template <class Real>
class Machine<Real>::Compiler {
 public:
  Compiler(Machine& machine, const Routine& routine, const StepCode& code, const Others& others)
      : m_(machine), routine_(routine), code_(code), others_(others) {}

  void compile() {
    m_.object_index_["(locals)"] = 0;
    m_.shapes_.push_back({});
    for (const Argument& argument : routine_.arguments) {
      declare(argument.name, argument.record.empty() ? nullptr : code_.record(argument.record),
              argument.sizes);
    }
    m_.argument_count_ = routine_.arguments.size();
    declare_all(routine_.body);
    if (const Record* result = code_.record(routine_.result.type)) {
      declare(routine_.result.object, result, {});
    }
    m_.objects_.resize(m_.shapes_.size());
    m_.frame_.objects.resize(m_.shapes_.size());
    m_.own_.resize(m_.shapes_.size());
    m_.steps_ = steps(routine_.body);
    m_.frame_.indices.resize(m_.loop_index_.size());
    m_.locals_.resize(m_.local_index_.size() + 1);
  }

  Step operator()(const Let& let) { return assign(let.symbol, let.value); }
  Step operator()(const Assign& assign_) { return assign(assign_.symbol, assign_.value); }
  Step operator()(const Accumulate& sum) {
    const Address target = address(sum.symbol);
    return [this, target, value = compiled(sum.value)] {
      m_.frame_.at(target) += value(m_.frame_);
      return true;
    };
  }
  Step operator()(const Collect& sum) {
    const Address target = address(sum.symbol);
    const Address lost = address(sum.lost);
    return [this, target, lost, value = compiled(sum.value)] {
      NumericsOf<Real>::collect_rest(m_.frame_.at(target), m_.frame_.at(lost), value(m_.frame_));
      return true;
    };
  }
  Step operator()(const Array& array) {
    const Address target{index_of(array.name), 0, {}};
    std::vector<CompiledExpression<Real>> values;
    for (const Expression& e : array.values) values.push_back(compiled(e));
    const long size = product(array.sizes);
    return [this, target, size, values] {
      Real* numbers = &m_.frame_.at(target);
      for (long i = 0; i < size; ++i) numbers[i] = 0;
      for (const auto& value : values) *numbers++ = value(m_.frame_);
      return true;
    };
  }
  Step operator()(const Matrix& matrix) {
    return [this, matrix] {
      m_.matrices_[matrix.name] = make_matrix<Real>(matrix.size);
      return true;
    };
  }
  Step operator()(const Copy& copy) {
    const int to = index_of(copy.to);
    if (copy.from.empty()) {
      return [this, to] {
        std::ranges::fill(object(to).numbers, Real(0));
        return true;
      };
    }
    const int from = index_of(copy.from);
    return [this, to, from] {
      object(to).numbers = object(from).numbers;
      m_.frame_.objects[static_cast<std::size_t>(to)] = object(to).numbers.data();
      return true;
    };
  }
  Step operator()(const Put& put) {
    const Address row = index_address(put.row);
    const Address column = index_address(put.column);
    return [this, name = put.matrix, row, column, value = compiled(put.value)] {
      m_.matrices_.at(name)->put(static_cast<int>(evaluate(row)),
                                 static_cast<int>(evaluate(column)), value(m_.frame_));
      return true;
    };
  }
  Step operator()(const SetFlag& set) {
    return [this, target = index_of(set.flag.object), set] {
      object(target).flags.at(set.flag.field) = set.value;
      return true;
    };
  }
  Step operator()(const For& loop) {
    const auto index = static_cast<std::size_t>(loop_index(loop.range.index));
    const Address lower = index_address(loop.range.lower);
    const Address upper = index_address(loop.range.upper);
    return [this, index, lower, upper, body = steps(loop.body)] {
      const long last = evaluate(upper);
      for (long i = evaluate(lower); i <= last; ++i) {
        m_.frame_.indices[index] = i;
        if (!run_all(body)) return false;
      }
      return true;
    };
  }
  Step operator()(const Scope& scope) {
    return [this, body = steps(scope.body)] { return run_all(body); };
  }
  Step operator()(const If& branch) {
    return [this, branch, target = index_of(branch.flag.object), body = steps(branch.then)] {
      return object(target).flags.at(branch.flag.field) != branch.set || run_all(body);
    };
  }
  Step operator()(const Call& call) {
    Machine* other = others_.at(call.routine).get();
    std::vector<Address> places;
    for (const Place& place : call.arguments) places.push_back(address(place));
    return [this, other, places] {
      std::vector<Given<Real>> given;
      for (const Address& place : places) {
        given.push_back(
            {&m_.frame_.at(place), m_.objects_[static_cast<std::size_t>(place.object)]});
      }
      other->run(given);
      return true;
    };
  }
  Step operator()(const Factorise& factorise) {
    return [this, name = factorise.matrix] {
      if (m_.matrices_.at(name)->factorise()) return true;
      m_.report_.iterations += m_.iteration_;
      return false;
    };
  }
  Step operator()(const SolveFactorised& solve) {
    const Address vector{index_of(solve.vector), 0, {}};
    const auto size = static_cast<std::size_t>(
        product(m_.shapes_[static_cast<std::size_t>(vector.object)].sizes));
    return [this, name = solve.matrix, vector, size] {
      m_.matrices_.at(name)->solve({&m_.frame_.at(vector), size});
      return true;
    };
  }
  Step operator()(const Invert& invert) {
    const Address inverse = address(invert.inverse);
    return [this, invert, inverse, target = index_of(invert.regular.object)] {
      AnyMatrix<Real>& matrix = *m_.matrices_.at(invert.matrix);
      const int size = size_of(invert.inverse);
      const bool regular = matrix.factorise();
      for (int c = 0; regular && c < size; ++c) {
        std::vector<Real> column(static_cast<std::size_t>(size));
        column[static_cast<std::size_t>(c)] = 1;
        matrix.solve(column);
        for (int i = 0; i < size; ++i) {
          (&m_.frame_.at(inverse))[i * size + c] = column[static_cast<std::size_t>(i)];
        }
      }
      bool& flag = object(target).flags.at(invert.regular.field);
      flag = regular && flag;
      return true;
    };
  }
  Step operator()(const Iterate& iterate) {
    const bool newton = iterate.rule == Rule::newton;
    std::vector<Unknown> list = iterate.unknowns;
    // A fixed point moves by the difference of the new value and the old one.
    for (Unknown& u : list) {
      if (!newton) u.correction = u.correction - Expression::symbol(u.symbol);
    }
    const std::vector<Compiled> unknowns = compiled(list);
    const int start = index_of("start");
    const Address memory = address(Place{"start", "value"});
    const Steps body = steps(iterate.body);
    return [this, unknowns, start, memory, body, newton, name = iterate.name] {
      const bool known = object(start).flags.at("known");
      Real* kept = &m_.frame_.at(memory);
      for (const Compiled& u : unknowns) {
        m_.frame_.at(u.target) = known ? kept[u.memory] : u.start(m_.frame_);
      }
      const bool done = newton ? run_newton(*object(start).rules.at(name), unknowns, body)
                               : run_fixed_point(unknowns, body);
      if (!done) return false;
      for (const Compiled& u : unknowns) {
        kept[u.memory] = m_.frame_.at(u.target);
        if (newton) kept[u.memory] += u.correction(m_.frame_);
      }
      return true;
    };
  }
  Step operator()(const Refine& refine) {
    std::vector<Unknown> list = refine.unknowns;
    for (Unknown& u : list) u.correction = u.correction - Expression::symbol(u.symbol);
    const std::vector<Compiled> unknowns = compiled(list);
    std::vector<CompiledExpression<Real>> gradient;
    for (const Expression& e : refine.gradient) gradient.push_back(compiled(e));
    std::vector<Address> kept;
    for (const std::string& symbol : refine.kept) kept.push_back(address(symbol));
    const Address change{index_of(refine.name), 0, {}};
    return [this, unknowns, gradient, kept, change, body = steps(refine.body)] {
      const auto refinement = make_refinement<Real>(static_cast<int>(unknowns.size()),
                                                    static_cast<int>(gradient.size()));
      std::vector<Real> waiting(kept.size());
      for (bool more = true; more;) {
        if (!run_all(body)) return false;
        std::vector<Real> lack;
        std::vector<Real> slope;
        std::vector<Real> point;
        for (const Compiled& u : unknowns) {
          lack.push_back(u.correction(m_.frame_));
          point.push_back(m_.frame_.at(u.target));
        }
        for (const auto& component : gradient) slope.push_back(component(m_.frame_));
        for (std::size_t j = 0; refinement->is_first() && j < kept.size(); ++j) {
          waiting[j] = m_.frame_.at(kept[j]);
        }
        more = (*refinement)(point, lack, slope);
        for (std::size_t j = 0; j < point.size(); ++j) m_.frame_.at(unknowns[j].target) = point[j];
      }
      for (std::size_t j = 0; j < kept.size(); ++j) m_.frame_.at(kept[j]) = waiting[j];
      refinement->get_change({&m_.frame_.at(change), gradient.size()});
      return true;
    };
  }
  Step operator()(const Sweep& sweep) {
    const std::vector<Compiled> unknowns = compiled(sweep.unknowns);
    std::vector<Address> results;
    for (const std::string& result : sweep.results) results.push_back(address(result));
    return [this, unknowns, results, body = steps(sweep.body), count = sweep.count] {
      for (const Compiled& u : unknowns) m_.frame_.at(u.target) = u.start(m_.frame_);
      for (int i = 0; i < count; ++i) {
        if (!run_all(body)) return false;
        std::vector<Real> next;
        for (const Compiled& u : unknowns) next.push_back(u.correction(m_.frame_));
        for (std::size_t j = 0; j < next.size(); ++j) m_.frame_.at(unknowns[j].target) = next[j];
      }
      for (std::size_t j = 0; j < results.size(); ++j) {
        m_.frame_.at(results[j]) = m_.frame_.at(unknowns[j].target);
      }
      m_.report_.iterations = count;
      return true;
    };
  }
  Step operator()(const Return& end) {
    if (end.value) {
      return [this, value = compiled(*end.value)] {
        m_.report_.value = value(m_.frame_);
        return false;
      };
    }
    std::vector<Address> finite;
    for (const std::string& symbol : end.finite) finite.push_back(address(symbol));
    std::vector<std::pair<std::size_t, Address>> ranges;
    std::vector<Address> lower;
    for (const KernelRange& range : end.ranges) {
      ranges.emplace_back(static_cast<std::size_t>(loop_index(range.index)),
                          index_address(range.upper));
      lower.push_back(index_address(range.lower));
    }
    const int target = end.flag ? index_of(end.flag->object) : 0;
    return [this, end, finite, ranges, lower, target] {
      Real length = 0;
      sum_squares(length, finite, ranges, lower, 0);
      m_.report_.converged = end.success && is_finite(length);
      if (end.success && !m_.report_.converged) m_.report_.increment = length;
      if (end.flag) object(target).flags.at(end.flag->field) = m_.report_.converged;
      return false;
    };
  }

 private:
  struct Compiled {
    Address target;
    CompiledExpression<Real> start, correction;
    int memory = 0;
  };

  void sum_squares(Real& length, const std::vector<Address>& finite,
                   const std::vector<std::pair<std::size_t, Address>>& ranges,
                   const std::vector<Address>& lower, std::size_t depth) const {
    if (depth == ranges.size()) {
      Real sum = 0;
      for (const Address& place : finite) sum += m_.frame_.at(place) * m_.frame_.at(place);
      length += sum;
      return;
    }
    const auto& [index, upper] = ranges[depth];
    const long last = evaluate(upper);
    for (long i = evaluate(lower[depth]); i <= last; ++i) {
      m_.frame_.indices[index] = i;
      sum_squares(length, finite, ranges, lower, depth + 1);
    }
  }

  bool run_newton(AnyNewtonRule<Real>& rule, const std::vector<Compiled>& unknowns,
                  const Steps& body) const {
    rule.begin();
    for (m_.iteration_ = 1;; ++m_.iteration_) {
      if (!run_all(body)) return false;
      Real size = 0;
      Real scale = 0;
      std::vector<Real> corrections;
      for (const Compiled& u : unknowns) {
        corrections.push_back(u.correction(m_.frame_));
        size += magnitude(corrections.back());
      }
      // From the left, term by term, as it is written.
      for (const Compiled& u : unknowns) {
        scale += magnitude(m_.frame_.at(u.target));
        scale += magnitude(u.start(m_.frame_));
      }
      const Answer answer = rule(size, scale, static_cast<int>(m_.iteration_));
      if (answer != Answer::go_on) m_.report_.iterations += m_.iteration_;
      if (answer == Answer::failed) m_.report_.increment = size;
      if (answer != Answer::go_on) return answer == Answer::done;
      for (std::size_t j = 0; j < unknowns.size(); ++j) {
        m_.frame_.at(unknowns[j].target) += corrections[j];
      }
    }
  }

  bool run_fixed_point(const std::vector<Compiled>& unknowns, const Steps& body) const {
    const auto rule = make_fixed_point_rule<Real>(static_cast<int>(unknowns.size()));
    for (m_.iteration_ = 1;; ++m_.iteration_) {
      if (!run_all(body)) return false;
      std::vector<Real> increment;
      std::vector<Real> length;
      Real scale = 0;
      for (const Compiled& u : unknowns) {
        const Real value = m_.frame_.at(u.target);
        increment.push_back(u.correction(m_.frame_));
        length.push_back(magnitude(value) + magnitude(u.start(m_.frame_)));
        scale += length.back();
      }
      for (std::size_t j = 0; j < unknowns.size(); ++j) {
        m_.frame_.at(unknowns[j].target) += increment[j];
      }
      const Answer answer = (*rule)(increment, length, scale, static_cast<int>(m_.iteration_));
      const bool close = rule->size() <= 64 * NumericsOf<Real>::unit * scale;
      if (answer == Answer::go_on && !close) continue;
      m_.report_.iterations += m_.iteration_;
      if (answer == Answer::failed) m_.report_.increment = rule->size();
      return answer != Answer::failed;
    }
  }

  static Real magnitude(Real x) { return NumericsOf<Real>::size(x); }

  [[nodiscard]] Object<Real>& object(int index) const {
    return *m_.objects_[static_cast<std::size_t>(index)];
  }

  void declare(const std::string& name, const Record* record, const std::vector<int>& sizes) {
    m_.object_index_[name] = static_cast<int>(m_.shapes_.size());
    m_.shapes_.push_back({record, sizes});
  }
  void declare_all(const Body& body) {
    for (const Instruction& instruction : body) {
      if (const auto* array = std::get_if<Array>(&instruction.value)) {
        declare(array->name, nullptr, array->sizes);
      }
      if (const auto* refine = std::get_if<Refine>(&instruction.value)) {
        // As if it had one field: its change.
        declare(refine->name, nullptr, {static_cast<int>(refine->gradient.size())});
      }
      const auto* copy = std::get_if<Copy>(&instruction.value);
      if (copy != nullptr && copy->declares) declare(copy->to, code_.record(copy->record), {});
      for (const Body* inner : inner_bodies(instruction)) declare_all(*inner);
    }
  }

  [[nodiscard]] int index_of(const std::string& object) const {
    const auto it = m_.object_index_.find(object);
    if (it == m_.object_index_.end()) internal_error("no object " + object);
    return it->second;
  }
  int loop_index(const std::string& name) {
    return m_.loop_index_.try_emplace(name, static_cast<int>(m_.loop_index_.size())).first->second;
  }
  // An affine index as an address of no object.
  Address index_address(const AffineIndex& index) {
    Address result{0, index.constant, {}};
    for (const auto& [name, factor] : index.factors) {
      result.factors.emplace_back(loop_index(name), factor);
    }
    return result;
  }
  [[nodiscard]] long evaluate(const Address& index) const {
    long value = index.offset;
    for (const auto& [loop, factor] : index.factors) {
      value += factor * m_.frame_.indices[static_cast<std::size_t>(loop)];
    }
    return value;
  }

  [[nodiscard]] std::vector<int> sizes_of(const Place& place) const {
    const Shape& shape = m_.shapes_[static_cast<std::size_t>(index_of(place.object))];
    if (place.field.empty() || shape.record == nullptr) return shape.sizes;
    return std::ranges::find(shape.record->fields, place.field, &Field::name)->sizes;
  }
  [[nodiscard]] int size_of(const Place& place) const { return sizes_of(place).front(); }

  Address address(const Place& place) {
    if (place.object.empty()) {
      Address index = index_address(place.indices.front());
      index.object = kIndex;
      return index;
    }
    Address result{index_of(place.object), 0, {}};
    const Shape& shape = m_.shapes_[static_cast<std::size_t>(result.object)];
    if (!place.field.empty() && shape.record != nullptr)
      result.offset = offset_of(*shape.record, place.field);
    const std::vector<int> sizes = sizes_of(place);
    long stride = product(sizes);
    for (std::size_t k = 0; k < place.indices.size(); ++k) {
      stride /= sizes[k];
      const Address index = index_address(place.indices[k]);
      result.offset += stride * index.offset;
      for (const auto& [loop, factor] : index.factors) {
        result.factors.emplace_back(loop, stride * factor);
      }
    }
    return result;
  }
  Address address(const std::string& symbol) {
    const auto place = routine_.places.find(symbol);
    if (place != routine_.places.end()) return address(place->second);
    const auto argument = m_.object_index_.find(symbol);
    if (argument != m_.object_index_.end()) return {argument->second, 0, {}};
    const auto local =
        m_.local_index_.try_emplace(symbol, static_cast<int>(m_.local_index_.size()));
    return {0, local.first->second, {}};
  }

  CompiledExpression<Real> compiled(const Expression& e) {
    return CompiledExpression<Real>(e,
                                    [this](const std::string& symbol) { return address(symbol); });
  }
  std::vector<Compiled> compiled(const std::vector<Unknown>& unknowns) {
    std::vector<Compiled> result;
    for (const Unknown& u : unknowns) {
      result.push_back({address(u.symbol), compiled(u.start), compiled(u.correction), u.memory});
    }
    return result;
  }

  Step assign(const std::string& symbol, const Expression& value) {
    const CompiledExpression<Real> compiled_value = compiled(value);
    return [this, target = address(symbol), compiled_value] {
      m_.frame_.at(target) = compiled_value(m_.frame_);
      return true;
    };
  }

  Steps steps(const Body& body) {
    Steps result;
    for (const Instruction& instruction : body) {
      result.push_back(std::visit(*this, instruction.value));
    }
    return result;
  }

  Machine& m_;
  const Routine& routine_;
  const StepCode& code_;
  const Others& others_;
};

template <class Real>
Machine<Real>::Machine(const Routine& routine, const StepCode& code, const Others& others)
    : compiler_(std::make_unique<Compiler>(*this, routine, code, others)) {
  compiler_->compile();
  for (std::size_t i = 1 + argument_count_; i < shapes_.size(); ++i) {
    own_[i] = std::make_unique<Object<Real>>();
    if (shapes_[i].record != nullptr) *own_[i] = make_object<Real>(*shapes_[i].record);
    if (shapes_[i].record == nullptr) {
      own_[i]->numbers.resize(static_cast<std::size_t>(product(shapes_[i].sizes)));
    }
    objects_[i] = own_[i].get();
    frame_.objects[i] = own_[i]->numbers.data();
  }
  if (const auto pi = local_index_.find("pi"); pi != local_index_.end()) {
    locals_[static_cast<std::size_t>(pi->second)] = nearest_number<Real>(
        *parse_decimal("3.14159265358979323846264338327950288419716939937510"));
  }
  frame_.objects[0] = locals_.data();
}

template <class Real>
Machine<Real>::~Machine() = default;

template <class Real>
MachineReport<Real> Machine<Real>::run(const std::vector<Given<Real>>& arguments) {
  for (std::size_t i = 0; i < argument_count_; ++i) {
    objects_[1 + i] = arguments[i].object;
    frame_.objects[1 + i] = arguments[i].numbers;
  }
  report_ = {};
  iteration_ = 0;
  run_all(steps_);
  return report_;
}

template <class Real>
const Object<Real>& Machine<Real>::result() const {
  return *own_.back();
}

template Object<float> make_object(const Record&);
template Object<double> make_object(const Record&);
template Object<long double> make_object(const Record&);
template Object<Quad> make_object(const Record&);
template class Machine<float>;
template class Machine<double>;
template class Machine<long double>;
template class Machine<Quad>;

}  // namespace hamgen
