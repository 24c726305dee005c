// What the rules are told by which iterations end, and in which blocks.
#pragma once

#include <functional>

#include "generator/program/names.hpp"
#include "generator/program/written_failures.hpp"

namespace hamgen::written {

class RuleWriter : public FailureWriter {
 public:
  using FailureWriter::FailureWriter;

 protected:
  // What the rule says of increments, of the lengths that their unknowns are rounded with, and of
  // their ways.
  Value judged_of_each(const std::vector<Unknown>& unknowns, const Place& rule) {
    std::vector<Value> moved, lengths, ways;
    for (const Unknown& u : unknowns) {
      moved.push_back(magnitude(u.correction));
      lengths.push_back(length(u.symbol, u.beside));
      ways.push_back(u.by_torn ? way(u.symbol, u.beside) : lengths.back());
    }
    const auto count = static_cast<int>(unknowns.size());
    add(count == 1 ? Define{"Real", "size ", moved[0]} : numbers("moved ", std::move(moved)));
    add(count == 1 ? Define{"Real", "scale ", lengths[0]} : numbers("length ", std::move(lengths)));
    if (count == 1) return action("NewtonRule", rule, "", judged_by_size());
    const bool has_ways = std::ranges::any_of(unknowns, &Unknown::by_torn);
    if (has_ways) add(numbers("way ", std::move(ways)));
    return action("NewtonRule", rule, "of_each",
                  {object({"moved "}), object({"length "}), object({has_ways ? "way " : "length "}),
                   integer(count), at({"iteration "})});
  }

  // What the rule says of sums over the unknowns: of increments as parts of their sizes, and of
  // what each must be lost in.
  Value judged_of_parts(const IterateArray& iterate) {
    const Place rule{"start", iterate.name};
    add(Do{action("NewtonRule", rule, "know",
                  {object(iterate.values), object(iterate.increments), integer(iterate.count)})});
    for (const char* sum : {"size ", "uneven ", "moved ", "scale "})
      add(Define{"Real", sum, integer(0), true});
    over_unknowns(iterate, [&](const UnknownArray& u) {
      const Value moved = magnitude(Expression::symbol(u.increment));
      const Value unit = at({"start", iterate.name + ".unit", {u.index}});
      set(at({"size "}), joined("*", {moved, unit}), "+=");
      set(at({"moved "}), moved, "+=");
      set(at({"scale "}), length(u.value, u.beside), "+=");
      Value longest = length(u.value, u.beside);
      Value gone = u.by_torn ? way(u.value, u.beside) : longest;
      set(at({"uneven "}),
          action("NewtonRule", rule, "relative",
                 {index(u.index), moved, std::move(longest), std::move(gone)}),
          "+=");
    });
    return action(
        "NewtonRule", rule, "of_sums",
        {object(iterate.values), object(iterate.increments), at({"size "}), at({"uneven "}),
         at({"moved "}), at({"scale "}), integer(iterate.count), at({"iteration "})});
  }
  // Of linear equations it is told the increments, and what their unknowns are rounded with.
  Value judged_of_lengths(const IterateArray& iterate) {
    const Place rule{"start", iterate.name};
    for (const char* sum : {"size ", "scale ", "uneven "})
      add(Define{"Real", sum, integer(0), true});
    over_unknowns(iterate, [&](const UnknownArray& u) {
      const Value moved = magnitude(Expression::symbol(u.increment));
      set(at({"size "}), moved, "+=");
      set(at({"scale "}), length(u.value, u.beside), "+=");
      set(at({"uneven "}),
          action("LinearRule", rule, "relative", {moved, length(u.value, u.beside)}), "+=");
    });
    std::vector<Value> judged = judged_by_size();
    judged.push_back(at({"uneven "}));
    return action("LinearRule", rule, "", std::move(judged));
  }
  void over_unknowns(const IterateArray& iterate,
                     const std::function<void(const UnknownArray&)>& write_one) {
    const auto each = [&] {
      for (const UnknownArray& u : iterate.unknowns) write_one(u);
    };
    over(iterate.ranges, each, Shape::braces);
  }

  // Of a fixed point it is told a Distance.
  void distance_of(const IterateArray& iterate) {
    const auto add_to_distance = [&](std::vector<Value> values) {
      if (iterate.lanes == 0)
        return void(add(Do{action("Distance", {"distance "}, "add", std::move(values))}));
      const std::vector<Value> sum = {call("Lanes", {integer(0)}), object({"distance "})};
      values.insert(values.begin(), sum.begin(), sum.end());
      add(Do{call("add_lanes", std::move(values))});
    };
    const std::vector<WholeUnknowns> arrays = whole_unknowns(routine_, iterate);
    for (const WholeUnknowns& u : arrays) {
      const AffineIndex count{.constant = u.count, .factors = {}};
      add_to_distance({at(u.increment, Value::Kind::given), at(u.value, Value::Kind::given),
                       at(u.beside, Value::Kind::given), index(count, Value::Kind::count)});
    }
    if (!arrays.empty()) return;
    over_unknowns(iterate, [&](const UnknownArray& u) {
      add_to_distance({magnitude(Expression::symbol(u.increment)), length(u.value, u.beside)});
    });
  }

  static Define numbers(const std::string& name, std::vector<Value> values, bool varies = false) {
    const auto count = static_cast<int>(values.size());
    return {"Real", name, list(std::move(values)), varies, {count}};
  }

  static std::vector<Value> judged_by_size() {
    return {at({"size "}), at({"scale "}), at({"iteration "})};
  }
};

}  // namespace hamgen::written
