// Values in the text.
#include "generator/readback/findings.hpp"
#include "generator/readback/routine_reader.hpp"

namespace hamgen {

bool RoutineReader::same(const CppExpression& e, const written::Value& v) {
  using enum written::Value::Kind;
  switch (v.kind) {
    case formula:
      return is_same(scope_.value(e), meant(v.formula), scope_.precision());
    case place:
      if (v.place.object.empty())
        return is_same(scope_.value(e), machine_symbol(symbol_of(v.place)), scope_.precision());
      return scope_.is_place(e, v.place);
    case object:
      return scope_.is_place(e, v.place);
    case given:
      return is_given(e, v.place);
    case index:
    case count:
      return scope_.index(e) == v.place.indices.front();
    case constant:
    case word:
      return v.text == "largest" ? is_largest(e) : is_free_name(e, v.text);
    case call:
      // In parentheses alone.
      if (v.text.empty()) return same(e, v.parts[0]);
      [[fallthrough]];
    case zeros:
    case routine:
    case of_run:
      return e.kind == CppExpression::Kind::call && is_free_name(e.parts[0], v.text) &&
             same_parts(e, 1, v, 0);
    case action:
      return is_action(e, v);
    case member:
      return e.kind == CppExpression::Kind::member && e.text == v.text && same_parts(e, 0, v, 0);
    case prefix:
      return e.kind == CppExpression::Kind::prefix && e.text == v.text && same_parts(e, 0, v, 0);
    case joined:
      return is_joined(e, v);
    case choice:
      return e.kind == CppExpression::Kind::choice && same_parts(e, 0, v, 0);
    case list:
      return e.kind == CppExpression::Kind::list && same_parts(e, 0, v, 0);
  }
  internal_error("unknown kind of a value");
}

bool RoutineReader::same_parts(const CppExpression& e, std::size_t first, const written::Value& v,
                               std::size_t first_of_value) {
  if (e.parts.size() - first != v.parts.size() - first_of_value) return false;
  for (std::size_t i = 0; first + i < e.parts.size(); ++i) {
    if (!same(e.parts[first + i], v.parts[first_of_value + i])) return false;
  }
  return true;
}

// No local of this name.
bool RoutineReader::is_free_name(const CppExpression& e, const std::string& name) const {
  return e.is_name(name) && !scope_.place(e);
}

bool RoutineReader::is_largest(const CppExpression& e) const {
  const MachineValue largest{.kind = MachineValue::Kind::number,
                             .number = read_literal(scope_.precision().largest)->value};
  return is_same(scope_.value(e), largest, scope_.precision());
}

// object.name(...), or object(...)
bool RoutineReader::is_action(const CppExpression& e, const written::Value& v) {
  if (e.kind != CppExpression::Kind::call) return false;
  const CppExpression* object = &e.parts[0];
  if (!v.text.empty()) {
    if (object->kind != CppExpression::Kind::member || object->text != v.text) return false;
    object = &object->parts[0];
  }
  return same(*object, v.parts[0]) && same_parts(e, 1, v, 1);
}

// As it is read, from the left.
bool RoutineReader::is_joined(const CppExpression& e, const written::Value& v) {
  const CppExpression* left = &e;
  for (std::size_t i = v.parts.size() - 1; i > 0; --i) {
    if (!left->is_binary(v.text) || !same(left->parts[1], v.parts[i])) return false;
    left = &left->parts[0];
  }
  return same(*left, v.parts[0]);
}

bool RoutineReader::is_given(const CppExpression& e, const Place& place) const {
  if (place.object.starts_with("new "))
    return e.kind == CppExpression::Kind::call && e.parts.size() == 1 &&
           is_free_name(e.parts[0], place.object.substr(4));
  if (place.indices.empty()) return scope_.is_place(e, place);
  // An array from an element on: array + n + 2 * i.
  const std::optional<Place> found = scope_.element(e);
  return (e.is_binary("+") || e.is_binary("-")) && found && to_text(*found) == to_text(place);
}

}  // namespace hamgen
