#include "generator/program/records.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <string>

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

namespace {

// "x[0..5], y[0..5]": the arrays that the variables are, one after the other.
std::string arrays_of(std::span<const Quantity> variables) {
  std::string text;
  std::string last;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const ElementName element = split_element(variables[i].name);
    if (i > 0 && element.indexed && element.base == last) continue;
    last = element.base;
    text += (text.empty() ? "" : ", ") + variables[i].name;
    if (!element.indexed) continue;
    const auto end =
        std::find_if(variables.begin() + static_cast<std::ptrdiff_t>(i), variables.end(),
                     [&](const Quantity& other) { return split_element(other.name).base != last; });
    const std::string& name = std::prev(end)->name;
    text.pop_back();
    text += ".." + name.substr(name.find('[') + 1);
  }
  return text;
}

}  // namespace

Layout array_state(const std::vector<Quantity>& variables) {
  Layout result{.record = {.name = "State", .fields = {}}, .places = {}};
  const std::size_t n = variables.size() / 2;
  for (const char* name : {"q", "p"}) {
    const std::span<const Quantity> own = std::span(variables).subspan(*name == 'q' ? 0 : n, n);
    const bool says_itself =
        split_element(own.front().name).base == name && split_element(own.back().name).base == name;
    result.record.fields.push_back({.name = name,
                                    .sizes = {static_cast<int>(n)},
                                    .remark = says_itself ? "" : arrays_of(own)});
    for (std::size_t i = 0; i < n; ++i) {
      result.places.push_back({.object = {},
                               .field = name,
                               .indices = {{.constant = static_cast<long>(i), .factors = {}}}});
    }
  }
  return result;
}

}  // namespace hamgen
