#include "generator/interpreter/object.hpp"

#include <algorithm>
#include <cctype>

#include "generator/base/diagnostic.hpp"
#include "generator/interpreter/compiled_expression.hpp"
#include "generator/program/refinement_type.hpp"

namespace hamgen {

long product(const std::vector<int>& sizes) {
  long result = 1;
  for (const int size : sizes) result *= size;
  return result;
}

namespace {

// The numbers in "Refinement<12, 24>".
std::vector<int> template_arguments(const std::string& type) {
  std::vector<int> values;
  for (std::size_t i = type.find('<'); i < type.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(type[i])) != 0;
    if (!digit) continue;
    std::size_t length = 0;
    values.push_back(std::stoi(type.substr(i), &length));
    i += length;
  }
  return values;
}

template <class Real>
void add_block(Object<Real>& object, const Field& field, const Program& code) {
  const std::vector<int> sizes = template_arguments(field.type);
  if (field.type == "Matrix") {
    object.matrices[field.name] = Blocks<Real>::matrix(code.matrix->rows(), code.matrix->symmetric,
                                                       code.matrix->rows_of_border());
  } else if (field.type.starts_with("NewtonRule<")) {
    object.rules[field.name] = Blocks<Real>::newton_rule(sizes.at(0), 0, false);
  } else if (field.type.starts_with("NewtonRuleOfMany")) {
    object.rules[field.name] = Blocks<Real>::newton_rule(sizes.at(0), sizes.at(1), false);
  } else if (field.type.starts_with("NewtonRuleWithMatrix")) {
    object.rules[field.name] = Blocks<Real>::newton_rule_with_matrix(sizes.at(0));
  } else if (field.type.starts_with("WaitingNewtonRule")) {
    object.rules[field.name] = Blocks<Real>::newton_rule(sizes.at(0), sizes.at(1), true);
  } else if (field.type == "LinearRule") {
    object.rules[field.name] = Blocks<Real>::linear_rule();
  } else if (field.type.starts_with("SimplifiedNewtonRule")) {
    object.simplified[field.name] = Blocks<Real>::simplified_newton_rule();
  } else if (field.type.starts_with("Refinement")) {
    object.refinements[field.name] =
        Blocks<Real>::refinement(sizes.at(0), sizes.at(1), has_two_forms(field.type));
  } else if (auto rule = Blocks<Real>::fixed_point_rule(field.type)) {
    object.contractions[field.name] = std::move(rule);
  } else {
    internal_error("no block " + field.type);
  }
}

}  // namespace

std::vector<Field> numeric_fields(const Record& record) {
  std::vector<Field> fields;
  for (const Field& field : record.fields) {
    if (field.type == "Real") fields.push_back(field);
    if (!field.type.starts_with("Refinement")) continue;
    for (const char* part : {".slope", ".change"}) {
      fields.push_back(
          {.name = field.name + part, .sizes = {template_arguments(field.type).at(1)}});
    }
  }
  return fields;
}

long offset_of(const Record& record, const std::string& field) {
  long offset = 0;
  for (const Field& candidate : numeric_fields(record)) {
    if (candidate.name == field) return offset;
    offset += product(candidate.sizes);
  }
  if (std::ranges::find(record.fields, field, &Field::name) != record.fields.end()) return 0;
  internal_error("no field " + field + " in " + record.name);
}

template <class Real>
Object<Real> make_object(const Record& record, const Program& code) {
  Object<Real> object;
  for (const Field& field : numeric_fields(record)) {
    const auto size = static_cast<std::size_t>(product(field.sizes));
    for (std::size_t i = 0; i < size; ++i) {
      const bool given = i < field.values.size();
      object.numbers.push_back(given ? nearest_number<Real>(field.values[i]) : Real(0));
    }
  }
  for (const Field& field : record.fields) {
    if (field.type == "bool" || field.type == "int") {
      object.flags[field.name] = !field.values.empty() && field.values[0] != 0 ? 1 : 0;
    } else if (field.type != "Real") {
      add_block(object, field, code);
    }
  }
  return object;
}

template Object<float> make_object(const Record&, const Program&);
template Object<double> make_object(const Record&, const Program&);
template Object<long double> make_object(const Record&, const Program&);
template Object<numerics_of_quad::Real> make_object(const Record&, const Program&);

}  // namespace hamgen
