#include "generator/verify/symbolic_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "generator/base/diagnostic.hpp"
#include "generator/program/arithmetic.hpp"
#include "generator/program/lower.hpp"
#include "generator/verify/symbolic_instructions.hpp"

namespace hamgen {

namespace {

// Of a field of a record; none of a scalar or of one that is not in it.
std::vector<int> field_sizes(const Record* record, const std::string& field) {
  if (record == nullptr) return {};
  const auto it = std::ranges::find(record->fields, field, &Field::name);
  return it == record->fields.end() ? std::vector<int>{} : it->sizes;
}

bool is_error(const Expression& e) {
  return e.kind() == Kind::function && is_rounding_error(e.name());
}

bool has_error(const Expression& e) {
  return is_error(e) || std::ranges::any_of(e.operands(), has_error);
}

long count_of(const std::vector<int>& sizes) {
  long count = 1;
  for (const int size : sizes) count *= size;
  return count;
}

}  // namespace

SymbolicMachine::SymbolicMachine(const Program& code, std::set<std::string> opaque)
    : code_(code), opaque_(std::move(opaque)) {}

SymbolicMachine::Frame SymbolicMachine::frame_of(const std::string& routine,
                                                 const std::string& prefix) {
  Frame frame{.routine = code_.routine(routine), .prefix = prefix};
  if (frame.routine == nullptr) internal_error("no routine of the name " + routine);
  const Result& result = frame.routine->result;
  if (!result.object.empty()) {
    frame.objects[result.object] = {.root = prefix + result.object, .record = result.type};
    zeroed_.insert(prefix + result.object);
  }
  return frame;
}

std::optional<Expression> SymbolicMachine::run(const std::string& routine) {
  Frame frame = frame_of(routine, "");
  for (const Argument& argument : frame.routine->arguments) {
    if (argument.record.empty() && argument.sizes.empty()) {
      frame.locals[argument.name] = argument.name == "h" ? Expression::symbol("h", kRankOfStep)
                                                         : Expression::symbol(argument.name);
    } else {
      frame.objects[argument.name] = {
          .root = argument.name, .record = argument.record, .sizes = argument.sizes};
    }
  }
  run(frame, frame.routine->body);
  last_locals_ = frame.locals;
  return frame.result;
}

void SymbolicMachine::run(Frame& frame, const Body& body) {
  for (const Instruction& instruction : body) {
    if (frame.ended) return;
    std::visit(Run{*this, frame}, instruction.value);
  }
}

// --- names and values ----------------------------------------------------------------------------

std::string SymbolicMachine::unique(const std::string& name) {
  const int used = names_[name]++;
  return used == 0 ? name : unique(fmt::format("{}#{}", name, used + 1));
}

Expression SymbolicMachine::free_symbol(const std::string& name) {
  const auto hint = hints_.find(name);
  return Expression::symbol(unique(hint == hints_.end() ? name : hint->second), kRankOfTemporary);
}

Expression SymbolicMachine::define(const std::string& name, const Expression& value) {
  if (is_trivial(value)) return value;
  if (is_error(value)) return without_rounding(name, value);
  if (has_error(value)) return free_symbol(name);
  const auto [known, is_new] = known_.try_emplace({name, value}, Expression());
  if (!is_new) return known->second;
  known->second = Expression::symbol(unique(name), kRankOfTemporary);
  definitions_.add(known->second.name(), value);
  return known->second;
}

// What a product or a difference loses is free, and its rounded value, which stands before it, is
// the exact one less that.
Expression SymbolicMachine::without_rounding(const std::string& name, const Expression& error) {
  const Expression& x = error.operands()[0];
  const Expression& y = error.operands()[1];
  const Expression exact = error.name() == kProductError ? x * y : x - y;
  if (is_trivial(exact)) return Expression(0);
  const auto known = lost_.find(exact);
  if (const std::optional<std::size_t> i = definitions_.computed_as(exact)) {
    // What is computed twice by different names is rounded alike.
    const Expression lost = known == lost_.end() ? free_symbol(name) : known->second;
    definitions_.change(*i, definitions_.all()[*i].value - lost);
    lost_.emplace(exact, lost);
    return lost;
  }
  // Of what nobody has computed, or of one that has been told already.
  return known == lost_.end() ? free_symbol(name) : known->second;
}

Expression SymbolicMachine::set_free(Frame& frame, const Expression& value, std::size_t first) {
  if (value.kind() != Kind::symbol) return value;
  const std::optional<std::size_t> place = definitions_.place(value.name());
  if (!place || *place < first) return value;
  const Expression symbol = free_symbol(value.name() + "'");
  for (auto& [name, local] : frame.locals) {
    if (local == value) local = symbol;
  }
  return symbol;
}

std::optional<Expression> SymbolicMachine::local(const std::string& symbol) const {
  const auto it = last_locals_.find(symbol);
  if (it == last_locals_.end()) return {};
  return it->second;
}

Expression SymbolicMachine::evaluate(Frame& frame, const Expression& e) {
  Substitution values;
  for (const std::string& name : symbols(e)) values.emplace(name, number(frame, name));
  return substitute(e, values);
}

Expression SymbolicMachine::number(Frame& frame, const std::string& symbol) {
  const auto local = frame.locals.find(symbol);
  if (local != frame.locals.end()) {
    if (const auto added = frame.added.extract(symbol)) {
      std::vector<Expression> terms = added.mapped();
      terms.push_back(local->second);
      local->second = Expression::sum(std::move(terms));
    }
    return local->second;
  }
  const auto place = frame.routine->places.find(symbol);
  return place == frame.routine->places.end() ? Expression::symbol(symbol)
                                              : number_at(frame, place->second);
}

Expression SymbolicMachine::number_at(Frame& frame, const Place& place) {
  if (place.object.empty()) return Expression(at(frame, place.indices.at(0)));
  if (place.field.empty() && place.indices.empty()) {
    const auto local = frame.locals.find(place.object);
    if (local != frame.locals.end()) return local->second;
  }
  return read(cell(reference(frame, place)));
}

void SymbolicMachine::assign(Frame& frame, const std::string& symbol, const Expression& value,
                             bool by_name) {
  const auto place = frame.routine->places.find(symbol);
  if (place == frame.routine->places.end() || frame.locals.contains(symbol)) {
    frame.added.erase(symbol);
    frame.locals[symbol] = by_name ? define(symbol, value) : value;
  } else {
    const std::string where = cell(reference(frame, place->second));
    write(where, by_name ? define(where, value) : value);
  }
}

std::optional<std::string> SymbolicMachine::symbol_of(const Frame& frame, const Place& place) {
  const auto it = std::ranges::find_if(frame.routine->places,
                                       [&](const auto& entry) { return entry.second == place; });
  if (it == frame.routine->places.end()) return {};
  return it->first;
}

std::string SymbolicMachine::cell_of(Frame& frame, const std::string& symbol) {
  return cell(reference(frame, frame.routine->places.at(symbol)));
}

// --- places --------------------------------------------------------------------------------------

long SymbolicMachine::at(const Frame& frame, const AffineIndex& index) {
  long value = index.constant;
  for (const auto& [name, factor] : index.factors) value += factor * frame.indices.at(name);
  return value;
}

SymbolicMachine::Reference SymbolicMachine::reference(Frame& frame, const Place& place) const {
  const auto known = frame.objects.find(place.object);
  Reference result =
      known != frame.objects.end() ? known->second : Reference{.root = frame.prefix + place.object};
  if (!place.field.empty()) {
    result.field = place.field;
    result.sizes = field_sizes(code_.record(result.record), place.field);
    result.record.clear();
  }
  if (place.indices.empty()) return result;
  long linear = 0;
  for (std::size_t i = 0; i < place.indices.size(); ++i) {
    if (i > 0) linear *= result.sizes.at(i);
    linear += at(frame, place.indices[i]);
  }
  result.offset += linear;
  result.is_element = true;
  return result;
}

std::string SymbolicMachine::cell(const Reference& r) {
  const std::string stem = r.field.empty() ? r.root : r.root + "." + r.field;
  return r.is_element || !r.sizes.empty() ? fmt::format("{}[{}]", stem, r.offset) : stem;
}

std::vector<std::string> SymbolicMachine::cells_of(const Reference& reference) const {
  std::vector<std::string> cells;
  const auto add = [&](const std::string& stem, const std::vector<int>& sizes, long offset) {
    if (sizes.empty()) return cells.push_back(stem);
    for (long i = 0; i < count_of(sizes); ++i) {
      cells.push_back(fmt::format("{}[{}]", stem, offset + i));
    }
  };
  if (const Record* record = code_.record(reference.record)) {
    for (const Field& field : record->fields) {
      if (field.type == "Real") add(reference.root + "." + field.name, field.sizes, 0);
    }
    return cells;
  }
  const std::string& field = reference.field;
  add(field.empty() ? reference.root : reference.root + "." + field, reference.sizes,
      reference.offset);
  return cells;
}

void SymbolicMachine::forget(const std::string& root) {
  zeroed_.insert(root);
  std::erase_if(cells_, [&](const auto& entry) {
    return entry.first == root || entry.first.starts_with(root + ".") ||
           entry.first.starts_with(root + "[");
  });
}

Expression SymbolicMachine::read(const std::string& cell) {
  const auto it = cells_.find(cell);
  if (it != cells_.end()) return it->second;
  const std::string root = cell.substr(0, cell.find_last_of(".["));
  const bool zero = zeroed_.contains(root) || zeroed_.contains(cell.substr(0, cell.rfind('.')));
  const Expression value = zero ? Expression(0) : free_symbol(cell);
  cells_.emplace(cell, value);
  return value;
}

void SymbolicMachine::write(const std::string& cell, const Expression& value) {
  cells_.insert_or_assign(cell, value);
}

// --- from outside --------------------------------------------------------------------------------

Expression SymbolicMachine::value(const Place& place) { return read(outer_cell(place)); }

void SymbolicMachine::set(const Place& place, const Expression& value) {
  write(outer_cell(place), value);
}
void SymbolicMachine::set_flag(const Place& place, bool value) {
  flags_[outer_cell(place)] = value;
}
void SymbolicMachine::name(const Place& place, const std::string& symbol) {
  hints_[outer_cell(place)] = symbol;
}

std::string SymbolicMachine::outer_cell(const Place& place) const {
  std::string text = place.field.empty() ? place.object : place.object + "." + place.field;
  for (const AffineIndex& index : place.indices) text += fmt::format("[{}]", index.constant);
  return text;
}

}  // namespace hamgen
