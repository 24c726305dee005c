// What stands in statements: values, places, names.
#include <fmt/format.h>

#include <algorithm>

#include "generator/formats/routine_printer.hpp"

namespace hamgen {

std::string Dialect::kept_place(const Place& place) const {
  if (place.object == "self") return kept(place.field);
  const std::string within = to_text(Place{"", place.field, place.indices});
  return kept(place.object.substr(5)) + within;
}

std::string RoutinePrinter::value(const written::Value& v) {
  using enum written::Value::Kind;
  switch (v.kind) {
    case formula:
      return cpp_(v.formula);
    case place: {
      const bool whole = v.place.field.empty() && v.place.indices.empty();
      return (whole && is_address(v.place.object) ? "*" : "") + text(v.place);
    }
    case object:
      return text(v.place);
    case given:
      return given_text(v.place);
    case index:
      return text(v.place.indices.front());
    case count:
      return count_text(v.place.indices.front().constant);
    case word:
      return v.text == "largest" ? std::string(dialect_.scalar.largest) : v.text;
    case constant:
      return dialect_.constant(v.text);
    case zeros:
      return dialect_.empty_record(v.text);
    case call: {
      std::vector<std::string> list = values(v);
      for (std::size_t i = 0; i < v.changed && !dialect_.has_references(); ++i)
        list[i] = "&" + list[i];
      // Without a name in parentheses alone.
      const std::string name = v.text.empty() ? "" : dialect_.block(v.text);
      return fmt::format("{}({})", name, joined_texts(list, ", "));
    }
    case routine:
      return fmt::format("{}({})", dialect_.routine(v.text), arguments(v));
    case of_run:
      return dialect_.call_of_run(v.text, arguments(v));
    case action: {
      std::vector<std::string> list = values(v);
      const std::string of = list.front();
      list.erase(list.begin());
      return dialect_.call(v.type, of, v.text, joined_texts(list, ", "));
    }
    case member:
      return arguments(v) + "." + v.text;
    case prefix:
      return v.text + arguments(v);
    case joined:
      return joined_texts(values(v), (" " + v.text + " ").c_str());
    case choice: {
      const std::vector<std::string> parts = values(v);
      return fmt::format("{} ? {} : {}", parts[0], parts[1], parts[2]);
    }
    case list:
      return "{" + arguments(v) + "}";
  }
  return {};
}

std::vector<std::string> RoutinePrinter::values(const written::Value& of) {
  std::vector<std::string> texts;
  for (const written::Value& part : of.parts) texts.push_back(value(part));
  return texts;
}

std::string RoutinePrinter::name(const std::string& symbol) {
  if (symbol == "pi") {
    used_.pi = true;
    return dialect_.constant("pi");
  }
  const auto place = routine_.places.find(symbol);
  if (place != routine_.places.end()) {
    if (!written::is_of_lanes(place->second, lane_index_)) return text(place->second);
    return "Lanes::at(" + given_text(place->second) + ")";
  }
  const bool number = std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
    return argument.name == symbol && argument.record.empty() && argument.sizes.empty();
  });
  return number ? symbol : names_.local(symbol);
}

bool RoutinePrinter::is_address(const std::string& object) const {
  return !dialect_.has_references() &&
         std::ranges::any_of(routine_.arguments, [&](const Argument& argument) {
           return argument.name == object && !argument.record.empty();
         });
}

std::string RoutinePrinter::object(const std::string& name) const {
  if (name.starts_with("self.")) return dialect_.kept(name.substr(5));
  if (name.starts_with("new ")) return dialect_.empty_record(name.substr(4));
  const auto other = objects_.find(name);
  return written::name_in_text(other == objects_.end() ? name : other->second);
}

std::string RoutinePrinter::sizes(const std::vector<int>& sizes) const {
  std::string text;
  for (const int size : sizes) text += "[" + count_text(size) + "]";
  return text;
}

std::string RoutinePrinter::count_text(long count) const {
  if (dialect_.n == 0 || count % dialect_.n != 0 || count > 2L * dialect_.n) {
    return std::to_string(count);
  }
  return count == dialect_.n ? "n" : count == 0 ? "0" : "2 * n";
}

std::string RoutinePrinter::text(const AffineIndex& a) const {
  const bool is_n = dialect_.n > 0 && a.constant == dialect_.n && !a.factors.empty();
  const bool falls = std::ranges::all_of(a.factors, [](const auto& f) { return f.second < 0; });
  const bool leads = is_n || falls;  // the constant
  std::string text = is_n ? "n" : leads && a.constant != 0 ? std::to_string(a.constant) : "";
  const auto add = [&text](bool negative, const std::string& term) {
    text += text.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
    text += term;
  };
  for (const bool negative : {false, true}) {
    for (const auto& [index, factor] : a.factors) {
      const long size = std::abs(factor);
      if ((factor < 0) == negative)
        add(negative, size == 1 ? index : fmt::format("{} * {}", size, index));
    }
  }
  if (!leads && a.constant != 0) add(a.constant < 0, std::to_string(std::abs(a.constant)));
  return text.empty() ? "0" : text;
}

std::string RoutinePrinter::text(const Place& place) const {
  if (place.object.empty()) return dialect_.number(text(place.indices.front()));
  if (place.object == "self") return dialect_.kept(place.field);
  std::string result = object(place.object);
  if (!place.field.empty()) result += (is_address(place.object) ? "->" : ".") + place.field;
  for (const AffineIndex& index : place.indices) result += "[" + text(index) + "]";
  return result;
}

std::string RoutinePrinter::given_text(const Place& place) const {
  const bool ours = records_.contains(place.object) || place.object.starts_with("self.") ||
                    place.object.starts_with("new ");
  const bool record = place.field.empty() && ours;
  if (record && !dialect_.has_references()) return "&" + object(place.object);
  if (place.indices.empty()) return text(place);
  Place array = place;
  array.indices.pop_back();
  const AffineIndex& index = place.indices.back();
  const std::string offset = index.factors.empty() ? count_text(index.constant) : text(index);
  return text(array) + " + " + offset;
}

}  // namespace hamgen
