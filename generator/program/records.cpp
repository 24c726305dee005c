#include "generator/program/records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "generator/base/diagnostic.hpp"
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
  for (const Field& field : record.fields) {
    const auto count = field.sizes.empty() ? 1 : static_cast<std::size_t>(field.sizes.front());
    if (component >= count) {
      component -= count;
      continue;
    }
    Place place{.object = object, .field = field.name};
    if (!field.sizes.empty())
      place.indices.push_back({.constant = static_cast<long>(component), .factors = {}});
    return place;
  }
  internal_error("a component of no field");
}

std::vector<std::string> place_texts(const Layout& layout) {
  std::vector<std::string> texts;
  if (layout.in_loops) return texts;
  for (const Field& field : layout.record.fields) {
    if (field.sizes.empty()) texts.push_back(field.name);
    for (int i = 0; !field.sizes.empty() && i < field.sizes.front(); ++i)
      texts.push_back(fmt::format("{}[{}]", field.name, i));
  }
  return texts;
}

namespace {

// "A[1..5]", "A[3], A[5]"; empty where an element has the number here that it has in the model.
std::string elements_text(const std::string& base, const std::vector<long>& numbers) {
  constexpr std::size_t most = 6;
  const auto size = static_cast<long>(numbers.size());
  const long first = numbers.front();
  const bool is_range = numbers.back() - first == size - 1;
  if (is_range && first == 0) return "";
  if (is_range && size > 1) return fmt::format("{}[{}..{}]", base, first, numbers.back());
  std::string text;
  for (std::size_t i = 0; i < std::min(numbers.size(), most); ++i)
    text += fmt::format("{}{}[{}]", i == 0 ? "" : ", ", base, numbers[i]);
  return text + (numbers.size() > most ? fmt::format(", ... {}[{}]", base, numbers.back()) : "");
}

}  // namespace

Layout layout(const std::string& name, const std::vector<Quantity>& quantities, Defaults defaults) {
  Layout result{.record = {.name = name, .fields = {}}};
  std::vector<Field>& fields = result.record.fields;
  std::set<std::string> taken;
  std::string last;  // the array whose elements come one after the other
  std::vector<long> numbers;
  const auto end_array = [&] {
    if (numbers.empty()) return;
    const std::string elements = elements_text(last, std::exchange(numbers, {}));
    std::string& words = fields.back().remark;
    if (!elements.empty()) words = elements + (words.empty() ? "" : ": " + words);
  };
  for (const Quantity& quantity : quantities) {
    const ElementName element = split_element(quantity.name);
    if (fields.empty() || !element.indexed || last != element.base) {
      end_array();
      std::string field = member_identifier(element.base);
      while (!taken.insert(field).second) field += "_";
      fields.push_back({.name = field, .remark = remark(quantity)});
      last = element.indexed ? element.base : "";
    }
    Field& field = fields.back();
    if (element.indexed) {
      if (field.sizes.empty()) field.sizes.push_back(0);
      ++field.sizes.front();
      numbers.push_back(element.index);
    }
    if (defaults == Defaults::values) field.values.push_back(quantity.value);
  }
  end_array();
  return result;
}

namespace {

// "x[0..5], y[0..5]": the arrays that these of the variables are, one after the other.
std::string arrays_of(const QuantityList& variables, std::size_t first, std::size_t count) {
  std::string text;
  for (const QuantityList::Run& run : variables.runs()) {
    if (run.begin < first || run.begin >= first + count) continue;
    text += (text.empty() ? "" : ", ") + run.of.name;
    if (!run.indexed) continue;
    text += fmt::format("[{}..{}]", run.first, run.first + static_cast<long>(run.count) - 1);
  }
  return text;
}

}  // namespace

Layout array_state(const QuantityList& variables) {
  Layout result{.record = {.name = "State", .fields = {}}, .in_loops = true};
  const std::size_t n = variables.size() / 2;
  for (const char* name : {"q", "p"}) {
    const std::size_t first = *name == 'q' ? 0 : n;
    const bool says_itself = split_element(variables.name(first)).base == name &&
                             split_element(variables.name(first + n - 1)).base == name;
    result.record.fields.push_back({.name = name,
                                    .sizes = {static_cast<int>(n)},
                                    .remark = says_itself ? "" : arrays_of(variables, first, n)});
  }
  return result;
}

}  // namespace hamgen
