// Where the symbols and places of a routine are at run time.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/interpreter/machine.hpp"

namespace hamgen {

template <class Real>
class MachineAddresses {
 protected:
  MachineAddresses(MachineState<Real>& state, const Routine& routine, const Program& code)
      : m_(state), routine_(routine), code_(code) {}

  struct Compiled {
    Address target;
    CompiledExpression<Real> start, beside, way, correction;
    int memory = 0;
    bool by_torn = false;
  };

  struct Range {
    std::size_t index = 0;
    Address lower, upper;
  };
  Range range_of(const KernelRange& range) {
    return {static_cast<std::size_t>(loop_index(range.index)), index_address(range.lower),
            index_address(range.upper)};
  }
  void for_all(const std::vector<Range>& ranges, std::size_t depth,
               const std::function<void()>& use) const {
    if (depth == ranges.size()) return use();
    const Range& range = ranges[depth];
    const long last = evaluate(range.upper);
    for (long i = evaluate(range.lower); i <= last; ++i) {
      m_.frame.indices[range.index] = i;
      for_all(ranges, depth + 1, use);
    }
  }

  using Distance = typename NumericsOf<Real>::Moved;
  // Unknowns in arrays, and whole arrays.
  struct Array2 {
    Address value, increment;
    CompiledExpression<Real> beside;
    bool by_torn = false;
  };
  struct Whole {
    Address first;
    std::size_t size = 0;
  };
  Whole whole(const Place& place) {
    return {address(place), static_cast<std::size_t>(product(sizes_of(place)))};
  }
  [[nodiscard]] std::span<Real> span(const Whole& array) const {
    return {m_.frame.pointer(array.first), array.size};
  }

  // The matrix at a place, when it is wanted.
  std::function<AnyMatrix<Real>&()> matrix_at(const Place& place) {
    if (place.field.empty()) {
      return [this, name = place.object]() -> AnyMatrix<Real>& { return *m_.matrices.at(name); };
    }
    return [this, target = index_of(place.object), field = place.field]() -> AnyMatrix<Real>& {
      return *object(target).matrices.at(field);
    };
  }
  static Real magnitude(Real x) { return NumericsOf<Real>::size(x); }

  [[nodiscard]] Object<Real>& object(int index) const {
    return *m_.objects[static_cast<std::size_t>(index)];
  }

  void declare(const std::string& name, const Record* record, const std::vector<int>& sizes) {
    m_.object_index[name] = static_cast<int>(m_.shapes.size());
    m_.shapes.push_back({record, sizes});
  }
  // Arrays of several blocks may have one name: from its declaration on it is the array's own.
  void enter(const Array& array) { m_.object_index[array.name] = arrays_.at(&array); }
  // The records that a run keeps are "self.z", "self.start[i]", its numbers fields of "self".
  void declare_memory() {
    const auto keep = [&](const std::string& name, const Field& field, bool of_substep) {
      m_.kept.push_back({m_.shapes.size(), field.name, of_substep});
      declare(name, code_.record(field.type), {});
    };
    for (const Field& field : code_.record("Propagator")->fields) {
      keep("self." + field.name, field, false);
      if (!field.sizes.empty()) keep("self." + field.name + "[i]", field, true);
    }
  }
  void declare_all(const Body& body) {
    for (const Instruction& instruction : body) {
      if (const auto* array = std::get_if<Array>(&instruction.value)) {
        declare(array->name, nullptr, array->sizes);
        arrays_[array] = index_of(array->name);
      }
      if (const auto* refine = std::get_if<Refine>(&instruction.value)) {
        // As if it had one field: its change.
        declare(refine->name, nullptr, {static_cast<int>(refine->gradient.size())});
      }
      const auto* copy = std::get_if<Copy>(&instruction.value);
      if (copy != nullptr && copy->declares) declare(copy->to, code_.record(copy->record), {});
      if (const auto* locals = std::get_if<Declare>(&instruction.value)) {
        for (const std::string& name : locals->objects)
          declare(name, code_.record(locals->record), {});
      }
      if (const auto* note = std::get_if<Note>(&instruction.value))
        declare(note->name, nullptr, {});
      const auto* call = std::get_if<Call>(&instruction.value);
      if (call != nullptr && !call->object.empty() && !call->again) {
        declare(call->object, code_.record(call->record), {});
      }
      for (const Body* inner : inner_bodies(instruction)) declare_all(*inner);
    }
  }

  [[nodiscard]] int index_of(const std::string& object) const {
    const auto it = m_.object_index.find(object);
    if (it == m_.object_index.end()) internal_error("no object " + object);
    return it->second;
  }
  int loop_index(const std::string& name) {
    return m_.loop_index.try_emplace(name, static_cast<int>(m_.loop_index.size())).first->second;
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
      value += factor * m_.frame.indices[static_cast<std::size_t>(loop)];
    }
    return value;
  }

  [[nodiscard]] std::vector<int> sizes_of(const Place& place) const {
    const auto& shape = m_.shapes[static_cast<std::size_t>(index_of(place.object))];
    if (place.field.empty() || shape.record == nullptr) return shape.sizes;
    for (const Field& field : numeric_fields(*shape.record)) {
      if (field.name == place.field) return field.sizes;
    }
    return {};
  }
  [[nodiscard]] int size_of(const Place& place) const { return sizes_of(place).front(); }

  Address address(const Place& place) {
    if (place.object.empty()) {
      Address index = index_address(place.indices.front());
      index.object = kIndex;
      return index;
    }
    if (place.object == "self") return address(Place{"self." + place.field});
    if (!m_.object_index.contains(place.object)) return address(place.object);  // a local
    Address result{index_of(place.object), 0, {}};
    const auto& shape = m_.shapes[static_cast<std::size_t>(result.object)];
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
    // Symbols and objects have names of their own: a coordinate may be called z.  Only an argument
    // that is one number is both.
    const auto argument = m_.object_index.find(symbol);
    if (argument != m_.object_index.end()) {
      const auto& shape = m_.shapes[static_cast<std::size_t>(argument->second)];
      if (shape.record == nullptr && shape.sizes.empty()) return {argument->second, 0, {}};
    }
    const auto local = m_.local_index.try_emplace(symbol, static_cast<int>(m_.local_index.size()));
    return {0, local.first->second, {}};
  }

  CompiledExpression<Real> compiled(const Expression& e) {
    return CompiledExpression<Real>(
        e, [this](const std::string& symbol) { return address(symbol); }, functions_);
  }
  std::vector<Compiled> compiled(const std::vector<Unknown>& unknowns) {
    std::vector<Compiled> result;
    for (const Unknown& u : unknowns) {
      result.push_back({address(u.symbol), compiled(u.start), compiled(u.beside),
                        compiled(Expression::symbol(u.symbol) - u.beside), compiled(u.correction),
                        u.memory, u.by_torn});
    }
    return result;
  }

  MachineState<Real>& m_;
  const Routine& routine_;
  const Program& code_;
  FunctionsOf functions_ = FunctionsOf::library;  // of what is compiled now
  std::map<const Array*, int> arrays_;            // their objects
};

}  // namespace hamgen
