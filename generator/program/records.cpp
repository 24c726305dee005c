#include "generator/program/records.hpp"

#include <algorithm>
#include <set>

#include "generator/program/names.hpp"

namespace hamgen {

namespace {

std::string remark(const Quantity& quantity) {
  std::string text = quantity.comment;
  if (!quantity.unit.empty()) text += (text.empty() ? "[" : " [") + quantity.unit + "]";
  return text;
}

}  // namespace

Place Layout::in(const std::string& object, std::size_t component) const {
  Place place = places.at(component);
  place.object = object;
  return place;
}

std::vector<std::string> place_texts(const Layout& layout) {
  std::vector<std::string> texts;
  for (const Place& place : layout.places) texts.push_back(to_text(place).substr(1));
  return texts;
}

Layout layout(const std::string& name, const std::vector<Quantity>& quantities, Defaults defaults) {
  Layout result{.record = {.name = name, .fields = {}}, .places = {}};
  std::vector<Field>& fields = result.record.fields;
  std::set<std::string> taken;
  std::string last;  // the array whose elements come one after the other
  for (const Quantity& quantity : quantities) {
    const ElementName element = split_element(quantity.name);
    if (fields.empty() || !element.indexed || last != element.base) {
      std::string field = member_identifier(element.base);
      while (!taken.insert(field).second) field += "_";
      fields.push_back({.name = field, .remark = remark(quantity)});
      last = element.indexed ? element.base : "";
    }
    Field& field = fields.back();
    Place place{.object = {}, .field = field.name};
    if (element.indexed) {
      if (field.sizes.empty()) field.sizes.push_back(0);
      place.indices.push_back({.constant = field.sizes.front()++, .factors = {}});
    }
    if (defaults == Defaults::values) field.values.push_back(quantity.value);
    result.places.push_back(std::move(place));
  }
  return result;
}

Layout array_state(int degrees_of_freedom) {
  Layout result{.record = {.name = "State", .fields = {}}, .places = {}};
  for (const char* name : {"q", "p"}) {
    result.record.fields.push_back({.name = name, .sizes = {degrees_of_freedom}});
    for (int i = 0; i < degrees_of_freedom; ++i) {
      result.places.push_back(
          {.object = {}, .field = name, .indices = {{.constant = i, .factors = {}}}});
    }
  }
  return result;
}

}  // namespace hamgen
