#include "generator/readback/text_scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "generator/algebra/functions.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/program/written_code.hpp"
#include "generator/readback/findings.hpp"

namespace hamgen {

namespace {

using TermKind = CppExpression::Kind;

AffineIndex times(AffineIndex a, long factor) {
  a.constant *= factor;
  for (auto& entry : a.factors) entry.second *= factor;
  std::erase_if(a.factors, [](const auto& entry) { return entry.second == 0; });
  return a;
}

long integer(const CppExpression& e) {
  int value = 0;
  const char* end = e.text.data() + e.text.size();
  const auto [last, error] = std::from_chars(e.text.data(), end, value);
  if (error != std::errc{} || last != end)
    throw TextNotUnderstood(e.line, fmt::format("'{}' as an index", e.text));
  return value;
}

}  // namespace

AffineIndex plus(AffineIndex a, const AffineIndex& b, long sign) {
  a.constant += sign * b.constant;
  for (const auto& [name, factor] : b.factors) a.factors[name] += sign * factor;
  std::erase_if(a.factors, [](const auto& entry) { return entry.second == 0; });
  return a;
}

std::string symbol_of(const Place& place) {
  if (place.object.empty()) return "#" + to_text(place.indices.front());
  return "@" + to_text(place);
}

void TextScope::declare(const std::string& name, Meaning meaning, int line) {
  if (!frames_.back().emplace(name, std::move(meaning)).second)
    throw TextDifference(line, fmt::format("'{}' is declared twice", name));
}

const Meaning* TextScope::find(const std::string& name) const {
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    const auto found = frame->find(name);
    if (found != frame->end()) return &found->second;
  }
  return nullptr;
}

bool TextScope::is_count(const CppExpression& e, const std::string& count) const {
  if (e.kind != TermKind::name) return e.text == count;
  const Meaning* meaning = find(e.text);
  return meaning != nullptr && meaning->kind == Meaning::Kind::index && meaning->name == count;
}

AffineIndex TextScope::index(const CppExpression& e) const {
  if (e.kind == TermKind::number) return {.constant = integer(e), .factors = {}};
  if (e.kind == TermKind::name) {
    const Meaning* meaning = find(e.text);
    if (meaning == nullptr && e.text == "n" && n_ > 0) return {.constant = n_, .factors = {}};
    if (meaning != nullptr && meaning->kind == Meaning::Kind::index)
      return {.constant = 0, .factors = {{meaning->name, 1}}};
  }
  if (e.kind == TermKind::prefix && e.text == "-") return times(index(e.parts[0]), -1);
  if (e.is_binary("+")) return plus(index(e.parts[0]), index(e.parts[1]), 1);
  if (e.is_binary("-")) return plus(index(e.parts[0]), index(e.parts[1]), -1);
  if (e.is_binary("*")) {
    const AffineIndex a = index(e.parts[0]);
    const AffineIndex b = index(e.parts[1]);
    if (a.factors.empty()) return times(b, a.constant);
    if (b.factors.empty()) return times(a, b.constant);
  }
  throw TextNotUnderstood(e.line, "an index that is no sum of indices");
}

std::optional<Place> TextScope::place(const CppExpression& e) const {
  const CppExpression* base = &e;
  std::vector<AffineIndex> indices;
  for (; base->kind == TermKind::index; base = &base->parts[0])
    indices.insert(indices.begin(), index(base->parts[1]));
  std::string field;
  for (; base->kind == TermKind::member; base = &base->parts[0])
    field = base->text + (field.empty() ? "" : ".") + field;
  if (base->kind == TermKind::index) {
    // An element of a list of records: start_[i].known
    const std::optional<Place> record = place(*base);
    if (!record) return {};
    return Place{to_text(*record), field, std::move(indices)};
  }
  if (base->kind != TermKind::name) return {};
  const Meaning* meaning = find(base->text);
  if (meaning == nullptr) return {};
  if (meaning->kind != Meaning::Kind::object && (!field.empty() || !indices.empty())) return {};
  return Place{meaning->name, field, std::move(indices)};
}

bool TextScope::is_place(const CppExpression& e, const Place& exact) const {
  const std::optional<Place> found = place(e);
  return found && to_text(*found) == to_text(exact);
}

std::optional<Place> TextScope::element(const CppExpression& e) const {
  AffineIndex offset;
  const CppExpression* array = &e;
  for (; array->is_binary("+") || array->is_binary("-"); array = &array->parts[0])
    offset = plus(offset, index(array->parts[1]), array->is_binary("+") ? 1 : -1);
  std::optional<Place> found = place(*array);
  if (found && array != &e) found->indices.push_back(offset);
  return found;
}

MachineValue TextScope::value(const CppExpression& e) const {
  switch (e.kind) {
    case TermKind::number:
      return number(e);
    case TermKind::quoted:
      throw TextNotUnderstood(e.line, "a string in a formula");
    case TermKind::name:
      return name(e);
    case TermKind::prefix:
      if (e.text == "-") return -value(e.parts[0]);
      return machine_call("prefix" + e.text, {value(e.parts[0])});
    case TermKind::postfix:
      return machine_call("postfix" + e.text, {value(e.parts[0])});
    case TermKind::binary:
      return binary(e);
    case TermKind::choice:
      return machine_call("?:", {value(e.parts[0]), value(e.parts[1]), value(e.parts[2])});
    case TermKind::call:
      return call(e);
    case TermKind::index:
    case TermKind::member: {
      const std::optional<Place> found = place(e);
      if (!found) throw TextNotUnderstood(e.line, "an object that is not declared here");
      for (const AffineIndex& each : found->indices) {
        if (in_lanes() && each.factors.contains(lane_index_))
          throw TextDifference(e.line, "a number of one stage where those of all belong");
      }
      return machine_symbol(symbol_of(*found));
    }
    case TermKind::list: {
      std::vector<MachineValue> parts;
      for (const CppExpression& part : e.parts) parts.push_back(value(part));
      return machine_call("{}", std::move(parts));
    }
  }
  throw TextNotUnderstood(e.line, "a formula");
}

// Literals have the type of the numbers they meet: another one would widen what is computed.
MachineValue TextScope::number(const CppExpression& e) const {
  const std::optional<CppLiteral> literal = read_literal(e.text);
  if (!literal) throw TextNotUnderstood(e.line, fmt::format("the number {}", e.text));
  if (literal->is_integer) return machine_symbol("#" + std::to_string(integer(e)));
  if (precision_.is_quad() || literal->bits != precision_.bits)
    throw TextDifference(e.line, fmt::format("{} is no literal of {}", e.text, precision_.type));
  return {.kind = MachineValue::Kind::number, .number = literal->value};
}

MachineValue TextScope::name(const CppExpression& e) const {
  const Meaning* meaning = find(e.text);
  if (meaning == nullptr) return machine_symbol("::" + e.text);
  if (meaning->kind == Meaning::Kind::number) return machine_symbol(meaning->name);
  return machine_symbol((meaning->kind == Meaning::Kind::index ? "#" : "@") + meaning->name);
}

MachineValue TextScope::binary(const CppExpression& e) const {
  MachineValue a = value(e.parts[0]);
  MachineValue b = value(e.parts[1]);
  const bool constant =
      a.kind == MachineValue::Kind::number && b.kind == MachineValue::Kind::number;
  if (!constant || (e.text == "/" && b.number == 0)) {
    if (e.text == "+") return std::move(a) + std::move(b);
    if (e.text == "-") return std::move(a) + -std::move(b);
    if (e.text == "*") return std::move(a) * std::move(b);
    if (e.text == "/") return std::move(a) / std::move(b);
    return machine_call(e.text, {std::move(a), std::move(b)});
  }
  const Rational x = a.negative ? -a.number : a.number;
  const Rational y = b.negative ? -b.number : b.number;
  Rational result;
  if (e.text == "+") {
    result = x + y;
  } else if (e.text == "-") {
    result = x - y;
  } else if (e.text == "*") {
    result = x * y;
  } else if (e.text == "/") {
    result = x / y;
  } else {
    throw TextNotUnderstood(e.line, fmt::format("'{}' between numbers", e.text));
  }
  result = rounded(result, precision_);
  return {.kind = MachineValue::Kind::number, .negative = result < 0, .number = abs(result)};
}

MachineValue TextScope::call(const CppExpression& e) const {
  const CppExpression& callee = e.parts[0];
  if (callee.is_name("Real") && e.parts.size() == 2) return converted(e.parts[1]);
  if (in_lanes() && callee.is_name("Lanes::at") && e.parts.size() == 2)
    return machine_symbol(symbol_of(lanes(e.parts[1])));
  std::vector<MachineValue> arguments;
  for (std::size_t i = 1; i < e.parts.size(); ++i) arguments.push_back(value(e.parts[i]));
  if (const std::optional<Place> found = place(callee))
    return machine_call(symbol_of(*found), std::move(arguments));
  if (callee.kind != TermKind::name) throw TextNotUnderstood(e.line, "what is called here");
  return machine_call(function(callee.text, e.line), std::move(arguments));
}

bool TextScope::is_of_stages(const Place& place) const {
  return written::is_of_lanes(place, lane_index_);
}

Place TextScope::lanes(const CppExpression& e) const {
  const std::optional<Place> found = element(e);
  if (!found || !is_of_stages(*found))
    throw TextDifference(e.line, "no numbers of the stages of this loop");
  return *found;
}

// Real(2 * i + 1), and the doubles that quad numbers are written in.
MachineValue TextScope::converted(const CppExpression& argument) const {
  if (argument.kind == TermKind::number && precision_.is_quad()) {
    const std::optional<CppLiteral> literal = read_literal(argument.text);
    if (!literal) throw TextNotUnderstood(argument.line, "a number");
    return {.kind = MachineValue::Kind::number, .number = literal->value};
  }
  if (argument.kind == TermKind::prefix && argument.text == "-" && precision_.is_quad())
    return -converted(argument.parts[0]);
  return machine_symbol("#" + to_text(index(argument)));
}

// A function of the mathematical library for this scalar, by its name without all that; any other
// with "::" before it, but for what the fixed blocks are called in the routines.
std::string TextScope::function(const std::string& name, int line) const {
  if (is_rounding_error(name)) return name;
  if (has_packs() && name.starts_with("lane_")) {
    const Function* row = find_function(name.substr(5));
    return row != nullptr ? std::string(row->cpp) : name.substr(5);
  }
  constexpr std::string_view kLibrary = "library<std::";
  if (has_packs() && name.starts_with(kLibrary))
    return name.substr(kLibrary.size(), name.size() - kLibrary.size() - 1);
  if (name.starts_with("std::") && !precision_.is_quad()) return name.substr(5);
  constexpr std::string_view kBuiltin = "__builtin_";
  if (name.starts_with(kBuiltin) && !precision_.is_quad()) {
    std::string plain = name.substr(kBuiltin.size());
    const std::string suffix = precision_.bits == 24 ? "f" : precision_.bits == 64 ? "l" : "";
    if (!plain.ends_with(suffix)) throw TextDifference(line, name + " is of another type");
    plain.resize(plain.size() - suffix.size());
    return plain;
  }
  const bool in_quadmath =
      name == "powq" ||
      std::ranges::find(all_functions(), name, &Function::quad) != all_functions().end();
  if (precision_.is_quad() && in_quadmath) return name.substr(0, name.size() - 1);
  return "::" + name;
}

}  // namespace hamgen
