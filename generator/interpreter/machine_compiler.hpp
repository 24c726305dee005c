// Makes the steps of a machine from the instructions of its routine.
#pragma once

#include <cmath>

#include "generator/interpreter/machine_iteration_compiler.hpp"

namespace hamgen {

template <class Real>
class MachineCompiler : public MachineIterationCompiler<Real> {
  using Base = MachineIterationCompiler<Real>;
  using Base::address;
  using Base::code_;
  using Base::compiled;
  using Base::declare;
  using Base::declare_all;
  using Base::enter;
  using Base::evaluate;
  using Base::for_all;
  using Base::index_address;
  using Base::index_of;
  using Base::loop_index;
  using Base::m_;
  using Base::matrix_at;
  using Base::object;
  using Base::range_of;
  using Base::routine_;
  using Base::run_all;
  using Base::size_of;
  using Base::sizes_of;
  using typename Base::Range;
  using typename Base::Step;
  using typename Base::Steps;

 public:
  using Others = typename Machine<Real>::Others;
  MachineCompiler(MachineState<Real>& state, const Routine& routine, const Program& code,
                  const Others& others)
      : Base(state, routine, code), others_(others) {}

  Steps compile() {
    m_.object_index["(locals)"] = 0;
    m_.shapes.push_back({});
    for (const Argument& argument : routine_.arguments) {
      declare(argument.name, argument.record.empty() ? nullptr : code_.record(argument.record),
              argument.sizes);
    }
    for (const Argument& argument : routine_.arguments) m_.arguments.push_back(argument.name);
    if (routine_.of_run) this->declare_memory();
    declare_all(routine_.body);
    const Record* returned = code_.record(routine_.result.type);
    if (returned != nullptr && !routine_.result.object.empty()) {
      declare(routine_.result.object, returned, {});
    }
    m_.objects.resize(m_.shapes.size());
    m_.frame.objects.resize(m_.shapes.size());
    m_.own.resize(m_.shapes.size());
    Steps result = steps(routine_.body);
    m_.frame.indices.resize(m_.loop_index.size());
    m_.locals.resize(m_.local_index.size() + 1);
    return result;
  }

  Step operator()(const Let& let) { return assign(let.symbol, let.value); }
  Step operator()(const Assign& assign_) { return assign(assign_.symbol, assign_.value); }
  Step operator()(const Accumulate& sum) {
    const Address target = address(sum.symbol);
    return [this, target, value = compiled(sum.value)] {
      m_.frame.at(target) += value(m_.frame);
      return true;
    };
  }
  Step operator()(const Collect& sum) {
    const Address target = address(sum.symbol);
    const Address lost = address(sum.lost);
    return [this, target, lost, value = compiled(sum.value)] {
      NumericsOf<Real>::collect_rest(m_.frame.at(target), m_.frame.at(lost), value(m_.frame));
      return true;
    };
  }
  Step operator()(const CollectStages& sum) {
    const Address target = address(sum.symbol);
    const Address lost = address(sum.lost);
    return [this, target, lost, slopes = address(sum.in("slope")),
            changes = address(sum.in("change")), sum] {
      NumericsOf<Real>::collect_stages(m_.frame.at(target), m_.frame.at(lost), sum.lanes,
                                       &m_.frame.at(slopes), &m_.frame.at(changes), sum.count);
      return true;
    };
  }
  Step operator()(const Array& array) {
    enter(array);
    const Address target{index_of(array.name), 0, {}};
    std::vector<CompiledExpression<Real>> values;
    for (const Expression& e : array.values) values.push_back(compiled(e));
    const long size = product(array.sizes);
    return [this, target, size, values] {
      Real* numbers = &m_.frame.at(target);
      for (long i = 0; i < size; ++i) numbers[i] = 0;
      for (const auto& value : values) *numbers++ = value(m_.frame);
      return true;
    };
  }
  Step operator()(const Matrix& matrix) {
    // Those of several blocks have one name.
    const std::string form =
        fmt::format("{} {}{}{}", matrix.name, matrix.size, matrix.symmetric ? " symmetric" : "",
                    matrix.patterned ? " patterned" : "");
    return [this, matrix, form] {
      std::unique_ptr<AnyMatrix<Real>>& own = m_.own_matrices[form];
      if (own) {
        own->clear();
      } else {
        own = matrix.patterned ? Blocks<Real>::matrix(code_.matrix->rows(), code_.matrix->symmetric,
                                                      code_.matrix->rows_of_border())
                               : Blocks<Real>::matrix(matrix.size, matrix.symmetric);
      }
      m_.matrices[matrix.name] = own.get();
      return true;
    };
  }
  Step operator()(const Copy& copy) {
    const int to = index_of(copy.to);
    if (copy.from.empty()) {
      const Record* record = code_.record(copy.record);
      return [this, to, record] {
        this->begin_anew(to, *record);
        return true;
      };
    }
    const int from = index_of(copy.from);
    return [this, to, from] {
      object(to).numbers = object(from).numbers;
      m_.frame.objects[static_cast<std::size_t>(to)] = object(to).numbers.data();
      return true;
    };
  }
  Step operator()(const Clear& clear) {
    return [this, matrix = matrix_at(clear.matrix)] {
      matrix().clear();
      return true;
    };
  }
  Step operator()(const Put& put) {
    const Address row = index_address(put.row);
    const Address column = index_address(put.column);
    return [this, matrix = matrix_at(put.matrix), row, column, value = compiled(put.value)] {
      matrix().put(static_cast<int>(evaluate(row)), static_cast<int>(evaluate(column)),
                   value(m_.frame));
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
    const FunctionsOf outer = this->functions_;
    if (loop.lanes > 0) this->functions_ = FunctionsOf::lanes;
    Steps body = steps(loop.body);
    this->functions_ = outer;
    return [this, index, lower, upper, body = std::move(body)] {
      const long last = evaluate(upper);
      for (long i = evaluate(lower); i <= last; ++i) {
        m_.frame.indices[index] = i;
        if (!run_all(body)) return false;
      }
      return true;
    };
  }
  Step operator()(const Scope& scope) {
    return [this, body = steps(scope.body)] { return run_all(body); };
  }
  Step operator()(const If& branch) {
    const int also = branch.also ? index_of(branch.also->object) : 0;
    return [this, branch, target = index_of(branch.flag.object), also, body = steps(branch.then)] {
      if ((object(target).flags.at(branch.flag.field) != 0) != branch.set) return true;
      if (also > 0 && object(also).flags.at(branch.also->field) == 0) return true;
      return run_all(body);
    };
  }
  Step operator()(const Call& call) {
    return [this, run = called(call), call] {
      const MachineReport<Real> report = run();
      return report.converged || !call.must_succeed;
    };
  }
  Step operator()(const Alternate& alternate) {
    const auto first = called(alternate.first);
    const auto second = called(alternate.second);
    const int target = index_of(alternate.patience.object);
    return [this, first, second, target, alternate, before = steps(alternate.before),
            between = steps(alternate.between)] {
      int& patience = object(target).flags.at(alternate.patience.field);
      if (patience == 0 && !run_all(before)) return false;
      for (int attempt = 0; attempt < alternate.attempts() && patience == 0; ++attempt) {
        if (first().converged) return true;
        if (!run_all(between)) return false;
      }
      if (patience == 0) patience = alternate.steps;
      --patience;
      return second().converged;
    };
  }
  Step operator()(const Factorise& factorise) {
    return [this, matrix = matrix_at(factorise.matrix), count = factorise.compared] {
      if (count > 0) m_.newton->compare(matrix(), count);
      if (matrix().factorise()) return true;
      m_.report.iterations += m_.iteration;
      m_.report.increment = HUGE_VAL;
      return false;
    };
  }
  Step operator()(const SolveFactorised& solve) {
    const Address vector = address(solve.vector);
    const auto size = static_cast<std::size_t>(product(sizes_of(solve.vector)));
    return [this, matrix = matrix_at(solve.matrix), vector, size] {
      matrix().solve({&m_.frame.at(vector), size});
      return true;
    };
  }
  Step operator()(const Invert& invert) {
    const Address inverse = address(invert.inverse);
    return [this, invert, inverse, target = index_of(invert.regular.object)] {
      AnyMatrix<Real>& matrix = *m_.matrices.at(invert.matrix);
      const int size = size_of(invert.inverse);
      const bool regular = matrix.factorise();
      for (int c = 0; regular && c < size; ++c) {
        std::vector<Real> column(static_cast<std::size_t>(size));
        column[static_cast<std::size_t>(c)] = 1;
        matrix.solve(column);
        for (int i = 0; i < size; ++i) {
          (&m_.frame.at(inverse))[i * size + c] = column[static_cast<std::size_t>(i)];
        }
      }
      int& flag = object(target).flags.at(invert.regular.field);
      flag = regular && flag != 0 ? 1 : 0;
      return true;
    };
  }
  using Base::operator();
  Step operator()(const Repeat& repeat) {
    return [this, count = static_cast<std::size_t>(repeat.count), body = steps(repeat.body)] {
      for (std::size_t i = 0; i < count; ++i) {
        m_.memory->substep = i;
        if (!run_all(body)) return false;
      }
      return true;
    };
  }
  Step operator()(const Return& end) {
    if (!end.report.empty()) {
      return [this, from = index_of(end.report)] {
        const Object<Real>& report = object(from);
        m_.report.converged = report.flags.at("converged") != 0;
        m_.report.iterations = report.flags.at("iterations");
        m_.report.increment = report.numbers.at(0);
        return false;
      };
    }
    if (end.value) {
      return [this, value = compiled(*end.value)] {
        m_.report.value = value(m_.frame);
        return false;
      };
    }
    std::vector<std::vector<Address>> finite;
    for (const std::vector<std::string>& sum : finite_sums(routine_, end)) {
      finite.emplace_back();
      for (const std::string& symbol : sum) finite.back().push_back(address(symbol));
    }
    std::vector<Range> ranges;
    for (const KernelRange& range : end.ranges) ranges.push_back(range_of(range));
    const int target = end.flag ? index_of(end.flag->object) : 0;
    return [this, end, finite, ranges, target] {
      Real length = 0;
      for_all(ranges, 0, [&] {
        Real sum = 0;
        for (const std::vector<Address>& places : finite) {
          Real moved = 0;
          for (const Address& place : places) moved += m_.frame.at(place);
          sum += moved * moved;
        }
        length += sum;
      });
      m_.report.converged = end.success && length <= NumericsOf<Real>::most;
      if (end.success && !m_.report.converged) m_.report.increment = length;
      if (end.flag) object(target).flags.at(end.flag->field) = m_.report.converged;
      return false;
    };
  }

 private:
  // What runs the routine that is called.
  std::function<MachineReport<Real>()> called(const Call& call) {
    Machine<Real>* other = others_.at(call.routine).get();
    const std::vector<Argument>& arguments = code_.routine(call.routine)->arguments;
    struct Passed {
      Address place;
      std::function<AnyMatrix<Real>&()> matrix;
      bool is_report = false;
    };
    std::vector<Passed> slots;
    bool reports = call.record == "StepReport";
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      Passed slot;
      if (arguments[i].record == "Matrix") {
        slot.matrix = matrix_at(call.arguments[i]);
      } else if (arguments[i].record == "StepReport") {
        slot.is_report = true;
        reports = true;
      } else {
        slot.place = address(call.arguments[i]);
      }
      slots.push_back(std::move(slot));
    }
    const bool kept = !call.object.empty() && (routine_.of_run || call.record != "StepReport");
    const int result = kept ? index_of(call.object) : 0;
    return [this, other, slots, reports, result] {
      std::vector<Given<Real>> given;
      for (const Passed& slot : slots) {
        if (slot.matrix) {
          given.push_back({nullptr, nullptr, &slot.matrix()});
        } else if (slot.is_report) {
          given.push_back({});
        } else {
          given.push_back({m_.frame.pointer(slot.place),
                           m_.objects[static_cast<std::size_t>(slot.place.object)]});
        }
      }
      const MachineReport<Real> report = other->run(given);
      if (routine_.of_run) {
        this->keep_report(result, report);
        return report;
      }
      if (reports) m_.report.iterations += report.iterations;
      if (reports) m_.report.increment = report.increment;
      if (result > 0) {
        object(result).numbers = other->result().numbers;
        object(result).flags = other->result().flags;
        m_.frame.objects[static_cast<std::size_t>(result)] = object(result).numbers.data();
      }
      return report;
    };
  }
  Step assign(const std::string& symbol, const Expression& value) {
    const CompiledExpression<Real> compiled_value = compiled(value);
    return [this, target = address(symbol), compiled_value] {
      m_.frame.at(target) = compiled_value(m_.frame);
      return true;
    };
  }

  Steps steps(const Body& body) override {
    Steps result;
    for (const Instruction& instruction : body) {
      result.push_back(std::visit(*this, instruction.value));
    }
    return result;
  }

  const Others& others_;
};

}  // namespace hamgen
