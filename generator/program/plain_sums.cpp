#include "generator/program/plain_sums.hpp"

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

namespace {

bool is_gone(const std::string& object) { return object == "carry" || object == "rest"; }

// The carry, or what an array of stages keeps of it.
bool is_carry(const Place& place) {
  return place.object == "carry" || (place.object == "start" && place.field == "small");
}

class PlainSums {
 public:
  explicit PlainSums(Routine& routine) : routine_(routine) {
    for (const auto& [symbol, place] : routine.places) {
      if (is_carry(place)) zeros_.emplace(symbol, Expression(0));
    }
  }

  void run() {
    std::erase_if(routine_.arguments, [](const Argument& each) { return is_gone(each.name); });
    for (std::string& line : routine_.remark) {
      if (line.find("z + carry") != std::string::npos) line = "dz = Z - z for one step from z.";
    }
    rewrite(routine_.body);
    std::erase_if(routine_.places, [](const auto& entry) {
      return is_gone(entry.second.object) || is_carry(entry.second);
    });
  }

 private:
  void rewrite(Body& body) {
    Body result;
    for (Instruction& instruction : body) {
      for (Body* inner : inner_bodies(instruction)) rewrite(*inner);
      for_values(instruction, [this](Expression& e) { e = substitute(e, zeros_); });
      if (is_dropped(instruction)) continue;
      result.push_back(std::move(instruction));
      if (const auto* assign = std::get_if<Assign>(&result.back().value)) join(result, *assign);
    }
    body = std::move(result);
  }

  // Changes what stays, too.
  bool is_dropped(Instruction& instruction) {
    if (const auto* let = std::get_if<Let>(&instruction.value)) {
      // A sum that had nothing but a carry.
      const bool nothing = let->value.is_zero() && !let->varies;
      if (nothing) zeros_.emplace(let->symbol, Expression(0));
      return nothing;
    }
    if (const auto* assign = std::get_if<Assign>(&instruction.value)) {
      const auto place = routine_.places.find(assign->symbol);
      if (place == routine_.places.end()) return false;
      return is_carry(place->second) || (place->second.object == "rest" && assign->value.is_zero());
    }
    if (const auto* loop = std::get_if<For>(&instruction.value)) return loop->body.empty();
    if (auto* copy = std::get_if<Copy>(&instruction.value)) {
      if (is_gone(copy->from)) copy->from.clear();
      return is_gone(copy->to);
    }
    if (auto* call = std::get_if<Call>(&instruction.value)) drop_arguments(*call);
    if (auto* two = std::get_if<Alternate>(&instruction.value)) {
      drop_arguments(two->first);
      drop_arguments(two->second);
    }
    if (auto* end = std::get_if<Return>(&instruction.value))
      std::erase_if(end->finite, [this](const auto& symbol) { return stands_in(symbol, "rest"); });
    if (auto* iterate = std::get_if<Iterate>(&instruction.value)) forget(iterate->kept);
    if (auto* refine = std::get_if<Refine>(&instruction.value)) forget(refine->kept);
    if (const auto* sum = std::get_if<Collect>(&instruction.value))
      instruction.value = Accumulate{sum->symbol, sum->value};
    if (const auto* sum = std::get_if<CollectStages>(&instruction.value)) {
      const Expression values = sum_from(sum->in("slope"), sum->count);
      instruction.value = Assign{sum->symbol, values + sum_from(sum->in("change"), sum->count)};
    }
    return false;
  }

  Expression sum_from(Place place, int count) {
    Expression sum(0);
    for (int i = 0; i < count; ++i, ++place.indices.back().constant) {
      const std::string symbol = to_text(place);
      routine_.places.insert_or_assign(symbol, place);
      sum += Expression::symbol(symbol, kRankOfVariable + static_cast<int>(routine_.places.size()));
    }
    return sum;
  }

  static void drop_arguments(Call& call) {
    std::erase_if(call.arguments, [](const Place& place) { return is_gone(place.object); });
  }
  void forget(std::vector<std::string>& kept) const {
    std::erase_if(kept, [this](const auto& symbol) { return zeros_.contains(symbol); });
  }

  [[nodiscard]] bool stands_in(const std::string& symbol, const std::string& object) const {
    const auto it = routine_.places.find(symbol);
    return it != routine_.places.end() && it->second.object == object;
  }

  // dz = a; rest = b becomes dz = a + b.
  void join(Body& body, const Assign& last) const {
    if (!stands_in(last.symbol, "rest")) return;
    Place place = routine_.places.at(last.symbol);
    place.object = "dz";
    const auto is_increment = [&](const Instruction& each) {
      const auto* assign = std::get_if<Assign>(&each.value);
      return assign != nullptr && stands_in(assign->symbol, "dz") &&
             routine_.places.at(assign->symbol) == place;
    };
    const auto found = std::ranges::find_if(body, is_increment);
    if (found == body.end()) internal_error("a rest of no increment");
    Assign sum = std::get<Assign>(found->value);
    sum.value += last.value;
    body.back().value = std::move(sum);
    body.erase(found);
  }

  Routine& routine_;
  Substitution zeros_;
};

}  // namespace

void use_plain_sums(Program& code) {
  for (Routine& routine : code.routines) PlainSums(routine).run();
  for (Record& record : code.records)
    std::erase_if(record.fields, [&](const Field& field) {
      return record.name == "Start" && field.name == "small";
    });
}

}  // namespace hamgen
